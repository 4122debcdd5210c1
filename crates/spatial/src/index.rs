//! The trait of all spatial indices, and the index without a structure.

use glam::DVec3;

use crate::error::SpatialError;
use crate::item::{Item, check_items};
use crate::ray::Ray;

/// Items that can be searched by their place in space.
///
/// An index implements only two searches: the items near a point, and the items along a ray. All
/// queries are written once, on top of these, in [`PointQueries`](crate::PointQueries) and
/// [`SurfaceQueries`](crate::SurfaceQueries). Therefore all indices have the same queries and the
/// same answers, and differ only in time and memory.
///
/// # Contract
///
/// - **Slots.** An index orders its items as it likes. The slot of an item is its place in this
///   order, from 0.
/// - **Complete.** A search visits every item whose box is within the limit that was valid when the
///   item's turn came. It may visit others. It visits no item twice.
/// - **Limit.** `visit` returns the limit for the rest of the search, which must not grow.
/// - **Rounding.** The squared distance of a box is never larger than that of a point inside, as
///   computed in double precision from differences to the query, so no item is skipped by rounding.
/// - **No cache.** A query changes nothing in the index, so threads can share it.
pub trait SpatialIndex<I: Item>: Sized + Send + Sync {
    /// The name of the index: `kd-tree`.
    const NAME: &'static str;

    /// Builds the index of `items`.
    ///
    /// The same items in the same order give the same index on any number of threads.
    ///
    /// # Errors
    ///
    /// [`SpatialError::ItemNotFinite`] for the first item with a coordinate that is not finite;
    /// [`SpatialError::TooManyItems`] beyond `u32::MAX` items.
    fn build(items: Vec<I>) -> Result<Self, SpatialError>;

    /// Returns the items by slot.
    fn items(&self) -> &[I];

    /// Calls `visit` with the slot of each item that may be within the squared distance `limit` of
    /// `query`, near items first as far as the structure allows.
    ///
    /// Visits nothing if a coordinate of `query` is not finite or beyond the range of `f32`.
    fn visit_near(&self, query: DVec3, limit: f64, visit: impl FnMut(usize) -> f64);

    /// Calls `visit` with the slot of each item whose box `ray` may hit up to the scaled parameter
    /// `limit`, in about the order of the ray.
    #[doc(hidden)]
    fn visit_along(&self, ray: &Ray, limit: f64, visit: impl FnMut(usize) -> f64);

    /// Returns the bytes of all tables, items included; O(1).
    fn memory_bytes(&self) -> usize;
}

/// Returns whether a search for `query` can find anything.
#[inline]
pub(crate) fn can_search(query: DVec3) -> bool {
    query.as_vec3().is_finite()
}

/// A list of items without any structure: each query visits all of them.
///
/// The reference for the other indices, and the fastest one for a few items.
#[derive(Clone, Debug)]
pub struct ItemList<I> {
    items: Vec<I>,
}

impl<I: Item> SpatialIndex<I> for ItemList<I> {
    const NAME: &'static str = "list";

    fn build(items: Vec<I>) -> Result<Self, SpatialError> {
        check_items(&items)?;
        Ok(Self { items })
    }

    fn items(&self) -> &[I] {
        &self.items
    }

    fn visit_near(&self, query: DVec3, _: f64, mut visit: impl FnMut(usize) -> f64) {
        if can_search(query) {
            (0..self.items.len()).for_each(|slot| {
                visit(slot);
            });
        }
    }

    fn visit_along(&self, _: &Ray, _: f64, mut visit: impl FnMut(usize) -> f64) {
        (0..self.items.len()).for_each(|slot| {
            visit(slot);
        });
    }

    fn memory_bytes(&self) -> usize {
        size_of_val(self.items.as_slice())
    }
}
