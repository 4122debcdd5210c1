//! Holes: the rows of deleted elements, until a mesh is compacted.

use std::fmt::Debug;

use crate::clone_by_field;
use crate::handles::iterator_ext::IteratorExt;
use crate::handles::row_id::{RowId, row};
use crate::tables::memory::TableBytes;
use crate::tables::probe::{Probe, Untraced};
use crate::tables::table::Table;

/// The number of rows per word of bits.
const WORD: usize = u64::BITS as usize;

/// The holes in the tables of a structure: the rows of deleted elements, stored as one bit per row.
///
/// ```text
/// row     0 1 2 3 4 5 6 7
/// hole        •     • •        rows() = 0 1 3 4 7     new_rows()[4] = 3
/// ```
///
/// Nothing is stored until the first row is deleted.
#[derive(Debug)]
pub struct Holes<P: Probe = Untraced> {
    /// One word for 64 rows; rows beyond the last word are not holes.
    words: Table<u64, P>,
    count: usize,
}

clone_by_field!(Holes<P: Probe> { words, count });

impl Holes {
    /// Returns an empty set. `name` is the name of the table that stores the bits, for example
    /// `"face holes"`.
    pub fn new(name: &'static str) -> Self {
        Self {
            words: Table::new(name, "64 rows", Vec::new()),
            count: 0,
        }
    }
}

impl<P: Probe> Holes<P> {
    /// Returns the same set of holes in a table that reports its reads and writes to `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> Holes<Q> {
        Holes {
            words: self.words.probed(probe),
            count: self.count,
        }
    }

    /// Makes `row` a hole; O(1) amortised.
    ///
    /// # Panics
    ///
    /// Panics if the row is already a hole, because deleting an element twice is a bug of the
    /// caller.
    pub fn insert(&mut self, row: usize) {
        while self.words.len() <= row / WORD {
            self.words.push(0);
        }
        let word = self.words.write(row / WORD);
        assert_eq!(*word >> (row % WORD) & 1, 0, "row {row} is already a hole");
        *word |= 1 << (row % WORD);
        self.count += 1;
    }

    /// Makes each row below `end` a hole if `is_unused` returns true for the row. Calls `report`
    /// with each new hole, ascending, and returns the number of new holes; O(end).
    pub fn insert_unused<H: RowId>(
        &mut self,
        end: usize,
        is_unused: impl Fn(usize) -> bool,
        mut report: impl FnMut(H),
    ) -> usize {
        let before = self.count;
        for handle in (0..row(end)).map(H::from_row) {
            let row = handle.row() as usize;
            if is_unused(row) && !self.has(row) {
                self.insert(row);
                report(handle);
            }
        }
        self.count - before
    }

    /// Makes the set empty and frees its memory. Compaction calls this method last.
    pub fn clear(&mut self) {
        self.words.clear();
        self.count = 0;
    }

    /// Returns the rows below `end` that are not holes, ascending; O(end). The probe does not
    /// record the reads.
    #[inline]
    pub fn rows(&self, end: usize) -> impl Iterator<Item = u32> + Clone + use<'_, P> {
        let words = self.words.rows();
        let is_hole = move |row: u32| {
            let word = words.get(row as usize / WORD).copied();
            word.unwrap_or(0) >> (row as usize % WORD) & 1 == 1
        };
        let is_empty = self.count == 0;
        (0..row(end)).filter(move |&row| is_empty || !is_hole(row))
    }
}

impl<P: Probe> HoleSet<P> for Holes<P> {
    #[inline]
    fn len(&self) -> usize {
        self.count
    }

    #[inline]
    fn has(&self, row: usize) -> bool {
        self.count > 0
            && row / WORD < self.words.len()
            && self.words.read(row / WORD) >> (row % WORD) & 1 == 1
    }

    #[inline]
    fn handles<H: RowId>(&self, end: usize) -> impl Iterator<Item = H> + Clone {
        self.rows(end).map_inline(H::from_row)
    }

    fn bytes(&self) -> Option<TableBytes> {
        let bytes = self.words.bytes();
        (bytes.bytes > 0).then_some(bytes)
    }

    fn check(&self, end: usize) -> Result<(), String> {
        let words = self.words.rows().iter();
        let bits: usize = words.map(|word| word.count_ones() as usize).sum();
        let below = end - self.rows(end).count();
        if bits != self.count || below != self.count {
            let name = self.words.bytes().table;
            return Err(format!(
                "{name}: the count is {}, but {bits} bits are set, {below} of them below row {end}",
                self.count
            ));
        }
        Ok(())
    }
}

impl<P: Probe> Holes<P> {
    /// Removes the rows that are holes from `table`; the other rows move down and keep their order.
    /// The holes must be rows of `table`. A table that uses less than half of its memory frees the
    /// unused part. O(rows). The probe does not record the change.
    pub fn compact_table<T: Copy>(&self, table: &mut Table<T, P>) {
        let mut to = 0;
        let end = table.len();
        if !self.is_empty() {
            let rows = table.rows_mut();
            for from in self.rows(end) {
                rows[to] = rows[from as usize];
                to += 1;
            }
            table.truncate(to);
        }
        table.shrink_if_half_empty();
    }
}

