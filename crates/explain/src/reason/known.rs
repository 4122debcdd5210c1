//! The ways to rows that a query has found so far. A scan finds one or more for each row of a table, so adding one is fast.

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
    /// The letters of rows; their numbers are in the keys of `latest`.
    letters: Vec<&'static str>,
    /// The latest link, by the letter and the number of a row.
    latest: FxHashMap<u64, u32>,
    links: Vec<Link>,
}

impl Known {
    /// Returns the knowledge of a query that names the rows `asked`.
    pub(super) fn new(asked: Vec<RowName>) -> Self {
        Self {
            asked,
            letters: Vec::new(),
            latest: FxHashMap::default(),
            links: Vec::new(),
        }
    }

    fn key(&mut self, name: RowName) -> u64 {
        let letter = (self.letters.iter()).position(|&letter| letter == name.letter);
        let letter = letter.unwrap_or_else(|| {
            self.letters.push(name.letter);
            self.letters.len() - 1
        });
        (letter as u64) << 32 | u64::from(name.row)
    }

    /// Adds a way to a row. O(1).
    pub(super) fn add(&mut self, name: RowName, source: Source, time: usize) {
        let (key, source, time) = (self.key(name), Packed::from(source), time as u32);
        let number = self.links.len() as u32;
        let before = self.latest.insert(key, number);
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
        let key = self.key(name);
        let mut next = self.latest.get(&key).copied();
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
