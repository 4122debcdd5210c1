//! The ways to rows that a query has found so far. A scan finds one or more for each row of a table, so adding one is fast.

use std::num::NonZero;

use rustc_hash::FxHashMap;
use sixfold_core::{Line, RecordTable, RowName};

use super::Way;

/// Maximum number of ways to a row: the latest ones. The query naming the row is always one of them.
const MOST_WAYS: usize = 6;

/// Where a way comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// The query names the row.
    Asked,
    /// The row was read.
    Same,
    /// A field of the row `of` of a table names the row. The table and the column by their numbers.
    Field {
        table: usize,
        column: usize,
        of: u32,
    },
}

/// The latest way to a row is the first link of a chain; each link has the number of the link before it.
#[derive(Debug)]
struct Link {
    before: Option<u32>,
    time: u32,
    source: Packed,
}

/// A [`Source`] in eight bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Packed {
    of: u32,
    table: u16,
    column: u16,
}

impl Packed {
    const ASKED: Self = Self::plain(0);
    const SAME: Self = Self::plain(1);
    /// The number of a table that no structure has.
    const NO_TABLE: u16 = u16::MAX;

    const fn plain(column: u16) -> Self {
        Self {
            of: 0,
            table: Self::NO_TABLE,
            column,
        }
    }

    fn way(self, time: u32, tables: &[RecordTable]) -> Way {
        let (name, of) = match self {
            Self::ASKED => (Line::ASKED, None),
            Self::SAME => (Line::SAME, None),
            Self { of, table, column } => {
                let table = &tables[usize::from(table)];
                let of = RowName {
                    letter: table.letter,
                    row: of,
                };
                (table.columns[usize::from(column)].name, Some(of))
            }
        };
        Way {
            name,
            of,
            time: time as usize,
            is_part: false,
        }
    }
}

impl From<Source> for Packed {
    fn from(source: Source) -> Self {
        match source {
            Source::Asked => Self::ASKED,
            Source::Same => Self::SAME,
            Source::Field { table, column, of } => Self {
                of,
                table: table as u16,
                column: column as u16,
            },
        }
    }
}

/// The ways to each row, with the times at which they were found.
#[derive(Debug)]
pub(super) struct Known {
    /// The rows that the query names.
    asked: Vec<RowName>,
    /// For each letter of rows their latest links.
    latest: Vec<(&'static str, Latest)>,
    links: Vec<Link>,
}

/// The latest links of the rows with one letter.
#[derive(Debug, Default)]
struct Latest {
    /// Of the rows that are not in `in_order`.
    by_row: FxHashMap<u32, u32>,
    /// Of the first rows, in their order, if a scan finds ways to most of them.
    in_order: Vec<Option<NonZero<u32>>>,
}

impl Latest {
    fn get(&self, row: u32) -> Option<u32> {
        match self.in_order.get(row as usize) {
            Some(number) => number.map(|number| number.get() - 1),
            None => self.by_row.get(&row).copied(),
        }
    }

    /// Returns the number before.
    fn replace(&mut self, row: u32, number: u32) -> Option<u32> {
        match self.in_order.get_mut(row as usize) {
            Some(place) => {
                let before = std::mem::replace(place, NonZero::new(number + 1));
                before.map(|number| number.get() - 1)
            }
            None => self.by_row.insert(row, number),
        }
    }
}

impl Known {
    /// Returns the knowledge of a query that names the rows `asked`.
    pub(super) fn new(asked: Vec<RowName>) -> Self {
        Self {
            asked,
            latest: Vec::new(),
            links: Vec::new(),
        }
    }

    fn latest(&mut self, letter: &'static str) -> &mut Latest {
        let place = self.latest.iter().position(|(known, _)| *known == letter);
        let place = place.unwrap_or_else(|| {
            self.latest.push((letter, Latest::default()));
            self.latest.len() - 1
        });
        &mut self.latest[place].1
    }

    /// Makes adding ways fast for the rows of tables that a scan reads, or that it finds in their fields. O(rows) for the
    /// first scan.
    pub(super) fn begin_scan(&mut self, tables: &[RecordTable], rows: usize) {
        self.links.reserve(3 * rows);
        for table in tables {
            let latest = self.latest(table.letter);
            if latest.in_order.len() < table.rows {
                latest.in_order.resize(table.rows, None);
                let known = std::mem::take(&mut latest.by_row);
                let mut known: Vec<(u32, u32)> = known.into_iter().collect();
                known.sort_unstable();
                for (row, number) in known {
                    latest.replace(row, number);
                }
            }
        }
    }

    /// Adds a way to a row. O(1).
    pub(super) fn add(&mut self, name: RowName, source: Source, time: usize) {
        let (source, time) = (Packed::from(source), time as u32);
        let number = self.links.len() as u32;
        let before = self.latest(name.letter).replace(name.row, number);
        self.links.push(Link {
            before,
            time,
            source,
        });
    }

    /// Returns the ways to a row, the latest last: of equal ones the latest, and not more than [`MOST_WAYS`].
    ///
    /// O([`add`](Self::add)s to this row since the last call for it).
    pub(super) fn ways(&mut self, name: RowName, tables: &[RecordTable]) -> Vec<Way> {
        let mut next = self.latest(name.letter).get(name.row);
        let mut kept: Vec<u32> = Vec::new();
        while let Some(number) = next.filter(|_| kept.len() < MOST_WAYS) {
            let Link { before, source, .. } = self.links[number as usize];
            let is_repeated = |&other: &u32| self.links[other as usize].source == source;
            if !kept.iter().any(is_repeated) {
                kept.push(number);
            }
            next = before;
        }
        // The others are never needed again.
        for (i, &number) in kept.iter().enumerate() {
            self.links[number as usize].before = kept.get(i + 1).copied();
        }
        let way = |&number: &u32| {
            let Link { time, source, .. } = self.links[number as usize];
            source.way(time, tables)
        };
        let mut ways: Vec<Way> = kept.iter().rev().map(way).collect();
        let is_lost = !ways.iter().any(|way| way.name == Line::ASKED);
        if is_lost && self.asked.contains(&name) {
            ways.drain(..ways.len().min(MOST_WAYS).saturating_sub(MOST_WAYS - 1));
            ways.insert(0, Packed::ASKED.way(0, tables));
        }
        ways
    }
}
