//! Iterators over distinct items, without hashing if there are few items.

use std::hash::Hash;

use rustc_hash::FxHashSet;

use crate::handles::row_id::{RowId, Slot};

/// Maximum number of distinct items that are stored in an array instead of a hash set.
const ARRAY_LEN: usize = 16;

/// The distinct items of an iterator, each at its first occurrence.
///
/// The first 16 distinct items are stored in an array and compared one by one, which is fast for
/// small neighbourhoods. From the 17th distinct item on, the iterator uses a hash set. The expected
/// time is O(1) per item.
#[derive(Clone, Debug)]
pub struct Distinct<I: Iterator> {
    items: I,
    array: Option<[I::Item; ARRAY_LEN]>,
    seen: usize,
    set: FxHashSet<I::Item>,
}

impl<I> Distinct<I>
where
    I: Iterator,
    I::Item: Copy + Eq + Hash,
{
    #[inline]
    pub(crate) fn new(items: I) -> Self {
        Self {
            items,
            array: None,
            seen: 0,
            set: FxHashSet::default(),
        }
    }

    /// Records `item`; returns whether it is new.
    #[inline]
    fn insert(&mut self, item: I::Item) -> bool {
        let seen = self.seen;
        if seen > ARRAY_LEN {
            return self.set.insert(item);
        }
        let array = self.array.get_or_insert([item; ARRAY_LEN]);
        if array[..seen].contains(&item) {
            return false;
        }
        self.seen += 1;
        if seen < ARRAY_LEN {
            array[seen] = item;
        } else {
            self.set.extend(array.iter().copied().chain([item]));
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
            if self.insert(item) {
                return Some(item);
            }
        }
    }
}

/// Minimum number of steps for which a hash set is used instead of repeating the walk.
const SET_STEPS: usize = 32;

/// The distinct items of a walk that can be repeated, each at its first occurrence. Empty slots in
/// the walk are skipped.
///
/// Structures use this iterator to find the faces across the sides of a face. The iterator stores
/// the last three items that it has yielded, which is enough for triangles and quads. For larger
/// faces, the iterator repeats the walk to find earlier items. From 32 steps on, the iterator uses
/// a hash set. For triangles and quads, this iterator is faster than [`Distinct`], because it needs
/// no array in memory. The expected time is O(1) per step.
///
/// ```
/// use sixfold_core::{DistinctWalk, FaceId, Slot};
/// let faces = [4, 9, 4].map(|f| Slot::some(FaceId::new(f)));
/// let across = [faces[0], Slot::NONE, faces[1], faces[2]];
/// let neighbours = DistinctWalk::new(across.into_iter());
/// assert!(neighbours.eq([4, 9].map(FaceId::new)));
/// ```
#[derive(Clone, Debug)]
pub struct DistinctWalk<W, H: RowId> {
    start: W,
    walk: W,
    steps: usize,
    last: [Slot<H>; 3],
    set: Option<FxHashSet<H>>,
}

impl<H: RowId, W: Iterator<Item = Slot<H>> + Clone> DistinctWalk<W, H> {
    /// Builds the iterator from a walk that has not made a step yet.
    #[inline(always)]
    pub fn new(walk: W) -> Self {
        Self {
            start: walk.clone(),
            walk,
            steps: 0,
            last: [Slot::NONE; 3],
            set: None,
        }
    }

    /// Returns whether `item`, found after `steps` steps, differs from all items found before.
    #[inline]
    fn is_new(&mut self, item: Slot<H>, steps: usize) -> bool {
        let [a, b, c] = self.last;
        if item == a || item == b || item == c {
            return false;
        }
        if steps > self.last.len() {
            // The arguments are passed by value, so that the walk can stay in registers.
            if !is_new_among_many(self.start.clone(), steps, item, &mut self.set) {
                return false;
            }
        }
        self.last = [item, a, b];
        true
    }
}

/// Returns all items of `walk`, if there are exactly three.
#[inline(always)]
fn three_steps<T>(mut walk: impl Iterator<Item = T>) -> Option<[T; 3]> {
    let items = [walk.next()?, walk.next()?, walk.next()?];
    walk.next().is_none().then_some(items)
}

