//! Each item once, without hashing where a handful of items is all there is.

use std::hash::Hash;

use rustc_hash::FxHashSet;

/// How many items are compared one by one before a hash set takes over.
const FEW: usize = 16;

/// The items of an iterator, each at its first occurrence.
///
/// Neighbourhoods are small, so the items seen are kept in place and compared one by one; from the
/// 17th distinct one on a hash set takes over, and a vertex of valence 100,000 stays linear. The
/// place for them is filled only when the first item comes: an empty answer costs nothing.
/// O(1) expected per item.
#[derive(Clone, Debug)]
pub struct Distinct<I: Iterator> {
    items: I,
    few: Option<[I::Item; FEW]>,
    seen: usize,
    many: FxHashSet<I::Item>,
}

/// Adds [`distinct`](IteratorExt::distinct) to every iterator.
pub trait IteratorExt: Iterator + Sized {
    /// Each item at its first occurrence.
    ///
    /// ```
    /// use mesh_core::IteratorExt;
    /// assert!([3, 1, 3, 2, 1].into_iter().distinct().eq([3, 1, 2]));
    /// ```
    #[inline]
    fn distinct(self) -> Distinct<Self>
    where
        Self::Item: Copy + Eq + Hash,
    {
        Distinct {
            items: self,
            few: None,
            seen: 0,
            many: FxHashSet::default(),
        }
    }
}

impl<I: Iterator> IteratorExt for I {}

impl<I> Distinct<I>
where
    I: Iterator,
    I::Item: Copy + Eq + Hash,
{
    /// Notes `item`; whether it is new.
    #[inline]
    fn note(&mut self, item: I::Item) -> bool {
        let seen = self.seen;
        if seen > FEW {
            return self.many.insert(item);
        }
        let few = self.few.get_or_insert([item; FEW]);
        if few[..seen].contains(&item) {
            return false;
        }
        self.seen += 1;
        if seen < FEW {
            few[seen] = item;
        } else {
            self.many.extend(few.iter().copied().chain([item]));
        }
        true
    }
}

impl<I> Iterator for Distinct<I>
where
    I: Iterator,
    I::Item: Copy + Eq + Hash,
{
    type Item = I::Item;

    #[inline]
    fn next(&mut self) -> Option<I::Item> {
        loop {
            let item = self.items.next()?;
            if self.note(item) {
                return Some(item);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_content_hold_across_the_change_of_method() {
        for distinct in [0, 1, FEW - 1, FEW, FEW + 1, 100] {
            let items = (0..3 * distinct).map(|i| (i * 7) % distinct.max(1));
            let mut expected: Vec<usize> = Vec::new();
            for item in items.clone() {
                if !expected.contains(&item) {
                    expected.push(item);
                }
            }
            assert!(items.distinct().eq(expected), "{distinct} distinct items");
        }
    }
}
