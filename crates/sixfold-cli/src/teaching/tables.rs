//! `sixfold tables`: shows the tables of data structures, row by row.

use std::io;
use std::process::ExitCode;

use serde::Serialize;
use sixfold_explain::{Record, RecordColumn, Records, Refused};
use sixfold_results::numbers::{counted, grouped};

use crate::arguments::Tables;
use crate::column_table::{Column, column_table};
use crate::failure::Failure;
use crate::output::{Output, check_outputs, is_stdout};
use crate::teaching::{explain, mesh, print_refused, side_by_side};
use crate::text::{TextOutput, WithNotices, hanging_indent};

/// Maximum number of rows of a table, if the rows are not named.
const MOST_ROWS: usize = 200;

/// The records of one structure.
#[derive(Serialize)]
struct Shown {
    backend: &'static str,
    records: Vec<Records>,
}

#[derive(Serialize)]
struct Document<'d> {
    mesh: &'d str,
    structures: &'d [Shown],
    refused: &'d [Refused],
}

pub(crate) fn run(arguments: &Tables) -> Result<ExitCode, Failure> {
    let outputs = [
        ("--json", arguments.json.as_ref()),
        ("--csv", arguments.csv.as_ref()),
        ("--markdown", arguments.markdown.as_ref()),
    ];
    check_outputs(arguments.mesh.as_deref(), &outputs)?;
    let [json, csv, markdown] = outputs.map(|(_, path)| Output::open_if(path));
    let (json, csv, markdown) = (json?, csv?, markdown?);
    let to_stdout = outputs
        .iter()
        .any(|(_, path)| path.is_some_and(|p| is_stdout(p)));
    let mut text = TextOutput::new(!to_stdout);
    let (name, polygons) = mesh(arguments.mesh.as_deref(), &arguments.explained)?;
    let rows = arguments.rows.clone().unwrap_or(0..MOST_ROWS);
    let (shown, refused) = explain(&arguments.explained, |structure| {
        let backend = structure.name();
        let records = structure.build(&polygons)?.records(rows.clone());
        Ok(Shown { backend, records })
    })?;
    if arguments.rows.is_none() {
        check_rows(&shown)?;
    }
    print(&name, &shown, &refused, &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        let document = Document {
            mesh: &name,
            structures: &shown,
            refused: &refused,
        };
        done = done.and(output.write_json(&WithNotices::new(&document)));
    }
    if let Some(output) = csv {
        done = done.and(output.finish(|writer| write_csv(&shown, writer)));
    }
    if let Some(output) = markdown {
        let text = markdown_text(&shown);
        done = done.and(output.finish(|writer| writer.write_all(text.as_bytes())));
    }
    done.map(|()| ExitCode::SUCCESS)
}

/// Returns an error if a table is not shown completely.
fn check_rows(shown: &[Shown]) -> Result<(), Failure> {
    let all = shown
        .iter()
        .flat_map(|one| one.records.iter().map(move |records| (one, records)));
    let longest = all.max_by_key(|(_, records)| records.total);
    match longest {
        Some((one, records)) if records.total > MOST_ROWS => Err(Failure::usage(format!(
            "{} has {}, and a table shows at most {MOST_ROWS} rows: name the rows, such as \
             --rows 0..20",
            one.backend,
            counted(records.total, records.element, &plural(records.element)),
        ))),
        _ => Ok(()),
    }
}

fn plural(element: &str) -> String {
    match element.strip_suffix("ex") {
        Some(stem) => format!("{stem}ices"),
        None => format!("{element}s"),
    }
}

fn print(name: &str, shown: &[Shown], refused: &[Refused], text: &mut TextOutput) {
    let blocks: Vec<String> = shown.iter().map(|one| block(name, one)).collect();
    text.print_line(&side_by_side(&blocks));
    text.print_line("");
    text.print_line(&match shown {
        [one] => legend(one),
        _ => hanging_indent(
            "",
            "† not stored: follows from the number of the row, or from other fields; `sixfold tables \
             --backend NAME` says what each field means",
        ),
    });
    print_refused(refused, text);
}

