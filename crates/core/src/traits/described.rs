//! The records of a structure, as a textbook shows them.

use std::fmt;

use crate::Point;
use crate::handles::row_id::RowId;
use crate::polygons::error::BuildError;
use crate::tables::editing::Editing;
use crate::tables::face_spans::FaceSpans;
use crate::tables::probe::Probe;
use crate::traits::query::MeshQuery;
use crate::traits::representation::Relation;

/// A structure that describes its tables: what a row is, and what each field of a row means.
///
/// Tools that show tables and explain queries read a structure through this trait. The values come
/// from the tables of the structure, so there is no second copy of the layout.
pub trait Described: MeshQuery {
    /// Returns the tables that this mesh has, in the order in which a textbook shows them.
    fn tables(&self) -> Vec<RecordTable>;

    /// Returns the fields of a row, in the order of the columns of its table; `None` if there is no
    /// such row, or if the row belongs to a deleted element. A probe may record reads.
    ///
    /// Unless `walks` is true, a field that a walk along other rows finds is [`Field::None`], so that the
    /// records of all rows take O(rows).
    fn record(&self, table: &str, row: usize, walks: bool) -> Option<Vec<Field>>;

    /// Returns the names of the rows that the handle of an element gives without a read. A structure
    /// without rows for this kind of element returns none, or the rows of the ends of an edge.
    fn rows_of(&self, element: Element<Self>) -> Vec<RowName>;

    /// Returns which field has no room for the fault of a mesh that the structure refuses, such as `a half-edge has one
    /// twin, so the side of f8 has no place`. None by default.
    fn no_room(refusal: &BuildError) -> Option<String> {
        let _ = refusal;
        None
    }

    /// Words of textbooks that stand for several fields. None by default.
    const WORDS: &'static [Word] = &[];

    /// Returns the steps of a query, as a textbook writes them. No steps by default.
    fn algorithm(relation: Relation) -> &'static [Line] {
        let _ = relation;
        &[]
    }
}

/// An element of a mesh.
#[derive(Debug)]
pub enum Element<M: MeshQuery + ?Sized> {
    /// A vertex.
    Vertex(M::Vertex),
    /// An edge.
    Edge(M::Edge),
    /// A face.
    Face(M::Face),
}

impl<M: MeshQuery + ?Sized> Clone for Element<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: MeshQuery + ?Sized> Copy for Element<M> {}

/// One line of an algorithm, with the reads that it makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The text, indented by two spaces in a loop. A line that yields results has the word `yield`.
    pub text: &'static str,
    /// The tables of which the line reads rows, each with the way to the row: the name of the field
    /// of another row that names this row, or [`ASKED`](Self::ASKED), [`SAME`](Self::SAME),
    /// [`NEXT_ROW`](Self::NEXT_ROW), [`SCAN`](Self::SCAN) or [`SEARCH`](Self::SEARCH).
    pub reads: &'static [(&'static str, &'static str)],
}

impl Line {
    /// The row belongs to the element of the query.
    pub const ASKED: &'static str = "asked";
    /// The row has the name of a row that was read before, in the same or in another table.
    pub const SAME: &'static str = "same";
    /// The row is the one after the row before.
    pub const NEXT_ROW: &'static str = "next row";
    /// All rows of the table are read in order.
    pub const SCAN: &'static str = "scan";
    /// The row is found by a binary search.
    pub const SEARCH: &'static str = "search";

    /// Returns a line that reads rows.
    pub const fn new(text: &'static str, reads: &'static [(&'static str, &'static str)]) -> Self {
        Self { text, reads }
    }

    /// Returns a line that reads no row.
    pub const fn text(text: &'static str) -> Self {
        Self { text, reads: &[] }
    }
}

/// A word of textbooks for several fields, such as `target` for the origin of the twin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The letter of the rows to which the word applies.
    pub letter: &'static str,
    /// The word.
    pub name: &'static str,
    /// The fields of the row `x`, such as `origin(twin(x))`.
    pub means: &'static str,
}

impl Word {
    /// Returns a word. The arguments are the fields, in their order.
    pub const fn new(letter: &'static str, name: &'static str, means: &'static str) -> Self {
        Self {
            letter,
            name,
            means,
        }
    }
}

/// The name of a row of a table, such as `h3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RowName {
    /// The letter of the table.
    pub letter: &'static str,
    /// The number of the row.
    pub row: u32,
}

impl RowName {
    /// Returns the name of the row of `handle`.
    pub fn new(letter: &'static str, handle: impl RowId) -> Self {
        let row = handle.row();
        Self { letter, row }
    }
}

/// Writes `h3`.
impl fmt::Display for RowName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.letter, self.row)
    }
}

