//! The reasons for which a query reads rows, inferred from the description of the tables.
//!
//! A row is read because a row that was read before names it, because the query names it, or because all
//! rows are searched. No query says why it reads a row: the description of the tables
//! ([`Described::record`](sixfold_core::Described::record)) has the names, and the steps of the query ([`Described::algorithm`](sixfold_core::Described::algorithm)) decide
//! between several reasons.

mod known;

use std::collections::{HashMap, HashSet};

use serde::Serialize;
use sixfold_core::{Access, Field, Line, RecordTable, RowName};

use crate::named_mesh::RecordSource;
use known::{Known, Source};

/// Number of rows in order that are a scan, not the corners of one face.
const SCANNED_ROWS: usize = 16;

/// The way of a row for which no reason is found.
const UNKNOWN: &str = "unknown";

/// Why a query reads a row.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Reason {
    /// The way to the row: the name of a field, or a constant of [`Line`]; `unknown` if no reason is
    /// found.
    pub way: &'static str,
    /// The row whose field names the row.
    pub of: Option<String>,
    /// The reason as text, such as `twin of h4`.
    pub text: String,
}

/// A way to a row, which is known after a read.
#[derive(Clone, Copy, Debug)]
struct Way {
    name: &'static str,
    of: Option<RowName>,
    /// The number of the read that gave the way; 0 for the rows that the query names.
    time: usize,
    /// True if the row is a part of the named element, such as a corner of a face.
    is_part: bool,
}

impl Way {
    /// Returns a way that needs no row that was read before.
    const fn plain(name: &'static str) -> Self {
        Self {
            name,
            of: None,
            time: usize::MAX,
            is_part: false,
        }
    }
}

/// What a query knows after each of its reads.
pub(crate) struct Inference<'m> {
    mesh: &'m dyn RecordSource,
    tables: Vec<RecordTable>,
    /// The numbers of the tables with derived columns.
    deriving: Vec<usize>,
    lines: &'static [Line],
    known: Known,
    /// The rows of the element of the query.
    asked: HashSet<RowName>,
    /// The number of reads.
    time: usize,
    /// The current line.
    line: Option<usize>,
    last: Option<(&'static str, usize)>,
    /// For each table: the row where a scan continues.
    scanned: HashMap<&'static str, usize>,
    is_scanning: bool,
}

impl<'m> Inference<'m> {
    /// Returns the knowledge of a query that names the rows `asked`.
    pub(crate) fn new(
        mesh: &'m dyn RecordSource,
        lines: &'static [Line],
        asked: Vec<RowName>,
    ) -> Self {
        let tables = mesh.record_tables();
        let derives = |table: &usize| {
            let mut columns = tables[*table].columns.iter();
            columns.any(|column| column.is_derived)
        };
        let mut inference = Self {
            mesh,
            deriving: (0..tables.len()).filter(derives).collect(),
            known: Known::new(asked.clone()),
            tables,
            lines,
            asked: asked.iter().copied().collect(),
            time: 0,
            line: None,
            last: None,
            scanned: HashMap::new(),
            is_scanning: false,
        };
        for name in asked {
            inference.learn(name, Source::Asked, None);
        }
        inference
    }

    /// Returns the table of an access, or `None` if the structure does not describe the table.
    pub(crate) fn table(&self, access: &Access) -> Option<RecordTable> {
        let mut tables = self.tables.iter();
        tables.find(|table| table.name == access.table).copied()
    }

    /// Returns the line that yields a result after the current line.
    pub(crate) fn yielding(&mut self) -> Option<usize> {
        let yields = |line: &usize| self.lines[*line].text.contains("yield");
        let from = self.line.unwrap_or(0);
        let line = (from..self.lines.len()).chain(0..from).find(yields);
        self.line = line;
        line
    }

    /// Returns the reason for the first of `accesses`, a read of `table`, and the line that it falls
    /// on. Then learns the names in the row.
    pub(crate) fn read(
        &mut self,
        table: RecordTable,
        accesses: &[Access],
    ) -> (Reason, Option<usize>) {
        let row = accesses[0].row;
        let name = RowName {
            letter: table.letter,
            row: row as u32,
        };
        let (way, line) = self.way(table, name, accesses);
        if way.name == Line::SCAN {
            self.scanned.insert(table.name, row + 1);
        }
        self.is_scanning = way.name == Line::SCAN;
        self.line = line.or(self.line);
        self.last = Some((table.name, row));
        self.time += 1;
        // A part says nothing new about the element to which it belongs.
        let whole = way.of.filter(|_| way.is_part);
        if whole.is_some() && way.name == Line::ASKED {
            self.asked.insert(name);
        }
        self.learn_row(table, name, whole);
        (self.reason(way, table), line)
    }

