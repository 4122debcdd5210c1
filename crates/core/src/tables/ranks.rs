//! Consecutive numbers for the members of a set of numbers.

use crate::handles::row_id::row;
use crate::traits::refine::{CHUNK_ROWS, all_rows, for_each_chunk};

/// The number of items of a [`Block`].
const BLOCK: usize = u64::BITS as usize;

/// A subset of the numbers `0..items`, which are called items. The items in the subset are its
/// members. The rank of a member is the number of smaller members.
///
/// ```text
/// item     0 1 2 3 4 5 6 7
/// member   • •   •   • • •      rank(3) = 2, select(2) = 3, select_missing(1) = 4
/// rank     0 1   2   3 4 5
/// ```
///
/// The set stores one bit per item and one count per block of 64 items (Jacobson 1989): 16 bytes
/// for 64 items. If every item is a member, nothing is stored, because the rank of an item is then
/// the item itself.
#[derive(Clone, Debug, Default)]
pub struct Ranks {
    blocks: Vec<Block>,
    items: usize,
    members: usize,
}

/// The members among 64 items, and the number of members before these items.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    members: u64,
    before: u32,
}

impl Ranks {
    /// Replaces the subset by the items for which `is_member` returns true. Each row has `N` items:
    /// the `j`-th item of row `i` is `N * i + j`. O(items), on the threads of the current rayon
    /// pool. Allocated memory is reused.
    ///
    /// # Panics
    ///
    /// Panics if there are more items than [`MAX_ROWS`](crate::MAX_ROWS). If `N` does not divide
    /// 64, the call does not compile.
    pub fn fill<const N: usize, T: Sync>(
        &mut self,
        rows: &[T],
        is_member: impl Fn(&T) -> [bool; N] + Sync,
    ) {
        if all_rows(rows, |row| is_member(row).into_iter().all(|is| is)) {
            self.items = row(N * rows.len()) as usize;
            self.members = self.items;
            self.blocks.clear();
        } else {
            self.fill_by_row(rows, |_, row| is_member(row));
        }
    }

    /// Does the same as [`fill`](Self::fill), but passes the number of the row to `is_member` as an
    /// additional argument. Stores one bit per item even if every item is a member.
    ///
    /// # Panics
    ///
    /// Panics if there are more items than [`MAX_ROWS`](crate::MAX_ROWS). If `N` does not divide
    /// 64, the call does not compile.
    pub fn fill_by_row<const N: usize, T: Sync>(
        &mut self,
        rows: &[T],
        is_member: impl Fn(usize, &T) -> [bool; N] + Sync,
    ) {
        const { assert!(BLOCK.is_multiple_of(N)) };
        self.items = row(N * rows.len()) as usize;
        let rows_of_block = BLOCK / N;
        let blocks = rows.len().div_ceil(rows_of_block);
        self.blocks.clear();
        self.blocks.reserve_exact(blocks);
        self.blocks.resize(blocks, Block::default());
        for_each_chunk(&mut self.blocks, CHUNK_ROWS / BLOCK, |first, blocks| {
            let first = first * rows_of_block;
            let chunks = rows[first..].chunks(rows_of_block);
            for (first, (block, rows)) in (first..)
                .step_by(rows_of_block)
                .zip(blocks.iter_mut().zip(chunks))
            {
                let items = (first..).zip(rows).flat_map(|(i, row)| is_member(i, row));
                let bits = items.enumerate().map(|(i, is)| u64::from(is) << i);
                block.members = bits.fold(0, |members, bit| members | bit);
            }
        });
        let mut before = 0;
        for block in &mut self.blocks {
            block.before = before;
            before += block.members.count_ones();
        }
        self.members = before as usize;
    }

    /// Returns the number of items, including items that are not members; O(1).
    pub fn items(&self) -> usize {
        self.items
    }

    /// Returns the number of members; O(1).
    pub fn members(&self) -> usize {
        self.members
    }

    /// Returns the number of items that are not members; O(1).
    pub fn missing(&self) -> usize {
        self.items - self.members
    }

    /// Returns whether `item` is a member; O(1).
    #[inline]
    pub fn contains(&self, item: usize) -> bool {
        match self.blocks.get(item / BLOCK) {
            Some(block) => block.members >> (item % BLOCK) & 1 == 1,
            None => item < self.members,
        }
    }

