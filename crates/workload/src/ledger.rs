//! What queries read, counted as they read it: rows, bytes, and the cache lines these lie in.
//!
//! The model is of plain memory, so that the figures are exact and the same on every machine: each
//! table starts at a multiple of 64 bytes, its rows lie one after the other, and a line is 64 bytes of
//! one table. A row that straddles two lines touches both.
//!
//! ```text
//! lines of 64   0                  1                  2                  3
//!               ├──────────────────┼──────────────────┼──────────────────┼──
//! rows of 24    0      1      2      3      4      5      6      7      8
//!               rows 2 and 5 touch two lines each: bytes 48 to 71, and 120 to 143
//! ```
//!
//! Beside it runs a model of a small cache, [`CACHE_LINES`] lines of any table, the first to come the
//! first to go. A line that is touched and not there is *fetched*; it is a *jump* if none of the
//! [`REACH`] lines on either side is there either. A stream is fetched and hardly ever jumps, even if it
//! leaves lines out, and the prefetchers of a processor see it coming; what jumps, they do not.

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use sixfold::{MemoryFootprint, Probe, TableBytes};

/// Bytes of a cache line.
pub const LINE_BYTES: usize = 64;
/// Lines that the small cache of the model holds: 256 KiB, what a core has to itself at the least on most
/// processors. What comes back from there is near, and a walk hardly waits for it.
pub const CACHE_LINES: u64 = 4096;
/// How many lines beside one that is there can be foreseen, on either side.
pub const REACH: usize = 4;

/// A number that clones of a probe share. Whoever counts asks from one thread: of two threads that
/// count at once, one may be lost.
#[derive(Debug, Default)]
struct Shared(AtomicU64);

impl Shared {
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

fn zero<const N: usize>(numbers: [&Shared; N]) {
    for number in numbers {
        number.set(0);
    }
}

/// What one line has been through.
#[derive(Debug, Default)]
struct Line {
    /// The last question that touched it.
    asked: Shared,
    /// Which of its bytes that question has read, a bit for each.
    read: Shared,
    /// Which fetch brought it last, counted from 1; 0 if none did.
    fetch: Shared,
}

/// One table, and all its lines.
#[derive(Debug)]
struct Page {
    name: Cow<'static, str>,
    row_bytes: usize,
    reads: Shared,
    lines: Vec<Line>,
}

/// What a series of questions came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sum {
    /// Rows read, one as often as it is read.
    pub(crate) reads: u64,
    /// Bytes that a question reads, each once for each question.
    pub(crate) bytes: u64,
    /// Lines that a question touches, each once for each question.
    pub(crate) lines: u64,
    /// Lines that the small cache did not have.
    pub(crate) fetched: u64,
    /// Those of them that lie beside none it had.
    pub(crate) jumps: u64,
}

/// What is being done while rows are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The next element is looked for.
    Listing,
    /// An element is asked.
    Asking,
}

#[derive(Debug, Default)]
struct Totals {
    reads: Shared,
    bytes: Shared,
    lines: Shared,
    fetched: Shared,
    jumps: Shared,
}

#[derive(Debug)]
struct Book {
    pages: Vec<Page>,
    /// By [`Step`].
    totals: [Totals; 2],
    step: Shared,
    question: Shared,
    /// Lines fetched by now: the clock of the small cache.
    fetches: Shared,
    /// Lines touched at all.
    touched: Shared,
}

/// A probe that counts; its clones count into one book.
#[derive(Clone, Debug)]
pub(crate) struct Ledger(Arc<Book>);

impl Ledger {
    /// An empty book with a page for each table of `memory`. A read of any other table counts as a
    /// read, and touches nothing that is known.
    pub(crate) fn of(memory: &MemoryFootprint) -> Self {
        let page = |table: &TableBytes| {
            let lines = (table.rows * table.row_bytes).div_ceil(LINE_BYTES);
            Page {
                name: table.table.clone(),
                row_bytes: table.row_bytes,
                reads: Shared::default(),
                lines: std::iter::repeat_with(Line::default).take(lines).collect(),
            }
        };
        Self(Arc::new(Book {
            pages: memory.tables.iter().map(page).collect(),
            totals: Default::default(),
            step: Shared::default(),
            question: Shared::default(),
            fetches: Shared::default(),
            touched: Shared::default(),
        }))
    }

