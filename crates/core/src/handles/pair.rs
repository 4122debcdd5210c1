//! Edges as pairs of their ends.

use std::fmt::{self, Debug};

use crate::handles::handle::{Handle, HashHandleMap};
use crate::handles::iterator_ext::IteratorExt;

/// An edge as the pair of its ends, the lower end first. Structures that identify an edge by its
/// ends use pairs as edge handles. A pair is printed as `v3–v7`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair<V>([V; 2]);

impl<V: Handle> Pair<V> {
    /// Returns the edge between `a` and `b`; the order of `a` and `b` does not matter.
    #[inline]
    pub fn new(a: V, b: V) -> Self {
        Self(if a < b { [a, b] } else { [b, a] })
    }

    /// Yields the edges of a face of `degree` corners: edge `i` joins corners `i` and `i + 1`.
    /// `corner(i)` must return the vertex at corner `i`.
    ///
    /// ```
    /// use sixfold_core::{Pair, VertexId};
    /// let face = [4, 9, 6].map(VertexId::new);
    /// let mut sides = Pair::sides(face.len(), |i| face[i]);
    /// assert_eq!(sides.next(), Some(Pair::new(face[0], face[1])));
    /// assert_eq!(sides.last(), Some(Pair::new(face[2], face[0])));
    /// ```
    #[inline]
    pub fn sides(degree: usize, corner: impl Fn(usize) -> V) -> impl Iterator<Item = Self> {
        (0..degree).map_inline(move |i| {
            let next = if i + 1 == degree { 0 } else { i + 1 };
            Self::new(corner(i), corner(next))
        })
    }

    /// Returns the two ends, the lower first.
    #[inline]
    pub fn ends(self) -> [V; 2] {
        self.0
    }

    /// Returns whether `v` is one of the two ends.
    #[inline]
    pub fn has(self, v: V) -> bool {
        self.0[0] == v || self.0[1] == v
    }
}

impl<V: Handle> Handle for Pair<V> {
    type Map<T: Clone> = HashHandleMap<Self, T>;
}

impl<V: Debug> Debug for Pair<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}–{:?}", self.0[0], self.0[1])
    }
}

impl<V: Debug> fmt::Display for Pair<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Debug::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handles::row_id::VertexId;

    #[test]
    fn a_pair_has_no_direction() {
        let [a, b] = [VertexId::new(9), VertexId::new(4)];
        assert_eq!(Pair::new(a, b), Pair::new(b, a));
        assert_eq!(Pair::new(a, b).ends(), [b, a]);
        assert_eq!(Pair::new(a, b).to_string(), "v4–v9");
        assert!(Pair::new(a, b).has(a) && !Pair::new(a, b).has(VertexId::new(5)));
    }
}