/// The name of the table that marks deleted vertices with one bit per vertex row.
pub const VERTEX_HOLES: &str = "vertex holes";
/// The name of the table that marks deleted edges with one bit per edge row.
pub const EDGE_HOLES: &str = "edge holes";
/// The name of the table that marks deleted faces with one bit per face row.
pub const FACE_HOLES: &str = "face holes";

/// A set of holes: the rows of deleted elements in a table.
pub trait HoleSet<P: Probe>: Clone + Debug + Send + Sync {
    /// Returns the number of holes; O(1).
    fn len(&self) -> usize;

    /// Returns whether there are no holes; O(1).
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns whether `row` is a hole; O(1).
    fn has(&self, row: usize) -> bool;

    /// Returns whether the row of `handle` is below `end` and is not a hole; O(1).
    #[inline]
    fn contains<H: RowId>(&self, handle: H, end: usize) -> bool {
        let row = handle.row() as usize;
        row < end && !self.has(row)
    }

    /// Returns the handles of the rows below `end` that are not holes, ascending; O(end).
    fn handles<H: RowId>(&self, end: usize) -> impl Iterator<Item = H> + Clone;

    /// Returns, for each row below `end`, the new row of its element after all holes are removed.
    /// The new row is the number of earlier rows that are not holes. O(end).
    fn new_rows(&self, end: usize) -> Vec<u32> {
        let mut new = 0;
        let mut rows = Vec::with_capacity(end);
        for row in 0..end {
            rows.push(new);
            new += u32::from(!self.has(row));
        }
        rows
    }

    /// Returns the name and the bytes of the table that stores the set, or `None` if there is no
    /// table.
    fn bytes(&self) -> Option<TableBytes>;

    /// Checks that the stored number of holes is correct, and that all holes are rows below `end`.
    ///
    /// # Errors
    ///
    /// Returns a description of the fault.
    fn check(&self, end: usize) -> Result<(), String>;
}

/// The holes of a [`Compact`](crate::Compact) mesh: an empty set, known at compile time.
#[derive(Clone, Copy, Debug)]
pub struct NoHoles;

impl<P: Probe> HoleSet<P> for NoHoles {
    #[inline]
    fn len(&self) -> usize {
        0
    }

    #[inline]
    fn has(&self, _: usize) -> bool {
        false
    }

    #[inline]
    fn handles<H: RowId>(&self, end: usize) -> impl Iterator<Item = H> + Clone {
        (0..row(end)).map_inline(H::from_row)
    }

    fn bytes(&self) -> Option<TableBytes> {
        None
    }

    fn check(&self, _: usize) -> Result<(), String> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handles::row_id::VertexId;

    #[test]
    fn rows_skip_holes_at_all_positions() {
        for end in [0_usize, 1, 63, 64, 65, 130, 200] {
            let sets: [&dyn Fn(usize) -> bool; 6] = [
                &|_| false,
                &|_| true,
                &|row| row % 3 == 1,
                &|row| row < 64,
                &|row| row >= 64,
                &|row| row == 0 || row + 1 == end,
            ];
            for (i, is_hole) in sets.iter().enumerate() {
                let mut holes = Holes::new("holes");
                for row in (0..end).filter(|&row| is_hole(row)).rev() {
                    holes.insert(row);
                }
                let expected: Vec<u32> = (0..end).filter(|&r| !is_hole(r)).map(row).collect();
                let rows = holes.rows(end);
                assert_eq!(
                    rows.clone().collect::<Vec<_>>(),
                    expected,
                    "set {i} of {end}"
                );
                assert_eq!(
                    rows.fold(0, |sum, row| sum ^ row),
                    expected.iter().fold(0, |sum, row| sum ^ row)
                );
                assert_eq!(holes.len() + expected.len(), end);
                assert_eq!(holes.check(end), Ok(()));
                let new = holes.new_rows(end);
                let closed: Vec<u32> = expected.iter().map(|&old| new[old as usize]).collect();
                assert!(closed.into_iter().eq(0..row(expected.len())));
                let mut table = Table::new("rows", "row", (0..row(end)).collect());
                holes.compact_table(&mut table);
                assert_eq!(table.rows(), expected);
            }
        }
    }

    #[test]
    fn unused_rows_become_holes_once() {
        let mut holes = Holes::new("holes");
        holes.insert(2);
        let mut inserted = Vec::new();
        let count =
            holes.insert_unused(6, |row| row % 2 == 0, |v: VertexId| inserted.push(v.row()));
        assert_eq!(count, 2);
        assert_eq!(inserted, [0, 4]);
        assert_eq!(holes.rows(6).collect::<Vec<_>>(), [1, 3, 5]);
    }

    #[test]
    fn a_row_beyond_all_bits_is_not_a_hole() {
        let mut holes = Holes::new("holes");
        assert!(holes.bytes().is_none() && !holes.has(7));
        holes.insert(3);
        assert!(holes.has(3) && !holes.has(1000));
        assert_eq!(holes.rows(6).collect::<Vec<_>>(), [0, 1, 2, 4, 5]);
        assert!(holes.check(3).is_err(), "a hole beyond the rows");
        holes.clear();
        assert!(holes.is_empty() && !holes.has(3));
    }

    #[test]
    #[should_panic(expected = "row 3 is already a hole")]
    fn deleting_a_row_twice_panics() {
        let mut holes = Holes::new("holes");
        holes.insert(3);
        holes.insert(3);
    }
}
