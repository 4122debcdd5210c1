//! Counts the rows, bytes and cache lines that queries read.
//!
//! The counts come from a model of memory, so they are exact and the same on every machine. Each
//! table starts at a multiple of 64 bytes, and its rows follow each other without gaps. A cache
//! line is 64 bytes of one table. A row that crosses the end of a cache line touches two cache
//! lines.
//!
//! ```text
//! lines of 64   0                  1                  2                  3
//!               ├──────────────────┼──────────────────┼──────────────────┼──
//! rows of 24    0      1      2      3      4      5      6      7      8
//!               rows 2 and 5 touch two lines each: bytes 48 to 71, and 120 to 143
//! ```
//!
//! The model also simulates a small cache of [`CACHE_LINES`] lines. If the simulated cache is full,
//! the line that was fetched first is removed. A touched line that is not in the cache is
//! *fetched*. A fetch is a *jump* if the cache contains no line within [`REACH`] lines before or
//! after the fetched line. Sequential access fetches lines but rarely jumps. The prefetchers of a
//! processor can predict sequential access, but not jumps.

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use sixfold::{MemoryFootprint, TableBytes};
use sixfold_core::Probe;
use sixfold_measure::LINE_BYTES;

/// Number of lines in the simulated cache. The simulated cache has 256 KiB. Most processors have at
/// least 256 KiB of cache per core.
pub const CACHE_LINES: u64 = 4096;
/// The fetch of a cache line is a jump if the fetched line is more than this number of lines away
/// from every line in the simulated cache.
pub const REACH: usize = 4;

/// A number that clones of a probe share. Only one thread may count, or counts may be lost.
#[derive(Debug, Default)]
struct Counter(AtomicU64);

impl Counter {
    #[inline]
    fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    #[inline]
    fn set(&self, value: u64) {
        self.0.store(value, Ordering::Relaxed);
    }

    #[inline]
    fn add(&self, more: u64) {
        self.set(self.get() + more);
    }
}

fn set_to_zero<const N: usize>(numbers: [&Counter; N]) {
    for number in numbers {
        number.set(0);
    }
}

#[derive(Debug, Default)]
struct Line {
    /// The number of the last query that touched this line.
    last_query: Counter,
    /// The bytes that this query has read, one bit per byte.
    read: Counter,
    /// The number of the last fetch of this line, from 1; 0 if it was never fetched.
    fetch: Counter,
}

#[derive(Debug)]
struct TableLines {
    name: Cow<'static, str>,
    row_bytes: usize,
    reads: Counter,
    lines: Vec<Line>,
}

/// The counts of a series of queries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ReadCounts {
    /// Number of row reads.
    pub(crate) reads: u64,
    /// Bytes read. A byte counts once per query.
    pub(crate) bytes: u64,
    /// Lines touched. A line counts once per query.
    pub(crate) lines: u64,
    /// Lines that were not in the small cache.
    pub(crate) fetched: u64,
    /// Fetched lines that were not near a cached line.
    pub(crate) jumps: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The next element is listed.
    Listing,
    /// An element is queried.
    Querying,
}

#[derive(Debug, Default)]
struct Totals {
    reads: Counter,
    bytes: Counter,
    lines: Counter,
    fetched: Counter,
    jumps: Counter,
}

#[derive(Debug)]
struct CacheModel {
    tables: Vec<TableLines>,
    /// The totals of each [`Step`].
    totals: [Totals; 2],
    step: Counter,
    /// The number of the current query.
    query: Counter,
    /// Number of fetched lines. The age of a cached line is measured in fetches.
    fetches: Counter,
    /// Number of distinct lines touched.
    touched: Counter,
}

/// A probe that counts reads. Its clones share one [`CacheModel`].
#[derive(Clone, Debug)]
pub(crate) struct CountingProbe(Arc<CacheModel>);

impl CountingProbe {
    /// Makes a probe with zero counts for the tables of `memory`. A read of another table counts as
    /// a row read, but touches no line.
    pub(crate) fn new(memory: &MemoryFootprint) -> Self {
        let table_lines = |table: &TableBytes| {
            let lines = (table.rows * table.row_bytes).div_ceil(LINE_BYTES);
            TableLines {
                name: table.table.clone(),
                row_bytes: table.row_bytes,
                reads: Counter::default(),
                lines: std::iter::repeat_with(Line::default).take(lines).collect(),
            }
        };
        Self(Arc::new(CacheModel {
            tables: memory.tables.iter().map(table_lines).collect(),
            totals: Default::default(),
            step: Counter::default(),
            query: Counter::default(),
            fetches: Counter::default(),
            touched: Counter::default(),
        }))
    }

    /// Resets all counts and empties the small cache.
    pub(crate) fn clear(&self) {
        let CacheModel {
            tables,
            totals,
            step,
            query,
            fetches,
            touched,
        } = &*self.0;
        for table in tables {
            table.reads.set(0);
            for Line {
                last_query,
                read,
                fetch,
            } in &table.lines
            {
                set_to_zero([last_query, read, fetch]);
            }
        }
        for total in totals {
            let Totals {
                reads,
                bytes,
                lines,
                fetched,
                jumps,
            } = total;
            set_to_zero([reads, bytes, lines, fetched, jumps]);
        }
        set_to_zero([step, query, fetches, touched]);
    }

