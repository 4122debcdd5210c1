//! Disjoint classes of numbered items.

use crate::handles::row_id::row;

/// A partition of the numbers `0..len`, called items, into disjoint classes. The root of a class is
/// its lowest item.
///
/// The method is linking by index with path halving (Tarjan & van Leeuwen 1984). Each call takes
/// O(log n) amortised time for n items. The classes take 4 bytes per item.
/// [`Partition`](crate::Partition) also stores parities and sizes.
pub struct Classes {
    parent: Vec<u32>,
}

impl Classes {
    /// Builds `len` classes of one item each.
    ///
    /// # Panics
    ///
    /// Panics if there are more than [`MAX_ROWS`](crate::MAX_ROWS) items.
    pub fn new(len: usize) -> Self {
        Self {
            parent: (0..row(len)).collect(),
        }
    }

    /// Merges the classes of `a` and `b`.
    ///
    /// # Panics
    ///
    /// Panics if `a` or `b` is not an item.
    #[inline]
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(row(a)), self.root(row(b)));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    #[inline]
    fn root(&mut self, mut item: u32) -> u32 {
        loop {
            let up = self.parent[item as usize];
            if up == item {
                return item;
            }
            let above = self.parent[up as usize];
            self.parent[item as usize] = above;
            item = above;
        }
    }

    /// Returns the root of each item; O(n).
    pub fn into_roots(mut self) -> Vec<u32> {
        // No parent is higher than its item, so the root of the parent is known.
        for item in 0..self.parent.len() {
            self.parent[item] = self.parent[self.parent[item] as usize];
        }
        self.parent
    }

    /// Returns the number of the class of each item, and the number of classes. The classes are
    /// numbered in the order of their lowest items. O(n).
    pub fn into_numbers(mut self) -> (Vec<u32>, usize) {
        let mut classes = 0;
        for item in 0..self.parent.len() {
            let parent = self.parent[item] as usize;
            self.parent[item] = if parent == item {
                classes += 1;
                classes - 1
            } else {
                // The parent is lower than its item, so it has the number of its class.
                self.parent[parent]
            };
        }
        (self.parent, classes as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_those_of_a_search() {
        const LEN: usize = 40;
        let mut random = 1_u64;
        let mut item = || {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1);
            (random >> 33) as usize % LEN
        };
        for joins in 0..2 * LEN {
            let (mut classes, mut again) = (Classes::new(LEN), Classes::new(LEN));
            // By item: the lowest item of its class.
            let mut lowest: Vec<u32> = (0..row(LEN)).collect();
            for _ in 0..joins {
                let (a, b) = (item(), item());
                classes.join(a, b);
                again.join(a, b);
                let (low, high) = (lowest[a].min(lowest[b]), lowest[a].max(lowest[b]));
                for root in lowest.iter_mut().filter(|root| **root == high) {
                    *root = low;
                }
            }
            assert_eq!(classes.into_roots(), lowest);
            let mut roots = lowest.clone();
            roots.sort_unstable();
            roots.dedup();
            let (numbers, count) = again.into_numbers();
            assert_eq!(count, roots.len());
            for (number, root) in numbers.iter().zip(&lowest) {
                assert_eq!(roots[*number as usize], *root);
            }
        }
    }
}
