//! The memory of a structure, table by table.

use std::borrow::Cow;

/// The number of bytes that one table allocates.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
pub struct TableBytes {
    /// The name of the table.
    pub table: Cow<'static, str>,
    /// The number of rows.
    pub rows: usize,
    /// The bytes allocated for the rows, including spare capacity.
    pub bytes: usize,
    /// The bytes of one row; not part of reports.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub row_bytes: usize,
}

/// The number of bytes that a structure allocates on the heap, table by table, including positions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize))]
pub struct MemoryFootprint {
    /// All tables.
    pub tables: Vec<TableBytes>,
}

impl MemoryFootprint {
    /// Returns the sum over all tables, in bytes.
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