    /// Starts a new query. The following reads belong to this query and to `step`.
    #[inline]
    pub(crate) fn begin(&self, step: Step) {
        self.0.query.add(1);
        self.0.step.set(step as u64);
    }

    pub(crate) fn counts(&self, step: Step) -> ReadCounts {
        let total = &self.0.totals[step as usize];
        ReadCounts {
            reads: total.reads.get(),
            bytes: total.bytes.get(),
            lines: total.lines.get(),
            fetched: total.fetched.get(),
            jumps: total.jumps.get(),
        }
    }

    /// Returns the number of distinct lines touched.
    pub(crate) fn touched(&self) -> u64 {
        self.0.touched.get()
    }

    /// Returns for each table the bytes per row and the number of row reads. Listing does not
    /// count.
    pub(crate) fn tables(&self) -> impl Iterator<Item = (&str, usize, u64)> {
        let tables = self.0.tables.iter();
        let read = tables.map(|table| (&*table.name, table.row_bytes, table.reads.get()));
        read.filter(|&(.., reads)| reads > 0)
    }
}

impl CacheModel {
    /// Records a read of some bytes of the line `at`. `bytes` has one bit per byte, and `number` is
    /// the number of set bits.
    #[inline]
    fn touch(&self, lines: &[Line], at: usize, bytes: u64, number: usize, total: &Totals) {
        let line = &lines[at];
        let query = self.query.get();
        if line.last_query.get() != query {
            line.last_query.set(query);
            line.read.set(0);
            total.lines.add(1);
        }
        let before = line.read.get();
        let new = match before & bytes {
            0 => number, // the only case in streaming access; counting bits would take longer
            _ => (bytes & !before).count_ones() as usize,
        };
        total.bytes.add(new as u64);
        line.read.set(before | bytes);

        let now = self.fetches.get();
        let is_cached = |line: &Line| {
            let fetch = line.fetch.get();
            fetch > 0 && now - fetch < CACHE_LINES
        };
        if is_cached(line) {
            return;
        }
        let around = at.saturating_sub(REACH)..lines.len().min(at + REACH + 1);
        let is_near = lines[around].iter().any(is_cached);
        total.jumps.add(u64::from(!is_near));
        total.fetched.add(1);
        self.touched.add(u64::from(line.fetch.get() == 0));
        self.fetches.set(now + 1);
        line.fetch.set(now + 1);
    }
}

impl Probe for CountingProbe {
    #[inline]
    fn read(&self, table: &'static str, row: usize, bytes: usize) {
        let model = &*self.0;
        let total = &model.totals[model.step.get() as usize];
        total.reads.add(1);
        let has_name =
            |lines: &&TableLines| std::ptr::eq(&*lines.name, table) || lines.name == table;
        let Some(table) = model.tables.iter().find(has_name) else {
            return;
        };
        if model.step.get() == Step::Querying as u64 {
            table.reads.add(1);
        }
        // A partial read of a row starts at the beginning of the row.
        let start = row.saturating_mul(table.row_bytes);
        let end = start.saturating_add(bytes);
        let mut from = start;
        while from < end {
            let line = from / LINE_BYTES;
            if line >= table.lines.len() {
                return; // no such row: the table itself reports the error
            }
            let to = end.min((line + 1) * LINE_BYTES);
            let bits = (u64::MAX >> (LINE_BYTES - (to - from))) << (from % LINE_BYTES);
            model.touch(&table.lines, line, bits, to - from, total);
            from = to;
        }
    }

