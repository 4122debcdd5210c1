//! The table of the results of many meshes.

use comfy_table::{Attribute, Cell, CellAlignment};
use sixfold_study::{Collection, Pooled};

use crate::tables::styled;

/// Returns the table of mean ratios, with a row per operation and a column per backend. A mean
/// ratio is the geometric mean of the ratios to the best backend of each mesh.
pub(super) fn pooled_table(collection: &Collection, bold: bool) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let mut columns: Vec<&str> = Vec::new();
    for row in &collection.pooled {
        if !columns.contains(&row.backend.as_str()) {
            columns.push(&row.backend);
        }
    }
    let mut header = vec![Cell::new("× the best\non average")];
    header.extend(columns.iter().map(|name| right(name.replace('-', "\n"))));
    let mut table = styled(header, bold);
    for rows in collection
        .pooled
        .chunk_by(|a, b| a.operation == b.operation)
    {
        let mut line = vec![Cell::new(rows[0].operation.name())];
        let most = rows.iter().map(|row| row.meshes).max().unwrap_or(0);
        for column in &columns {
            let row = rows.iter().find(|row| row.backend == *column);
            line.push(row.map_or_else(|| right("–".into()), |row| cell(row, most, bold)));
        }
        table.add_row(line);
    }
    format!("{}\n{LEGEND}", table.trim_fmt())
}

const LEGEND: &str = "* fastest or tied with the fastest on most meshes\n\
    (n) on n meshes only: the backend cannot hold the other meshes, or did different work there";

/// Formats a cell such as `1.04*` or `18.2 (3)`.
fn cell(row: &Pooled, most: usize, bold: bool) -> Cell {
    let ratio = match row.ratio_to_best {
        ratio if ratio < 9.995 => format!("{ratio:.2}"),
        ratio if ratio < 99.95 => format!("{ratio:.1}"),
        ratio => format!("{ratio:.0}"),
    };
    let ahead = 2 * (row.best + row.tied) > row.meshes;
    let mark = if ahead { "*" } else { " " };
    let fewer = match row.meshes < most {
        true => format!(" ({})", row.meshes),
        false => String::new(),
    };
    let cell = Cell::new(format!("{ratio}{mark}{fewer}")).set_alignment(CellAlignment::Right);
    match bold && ahead {
        true => cell.add_attribute(Attribute::Bold),
        false => cell,
    }
}