    /// Returns how many of `accesses`, which follow the last read, go on with its scan: 0 if it was not a scan.
    pub(crate) fn scan_length(&self, accesses: &[Access]) -> usize {
        let Some((table, row)) = self.last.filter(|_| self.is_scanning) else {
            return 0;
        };
        let in_order = accesses.iter().zip(row + 1..);
        let in_order =
            in_order.take_while(|(access, row)| access.row == *row && access.table == table);
        in_order.count()
    }

    /// Reads the next `rows` rows of a scan of `table`. The same as [`read`](Self::read) for each of them: their reason is
    /// that of the last row.
    pub(crate) fn scan_on(&mut self, table: RecordTable, rows: usize) {
        let Some((_, last)) = self.last else {
            return;
        };
        // If several lines scan the table, the rows go to these lines in turn.
        let mut lines = Vec::new();
        let mut line = self.line;
        loop {
            line = self.line_after(line, table, Line::SCAN);
            if line.is_none() || lines.first() == Some(&line) || lines.len() == rows {
                break;
            }
            lines.push(line);
        }
        if let Some(count) = rows.checked_sub(1)
            && !lines.is_empty()
        {
            self.line = lines[count % lines.len()];
        }
        self.known.begin_scan(&self.tables, rows);
        for row in last + 1..=last + rows {
            self.time += 1;
            let name = RowName {
                letter: table.letter,
                row: row as u32,
            };
            self.learn_row(table, name, None);
        }
        self.last = Some((table.name, last + rows));
        self.scanned.insert(table.name, last + rows + 1);
    }

    /// Learns the name of a row of `table` that is read, and the names in the row except `whole`.
    fn learn_row(&mut self, table: RecordTable, name: RowName, whole: Option<RowName>) {
        let number = self.tables.iter().position(|one| one.name == table.name);
        let fields = self.mesh.own_fields(table.name, name.row as usize);
        let fields = fields.unwrap_or_default();
        self.known.add(name, Source::Same, self.time);
        for place in 0..self.deriving.len() {
            match self.deriving[place] {
                same if Some(same) == number => self.learn_derived(same, name, &fields, whole),
                other => self.learn_derived_of(other, name, whole),
            }
        }
        let Some(table) = number else { return };
        for (column, &field) in fields.iter().enumerate() {
            if let Field::Row(to) = field
                && !self.tables[table].columns[column].is_derived
            {
                let of = name.row;
                self.learn(to, Source::Field { table, column, of }, whole);
            }
        }
    }

    /// Adds a way to a row, and to the rows that fields of this row name without a read, except to
    /// `whole`.
    fn learn(&mut self, name: RowName, source: Source, whole: Option<RowName>) {
        self.known.add(name, source, self.time);
        for place in 0..self.deriving.len() {
            self.learn_derived_of(self.deriving[place], name, whole);
        }
    }

    /// Adds ways to the rows that derived fields of a row in a table name, if the table has such rows.
    fn learn_derived_of(&mut self, table: usize, name: RowName, whole: Option<RowName>) {
        let RecordTable {
            letter,
            name: table_name,
            ..
        } = self.tables[table];
        if letter == name.letter {
            let fields = self.mesh.own_fields(table_name, name.row as usize);
            self.learn_derived(table, name, &fields.unwrap_or_default(), whole);
        }
    }

    fn learn_derived(
        &mut self,
        table: usize,
        name: RowName,
        fields: &[Field],
        whole: Option<RowName>,
    ) {
        for (column, &field) in fields.iter().enumerate() {
            if let Field::Row(to) = field
                && self.tables[table].columns[column].is_derived
                && whole != Some(to)
            {
                let of = name.row;
                let source = Source::Field { table, column, of };
                self.known.add(to, source, self.time);
            }
        }
    }

    /// Returns the ways to a row, the latest first.
    fn ways(&mut self, table: RecordTable, name: RowName) -> Vec<Way> {
        let mut ways = self.known.ways(name, &self.tables);
        let is_known = !ways.is_empty();
        // The row is a part of a known element, such as a corner of f3.
        for same in (self.tables.iter()).filter(|same| same.letter == table.letter) {
            let fields = self
                .mesh
                .own_fields(same.name, name.row as usize)
                .unwrap_or_default();
            for (column, field) in same.columns.iter().zip(fields) {
                if let Field::Row(of) = field
                    && column.is_derived
                    && of.letter != table.letter
                {
                    let known = self.known.ways(of, &self.tables);
                    ways.extend(known.iter().map(|known| Way {
                        name: match known.name {
                            Line::ASKED => Line::ASKED,
                            _ => column.name,
                        },
                        of: Some(of),
                        time: known.time,
                        is_part: true,
                    }));
                }
            }
        }
        // A row that belongs to the element of the query comes before rows that were read later: the
        // sides of a face are walked with the vertices of this face, not of its neighbours.
        let is_asked = |way: &Way| way.of.is_some_and(|of| self.asked.contains(&of));
        ways.retain(|way| way.name != Line::SAME);
        ways.sort_by_key(|way| std::cmp::Reverse((is_asked(way) && !way.is_part, way.time)));
        let row = name.row as usize;
        if let Some(before) = row.checked_sub(1)
            && self.last == Some((table.name, before))
        {
            let of = RowName {
                row: before as u32,
                ..name
            };
            ways.push(Way {
                of: Some(of),
                ..Way::plain(Line::NEXT_ROW)
            });
        }
        if is_known {
            ways.push(Way::plain(Line::SAME));
        }
        ways.push(Way::plain(Line::SEARCH));
        ways
    }