/// Returns the tables of one structure.
fn block(mesh: &str, shown: &Shown) -> String {
    let mut parts = vec![format!("{} of {mesh}", shown.backend)];
    for records in &shown.records {
        let total = counted(records.total, records.element, &plural(records.element));
        let rows = match (records.rows.first(), records.rows.last()) {
            _ if records.rows.len() == records.total => String::new(),
            (Some(first), Some(last)) => format!(", of which {} to {}", first.name, last.name),
            _ => ", none of them in these rows".into(),
        };
        parts.push(format!("{total}{rows}\n{}", table(records)));
    }
    parts.join("\n\n")
}

/// Returns the table of records. Columns that are not stored have a `†`.
fn table(records: &Records) -> String {
    let names = Column::words("", records.rows.iter().map(|row| row.name.clone()));
    let column = |(i, column): (usize, &RecordColumn)| {
        let cells = records.rows.iter().map(|row| field(row, i));
        Column::words(&heading(column), cells)
    };
    let columns: Vec<Column> = records.columns.iter().enumerate().map(column).collect();
    column_table(&names, &columns)
}

fn heading(column: &RecordColumn) -> String {
    let mark = if column.derived { "†" } else { "" };
    format!("{}{mark}", column.name)
}

/// Returns a field of a record, and `deleted` for a deleted element.
fn field(record: &Record, i: usize) -> String {
    record
        .fields
        .get(i)
        .cloned()
        .unwrap_or_else(|| "deleted".into())
}

/// Returns what each column means.
fn legend(shown: &Shown) -> String {
    let columns = shown.records.iter().flat_map(|records| {
        let columns = records.columns.iter();
        columns.map(move |column| (records.element, column))
    });
    let columns: Vec<_> = columns
        .filter(|(_, column)| column.name != "position")
        .collect();
    let mut lines: Vec<String> = Vec::new();
    for (element, column) in &columns {
        let first = format!("{element} {}: ", heading(column));
        lines.push(hanging_indent(&first, column.about));
    }
    if columns.iter().any(|(_, column)| column.derived) {
        lines.push("† not stored: follows from the number of the row, or from other fields".into());
    }
    lines.join("\n")
}

/// Writes one line for each field.
fn write_csv(shown: &[Shown], writer: impl io::Write) -> io::Result<()> {
    let mut lines = csv::Writer::from_writer(writer);
    let written = |lines: &mut csv::Writer<_>| -> csv::Result<()> {
        lines.write_record([
            "backend", "element", "row", "field", "derived", "table", "value",
        ])?;
        for one in shown {
            for records in &one.records {
                for row in &records.rows {
                    for (i, column) in records.columns.iter().enumerate() {
                        let derived = column.derived.to_string();
                        lines.write_record([
                            one.backend,
                            records.element,
                            &row.name,
                            column.name,
                            &derived,
                            column.table,
                            &field(row, i),
                        ])?;
                    }
                }
            }
        }
        Ok(())
    };
    written(&mut lines).map_err(io::Error::other)?;
    lines.flush()
}

/// Returns the tables as Markdown, with a heading for each structure.
fn markdown_text(shown: &[Shown]) -> String {
    let mut text = String::new();
    for one in shown {
        text += &format!("## {}\n\n", one.backend);
        for records in &one.records {
            let heads: Vec<String> = records.columns.iter().map(heading).collect();
            text += &format!("| {} | {} |\n", records.element, heads.join(" | "));
            text += &format!("|---|{}\n", "---|".repeat(heads.len()));
            for row in &records.rows {
                let fields: Vec<String> = (0..heads.len()).map(|i| field(row, i)).collect();
                text += &format!("| {} | {} |\n", row.name, fields.join(" | "));
            }
            text += &format!("\n{}\n\n", counted_rows(records));
        }
    }
    text
}

/// Says how many of the rows a table shows.
fn counted_rows(records: &Records) -> String {
    let elements = plural(records.element);
    match records.rows.len() == records.total {
        true => format!("{} {elements}.", grouped(records.total)),
        false => format!(
            "{} of {} {elements}.",
            grouped(records.rows.len()),
            grouped(records.total)
        ),
    }
}
