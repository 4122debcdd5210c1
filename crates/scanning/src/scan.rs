//! The scan of a whole table.

use sixfold_core::{Probe, Table};

/// The number of rows that one step of a scan reads.
const BLOCK: usize = 64;

/// Scans a whole table in blocks, and yields in order the rows that `hits` selects.
///
/// `hits` gets a block of up to 64 rows and returns one bit for each row of the block. The bit
/// is 1 if the row is selected; the lowest bit belongs to the first row. [`hits_in`] computes
/// these bits for one condition. Each row is read once, immediately before `hits` is called
/// with the block of the row.
///
/// ```
/// use sixfold_core::Table;
/// use sixfold_scanning::{hits_in, scan};
/// let table = Table::new("vertex", "corner", vec![7, 0, 7, 3]);
/// let sevens = scan(&table, |block| hits_in(block, |&v| v == 7));
/// assert!(sevens.eq([0, 2]));
/// ```
#[inline]
pub fn scan<T, P: Probe>(
    table: &Table<T, P>,
    hits: impl Fn(&[T]) -> u64,
) -> impl Iterator<Item = usize> {
    Scan {
        table,
        find: hits,
        block: 0,
        next: 0,
        hits: 0,
    }
}

/// Tests a block of up to 64 rows with `is_hit`, and returns one bit for each row: 1 if `is_hit` is
/// true.
///
/// Few blocks contain a hit. Therefore a first loop tests the whole block without a branch, so that
/// the compiler can use vector instructions. If the block has a hit, a second loop computes the
/// bits row by row.
#[inline]
pub fn hits_in<T>(block: &[T], is_hit: impl Fn(&T) -> bool) -> u64 {
    if let Ok(block) = <&[T; BLOCK]>::try_from(block)
        && !block.iter().fold(false, |any, row| any | is_hit(row))
    {
        return 0;
    }
    let bits = block.iter().zip(0..);
    let bits = bits.map(|(row, i)| u64::from(is_hit(row)) << i);
    bits.fold(0, |mask, bit| mask | bit)
}

/// The rows found in the blocks of a table, in order.
struct Scan<'a, T, P: Probe, F> {
    table: &'a Table<T, P>,
    find: F,
    /// The first row of the current block.
    block: usize,
    /// The first row after the current block.
    next: usize,
    /// The hits in the current block that have not been yielded yet.
    hits: u64,
}

impl<T, P: Probe, F: Fn(&[T]) -> u64> Iterator for Scan<'_, T, P, F> {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        let rows = self.table.len();
        while self.hits == 0 {
            if self.next == rows {
                return None;
            }
            self.block = self.next;
            self.next = (self.next + BLOCK).min(rows);
            self.hits = (self.find)(self.table.read_range(self.block..self.next));
        }
        let row = self.block + self.hits.trailing_zeros() as usize;
        self.hits &= self.hits - 1;
        Some(row)
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::Traced;

    use super::*;

    #[test]
    fn a_scan_finds_what_a_search_finds_at_every_block_boundary() {
        for rows in [0, 1, 63, 64, 65, 127, 128, 129, 300] {
            let values: Vec<usize> = (0..rows).map(|row| row * 5 % 7).collect();
            let probe = Traced::default();
            let table = Table::new("values", "row", values.clone()).probed(probe.clone());
            for wanted in 0..8 {
                let found = scan(&table, |block| hits_in(block, |&value| value == wanted));
                let expected = (0..rows).filter(|&row| values[row] == wanted);
                assert!(found.eq(expected), "{wanted} in {rows} rows");
                let read = probe.take().into_iter().map(|access| access.row);
                assert!(read.eq(0..rows), "each of {rows} rows once, in order");
            }
            let all: Vec<usize> = scan(&table, |block| hits_in(block, |_| true)).collect();
            assert!(all.into_iter().eq(0..rows));
            let ends = [0, 63, 64, rows.saturating_sub(1)];
            let ends = |row: &usize| ends.contains(row);
            let rows_as_values = Table::new("rows", "row", (0..rows).collect());
            let found = scan(&rows_as_values, |block| hits_in(block, ends));
            assert!(found.eq((0..rows).filter(ends)), "{rows} rows");
        }
    }
}
