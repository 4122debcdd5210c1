//! Lists that are nearly always short: the elements around a vertex, an edge or a face.

use smallvec::SmallVec;

/// The number of items that are stored on the stack and compared one by one.
const FEW: usize = 16;

/// A list of a neighbourhood: up to 16 items on the stack, which is more than the valence of nearly
/// every vertex; more items on the heap.
pub type Few<T> = SmallVec<[T; FEW]>;

/// Search for items in a list: one by one if there are few, by bisection if there are many.
pub trait Lookup<T> {
    /// Sorts the items if [`has`](Self::has) needs it; O(items log items).
    fn order(&mut self);

    /// Returns whether `item` is in the list, after [`order`](Self::order); O(log items) if there
    /// are many.
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
        // No early exit: the position of an item is unpredictable.
        self.iter().fold(false, |found, &one| found | (one == item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_found_in_short_and_long_lists() {
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