    /// Returns the number of members before `item`; O(1). If `item` is a member, this number is its
    /// rank.
    #[inline]
    pub fn rank(&self, item: usize) -> usize {
        match self.blocks.get(item / BLOCK) {
            Some(block) => {
                let before = block.members & !(u64::MAX << (item % BLOCK));
                (block.before + before.count_ones()) as usize
            }
            None => item.min(self.members),
        }
    }

    /// Returns the member of rank `rank`; O(1) if every item is a member, otherwise O(log items).
    ///
    /// # Panics
    ///
    /// Panics if `rank` is not less than the number of members.
    pub fn select(&self, rank: usize) -> usize {
        assert!(
            rank < self.members,
            "no member of rank {rank}: every rank is below {}",
            self.members
        );
        if self.blocks.is_empty() {
            return rank;
        }
        let blocks = &self.blocks;
        let block = blocks.partition_point(|block| block.before as usize <= rank) - 1;
        let Block { members, before } = blocks[block];
        BLOCK * block + nth_bit(members, rank - before as usize)
    }

    /// Returns the missing item that has `rank` missing items before it; O(log items). An item is
    /// missing if it is not a member.
    ///
    /// # Panics
    ///
    /// Panics if `rank` is not less than the number of missing items.
    pub fn select_missing(&self, rank: usize) -> usize {
        assert!(
            rank < self.missing(),
            "no missing item of rank {rank}: every rank is below {}",
            self.missing()
        );
        // The number of missing items before a block.
        let gaps = |block: usize| BLOCK * block - self.blocks[block].before as usize;
        let (mut low, mut high) = (0, self.blocks.len());
        while high - low > 1 {
            let middle = low.midpoint(high);
            if gaps(middle) <= rank {
                low = middle;
            } else {
                high = middle;
            }
        }
        BLOCK * low + nth_bit(!self.blocks[low].members, rank - gaps(low))
    }
}

/// Returns the position of the set bit that has `rank` set bits below it.
fn nth_bit(bits: u64, rank: usize) -> usize {
    let clear_lowest = |bits: u64| bits & (bits - 1);
    (0..rank)
        .fold(bits, |bits, _| clear_lowest(bits))
        .trailing_zeros() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_and_selections_are_those_of_a_list() {
        type Membership = fn(usize) -> bool;
        let sets: [(usize, Membership); 6] = [
            (0, |_| true),
            (200, |_| true),
            (1, |_| false),
            (300, |i| i % 3 == 0),
            (640, |i| !(70..=500).contains(&i)),
            (20_000, |i| i % 64 != 5 && i != 19_999),
        ];
        let mut ranks = Ranks::default();
        for (items, is_member) in sets {
            let rows: Vec<usize> = (0..items).collect();
            ranks.fill(&rows, |&i| [is_member(i)]);
            let (members, missing): (Vec<usize>, Vec<usize>) =
                rows.iter().partition(|&&i| is_member(i));
            assert_eq!(ranks.members(), members.len());
            assert_eq!(ranks.missing(), missing.len());
            for (place, &item) in members.iter().enumerate() {
                assert!(ranks.contains(item));
                assert_eq!(ranks.rank(item), place);
                assert_eq!(ranks.select(place), item);
            }
            for (place, &item) in missing.iter().enumerate() {
                assert!(!ranks.contains(item));
                assert_eq!(ranks.rank(item), item - place);
                assert_eq!(ranks.select_missing(place), item);
            }
            assert!(!ranks.contains(items), "beyond the last");
        }
    }

    #[test]
    fn a_row_may_stand_for_several_items() {
        let rows: Vec<[bool; 2]> = (0..500).map(|i| [i % 7 > 0, i % 2 > 0]).collect();
        let mut pairs = Ranks::default();
        pairs.fill(&rows, |&row| row);
        let mut items = Ranks::default();
        items.fill(rows.as_flattened(), |&is| [is]);
        let mut by_row = Ranks::default();
        by_row.fill_by_row(&rows, |i, _| rows[i]);
        for item in 0..1000 {
            assert_eq!(pairs.contains(item), items.contains(item));
            assert_eq!(pairs.rank(item), items.rank(item));
            assert_eq!(by_row.rank(item), items.rank(item));
        }
    }
}
