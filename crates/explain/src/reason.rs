//! The reasons for which a query reads rows, inferred from the description of the tables.
//!
//! A row is read because a row that was read before names it, because the query names it, or because all
//! rows are searched. No query says why it reads a row: the description of the tables
//! ([`Described::record`](sixfold_core::Described::record)) has the names, and the steps of the query ([`Described::algorithm`](sixfold_core::Described::algorithm)) decide
//! between several reasons.

use std::collections::{HashMap, HashSet};

use rustc_hash::FxHashMap;
use serde::Serialize;
use sixfold_core::{Access, Column, Field, Line, RecordTable, RowName};
use smallvec::SmallVec;

use crate::named_mesh::RecordSource;

/// Number of rows in order that are a scan, not the corners of one face.
const SCANNED_ROWS: usize = 16;

/// Maximum number of reasons that are kept for each row: the latest ones.
const KEPT_REASONS: usize = 6;

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
    lines: &'static [Line],
    /// A scan has one way to each of its rows.
    known: FxHashMap<RowName, SmallVec<[Way; 1]>>,
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
        let mut inference = Self {
            mesh,
            tables: mesh.record_tables(),
            lines,
            known: FxHashMap::default(),
            asked: asked.iter().copied().collect(),
            time: 0,
            line: None,
            last: None,
            scanned: HashMap::new(),
            is_scanning: false,
        };
        for name in asked {
            inference.learn(name, Line::ASKED, None, None);
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
        self.learn(name, Line::SAME, None, whole);
        let fields = self.mesh.own_fields(table.name, row).unwrap_or_default();
        for (column, field) in table.columns.iter().zip(fields) {
            if let Field::Row(to) = field
                && !column.is_derived
            {
                self.learn(to, column.name, Some(name), whole);
            }
        }
        (self.reason(way, table), line)
    }

    /// Adds a way to a row, and to the rows that fields of this row name without a read, except to
    /// `whole`.
    fn learn(
        &mut self,
        name: RowName,
        way: &'static str,
        of: Option<RowName>,
        whole: Option<RowName>,
    ) {
        self.add(name, way, of);
        for place in 0..self.tables.len() {
            let table = self.tables[place];
            let is_derived = |column: &Column| column.is_derived;
            if table.letter != name.letter || !table.columns.iter().any(is_derived) {
                continue;
            }
            let fields = self
                .mesh
                .own_fields(table.name, name.row as usize)
                .unwrap_or_default();
            for (column, field) in table.columns.iter().zip(fields) {
                if let Field::Row(to) = field
                    && column.is_derived
                    && whole != Some(to)
                {
                    self.add(to, column.name, Some(name));
                }
            }
        }
    }

    fn add(&mut self, name: RowName, way: &'static str, of: Option<RowName>) {
        let ways = self.known.entry(name).or_default();
        ways.retain(|known| known.name != way || known.of != of);
        if ways.len() == KEPT_REASONS {
            let oldest = ways.iter().position(|way| way.name != Line::ASKED);
            ways.remove(oldest.unwrap_or(0));
        }
        ways.push(Way {
            name: way,
            of,
            time: self.time,
            is_part: false,
        });
    }

    /// Returns the ways to a row, the latest first.
    fn ways(&self, table: RecordTable, name: RowName) -> Vec<Way> {
        let known = self.known.get(&name);
        let mut ways = known.map(|known| known.to_vec()).unwrap_or_default();
        // The row is a part of a known element, such as a corner of f3.
        for same in self
            .tables
            .iter()
            .filter(|same| same.letter == table.letter)
        {
            let fields = self
                .mesh
                .own_fields(same.name, name.row as usize)
                .unwrap_or_default();
            for (column, field) in same.columns.iter().zip(fields) {
                if let Field::Row(of) = field
                    && column.is_derived
                    && of.letter != table.letter
                {
                    let known = self.known.get(&of).into_iter().flatten();
                    ways.extend(known.map(|known| Way {
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
        if self.known.contains_key(&name) {
            ways.push(Way::plain(Line::SAME));
        }
        ways.push(Way::plain(Line::SEARCH));
        ways
    }

    /// Returns the way of a read, and its line.
    fn way(&self, table: RecordTable, name: RowName, accesses: &[Access]) -> (Way, Option<usize>) {
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
