//! The records of a structure: one for each element, from all tables about this kind of element.

use serde::Serialize;
use sixfold_core::{Column, RecordTable};

use crate::named_mesh::RecordSource;

/// The records of all elements of one kind. If a structure has several tables with a row for each of
/// these elements, a record has the fields of all of them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Records {
    /// What a record describes, such as `half-edge`.
    pub element: &'static str,
    /// The columns, in the order of the fields.
    pub columns: Vec<RecordColumn>,
    /// The number of records, of which `rows` may have only some.
    pub total: usize,
    /// The requested records.
    pub rows: Vec<Record>,
}

/// One column of [`Records`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordColumn {
    /// The name of the field in textbooks, such as `twin`.
    pub name: &'static str,
    /// What the field means.
    pub about: &'static str,
    /// The table that stores the field.
    pub table: &'static str,
    /// True if the field is not stored: it follows from the number of the row, or from other fields.
    pub derived: bool,
}

/// One record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Record {
    /// The name of the row, such as `h3`.
    pub name: String,
    /// The fields, as text: `v4`, `none`, `3` or `(1, 0, 0)`. Empty if the element was deleted.
    pub fields: Vec<String>,
}

/// Returns the rows of the records to show, for the letter and the number of the rows of one kind.
pub(crate) type RowsOf<'r> = &'r dyn Fn(&str, usize) -> Vec<usize>;

/// Returns the letter and the number in the name of a row, such as `h5`; `None` for another text.
pub(crate) fn row_name(name: &str) -> Option<(&str, u32)> {
    let (letter, digits) = name.split_at(name.find(|c: char| c.is_ascii_digit())?);
    let row = digits.parse().ok().filter(|_| !letter.is_empty())?;
    Some((letter, row))
}

/// Returns the records of `mesh` in `rows`. O(records in `rows`).
pub(crate) fn records(mesh: &dyn RecordSource, rows: RowsOf<'_>) -> Vec<Records> {
    let tables = mesh.record_tables();
    let mut letters: Vec<&str> = Vec::new();
    for table in &tables {
        if !letters.contains(&table.letter) {
            letters.push(table.letter);
        }
    }
    let of_letter = letters.into_iter().map(|letter| {
        let same = tables.iter().filter(|table| table.letter == letter);
        records_of(mesh, &same.collect::<Vec<_>>(), rows)
    });
    of_letter.collect()
}

/// Returns the records of tables that describe the same elements.
fn records_of(mesh: &dyn RecordSource, tables: &[&RecordTable], rows: RowsOf<'_>) -> Records {
    let column = |table: &RecordTable, column: &Column| RecordColumn {
        name: column.name,
        about: column.about,
        table: table.name,
        derived: column.is_derived,
    };
    let columns = tables.iter().flat_map(|table| {
        let columns = table.columns.iter();
        columns.map(move |one| column(table, one))
    });
    let total = tables.iter().map(|table| table.rows).max().unwrap_or(0);
    let record = |row: usize| {
        let fields: Option<Vec<_>> = tables
            .iter()
            .map(|table| mesh.fields(table.name, row))
            .collect();
        let fields = fields.unwrap_or_default().concat();
        Record {
            name: format!("{}{row}", tables[0].letter),
            fields: fields.iter().map(ToString::to_string).collect(),
        }
    };
    Records {
        element: tables[0].element,
        columns: columns.collect(),
        total,
        rows: rows(tables[0].letter, total)
            .into_iter()
            .map(record)
            .collect(),
    }
}