/// Returns whether `item` differs from all items in the first `steps` steps of `walk`.
#[cold]
#[inline(never)]
fn is_new_among_many<H: RowId>(
    walk: impl Iterator<Item = Slot<H>>,
    steps: usize,
    item: Slot<H>,
    set: &mut Option<FxHashSet<H>>,
) -> bool {
    let mut before = walk.take(steps);
    if steps < SET_STEPS {
        return before.all(|other| other != item);
    }
    let set = set.get_or_insert_with(|| before.filter_map(Slot::get).collect());
    item.get().is_some_and(|item| set.insert(item))
}

impl<H: RowId, W: Iterator<Item = Slot<H>> + Clone> Iterator for DistinctWalk<W, H> {
    type Item = H;

    #[inline]
    fn next(&mut self) -> Option<H> {
        loop {
            let slot = self.walk.next()?;
            let steps = self.steps;
            self.steps += 1;
            if let Some(item) = slot.get()
                && self.is_new(slot, steps)
            {
                return Some(item);
            }
        }
    }

    /// Folds all items at once. For triangles, this needs three comparisons and no state.
    ///
    /// All functions on this path are inlined, and the fields are in variables. If the walk is in
    /// memory instead, the fold can take three times the time.
    #[inline(always)]
    fn fold<B, F: FnMut(B, H) -> B>(self, init: B, mut f: F) -> B {
        let Self {
            start,
            walk,
            steps,
            last,
            set,
        } = self;
        let mut folded = init;
        if steps == 0
            && let Some([a, b, c]) = three_steps(walk.clone())
        {
            if let Some(item) = a.get() {
                folded = f(folded, item);
            }
            if let Some(item) = b.get().filter(|_| b != a) {
                folded = f(folded, item);
            }
            if let Some(item) = c.get().filter(|_| c != a && c != b) {
                folded = f(folded, item);
            }
            return folded;
        }
        let rest = Self {
            start,
            walk,
            steps,
            last,
            set,
        };
        fold_by_steps(rest, folded, f)
    }
}

#[inline(never)]
fn fold_by_steps<T, B>(items: impl Iterator<Item = T>, init: B, mut f: impl FnMut(B, T) -> B) -> B {
    let mut folded = init;
    for item in items {
        folded = f(folded, item);
    }
    folded
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handles::iterator_ext::IteratorExt;
    use crate::handles::row_id::FaceId;

    #[test]
    fn a_walk_yields_each_item_once_from_any_step_on() {
        let limit = SET_STEPS as u32;
        for distinct in [1, 2, 3, 4, 5, limit - 1, limit, limit + 1, limit + 2, 200] {
            for steps in [0, 1, 2, 3, 4, 5, limit, limit + 1, 3 * distinct] {
                let slot = |i: u32| match i % 4 {
                    1 => Slot::NONE,
                    _ => Slot::some(FaceId::new(i * 7 % distinct)),
                };
                let slots: Vec<Slot<FaceId>> = (0..steps).map(slot).collect();
                let mut expected: Vec<FaceId> = Vec::new();
                for item in slots.iter().copied().filter_map(Slot::get) {
                    if !expected.contains(&item) {
                        expected.push(item);
                    }
                }
                let walk = || DistinctWalk::new(slots.iter().copied());
                for taken in [0, 1, 2, expected.len()] {
                    let mut rest = walk();
                    let mut items: Vec<FaceId> = rest.by_ref().take(taken).collect();
                    rest.for_each(|item| items.push(item));
                    assert_eq!(items, expected, "{taken} taken of {steps} steps");
                }
                let one_by_one: Vec<FaceId> = std::iter::from_fn({
                    let mut walk = walk();
                    move || walk.next()
                })
                .collect();
                assert_eq!(one_by_one, expected);
            }
        }
    }

    #[test]
    fn order_and_content_are_right_before_and_after_the_hash_set() {
        for distinct in [0, 1, ARRAY_LEN - 1, ARRAY_LEN, ARRAY_LEN + 1, 100] {
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
