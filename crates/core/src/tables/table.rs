//! A table: rows of one kind, and a probe that records every access to a row.

use std::fmt;
use std::ops::Range;

use crate::tables::memory::TableBytes;
use crate::tables::probe::{Probe, Untraced};

/// One table of a structure. Queries and edits access the rows only through this type.
///
/// With the probe [`Untraced`], a read is only a bounds-checked index. Each table stores its name
/// and the kind of its rows, for traces, memory reports and the panic message of a missing row.
pub struct Table<T, P: Probe = Untraced> {
    rows: Vec<T>,
    name: &'static str,
    element: &'static str,
    probe: P,
}

impl<T> Table<T> {
    /// Builds a table called `name`. `element` is the kind of element that a row describes, for
    /// example `"vertex"`.
    pub fn new(name: &'static str, element: &'static str, rows: Vec<T>) -> Self {
        Self {
            rows,
            name,
            element,
            probe: Untraced,
        }
    }
}

impl<T, P: Probe> Table<T, P> {
    /// Returns a table that has the same rows and reports its reads and writes to `probe`.
    pub fn probed<Q: Probe>(self, probe: Q) -> Table<T, Q> {
        let Self {
            rows,
            name,
            element,
            ..
        } = self;
        Table {
            rows,
            name,
            element,
            probe,
        }
    }

    /// Returns the number of rows.
    #[inline]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether the table has no rows.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Reads row `row`.
    ///
    /// # Panics
    ///
    /// Panics if the table has no row `row`; the message names the table, the element and the row.
    #[inline]
    pub fn read(&self, row: usize) -> &T {
        self.probe.read(self.name, row, size_of::<T>());
        match self.rows.get(row) {
            Some(value) => value,
            None => self.no_such_row(row),
        }
    }

    /// Reads rows `2 * pair` and `2 * pair + 1`, with one bounds check for both.
    ///
    /// # Panics
    ///
    /// Panics if the table does not have both rows; the message names the table, the element and
    /// the row.
    #[inline]
    pub fn read_pair(&self, pair: usize) -> &[T; 2] {
        self.probe.read(self.name, 2 * pair, size_of::<T>());
        self.probe.read(self.name, 2 * pair + 1, size_of::<T>());
        match self.rows.as_chunks().0.get(pair) {
            Some(rows) => rows,
            None => self.no_such_row(2 * pair),
        }
    }

    /// Reads the rows of `range`.
    ///
    /// # Panics
    ///
    /// Panics if the table does not have all rows of `range`.
    #[inline]
    pub fn read_range(&self, range: Range<usize>) -> &[T] {
        self.probe
            .read_rows(self.name, range.clone(), size_of::<T>());
        match self.rows.get(range.clone()) {
            Some(values) => values,
            None => self.no_such_row(range.end.max(range.start + 1) - 1),
        }
    }

    /// Returns row `row` for writing.
    ///
    /// # Panics
    ///
    /// Panics if the table has no row `row`; the message names the table, the element and the row.
    #[inline]
    pub fn write(&mut self, row: usize) -> &mut T {
        self.probe.write(self.name, row, size_of::<T>());
        if row >= self.rows.len() {
            self.no_such_row(row);
        }
        &mut self.rows[row]
    }

    /// Adds a row at the end; O(1) amortised.
    ///
    /// The caller must check beforehand that the table has fewer than [`MAX_ROWS`](crate::MAX_ROWS)
    /// rows.
    #[inline]
    pub fn push(&mut self, value: T) {
        self.probe.write(self.name, self.rows.len(), size_of::<T>());
        self.rows.push(value);
    }

    /// Adds rows at the end; O(rows) amortised.
    #[inline]
    pub fn extend(&mut self, values: impl IntoIterator<Item = T>) {
        for value in values {
            self.push(value);
        }
    }

    /// Returns a table with the given rows and with the probe of this table.
    pub fn new_like<U>(
        &self,
        name: &'static str,
        element: &'static str,
        rows: Vec<U>,
    ) -> Table<U, P> {
        Table {
            rows,
            name,
            element,
            probe: self.probe.clone(),
        }
    }