/// One table of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordTable {
    /// The name of the table, as in traces and memory reports.
    pub name: &'static str,
    /// What a row describes, such as `half-edge`.
    pub element: &'static str,
    /// The letter of the names of rows: row 3 of a table with the letter `h` is `h3`. Tables with the
    /// same letter describe the same elements.
    pub letter: &'static str,
    /// The number of rows, including the rows of deleted elements.
    pub rows: usize,
    /// The columns.
    pub columns: &'static [Column],
}

impl RecordTable {
    /// Returns a table. The arguments are the fields, in their order.
    pub const fn new(
        name: &'static str,
        element: &'static str,
        letter: &'static str,
        rows: usize,
        columns: &'static [Column],
    ) -> Self {
        Self {
            name,
            element,
            letter,
            rows,
            columns,
        }
    }
}

/// One column of a table: a field that each row stores, or that follows from the number of the row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// The name of the field in textbooks, such as `twin`.
    pub name: &'static str,
    /// What the field means, such as `the half-edge in the opposite direction`.
    pub about: &'static str,
    /// True if the field is not stored: it follows from the number of the row, or from other fields.
    pub is_derived: bool,
    /// True if a derived field is found by reading other rows.
    pub is_searched: bool,
}

impl Column {
    /// Returns a column that is stored.
    pub const fn stored(name: &'static str, about: &'static str) -> Self {
        Self {
            name,
            about,
            is_derived: false,
            is_searched: false,
        }
    }

    /// Returns a column that is not stored.
    pub const fn derived(name: &'static str, about: &'static str) -> Self {
        Self {
            name,
            about,
            is_derived: true,
            is_searched: false,
        }
    }

    /// Returns a column that is not stored, whose fields are found by reading other rows. A table has
    /// at most one such column.
    pub const fn searched(name: &'static str, about: &'static str) -> Self {
        Self {
            is_searched: true,
            ..Self::derived(name, about)
        }
    }

    /// The column of the position of a vertex.
    pub const POSITION: Self = Self::stored("position", "the coordinates of the vertex");
}

/// The value of one field of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Field {
    /// The name of a row.
    Row(RowName),
    /// There is no element, such as the face beyond a boundary.
    None,
    /// A number that is not the name of a row.
    Number(u32),
    /// A position.
    Point(Point),
}

impl Field {
    /// Returns the name of the row of `handle`.
    pub fn row(letter: &'static str, handle: impl RowId) -> Self {
        Self::Row(RowName::new(letter, handle))
    }

    /// Returns the name of the row of `handle`, or [`None`](Self::None).
    pub fn optional(letter: &'static str, handle: Option<impl RowId>) -> Self {
        handle.map_or(Self::None, |handle| Self::row(letter, handle))
    }
}

/// Writes `h3`, `none`, `7` or `(1, 0, 0.5)`.
impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Row(name) => name.fmt(f),
            Self::None => f.write_str("none"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Point(Point { x, y, z }) => write!(f, "({x}, {y}, {z})"),
        }
    }
}

/// The description of the ranges of corners of faces; the letter of corners is `c`.
impl<P: Probe, E: Editing> FaceSpans<P, E> {
    /// Returns the tables of the ranges: none if all faces have the same degree.
    pub fn record_tables(&self) -> Vec<RecordTable> {
        const FIRST: Column = Column::stored("first", "the first corner of the face");
        const OFFSETS: &[Column] = &[FIRST, Column::derived("degree", "the number of corners")];
        const SPANS: &[Column] = &[FIRST, Column::stored("degree", "the number of corners")];
        const OWNERS: &[Column] = &[Column::stored("face", "the face that has the corner")];
        match self {
            Self::Uniform { .. } => Vec::new(),
            Self::Mixed(_) => vec![RecordTable::new(
                "offsets",
                "face",
                "f",
                self.len(),
                OFFSETS,
            )],
            Self::Scattered(faces) => vec![
                RecordTable::new("spans", "face", "f", self.len(), SPANS),
                RecordTable::new(
                    "owners",
                    "corner",
                    "c",
                    faces.as_ref().corner_count(),
                    OWNERS,
                ),
            ],
        }
    }

    /// Returns the fields of a row of `offsets`, `spans` or `owners`; `None` if there is no such row.
    pub fn record(&self, table: &str, row: usize) -> Option<Vec<Field>> {
        match (self, table) {
            (Self::Scattered(faces), "owners") => {
                let owner = faces.as_ref().owner_of(row)?;
                Some(vec![Field::optional("f", owner)])
            }
            (Self::Mixed(_), "offsets") | (Self::Scattered(_), "spans") if row < self.len() => {
                let range = self.range(crate::FaceId::new(row as u32));
                let first = Field::Row(RowName {
                    letter: "c",
                    row: range.start as u32,
                });
                Some(vec![first, Field::Number(range.len() as u32)])
            }
            _ => None,
        }
    }
}
