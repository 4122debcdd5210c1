//! Names of elements, and data kept by name.

use std::fmt::Debug;
use std::hash::Hash;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

use rustc_hash::FxHashMap;

use crate::row_id::RowId;

/// How a structure names an element: a row, a pair of vertices, or the very coordinates.
///
/// The type of the handle also decides how data is kept for it ([`Handle::Map`]).
pub trait Handle: Copy + Eq + Ord + Hash + Debug + Send + Sync + 'static {
    /// Data by handle: a vector for rows, a hash map for the rest.
    type Map<T: Clone>: HandleMap<Self, T>;

    /// A number made of the handle, the same for equal handles: something for a sink to consume,
    /// so that a benchmark cannot count elements without naming them. Costs a few instructions.
    fn token(self) -> u64;
}

/// Data kept for each element of one kind, by handle.
///
/// Every handle reads the value that the map was filled with until it is written.
pub trait HandleMap<H: Copy, T: Clone>: Index<H, Output = T> + IndexMut<H> + Clone {
    /// A map that reads `value` everywhere; `rows` bounds the rows of handles that are rows.
    fn filled(rows: usize, value: T) -> Self;

    /// Allocates room for `more` handles at once, if the map allocates for each handle that is written.
    fn reserve(&mut self, more: usize) {
        let _ = more;
    }

    /// Keeps `value` for `handle`, which may be new: where data is by row the map grows up to it, and
    /// rows in between, which are no elements yet, read `value` too. O(1) amortised.
    fn insert(&mut self, handle: H, value: T);

    /// Forgets what is kept for `handle`, an element that is no more. O(1).
    fn remove(&mut self, handle: H);

    /// What is kept for `old` is kept for `new` from now on. O(1) amortised.
    ///
    /// One name after the other: where several elements exchange their names, as an edit may have
    /// them do, [`Changes::follow`](crate::Changes::follow) does it for all at once.
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
    names: PhantomData<H>,
}

impl<H, T> RowMap<H, T> {
    /// The values by row.
    pub fn values(&self) -> &[T] {
        &self.values
    }
}

impl<H: RowId, T: Clone> HandleMap<H, T> for RowMap<H, T> {
    fn filled(rows: usize, value: T) -> Self {
        Self {
            values: vec![value; rows],
            names: PhantomData,
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

    /// A row of its own is nobody else's: it stays as it is until somebody writes it.
    #[inline]
    fn remove(&mut self, _: H) {}
}

impl<H: RowId, T> Index<H> for RowMap<H, T> {
    type Output = T;

    #[inline]
    fn index(&self, handle: H) -> &T {
        match self.values.get(handle.row() as usize) {
            Some(value) => value,
            None => no_such_row(handle, self.values.len()),
        }
    }
}

impl<H: RowId, T> IndexMut<H> for RowMap<H, T> {
    #[inline]
    fn index_mut(&mut self, handle: H) -> &mut T {
        let rows = self.values.len();
        match self.values.get_mut(handle.row() as usize) {
            Some(value) => value,
            None => no_such_row(handle, rows),
        }
    }
}

/// By value: a reference would keep the handle in memory on the way that never comes here.
#[cold]
#[inline(never)]
fn no_such_row<H: Debug>(handle: H, rows: usize) -> ! {
    panic!("no {handle:?} in this map: it has {rows} rows")
}

/// A [`HandleMap`] for handles that are no rows: a hash map and the value of all the others.
#[derive(Clone, Debug)]
pub struct HashHandleMap<H, T> {
    written: FxHashMap<H, T>,
    otherwise: T,
}

impl<H: Handle, T: Clone> HandleMap<H, T> for HashHandleMap<H, T> {
    fn filled(_rows: usize, value: T) -> Self {
        Self {
            written: FxHashMap::default(),
            otherwise: value,
        }
    }

    fn reserve(&mut self, more: usize) {
        self.written.reserve(more);
    }

    fn insert(&mut self, handle: H, value: T) {
        self.written.insert(handle, value);
    }

    fn remove(&mut self, handle: H) {
        self.written.remove(&handle);
    }
}

impl<H: Handle, T> Index<H> for HashHandleMap<H, T> {
    type Output = T;

    fn index(&self, handle: H) -> &T {
        self.written.get(&handle).unwrap_or(&self.otherwise)
    }
}

impl<H: Handle, T: Clone> IndexMut<H> for HashHandleMap<H, T> {
    fn index_mut(&mut self, handle: H) -> &mut T {
        self.written
            .entry(handle)
            .or_insert_with(|| self.otherwise.clone())
    }
}

/// An edge named by its two ends, the lower first: the handle where no table has edges.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Pair<V>([V; 2]);

impl<V: Handle> Pair<V> {
    /// The edge between `a` and `b`, in whichever order they come.
    #[inline]
    pub fn new(a: V, b: V) -> Self {
        Self(if a < b { [a, b] } else { [b, a] })
    }

    /// The sides of a face of `degree` corners: side `i` joins corners `i` and `i + 1`.
    ///
    /// ```
    /// use mesh_core::{Pair, VertexId};
    /// let face = [4, 9, 6].map(VertexId::new);
    /// let mut sides = Pair::sides(face.len(), |i| face[i]);
    /// assert_eq!(sides.next(), Some(Pair::new(face[0], face[1])));
    /// assert_eq!(sides.last(), Some(Pair::new(face[2], face[0])));
    /// ```
    #[inline]
    pub fn sides(degree: usize, corner: impl Fn(usize) -> V) -> impl Iterator<Item = Self> {
        (0..degree).map(move |i| {
            let next = if i + 1 == degree { 0 } else { i + 1 };
            Self::new(corner(i), corner(next))
        })
    }

    /// The two ends, the lower first.
    #[inline]
    pub fn ends(self) -> [V; 2] {
        self.0
    }

    /// Whether `v` is one of the two ends.
    #[inline]
    pub fn has(self, v: V) -> bool {
        self.0[0] == v || self.0[1] == v
    }
}

impl<V: Handle> Handle for Pair<V> {
    type Map<T: Clone> = HashHandleMap<Self, T>;

    #[inline]
    fn token(self) -> u64 {
        let [a, b] = self.0;
        a.token().wrapping_mul(3).wrapping_add(b.token())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row_id::VertexId;

    #[test]
    fn a_pair_has_no_direction() {
        let [a, b] = [VertexId::new(9), VertexId::new(4)];
        assert_eq!(Pair::new(a, b), Pair::new(b, a));
        assert_eq!(Pair::new(a, b).ends(), [b, a]);
        assert!(Pair::new(a, b).has(a) && !Pair::new(a, b).has(VertexId::new(5)));
    }

    #[test]
    fn maps_read_the_filling_until_written() {
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
    #[should_panic(expected = "no v3 in this map: it has 3 rows")]
    fn a_row_beyond_the_map_panics_by_name() {
        let rows: RowMap<VertexId, u8> = HandleMap::filled(3, 7);
        let _ = rows[VertexId::new(3)];
    }
}
