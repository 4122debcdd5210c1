//! Handles of elements, and maps from handles to values.

use std::fmt::Debug;
use std::hash::Hash;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

use rustc_hash::FxHashMap;

use crate::handles::row_id::RowId;

/// A value that identifies an element of a structure: a row, a pair of vertices, or coordinates.
///
/// The type of the handle determines the type of maps from handles to values ([`Handle::Map`]).
pub trait Handle: Copy + Eq + Ord + Hash + Debug + Send + Sync + 'static {
    /// A map from handles to values: a vector if handles are rows, otherwise a hash map.
    type Map<T: Clone>: HandleMap<Self, T>;
}

/// A map from the handles of one kind of element to values.
///
/// For each handle, the map returns an initial value until another value is written for this
/// handle.
pub trait HandleMap<H: Copy, T: Clone>: Index<H, Output = T> + IndexMut<H> + Clone {
    /// Builds a map that returns `value` for every handle. If handles are rows, every row must be
    /// less than `rows`.
    fn filled(rows: usize, value: T) -> Self;

    /// Reserves memory for `more` handles, if the map is a hash map.
    fn reserve(&mut self, more: usize) {
        let _ = more;
    }

    /// Stores `value` for `handle`, which may be new; O(1) amortised. A [`RowMap`] grows if
    /// necessary, and all rows that it adds get `value`.
    fn insert(&mut self, handle: H, value: T);

    /// Removes the value of `handle`, whose element was removed; O(1). A [`RowMap`] keeps the value
    /// in the unused row.
    fn remove(&mut self, handle: H);

    /// Moves the value of the handle `old` to the handle `new`; O(1) amortised.
    ///
    /// This method changes the handle of a single element. If an edit exchanges the handles of
    /// several elements, [`Changes::apply_to`](crate::Changes::apply_to) changes all of these
    /// handles at once.
    fn rename(&mut self, old: H, new: H) {
        let value = self[old].clone();
        self.remove(old);
        self.insert(new, value);
    }
}

/// A [`HandleMap`] for handles that are rows: a vector.
#[derive(Clone, Debug, PartialEq)]
pub struct RowMap<H, T> {
    values: Vec<T>,
    handle: PhantomData<H>,
}

impl<H, T> RowMap<H, T> {
    /// Returns the values in the order of the rows.
    pub fn values(&self) -> &[T] {
        &self.values
    }
}

/// Returns a map without rows.
impl<H, T> Default for RowMap<H, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

/// Builds the map from the values in the order of the rows, without copying.
///
/// ```
/// use sixfold_core::{FaceId, RowMap};
/// let areas: RowMap<FaceId, f32> = vec![0.5, 2.0].into();
/// assert_eq!(areas[FaceId::new(1)], 2.0);
/// ```
impl<H, T> From<Vec<T>> for RowMap<H, T> {
    fn from(values: Vec<T>) -> Self {
        Self {
            values,
            handle: PhantomData,
        }
    }
}

/// Returns the values in the order of the rows, without copying.
impl<H, T> From<RowMap<H, T>> for Vec<T> {
    fn from(map: RowMap<H, T>) -> Self {
        map.values
    }
}

/// Collects the values in the order of the rows.
impl<H, T> FromIterator<T> for RowMap<H, T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        values.into_iter().collect::<Vec<T>>().into()
    }
}

/// Stores the value of each handle, as [`insert`](HandleMap::insert) does.
impl<H: RowId, T: Clone> Extend<(H, T)> for RowMap<H, T> {
    #[inline]
    fn extend<I: IntoIterator<Item = (H, T)>>(&mut self, values: I) {
        for (handle, value) in values {
            self.insert(handle, value);
        }
    }
}

impl<H: RowId, T: Clone> HandleMap<H, T> for RowMap<H, T> {
    #[inline]
    fn filled(rows: usize, value: T) -> Self {
        Self {
            values: vec![value; rows],
            handle: PhantomData,
        }
    }

    #[inline]
    fn insert(&mut self, handle: H, value: T) {
        let at = handle.row() as usize;
        if at >= self.values.len() {
            self.values.resize(at + 1, value);
        } else {
            self.values[at] = value;
        }
    }

    /// Does nothing: the old value stays in the row.
    #[inline]
    fn remove(&mut self, _: H) {}
}

impl<H: RowId, T> Index<H> for RowMap<H, T> {
    type Output = T;

