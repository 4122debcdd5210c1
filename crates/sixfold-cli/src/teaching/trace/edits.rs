//! The rows that an edit reads, writes, makes and deletes.

use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;
use sixfold::Edit;
use sixfold_explain::{EditTrace, Elements, ReadRows, Refused, RowChange};
use sixfold_results::numbers::{counted, grouped};

use super::{Begun, begin, rows};
use crate::arguments;
use crate::column_table::{Column, column_table};
use crate::failure::Failure;
use crate::teaching::{explain, print_refused};
use crate::text::hanging_indent;

#[derive(Serialize)]
struct Document<'d> {
    mesh: &'d str,
    edits: &'d [Vec<EditTrace>],
    refused: &'d [Refused],
}

pub(super) fn run(path: Option<&Path>, arguments: &arguments::Trace) -> Result<ExitCode, Failure> {
    let Begun {
        json,
        mut text,
        name,
        polygons,
        edits,
    } = begin(path, arguments)?;
    // An edit that a structure refuses changes nothing, and the next one runs.
    let (traces, refused) = explain(&arguments.explained, |structure| {
        let mut mesh = structure.build(&polygons)?;
        let traces = edits.iter().map(|edit| mesh.edit(edit));
        traces.collect::<Result<Vec<_>, _>>()
    })?;
    let blocks = traces.iter().flatten().map(|trace| block(&name, trace));
    text.print_line(&blocks.collect::<Vec<_>>().join("\n\n\n"));
    if traces.len() > 1 {
        for i in 0..edits.len() {
            let of_edit: Vec<&EditTrace> = traces.iter().map(|of| &of[i]).collect();
            text.print_line(&format!("\n{}\n{}", edits[i], costs(&of_edit)));
        }
    }
    print_refused(&refused, &mut text);
    let document = Document {
        mesh: &name,
        edits: &traces,
        refused: &refused,
    };
    text.finish_with_document(json, &document)
}

/// Returns one edit on one structure.
fn block(mesh: &str, trace: &EditTrace) -> String {
    let EditTrace {
        structure, edit, ..
    } = trace;
    if let Some(refusal) = &trace.refusal {
        let head = format!("{edit} in {structure}, {mesh}: refused, {}", reads(trace));
        return format!(
            "{}\n\n{}",
            hanging_indent("", &head),
            hanging_indent("! ", refusal)
        );
    }
    let changed: Vec<&RowChange> = trace.rows.iter().filter(|row| row.is_changed()).collect();
    let head = format!(
        "{edit} in {structure}, {mesh}: {}, {}",
        counted(changed.len(), "row changes", "rows change"),
        reads(trace)
    );
    let mut lines = vec![hanging_indent("", &head), euler(trace), String::new()];
    if trace.edit == Edit::Compact.name() {
        lines.push("Whole tables are moved; the counts do not have these moves.\n".into());
    }
    let name = |row: &RowChange| format!("{} {}", row.table, row.row);
    let width = changed
        .iter()
        .map(|row| name(row).chars().count())
        .max()
        .unwrap_or(0);
    for row in &changed {
        lines.push(hanging_indent(
            &format!("  {:<width$}  ", name(row)),
            &change(row),
        ));
    }
    let rewritten = trace.rows.iter().filter(|row| !row.is_changed());
    let rewritten = rewritten.map(|row| ReadRows {
        table: row.table,
        row: row.row.clone(),
        rows: 1,
    });
    let lists = [
        (
            "written as before: ",
            row_names(&rewritten.collect::<Vec<_>>()),
        ),
        ("only read: ", row_names(&trace.only_read)),
        ("new elements: ", trace.created.clone()),
        ("deleted elements: ", trace.removed.clone()),
        (
            "moved to other rows: ",
            trace.renamed.iter().map(renamed).collect(),
        ),
        (
            "elements of these rows: ",
            trace
                .moved
                .iter()
                .map(|[row, name]| format!("{row} = {name}"))
                .collect(),
        ),
    ];
    for (title, items) in lists {
        if !items.is_empty() {
            lines.push(hanging_indent(title, &items.join(", ")));
        }
    }
    lines.join("\n")
}

/// Returns V − E + F before and after the edit.
fn euler(trace: &EditTrace) -> String {
    let sum = |of: Elements| {
        let Elements {
            vertices,
            edges,
            faces,
        } = of;
        format!("{vertices} − {edges} + {faces} = {}", of.euler())
    };
    match trace.before == trace.after {
        true => format!("V − E + F stays {}", sum(trace.before)),
        false => format!(
            "V − E + F was {}, is {}",
            sum(trace.before),
            sum(trace.after)
        ),
    }
}

fn reads(trace: &EditTrace) -> String {
    format!(
        "{}, {}",
        counted(trace.reads, "read", "reads"),
        counted(trace.writes, "write", "writes")
    )
}

fn renamed([name, old, new]: &[String; 3]) -> String {
    format!("{name} from {old} to {new}")
}

/// Lists rows: the first of each table with the name of the table.
fn row_names(read: &[ReadRows]) -> Vec<String> {
    let mut table = "";
    let text = read.iter().map(|read| {
        let title = match read.table == table {
            true => String::new(),
            false => format!("{} ", read.table),
        };
        table = read.table;
        title + &rows(&read.row, read.rows)
    });
    text.collect()
}

/// Returns the fields that change, or all fields of a new or deleted row.
fn change(row: &RowChange) -> String {
    let all = |fields: &Vec<String>| {
        let fields = row.columns.iter().zip(fields);
        let fields = fields.map(|(column, field)| format!("{column} {field}"));
        fields.collect::<Vec<_>>().join(", ")
    };
    match (&row.before, &row.after) {
        (None, Some(after)) => format!("new: {}", all(after)),
        (Some(before), None) => format!("deleted: {}", all(before)),
        (Some(before), Some(after)) => {
            let fields = row.columns.iter().zip(before.iter().zip(after));
            let fields = fields.filter(|(_, (old, new))| old != new);
            let fields = fields.map(|(column, (old, new))| format!("{column} {old} → {new}"));
            fields.collect::<Vec<_>>().join(", ")
        }
        (None, None) => String::new(),
    }
}

/// Returns what an edit costs in each structure.
fn costs(traces: &[&EditTrace]) -> String {
    let names = Column::words("", traces.iter().map(|trace| trace.structure.to_owned()));
    let figures = |head, figure: fn(&EditTrace) -> usize| {
        Column::figures(head, traces.iter().map(|trace| grouped(figure(trace))))
    };
    let changed = |trace: &EditTrace| trace.rows.iter().filter(|row| row.is_changed()).count();
    column_table(
        &names,
        &[
            figures("rows changed", changed),
            figures("reads", |trace| trace.reads),
            figures("writes", |trace| trace.writes),
        ],
    )
}
