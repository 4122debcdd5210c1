//! Lists that are nearly always short: the elements around a vertex, an edge or a face.

use smallvec::SmallVec;

/// Maximum number of items that are stored on the stack and compared one by one.
const INLINE_LEN: usize = 16;

/// A list of the elements in a neighbourhood. Up to 16 items are stored on the stack, which is
/// enough for nearly every vertex; a longer list is stored on the heap.
pub type ShortVec<T> = SmallVec<[T; INLINE_LEN]>;

/// Search in a list. A list of up to 16 items is searched item by item, and a longer list by
/// bisection.
pub trait Lookup<T> {
    /// Sorts the list if it has more than 16 items, as [`has`](Self::has) requires; O(n log n) for
    /// n items.
    fn sort_for_lookup(&mut self);

    /// Returns whether `item` is in the list; O(log n) for n items. The caller must call
    /// [`sort_for_lookup`](Self::sort_for_lookup) first.
    fn has(&self, item: T) -> bool;
}

impl<T: Copy + Ord> Lookup<T> for [T] {
    #[inline]
    fn sort_for_lookup(&mut self) {
        if self.len() > INLINE_LEN {
            self.sort_unstable();
        }
    }

    #[inline]
    fn has(&self, item: T) -> bool {
        if self.len() > INLINE_LEN {
            return self.binary_search(&item).is_ok();
        }
        // No early exit: the position of an item is unpredictable.
        self.iter()
            .fold(false, |found, &other| found | (other == item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_found_in_short_and_long_lists() {
        for len in [0, 1, 15, 16, 17, 40] {
            let mut list: ShortVec<usize> = (0..len).rev().map(|i| 3 * i).collect();
            list.sort_for_lookup();
            for i in 0..3 * len {
                assert_eq!(list.has(i), i % 3 == 0, "{i} among {len}");
            }
            assert!(!list.has(3 * len));
        }
    }
}
