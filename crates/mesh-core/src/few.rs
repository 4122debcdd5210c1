//! Lists that are short nearly always: what is around a vertex, an edge or a face.

use smallvec::SmallVec;

/// How many items lie on the stack, and are compared one after the other.
const FEW: usize = 16;

/// A list of a neighbourhood: up to 16 items lie on the stack, more than the valence of nearly every
/// vertex, and more of them on the heap.
pub type Few<T> = SmallVec<[T; FEW]>;

/// Items to be looked up: one after the other while they are few, by bisection if many.
pub trait Lookup<T> {
    /// Brings many items into the order that [`has`](Self::has) needs; O(items log items).
    fn order(&mut self);

    /// Whether `item` is one of them, after [`order`](Self::order); O(log items) where they are many.
    fn has(&self, item: T) -> bool;
}

impl<T: Copy + Ord> Lookup<T> for [T] {
    #[inline]
    fn order(&mut self) {
        if self.len() > FEW {
            self.sort_unstable();
        }
    }

    #[inline]
    fn has(&self, item: T) -> bool {
        if self.len() > FEW {
            return self.binary_search(&item).is_ok();
        }
        // No way out before the end: where an item is follows no pattern.
        self.iter().fold(false, |found, &one| found | (one == item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_found_however_many_there_are() {
        for len in [0, 1, 15, 16, 17, 40] {
            let mut list: Few<usize> = (0..len).rev().map(|i| 3 * i).collect();
            list.order();
            for i in 0..3 * len {
                assert_eq!(list.has(i), i % 3 == 0, "{i} among {len}");
            }
            assert!(!list.has(3 * len));
        }
    }
}
