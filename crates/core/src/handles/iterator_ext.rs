//! Methods for every iterator.

use std::hash::Hash;

use crate::handles::distinct::Distinct;

/// Adds [`distinct`](IteratorExt::distinct), [`map_inline`](IteratorExt::map_inline) and
/// [`filter_inline`](IteratorExt::filter_inline) to every iterator.
pub trait IteratorExt: Iterator + Sized {
    /// Yields each distinct item once, at its first occurrence.
    ///
    /// ```
    /// use sixfold_core::IteratorExt;
    /// assert!([3, 1, 3, 2, 1].into_iter().distinct().eq([3, 1, 2]));
    /// ```
    #[inline]
    fn distinct(self) -> Distinct<Self>
    where
        Self::Item: Copy + Eq + Hash,
    {
        Distinct::new(self)
    }

    /// Maps each item with `f`, like [`map`](Iterator::map). Use this method in public functions
    /// that return iterators.
    ///
    /// The `fold` of the result is always inlined; `for_each` and `sum` call `fold`. The `fold` of
    /// the standard library's `Map` may not be inlined. Without link-time optimisation, `for_each`
    /// over the neighbours of a vertex can therefore take 1.6 times as long with `map` as with
    /// `map_inline`.
    #[inline]
    fn map_inline<B, F: FnMut(Self::Item) -> B>(self, f: F) -> MapInline<Self, F> {
        MapInline { items: self, f }
    }

    /// Yields the items for which `keeps` is true, like [`filter`](Iterator::filter). The `fold` of the result is always
    /// inlined, for the same reason as that of [`map_inline`](Self::map_inline): without it, counting the boundary edges of a
    /// face-vertex mesh takes 8 % more instructions.
    #[inline]
    fn filter_inline<F: FnMut(&Self::Item) -> bool>(self, keeps: F) -> FilterInline<Self, F> {
        FilterInline { items: self, keeps }
    }
}

impl<I: Iterator> IteratorExt for I {}

/// The iterator of [`map_inline`](IteratorExt::map_inline).
#[derive(Clone, Debug)]
pub struct MapInline<I, F> {
    items: I,
    f: F,
}

impl<I: Iterator, B, F: FnMut(I::Item) -> B> Iterator for MapInline<I, F> {
    type Item = B;

    #[inline]
    fn next(&mut self) -> Option<B> {
        self.items.next().map(&mut self.f)
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        self.items.size_hint()
    }

    #[inline(always)]
    fn fold<A, G: FnMut(A, B) -> A>(self, init: A, mut visit: G) -> A {
        let mut f = self.f;
        self.items.fold(init, |folded, item| visit(folded, f(item)))
    }
}

/// The iterator of [`filter_inline`](IteratorExt::filter_inline).
#[derive(Clone, Debug)]
pub struct FilterInline<I, F> {
    items: I,
    keeps: F,
}

impl<I: Iterator, F: FnMut(&I::Item) -> bool> Iterator for FilterInline<I, F> {
    type Item = I::Item;

    #[inline]
    fn next(&mut self) -> Option<I::Item> {
        self.items.find(&mut self.keeps)
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, self.items.size_hint().1)
    }

    #[inline(always)]
    fn fold<A, G: FnMut(A, I::Item) -> A>(self, init: A, mut visit: G) -> A {
        let mut keeps = self.keeps;
        self.items.fold(init, |folded, item| match keeps(&item) {
            true => visit(folded, item),
            false => folded,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_items_are_the_same_by_next_and_by_fold() {
        let is_kept = |i: &i32| i % 3 != 0;
        for len in 0..8 {
            let mut rest = (0..len).filter_inline(is_kept);
            for start in (0..len).filter(is_kept) {
                let expected: Vec<i32> = (start..len).filter(is_kept).collect();
                let by_fold = rest.clone().fold(Vec::new(), |mut folded, item| {
                    folded.push(item);
                    folded
                });
                assert_eq!(by_fold, expected);
                assert!(
                    rest.size_hint()
                        .1
                        .is_some_and(|most| most >= expected.len())
                );
                assert_eq!(rest.next(), Some(start));
            }
            assert_eq!(rest.next(), None);
        }
    }

    #[test]
    fn mapped_items_are_the_same_by_next_and_by_fold() {
        for len in 0..4 {
            let mut rest = (0..len).map_inline(|i| i * i);
            for start in 0..=len {
                let expected: Vec<usize> = (start..len).map(|i| i * i).collect();
                assert_eq!(rest.size_hint(), (len - start, Some(len - start)));
                let by_fold = rest.clone().fold(Vec::new(), |mut folded, item| {
                    folded.push(item);
                    folded
                });
                assert_eq!(by_fold, expected);
                assert_eq!(rest.next(), expected.first().copied());
            }
        }
    }
}