    /// Forgets everything, the small cache included.
    pub(crate) fn clear(&self) {
        let Book {
            pages,
            totals,
            step,
            question,
            fetches,
            touched,
        } = &*self.0;
        for page in pages {
            page.reads.set(0);
            for Line { asked, read, fetch } in &page.lines {
                zero([asked, read, fetch]);
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
            zero([reads, bytes, lines, fetched, jumps]);
        }
        zero([step, question, fetches, touched]);
    }

    /// What is read from now on belongs to another question, and to `step`.
    #[inline]
    pub(crate) fn begin(&self, step: Step) {
        self.0.question.add(1);
        self.0.step.set(step as u64);
    }

    /// What the questions of `step` came to.
    pub(crate) fn sum(&self, step: Step) -> Sum {
        let total = &self.0.totals[step as usize];
        Sum {
            reads: total.reads.get(),
            bytes: total.bytes.get(),
            lines: total.lines.get(),
            fetched: total.fetched.get(),
            jumps: total.jumps.get(),
        }
    }

    /// Lines touched by anything, each once.
    pub(crate) fn touched(&self) -> u64 {
        self.0.touched.get()
    }

    /// The tables that questions (and no listing) have read, with the bytes of a row and how many rows.
    pub(crate) fn tables(&self) -> impl Iterator<Item = (&str, usize, u64)> {
        let pages = self.0.pages.iter();
        let read = pages.map(|page| (&*page.name, page.row_bytes, page.reads.get()));
        read.filter(|&(.., reads)| reads > 0)
    }
}

impl Book {
    /// Touches `bytes` of one line, a bit for each; they are `number`.
    #[inline]
    fn touch(&self, lines: &[Line], at: usize, bytes: u64, number: usize, total: &Totals) {
        let line = &lines[at];
        let question = self.question.get();
        if line.asked.get() != question {
            line.asked.set(question);
            line.read.set(0);
            total.lines.add(1);
        }
        let before = line.read.get();
        let new = match before & bytes {
            0 => number, // a stream has this alone; counting bits takes longer
            _ => (bytes & !before).count_ones() as usize,
        };
        total.bytes.add(new as u64);
        line.read.set(before | bytes);

        let now = self.fetches.get();
        let is_there = |line: &Line| {
            let fetch = line.fetch.get();
            fetch > 0 && now - fetch < CACHE_LINES
        };
        if is_there(line) {
            return;
        }
        let around = at.saturating_sub(REACH)..lines.len().min(at + REACH + 1);
        let beside = lines[around].iter().any(is_there);
        total.jumps.add(u64::from(!beside));
        total.fetched.add(1);
        self.touched.add(u64::from(line.fetch.get() == 0));
        self.fetches.set(now + 1);
        line.fetch.set(now + 1);
    }
}

impl Probe for Ledger {
    #[inline]
    fn read(&self, table: &'static str, row: usize, bytes: usize) {
        let book = &*self.0;
        let total = &book.totals[book.step.get() as usize];
        total.reads.add(1);
        let is_it = |page: &&Page| std::ptr::eq(&*page.name, table) || page.name == table;
        let Some(page) = book.pages.iter().find(is_it) else {
            return;
        };
        if book.step.get() == Step::Asking as u64 {
            page.reads.add(1);
        }
        // A part of a row is taken to be its beginning.
        let start = row.saturating_mul(page.row_bytes);
        let end = start.saturating_add(bytes);
        let mut from = start;
        while from < end {
            let line = from / LINE_BYTES;
            if line >= page.lines.len() {
                return; // no such row: the table says so itself
            }
            let to = end.min((line + 1) * LINE_BYTES);
            let bits = (u64::MAX >> (LINE_BYTES - (to - from))) << (from % LINE_BYTES);
            book.touch(&page.lines, line, bits, to - from, total);
            from = to;
        }
    }