    /// Returns the way of a read, and its line.
    fn way(
        &mut self,
        table: RecordTable,
        name: RowName,
        accesses: &[Access],
    ) -> (Way, Option<usize>) {
        let scan = self.distance(table, Line::SCAN);
        let scan = scan.map(|line| (Way::plain(Line::SCAN), line));
        let previous = (name.row as usize).checked_sub(1);
        let follows = previous.is_some_and(|row| self.last == Some((table.name, row)));
        if let Some((way, distance)) = scan
            && self.is_scanning
            && follows
        {
            return (way, Some(self.after(distance)));
        }
        let scan = scan.filter(|_| self.scans(table, accesses));
        if let Some((way, distance)) = scan
            && previous.is_some()
        {
            // A scan goes on where it was interrupted.
            return (way, Some(self.after(distance)));
        }
        let ways = self.ways(table, name);
        let mut named: Option<(Way, usize)> = None;
        for &way in &ways {
            let Some(distance) = self.distance(table, way.name) else {
                continue;
            };
            // The latest way counts, and of two ways from one read the one on the nearer line.
            if named.is_none_or(|(best, nearest)| best.time == way.time && distance < nearest) {
                named = Some((way, distance));
            }
        }
        let nearest = named
            .into_iter()
            .chain(scan)
            .min_by_key(|(_, distance)| *distance);
        if let Some((way, distance)) = nearest {
            return (way, Some(self.after(distance)));
        }
        let is_reason = |way: &&Way| way.name != Line::SAME && way.name != Line::SEARCH;
        let reason = ways.iter().find(is_reason).copied();
        (reason.unwrap_or(Way::plain(UNKNOWN)), None)
    }

    /// Returns whether the reads can be a scan of the whole table: they begin at its first row, or where
    /// the scan ended, and go on in order.
    fn scans(&self, table: RecordTable, accesses: &[Access]) -> bool {
        let row = accesses[0].row;
        let continues = row == 0 || self.scanned.get(table.name) == Some(&row);
        let needed = SCANNED_ROWS.min(table.rows.saturating_sub(row));
        let in_order = accesses.iter().zip(row..).take(needed);
        let in_order =
            in_order.filter(|(access, row)| access.table == table.name && access.row == *row);
        continues && needed > 0 && in_order.count() == needed
    }

    /// Returns the number of lines from the current line to the next line that reads `table` in this
    /// way.
    fn distance(&self, table: RecordTable, way: &str) -> Option<usize> {
        (1..=self.lines.len()).find(|&distance| {
            let line = self.lines[self.after(distance)];
            line.reads.contains(&(table.name, way))
        })
    }

    /// Returns the next line after `line` that reads `table` in this way.
    fn line_after(&self, line: Option<usize>, table: RecordTable, way: &str) -> Option<usize> {
        let from = line.map_or(0, |line| line + 1);
        let mut lines = (from..self.lines.len()).chain(0..from.min(self.lines.len()));
        lines.find(|&line| self.lines[line].reads.contains(&(table.name, way)))
    }

    /// Returns the line that is `distance` lines after the current line, from the first line again
    /// after the last.
    fn after(&self, distance: usize) -> usize {
        let from = self.line.unwrap_or(self.lines.len() - 1);
        (from + distance) % self.lines.len()
    }

    fn reason(&self, way: Way, table: RecordTable) -> Reason {
        let text = match (way.name, way.of) {
            (Line::ASKED, Some(of)) | (_, Some(of)) if way.is_part => {
                format!("a {} of {of}", table.element)
            }
            (Line::NEXT_ROW, Some(of)) => format!("the row after {of}"),
            (Line::ASKED, _) => "the query names it".into(),
            (Line::SAME, _) => "the same row again".into(),
            (Line::SCAN, _) => "every row in order".into(),
            (Line::SEARCH, _) => "a binary search".into(),
            (_, Some(of)) => format!("{} of {of}", way.name),
            (name, None) => name.into(),
        };
        Reason {
            way: way.name,
            of: way.of.map(|of| of.to_string()),
            text,
        }
    }
}
