//! Rotated axes for the boxes of a node, where boxes along the coordinate axes do not separate its items.
//!
//! ```text
//!   ┌──────────┐         The boxes of slanted needles overlap almost entirely, so a search visits all of
//!   │ ╱ ╱ ╱ ╱  │         them. Along the axes of the needles, the boxes are as thin as these
//!   │╱ ╱ ╱ ╱   │         (Gottschalk, Lin & Manocha 1996). Most nodes need no axes of their own.
//!   └──────────┘
//! ```

use glam::{DMat3, DVec3};

use super::build::BoxedItem;
use crate::bounds::Bounds;
use crate::item::Item;
use crate::turned_box::axes_along;

/// Nodes with at most this number of items are not divided again.
pub(super) const FEW: usize = 16;

/// The boxes of parts overlap if their sizes are more than this multiple of the size of the whole. The
/// parts of a surface have about the size of the whole.
const OVERLAPPING: f64 = 2.0;

/// Other axes are used if the sizes of the parts are less than this part of those along the old axes.
const BETTER: f64 = 0.5;

/// The length of a box along an axis counts at least this part of the longest box, so that flat boxes have
/// a size.
const LEAST_LENGTH: f64 = 1e-6;

/// The sizes of boxes: products of their lengths.
pub(super) struct Sizes {
    /// The least length of a box that counts.
    least: DVec3,
}

impl Sizes {
    /// Sizes of parts of `whole`.
    pub(super) fn within(whole: &Bounds) -> Self {
        let least = DVec3::splat(LEAST_LENGTH * whole.longest_axis().1);
        Self { least }
    }

    fn of(&self, bounds: &Bounds) -> f64 {
        bounds.extent().max(self.least).element_product()
    }

    pub(super) fn sum(&self, parts: &[Bounds]) -> f64 {
        parts.iter().map(|part| self.of(part)).sum()
    }

    /// Returns whether the boxes of parts overlap so much that other axes are tried.
    pub(super) fn overlap(&self, whole: &Bounds, parts: &[Bounds]) -> bool {
        self.sum(parts) > OVERLAPPING * self.of(whole)
    }
}

/// Returns axes along which the items of a node may have smaller boxes: along their longest side, and
/// along the side that is longest across it. `None` if the sides are on one line.
pub(super) fn other_axes<I: Item>(boxed: &[BoxedItem], items: &[I]) -> Option<DMat3> {
    axes_along(|| {
        boxed
            .iter()
            .flat_map(|boxed| items[boxed.item as usize].sides())
    })
}

/// Returns whether other parts are used: `before` and `after` are the sums of the sizes of the parts.
pub(super) fn is_better(before: f64, after: f64, is_turned: bool) -> bool {
    let factor = if is_turned { BETTER } else { 1.0 };
    after < factor * before && before.is_finite()
}
