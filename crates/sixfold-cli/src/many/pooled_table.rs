//! The table of the results of many meshes.

use comfy_table::{Attribute, Cell, CellAlignment};
use sixfold_results::numbers::{counted, figure, rounded_down};
use sixfold_results::{Pool, Pooled, Purpose, leaders};

use crate::tables::{stacked, unbroken};
use crate::text::hanging_indent;

/// Returns the table of mean ratios, with a row per operation and a column per backend. A mean
/// ratio is the geometric mean of the ratios to the best backend of each mesh.
pub(super) fn pooled_table(pool: &Pool, bold: bool) -> String {
    let mut columns: Vec<&str> = Vec::new();
    for row in pool.all() {
        if !columns.contains(&row.backend.as_str()) {
            columns.push(&row.backend);
        }
    }
    let meshes = pool.groups.first().map_or(0, |all| all.meshes.len());
    let table = |columns: &[&str]| {
        let mut table = unbroken(header("× the best\non average", columns), bold);
        for rows in pool.all().chunk_by(|a, b| a.operation == b.operation) {
            let name = &rows[0].operation;
            let fewer = rows[0].meshes < meshes;
            let mut line = vec![Cell::new(match fewer {
                true => format!("{name} ({})", rows[0].meshes),
                false => name.clone(),
            })];
            for column in columns {
                let row = rows.iter().find(|row| row.backend == *column);
                line.push(row.map_or_else(|| right("–".into()), |row| cell(row, bold)));
            }
            table.add_row(line);
        }
        table.trim_fmt()
    };
    let legend = LEGEND.map(|line| hanging_indent("", line)).join("\n");
    format!("{}\n{legend}", stacked(&columns, table))
}

/// Returns the table of groups of meshes, with a row per group and kind of work, and a column per
/// backend. Returns `None` if there are no groups besides the pooled meshes together.
pub(super) fn groups_table(pool: &Pool, bold: bool) -> Option<String> {
    if pool.groups.len() < 2 {
        return None;
    }
    let columns: Vec<&str> = pool.compared.iter().map(String::as_str).collect();
    let table = |columns: &[&str]| {
        let mut table = unbroken(header("× the fastest mean,\nby group", columns), bold);
        for (i, group) in pool.groups.iter().enumerate() {
            let meshes = counted(group.meshes.len(), "mesh", "meshes");
            // The name of the first group is too long for the first column.
            let name = if i == 0 {
                "all pooled meshes"
            } else {
                &group.name
            };
            let mut title = vec![Cell::new(format!("{name} ({meshes})"))];
            title.extend(columns.iter().map(|_| Cell::new("")));
            table.add_row(title);
            for purpose in Purpose::ALL {
                // Sorted from the fastest to the slowest.
                let rows = purpose.rows(&group.overall);
                let best = leaders(rows);
                if rows.is_empty() {
                    continue;
                }
                let mut line = vec![Cell::new(format!("  {}", purpose.title().to_lowercase()))];
                line.extend(columns.iter().map(|column| {
                    let row = rows.iter().find(|row| row.backend == **column);
                    let Some(row) = row else {
                        return right("–".into());
                    };
                    let is_leader = best.iter().any(|best| best.backend == row.backend);
                    let mark = match (is_leader, &best[..]) {
                        (false, _) => "",
                        (true, [_]) => "*",
                        (true, _) => "=",
                    };
                    let ratio = row.ratio_to_best / rows[0].ratio_to_best;
                    let ratio = match row.bound {
                        true => format!("≥{}", figure(rounded_down(ratio))),
                        false => figure(ratio),
                    };
                    let cell = right(format!("{mark}{ratio}"));
                    match bold && mark == "*" {
                        true => cell.add_attribute(Attribute::Bold),
                        false => cell,
                    }
                }));
                table.add_row(line);
            }
        }
        table.trim_fmt()
    };
    let legend = hanging_indent("", GROUPS_LEGEND);
    Some(format!("{}\n{legend}", stacked(&columns, table)))
}

const GROUPS_LEGEND: &str = "* clearly fastest; = one of several between which there is no clear difference; ≥ lower bound, not ranked. In the mean over all pooled meshes, each power of ten of \
    the number of faces has equal weight.";

fn right(text: String) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
}

/// Returns the header of a table with a column per backend.
fn header(title: &str, columns: &[&str]) -> Vec<Cell> {
    let names = columns.iter().map(|name| right(name.replace('-', "\n")));
    std::iter::once(Cell::new(title)).chain(names).collect()
}

const LEGEND: [&str; 4] = [
    "* clearly fastest on most meshes",
    "≥ lower bound, not ranked: on some meshes, a run would exceed the budget",
    "(n) mean over n meshes only: on the other meshes, a backend has no time",
    "– no time on these meshes",
];

/// Formats a cell such as `*1.04` or `≥18.2`.
fn cell(row: &Pooled, bold: bool) -> Cell {
    let ratio = match row.estimated {
        0 => figure(row.ratio_to_best),
        _ => format!("≥{}", figure(rounded_down(row.ratio_to_best))),
    };
    let ahead = 2 * row.best > row.meshes;
    let mark = if ahead { "*" } else { "" };
    let cell = Cell::new(format!("{mark}{ratio}")).set_alignment(CellAlignment::Right);
    match bold && ahead {
        true => cell.add_attribute(Attribute::Bold),
        false => cell,
    }
}