    fn write(&self, _: &'static str, _: usize, _: usize) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ledger(tables: &[(&'static str, usize, usize)]) -> Ledger {
        let table = |&(table, rows, row_bytes): &(&'static str, usize, usize)| TableBytes {
            table: table.into(),
            rows,
            bytes: rows * row_bytes,
            row_bytes,
        };
        Ledger::of(&tables.iter().map(table).collect())
    }

    /// Reads whole rows of one table as one question: the lines and the bytes.
    fn ask(ledger: &Ledger, table: &'static str, bytes: usize, rows: &[usize]) -> [u64; 2] {
        let before = ledger.sum(Step::Asking);
        ledger.begin(Step::Asking);
        for &row in rows {
            ledger.read(table, row, bytes);
        }
        let after = ledger.sum(Step::Asking);
        [after.lines - before.lines, after.bytes - before.bytes]
    }

    #[test]
    fn a_row_may_straddle_two_lines() {
        let ledger = ledger(&[("halves", 100, 24)]);
        assert_eq!(ask(&ledger, "halves", 24, &[0, 1]), [1, 48]);
        assert_eq!(ask(&ledger, "halves", 24, &[2]), [2, 24], "bytes 48 to 71");
        assert_eq!(ask(&ledger, "halves", 24, &[2, 3, 2]), [2, 48], "each once");
        assert_eq!(
            ask(&ledger, "halves", 24, &[8]),
            [1, 24],
            "bytes 192 to 215"
        );
        assert_eq!(ledger.sum(Step::Asking).reads, 7);
        assert_eq!(ledger.touched(), 3, "lines 0, 1 and 3");
    }

    #[test]
    fn a_row_longer_than_a_line_touches_all_its_lines() {
        let ledger = ledger(&[("records", 3, 160)]);
        assert_eq!(ask(&ledger, "records", 160, &[0]), [3, 160]);
        assert_eq!(ask(&ledger, "records", 160, &[1]), [3, 160], "160 to 319");
        assert_eq!(ledger.touched(), 5);
    }

    #[test]
    fn part_of_a_row_lies_where_the_row_does() {
        let ledger = ledger(&[("halves", 100, 24)]);
        // Row 5 begins at byte 120: four bytes of it are in line 1, the whole also in line 2.
        assert_eq!(ask(&ledger, "halves", 4, &[5]), [1, 4]);
        assert_eq!(ask(&ledger, "halves", 24, &[5]), [2, 24]);
    }

    #[test]
    fn tables_share_no_line_and_a_missing_row_is_none() {
        let ledger = ledger(&[("one", 1, 4), ("two", 1, 4)]);
        ledger.begin(Step::Asking);
        ledger.read("one", 0, 4);
        ledger.read("two", 0, 4);
        ledger.read("two", 99, 4);
        ledger.read("three", 0, 4);
        let sum = ledger.sum(Step::Asking);
        assert_eq!((sum.reads, sum.lines, sum.bytes), (4, 2, 8));
        let tables: Vec<_> = ledger.tables().collect();
        assert_eq!(tables, [("one", 4, 1), ("two", 4, 2)]);
    }

    #[test]
    fn a_stream_is_fetched_once_and_jumps_once() {
        let lines = 3 * CACHE_LINES as usize;
        let ledger = ledger(&[("corners", 16 * lines, 4)]);
        let rows: Vec<usize> = (0..16 * lines).collect();
        ask(&ledger, "corners", 4, &rows);
        let sum = ledger.sum(Step::Asking);
        assert_eq!((sum.fetched, sum.jumps), (lines as u64, 1));
        // The first lines have gone meanwhile, and come again.
        ask(&ledger, "corners", 4, &rows);
        let sum = ledger.sum(Step::Asking);
        assert_eq!((sum.fetched, sum.jumps), (2 * lines as u64, 2));
        assert_eq!(ledger.touched(), lines as u64);
    }

    #[test]
    fn the_small_cache_holds_what_came_last() {
        let far = REACH + 1;
        let lines = CACHE_LINES as usize;
        let ledger = ledger(&[("spread", far * (lines + 2), 64)]);
        let spread: Vec<usize> = (0..lines).map(|i| far * i).collect();
        ask(&ledger, "spread", 64, &spread);
        let full = ledger.sum(Step::Asking);
        assert_eq!((full.fetched, full.jumps), (CACHE_LINES, CACHE_LINES));
        ask(&ledger, "spread", 64, &spread);
        assert_eq!(ledger.sum(Step::Asking).fetched, CACHE_LINES, "all there");
        // One more drives the first out, and no other.
        ask(&ledger, "spread", 64, &[far * lines, far]);
        assert_eq!(ledger.sum(Step::Asking).fetched, CACHE_LINES + 1);
        ask(&ledger, "spread", 64, &[0]);
        assert_eq!(ledger.sum(Step::Asking).fetched, CACHE_LINES + 2);
    }

    #[test]
    fn a_stream_may_leave_lines_out_and_go_either_way() {
        for (stride, jumps) in [(1, 1), (REACH, 1), (REACH + 1, 20)] {
            let ledger = ledger(&[("records", 20 * stride, 64)]);
            let up: Vec<usize> = (0..20).map(|i| i * stride).collect();
            let down: Vec<usize> = up.iter().rev().copied().collect();
            for way in [up, down] {
                ledger.clear();
                ask(&ledger, "records", 64, &way);
                let sum = ledger.sum(Step::Asking);
                assert_eq!((sum.fetched, sum.jumps), (20, jumps), "{stride}: {way:?}");
            }
        }
    }

    #[test]
    fn listing_is_counted_apart_and_all_is_forgotten_together() {
        let ledger = ledger(&[("opposite", 64, 4)]);
        ledger.begin(Step::Listing);
        ledger.read("opposite", 0, 4);
        ask(&ledger, "opposite", 4, &[0, 16]);
        assert_eq!(ledger.sum(Step::Listing).reads, 1);
        assert_eq!(ledger.sum(Step::Asking).lines, 2);
        assert_eq!(ledger.sum(Step::Asking).fetched, 1, "line 0 was there");
        assert_eq!(ledger.tables().next(), Some(("opposite", 4, 2)));
        ledger.clear();
        assert_eq!(ledger.sum(Step::Listing), Sum::default());
        assert_eq!(ledger.sum(Step::Asking), Sum::default());
        assert_eq!((ledger.touched(), ledger.tables().count()), (0, 0));
    }
}