    #[inline]
    #[track_caller]
    fn index(&self, handle: H) -> &T {
        match self.values.get(handle.row() as usize) {
            Some(value) => value,
            None => no_such_row(handle, self.values.len()),
        }
    }
}

impl<H: RowId, T> IndexMut<H> for RowMap<H, T> {
    #[inline]
    #[track_caller]
    fn index_mut(&mut self, handle: H) -> &mut T {
        let rows = self.values.len();
        match self.values.get_mut(handle.row() as usize) {
            Some(value) => value,
            None => no_such_row(handle, rows),
        }
    }
}

/// Takes the handle by value: a reference would force the handle into memory in the caller.
#[cold]
#[inline(never)]
#[track_caller]
fn no_such_row<H: Debug>(handle: H, rows: usize) -> ! {
    panic!("no {handle:?} in this map: it has {rows} rows")
}

/// A [`HandleMap`] for handles that are not rows: a hash map with a default value.
#[derive(Clone, Debug)]
pub struct HashHandleMap<H, T> {
    written: FxHashMap<H, T>,
    default: T,
}

/// Returns a map with the default value of `T` for every handle.
impl<H, T: Default> Default for HashHandleMap<H, T> {
    fn default() -> Self {
        Self {
            written: FxHashMap::default(),
            default: T::default(),
        }
    }
}

/// Stores the value of each handle, as [`insert`](HandleMap::insert) does.
impl<H: Handle, T> Extend<(H, T)> for HashHandleMap<H, T> {
    #[inline]
    fn extend<I: IntoIterator<Item = (H, T)>>(&mut self, values: I) {
        self.written.extend(values);
    }
}

impl<H: Handle, T: Clone> HandleMap<H, T> for HashHandleMap<H, T> {
    #[inline]
    fn filled(_rows: usize, value: T) -> Self {
        Self {
            written: FxHashMap::default(),
            default: value,
        }
    }

    #[inline]
    fn reserve(&mut self, more: usize) {
        self.written.reserve(more);
    }

    #[inline]
    fn insert(&mut self, handle: H, value: T) {
        self.written.insert(handle, value);
    }

    #[inline]
    fn remove(&mut self, handle: H) {
        self.written.remove(&handle);
    }
}

impl<H: Handle, T> Index<H> for HashHandleMap<H, T> {
    type Output = T;

    #[inline]
    fn index(&self, handle: H) -> &T {
        self.written.get(&handle).unwrap_or(&self.default)
    }
}

impl<H: Handle, T: Clone> IndexMut<H> for HashHandleMap<H, T> {
    #[inline]
    fn index_mut(&mut self, handle: H) -> &mut T {
        self.written
            .entry(handle)
            .or_insert_with(|| self.default.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handles::pair::Pair;
    use crate::handles::row_id::VertexId;

    #[test]
    fn maps_return_the_initial_value_until_written() {
        let v = VertexId::new;
        let mut rows: RowMap<VertexId, u8> = HandleMap::filled(3, 7);
        rows[v(1)] = 1;
        assert_eq!(rows.values(), [7, 1, 7]);
        let mut pairs: HashHandleMap<Pair<VertexId>, u8> = HandleMap::filled(0, 7);
        pairs[Pair::new(v(0), v(1))] += 1;
        assert_eq!(pairs[Pair::new(v(1), v(0))], 8);
        assert_eq!(pairs[Pair::new(v(1), v(2))], 7);
    }

    #[test]
    fn maps_are_extended_by_handle() {
        let v = VertexId::new;
        let values = [(v(0), 'x'), (v(2), 'y')];
        let mut rows: RowMap<VertexId, char> = "abc".chars().collect();
        rows.extend(values);
        assert_eq!(Vec::from(rows), ['x', 'b', 'y']);
        let mut hashed: HashHandleMap<VertexId, char> = HashHandleMap::default();
        hashed.extend(values);
        assert_eq!([0, 1, 2].map(|i| hashed[v(i)]), ['x', '\0', 'y']);
    }

    #[test]
    #[should_panic(expected = "no v3 in this map: it has 3 rows")]
    fn a_row_beyond_the_map_panics_with_its_handle() {
        let rows: RowMap<VertexId, u8> = HandleMap::filled(3, 7);
        let _ = rows[VertexId::new(3)];
    }
}