    /// Returns the probe.
    pub fn probe(&self) -> P {
        self.probe.clone()
    }

    /// Replaces all rows. The probe does not record the change.
    pub fn replace(&mut self, rows: Vec<T>) {
        self.rows = rows;
    }

    /// Drops the rows from `len` on. The probe does not record the change.
    pub fn truncate(&mut self, len: usize) {
        self.rows.truncate(len);
    }

    /// Drops all rows and frees their memory. The probe does not record the change.
    pub fn clear(&mut self) {
        self.rows = Vec::new();
    }

    /// Frees spare memory if less than half of the capacity is used. The probe records no access.
    pub fn shrink_if_half_empty(&mut self) {
        if self.rows.len() < self.rows.capacity() / 2 {
            self.rows.shrink_to_fit();
        }
    }

    /// Returns all rows. The probe does not record the reads.
    #[inline]
    pub fn rows(&self) -> &[T] {
        &self.rows
    }

    /// Returns all rows for writing. The probe does not record the writes.
    #[inline]
    pub fn rows_mut(&mut self) -> &mut [T] {
        &mut self.rows
    }

    /// Changes the number of rows to `len`. Afterwards, the content of all rows is arbitrary, so
    /// the caller must overwrite every row. Allocates only if the capacity is too small. The probe
    /// does not record the change.
    pub fn resize(&mut self, len: usize, blank: T)
    where
        T: Copy,
    {
        if len > self.rows.capacity() {
            // Frees the old rows before the new rows are allocated.
            self.rows = Vec::new();
            self.rows.reserve_exact(len);
        }
        self.rows.resize(len, blank);
    }

    /// Returns the name and the size of the table; the bytes include spare capacity.
    pub fn bytes(&self) -> TableBytes {
        TableBytes {
            table: self.name.into(),
            rows: self.rows.len(),
            bytes: self.rows.capacity() * size_of::<T>(),
            row_bytes: size_of::<T>(),
        }
    }

    #[cold]
    #[inline(never)]
    fn no_such_row(&self, row: usize) -> ! {
        let Self { name, element, .. } = self;
        panic!(
            "no {element} {row}: table `{name}` has {} rows",
            self.rows.len()
        )
    }
}

impl<T: Clone, P: Probe> Clone for Table<T, P> {
    fn clone(&self) -> Self {
        Self {
            rows: self.rows.clone(),
            name: self.name,
            element: self.element,
            probe: self.probe.clone(),
        }
    }

    /// Copies the rows of `source` into the memory of this table. Allocates only if the rows do not
    /// fit. Spare capacity stays.
    fn clone_from(&mut self, source: &Self) {
        self.rows.clone_from(&source.rows);
        self.name = source.name;
        self.element = source.element;
        self.probe.clone_from(&source.probe);
    }
}

impl<T: fmt::Debug, P: Probe> fmt::Debug for Table<T, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.name)?;
        f.debug_list().entries(&self.rows).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::probe::{Access, AccessKind, Traced};

    #[test]
    fn a_traced_table_logs_each_access() {
        let probe = Traced::default();
        let mut table = Table::new("next", "half-edge", vec![5_u32, 6, 7]).probed(probe.clone());
        assert_eq!(*table.read(2), 7);
        assert_eq!(table.read_range(0..2), [5, 6]);
        *table.write(1) = 9;
        let touched = |kind, row| Access {
            kind,
            table: "next",
            row,
            bytes: 4,
        };
        let reads = [2, 0, 1].map(|row| touched(AccessKind::Read, row));
        let log = probe.take();
        assert_eq!(log[..3], reads);
        assert_eq!(log[3..], [touched(AccessKind::Write, 1)]);
        assert!(probe.take().is_empty());
        assert_eq!(*probe.pause(|| table.read(0)), 5);
        assert!(probe.take().is_empty());
        table.read(0);
        assert_eq!(probe.take(), [touched(AccessKind::Read, 0)]);
    }

    #[test]
    #[should_panic(expected = "no half-edge 3: table `next` has 3 rows")]
    fn a_missing_row_panics_with_table_and_row() {
        Table::new("next", "half-edge", vec![5_u32, 6, 7]).read(3);
    }
}
