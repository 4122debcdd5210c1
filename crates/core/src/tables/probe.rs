//! Observation of the reads and writes of queries and edits.

use std::fmt::Debug;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// An observer of the reads and writes of a [`Table`](crate::Table).
pub trait Probe: Clone + Debug + Send + Sync {
    /// Records that `bytes` bytes of row `row` of `table` are read.
    fn read(&self, table: &'static str, row: usize, bytes: usize);

    /// Records that `bytes` bytes of each of the rows `rows` of `table` are read, in order.
    #[inline(always)]
    fn read_rows(&self, table: &'static str, rows: Range<usize>, bytes: usize) {
        for row in rows {
            self.read(table, row, bytes);
        }
    }

    /// Records that `bytes` bytes of row `row` of `table` are written.
    fn write(&self, table: &'static str, row: usize, bytes: usize);
}

/// The probe for normal use: it records nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Untraced;

impl Probe for Untraced {
    #[inline(always)]
    fn read(&self, _: &'static str, _: usize, _: usize) {}

    #[inline(always)]
    fn read_rows(&self, _: &'static str, _: Range<usize>, _: usize) {}

    #[inline(always)]
    fn write(&self, _: &'static str, _: usize, _: usize) {}
}

/// The kind of an [`Access`]: a read or a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AccessKind {
    /// The row is read.
    Read,
    /// The row is written.
    Write,
}

/// One read or write of one row of one table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Access {
    /// Whether the row was read or written.
    pub kind: AccessKind,
    /// The name of the table.
    pub table: &'static str,
    /// The number of the row.
    pub row: usize,
    /// The number of bytes read or written.
    pub bytes: usize,
}

/// A probe that records every access in order. All clones of the probe share one log.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    log: Arc<Mutex<Log>>,
}

#[derive(Debug, Default)]
struct Log {
    accesses: Vec<Access>,
    is_paused: bool,
    /// The largest number of accesses; `None` for any number.
    limit: Option<usize>,
}

impl Traced {
    /// Returns all accesses since the previous call of `take`, in order, and empties the log.
    pub fn take(&self) -> Vec<Access> {
        std::mem::take(&mut self.log().accesses)
    }

    /// Calls `observed`, and records none of the accesses during the call.
    pub fn pause<T>(&self, observed: impl FnOnce() -> T) -> T {
        let was_paused = std::mem::replace(&mut self.log().is_paused, true);
        let result = observed();
        self.log().is_paused = was_paused;
        result
    }

    /// Calls `observed`, and records no access while the log has `limit` accesses.
    pub fn limit<T>(&self, limit: usize, observed: impl FnOnce() -> T) -> T {
        let before = self.log().limit.replace(limit);
        let result = observed();
        self.log().limit = before;
        result
    }

    fn push(&self, access: Access) {
        let mut log = self.log();
        let is_full = log.limit.is_some_and(|limit| log.accesses.len() >= limit);
        if !log.is_paused && !is_full {
            log.accesses.push(access);
        }
    }

    fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Probe for Traced {
    fn read(&self, table: &'static str, row: usize, bytes: usize) {
        let kind = AccessKind::Read;
        self.push(Access {
            kind,
            table,
            row,
            bytes,
        });
    }

    /// Locks the log once.
    fn read_rows(&self, table: &'static str, rows: Range<usize>, bytes: usize) {
        let mut log = self.log();
        if log.is_paused {
            return;
        }
        let room = match log.limit {
            Some(limit) => limit.saturating_sub(log.accesses.len()),
            None => usize::MAX,
        };
        log.accesses.extend(rows.take(room).map(|row| Access {
            kind: AccessKind::Read,
            table,
            row,
            bytes,
        }));
    }

    fn write(&self, table: &'static str, row: usize, bytes: usize) {
        let kind = AccessKind::Write;
        self.push(Access {
            kind,
            table,
            row,
            bytes,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accesses_after_the_limit_are_not_recorded() {
        let probe = Traced::default();
        let read = |count| (0..count).for_each(|row| probe.read("faces", row, 4));
        probe.limit(3, || read(5));
        assert_eq!(probe.take().len(), 3);
        read(5);
        assert_eq!(probe.take().len(), 5);
        probe.limit(3, || {
            probe.read("faces", 9, 4);
            probe.read_rows("faces", 0..5, 4);
        });
        let rows = probe.take().into_iter().map(|access| access.row);
        assert!(rows.eq([9, 0, 1]));
        probe.pause(|| probe.read_rows("faces", 0..5, 4));
        assert!(probe.take().is_empty());
    }
}
