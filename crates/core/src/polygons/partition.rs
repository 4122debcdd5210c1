//! Union–find with parity.

use crate::handles::row_id::row;

/// A partition of the numbers `0..len`, called items, into disjoint classes. Each item is equal to
/// the root of its class, or differs from the root (its parity).
///
/// The method is union by size with path halving (Tarjan & van Leeuwen 1984). Each call takes
/// nearly constant amortised time.
pub struct Partition {
    parent: Vec<u32>,
    size: Vec<u32>,
    /// Whether an item differs from its parent; used for orientability.
    odd: Vec<bool>,
    classes: usize,
}

impl Partition {
    /// Builds a partition in which every item is a class of its own.
    ///
    /// # Panics
    ///
    /// Panics if there are more than [`MAX_ROWS`](crate::MAX_ROWS) items.
    pub fn new(len: usize) -> Self {
        let rows = row(len);
        Self {
            parent: (0..rows).collect(),
            size: vec![1; len],
            odd: vec![false; len],
            classes: len,
        }
    }

    /// Returns the number of classes.
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// Returns the root of the class of `item`, and the parity of `item`: true if `item` differs
    /// from the root.
    ///
    /// # Panics
    ///
    /// Panics if `item` does not exist.
    pub fn root(&mut self, item: usize) -> (usize, bool) {
        let (mut at, mut odd) = (item, false);
        loop {
            let up = self.parent[at] as usize;
            if up == at {
                return (at, odd);
            }
            let above = self.parent[up] as usize;
            let skip = self.odd[at] ^ self.odd[up];
            odd ^= if above == up { self.odd[at] } else { skip };
            if above != up {
                self.parent[at] = self.parent[up];
                self.odd[at] = skip;
            }
            at = above;
        }
    }

    /// Returns the number of items in the class of `item`.
    ///
    /// # Panics
    ///
    /// Panics if `item` does not exist.
    pub fn class_size(&mut self, item: usize) -> usize {
        let (root, _) = self.root(item);
        self.size[root] as usize
    }

    /// Merges the classes of `a` and `b`. The root of the larger class becomes the root of the
    /// merged class. If both classes have the same size, the root of the class of `a` becomes the
    /// root.
    ///
    /// # Panics
    ///
    /// Panics if `a` or `b` does not exist.
    pub fn join(&mut self, a: usize, b: usize) {
        self.relate(a, b, false);
    }

    /// Merges the classes of `a` and `b`, and records whether the two items differ. Returns false
    /// if `differ` contradicts what earlier calls have recorded.
    ///
    /// # Panics
    ///
    /// Panics if `a` or `b` does not exist.
    pub fn relate(&mut self, a: usize, b: usize, differ: bool) -> bool {
        let ((mut a, odd_a), (mut b, odd_b)) = (self.root(a), self.root(b));
        let differ = differ ^ odd_a ^ odd_b;
        if a == b {
            return !differ;
        }
        if self.size[a] < self.size[b] {
            std::mem::swap(&mut a, &mut b);
        }
        self.parent[b] = row(a);
        self.odd[b] = differ;
        self.size[a] += self.size[b];
        self.classes -= 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parity_is_right_after_unions_in_any_order() {
        let len = 200;
        let mut partition = Partition::new(len);
        for i in (0..len - 7)
            .rev()
            .step_by(2)
            .chain((0..len - 7).rev().skip(1).step_by(2))
        {
            assert!(partition.relate(i, i + 7, true));
        }
        assert_eq!(partition.classes(), 7);
        for i in 0..len - 14 {
            assert!(partition.relate(i, i + 14, false));
            assert!(!partition.relate(i, i + 14, true));
        }
    }
}
