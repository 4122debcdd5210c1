//! The table of the results of many meshes.

use comfy_table::{Attribute, Cell, CellAlignment};
use sixfold_study::{Pool, Pooled};

use crate::tables::styled;

/// Returns the table of mean ratios, with a row per operation and a column per backend. A mean
/// ratio is the geometric mean of the ratios to the best backend of each mesh.
pub(super) fn pooled_table(pool: &Pool, bold: bool) -> String {
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    let mut columns: Vec<&str> = Vec::new();
    for row in pool.all() {
        if !columns.contains(&row.backend.as_str()) {
            columns.push(&row.backend);
        }
    }
    let mut header = vec![Cell::new("× the best\non average")];
    header.extend(columns.iter().map(|name| right(name.replace('-', "\n"))));
    let mut table = styled(header, bold);
    let meshes = pool.groups.first().map_or(0, |all| all.meshes.len());
    for rows in pool.all().chunk_by(|a, b| a.operation == b.operation) {
        let name = rows[0].operation.name();
        let fewer = rows[0].meshes < meshes;
        let mut line = vec![Cell::new(match fewer {
            true => format!("{name} ({})", rows[0].meshes),
            false => name.to_owned(),
        })];
        for column in &columns {
            let row = rows.iter().find(|row| row.backend == *column);
            line.push(row.map_or_else(|| right("–".into()), |row| cell(row, bold)));
        }
        table.add_row(line);
    }
    format!("{}\n{LEGEND}", table.trim_fmt())
}

const LEGEND: &str = "* fastest or tied with the fastest on most meshes\n\
    ? estimated on some meshes, because a run would exceed the budget\n\
    (n) mean over n meshes only: on the other meshes, a backend has no time\n\
    – no time on these meshes";

/// Formats a cell such as `1.04*` or `?18.2`.
fn cell(row: &Pooled, bold: bool) -> Cell {
    let ratio = match row.ratio_to_best {
        ratio if ratio < 9.995 => format!("{ratio:.2}"),
        ratio if ratio < 99.95 => format!("{ratio:.1}"),
        ratio => format!("{ratio:.0}"),
    };
    let ahead = 2 * (row.best + row.tied) > row.meshes;
    let mark = if ahead { "*" } else { " " };
    let estimated = if row.estimated > 0 { "?" } else { "" };
    let cell = Cell::new(format!("{estimated}{ratio}{mark}")).set_alignment(CellAlignment::Right);
    match bold && ahead {
        true => cell.add_attribute(Attribute::Bold),
        false => cell,
    }
}