    fn write(&self, _: &'static str, _: usize, _: usize) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probe(tables: &[(&'static str, usize, usize)]) -> CountingProbe {
        let table = |&(table, rows, row_bytes): &(&'static str, usize, usize)| TableBytes {
            table: table.into(),
            rows,
            bytes: rows * row_bytes,
            row_bytes,
        };
        CountingProbe::new(&tables.iter().map(table).collect())
    }

    /// Reads rows of one table as one query. Returns the numbers of lines and bytes.
    fn query(probe: &CountingProbe, table: &'static str, bytes: usize, rows: &[usize]) -> [u64; 2] {
        let before = probe.counts(Step::Querying);
        probe.begin(Step::Querying);
        for &row in rows {
            probe.read(table, row, bytes);
        }
        let after = probe.counts(Step::Querying);
        [after.lines - before.lines, after.bytes - before.bytes]
    }

    #[test]
    fn a_row_across_two_lines_touches_both() {
        let probe = probe(&[("halves", 100, 24)]);
        assert_eq!(query(&probe, "halves", 24, &[0, 1]), [1, 48]);
        assert_eq!(query(&probe, "halves", 24, &[2]), [2, 24], "bytes 48 to 71");
        assert_eq!(
            query(&probe, "halves", 24, &[2, 3, 2]),
            [2, 48],
            "each once"
        );
        assert_eq!(
            query(&probe, "halves", 24, &[8]),
            [1, 24],
            "bytes 192 to 215"
        );
        assert_eq!(probe.counts(Step::Querying).reads, 7);
        assert_eq!(probe.touched(), 3, "lines 0, 1 and 3");
    }

    #[test]
    fn a_row_longer_than_a_line_touches_all_its_lines() {
        let probe = probe(&[("records", 3, 160)]);
        assert_eq!(query(&probe, "records", 160, &[0]), [3, 160]);
        assert_eq!(query(&probe, "records", 160, &[1]), [3, 160], "160 to 319");
        assert_eq!(probe.touched(), 5);
    }

    #[test]
    fn a_read_of_part_of_a_row_starts_where_the_row_starts() {
        let probe = probe(&[("halves", 100, 24)]);
        // Row 5 begins at byte 120. Its first four bytes are in line 1, and the rest is in line 2.
        assert_eq!(query(&probe, "halves", 4, &[5]), [1, 4]);
        assert_eq!(query(&probe, "halves", 24, &[5]), [2, 24]);
    }

    #[test]
    fn tables_share_no_line_and_a_missing_row_touches_no_line() {
        let probe = probe(&[("one", 1, 4), ("two", 1, 4)]);
        probe.begin(Step::Querying);
        probe.read("one", 0, 4);
        probe.read("two", 0, 4);
        probe.read("two", 99, 4);
        probe.read("three", 0, 4);
        let counts = probe.counts(Step::Querying);
        assert_eq!((counts.reads, counts.lines, counts.bytes), (4, 2, 8));
        let tables: Vec<_> = probe.tables().collect();
        assert_eq!(tables, [("one", 4, 1), ("two", 4, 2)]);
    }

    #[test]
    fn a_stream_is_fetched_once_and_jumps_once() {
        let lines = 3 * CACHE_LINES as usize;
        let probe = probe(&[("corners", 16 * lines, 4)]);
        let rows: Vec<usize> = (0..16 * lines).collect();
        query(&probe, "corners", 4, &rows);
        let counts = probe.counts(Step::Querying);
        assert_eq!((counts.fetched, counts.jumps), (lines as u64, 1));
        // The first lines were evicted, so they are fetched again.
        query(&probe, "corners", 4, &rows);
        let counts = probe.counts(Step::Querying);
        assert_eq!((counts.fetched, counts.jumps), (2 * lines as u64, 2));
        assert_eq!(probe.touched(), lines as u64);
    }

    #[test]
    fn the_small_cache_holds_the_lines_fetched_last() {
        let far = REACH + 1;
        let lines = CACHE_LINES as usize;
        let probe = probe(&[("spread", far * (lines + 2), 64)]);
        let spread: Vec<usize> = (0..lines).map(|i| far * i).collect();
        query(&probe, "spread", 64, &spread);
        let full = probe.counts(Step::Querying);
        assert_eq!((full.fetched, full.jumps), (CACHE_LINES, CACHE_LINES));
        query(&probe, "spread", 64, &spread);
        assert_eq!(
            probe.counts(Step::Querying).fetched,
            CACHE_LINES,
            "all cached"
        );
        // One more line evicts the first line.
        query(&probe, "spread", 64, &[far * lines, far]);
        assert_eq!(probe.counts(Step::Querying).fetched, CACHE_LINES + 1);
        query(&probe, "spread", 64, &[0]);
        assert_eq!(probe.counts(Step::Querying).fetched, CACHE_LINES + 2);
    }

    #[test]
    fn a_stream_may_skip_lines_and_go_in_either_direction() {
        for (stride, jumps) in [(1, 1), (REACH, 1), (REACH + 1, 20)] {
            let probe = probe(&[("records", 20 * stride, 64)]);
            let up: Vec<usize> = (0..20).map(|i| i * stride).collect();
            let down: Vec<usize> = up.iter().rev().copied().collect();
            for rows in [up, down] {
                probe.clear();
                query(&probe, "records", 64, &rows);
                let counts = probe.counts(Step::Querying);
                assert_eq!(
                    (counts.fetched, counts.jumps),
                    (20, jumps),
                    "{stride}: {rows:?}"
                );
            }
        }
    }

    #[test]
    fn listing_is_counted_separately_and_clear_resets_all_counts() {
        let probe = probe(&[("opposite", 64, 4)]);
        probe.begin(Step::Listing);
        probe.read("opposite", 0, 4);
        query(&probe, "opposite", 4, &[0, 16]);
        assert_eq!(probe.counts(Step::Listing).reads, 1);
        assert_eq!(probe.counts(Step::Querying).lines, 2);
        assert_eq!(probe.counts(Step::Querying).fetched, 1, "line 0 was cached");
        assert_eq!(probe.tables().next(), Some(("opposite", 4, 2)));
        probe.clear();
        assert_eq!(probe.counts(Step::Listing), ReadCounts::default());
        assert_eq!(probe.counts(Step::Querying), ReadCounts::default());
        assert_eq!((probe.touched(), probe.tables().count()), (0, 0));
    }
}
