//! What a structure weighs, table by table.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// The bytes that one table holds.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct TableBytes {
    /// The name of the table.
    pub table: Cow<'static, str>,
    /// How many rows it has.
    pub rows: usize,
    /// Bytes allocated for them, capacity included.
    pub bytes: usize,
    /// Bytes of one row; no table of a report needs them.
    #[serde(skip)]
    pub row_bytes: usize,
}

/// The bytes that a structure really holds on the heap, table by table, positions included.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub struct MemoryFootprint {
    /// Each table.
    pub tables: Vec<TableBytes>,
}

impl MemoryFootprint {
    /// The sum over all tables, in bytes.
    pub fn total(&self) -> usize {
        self.tables.iter().map(|table| table.bytes).sum()
    }
}

impl FromIterator<TableBytes> for MemoryFootprint {
    fn from_iter<I: IntoIterator<Item = TableBytes>>(tables: I) -> Self {
        Self {
            tables: tables.into_iter().collect(),
        }
    }
}
