//! The memory of a structure: the bytes of each table, and the formula that they follow.

use std::collections::BTreeMap;

use serde::Serialize;
use sixfold_core::{MemoryFootprint, RecordTable};

/// The memory of one structure, without edits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Memory {
    /// The name of the structure.
    #[serde(rename = "backend")]
    pub structure: &'static str,
    /// The sum over all tables, in bytes.
    pub bytes: usize,
    /// The sum with symbols for the numbers of rows, such as `16 V + 12 H + 4 F`: the upper-case letters of the rows.
    pub formula: String,
    /// What the symbols of the formula stand for.
    pub symbols: Vec<Symbol>,
    /// The tables, in the order of the structure.
    pub tables: Vec<TableMemory>,
}

/// A symbol in a formula.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Symbol {
    /// The symbol, such as `H`.
    pub symbol: String,
    /// The elements that it counts, such as `half-edge`.
    pub element: &'static str,
    /// Their number in this mesh.
    pub count: usize,
}

/// The memory of one table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TableMemory {
    /// The name of the table, such as `halves`.
    pub table: String,
    /// What a row describes; `None` if the structure does not describe the table.
    pub element: Option<&'static str>,
    /// The bytes of one row.
    pub row_bytes: usize,
    /// The number of rows.
    pub rows: usize,
    /// The number of rows with symbols, such as `F + 1` for a table with one row more than faces.
    pub rows_formula: String,
    /// The bytes of all rows.
    pub bytes: usize,
}

impl Memory {
    /// Returns the memory of a structure, given the bytes of its tables and their descriptions.
    pub(crate) fn new(
        structure: &'static str,
        footprint: &MemoryFootprint,
        described: &[RecordTable],
    ) -> Self {
        let mut symbols: Vec<Symbol> = Vec::new();
        // The bytes for each row of a symbol, and the bytes without a symbol.
        let (mut factors, mut constant) = (BTreeMap::new(), 0);
        let mut tables = Vec::new();
        for table in &footprint.tables {
            let record = described.iter().find(|record| record.name == table.table);
            let mut rows_formula = table.rows.to_string();
            // A table of offsets has a row more than elements.
            let further = record.and_then(|record| table.rows.checked_sub(record.rows));
            let exact = table.bytes == table.row_bytes * table.rows;
            if let (Some(record), Some(further), true) = (record, further, exact) {
                let symbol = record.letter.to_uppercase();
                let place = symbols.iter().position(|known| known.symbol == symbol);
                let place = place.unwrap_or_else(|| {
                    symbols.push(Symbol {
                        symbol: symbol.clone(),
                        element: record.element,
                        count: record.rows,
                    });
                    symbols.len() - 1
                });
                *factors.entry(place).or_insert(0) += table.row_bytes;
                constant += further * table.row_bytes;
                rows_formula = match further {
                    0 => symbol,
                    _ => format!("{symbol} + {further}"),
                };
            } else {
                constant += table.bytes;
            }
            tables.push(TableMemory {
                table: table.table.to_string(),
                element: record.map(|record| record.element),
                row_bytes: table.row_bytes,
                rows: table.rows,
                rows_formula,
                bytes: table.bytes,
            });
        }
        let terms = factors.iter();
        let terms = terms.map(|(&place, factor)| format!("{factor} {}", symbols[place].symbol));
        let constant = Some(constant).filter(|&bytes| bytes > 0);
        let terms: Vec<String> = terms
            .chain(constant.map(|bytes| bytes.to_string()))
            .collect();
        Self {
            structure,
            bytes: footprint.total(),
            formula: terms.join(" + "),
            symbols,
            tables,
        }
    }
}
