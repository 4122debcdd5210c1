//! `sixfold tables`: shows the tables of data structures, row by row.

use std::io;
use std::process::ExitCode;

use serde::Serialize;
use sixfold::{PolygonMesh, shapes};
use sixfold_explain::{Record, RecordColumn, Records, Structure};
use sixfold_study::StudyMesh;
use sixfold_study::numbers::{counted, grouped};

use crate::arguments::Tables;
use crate::column_table::{Column, column_table};
use crate::failure::Failure;
use crate::load;
use crate::output::{Output, check_outputs, is_stdout};
use crate::text::{TextOutput, hanging_indent, width};
use crate::triangulate::triangulated;

/// Maximum number of rows of a table, if the rows are not named.
const MOST_ROWS: usize = 200;

/// The records of one structure.
#[derive(Serialize)]
struct Shown {
    backend: &'static str,
    records: Vec<Records>,
}

/// A structure that cannot hold the mesh.
#[derive(Serialize)]
struct Refused {
    backend: &'static str,
    reason: String,
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
    let (name, polygons) = mesh(arguments)?;
    let (shown, refused) = structures(arguments, &polygons)?;
    print(&name, &shown, &refused, &mut text);
    let mut done = text.finish();
    if let Some(output) = json {
        let document = Document {
            mesh: &name,
            structures: &shown,
            refused: &refused,
        };
        done = done.and(output.write_json(&document));
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

/// Returns the name of the mesh, and the mesh: a cube if no mesh is named.
fn mesh(arguments: &Tables) -> Result<(String, PolygonMesh), Failure> {
    let Some(path) = arguments.mesh.as_deref() else {
        let cube = StudyMesh::new("cube", shapes::cube());
        let cube = match arguments.triangulate {
            true => triangulated(cube)?,
            false => cube,
        };
        return Ok((cube.name, cube.polygons));
    };
    let study_mesh = load::for_study(path, arguments.read, false, arguments.triangulate)?;
    Ok((study_mesh.name, study_mesh.polygons))
}

/// Returns the records of the selected structures, and the structures that cannot hold the mesh. An
/// error if none can hold it, or if a table has too many rows.
fn structures(
    arguments: &Tables,
    polygons: &PolygonMesh,
) -> Result<(Vec<Shown>, Vec<Refused>), Failure> {
    let is_selected =
        |one: &Structure| arguments.all || arguments.backend.iter().any(|name| name == one.name());
    let (mut shown, mut refused) = (Vec::new(), Vec::new());
    let rows = arguments.rows.clone().unwrap_or(0..MOST_ROWS);
    for structure in Structure::all().into_iter().filter(is_selected) {
        let backend = structure.name();
        match structure.records(polygons, rows.clone()) {
            Ok(records) => shown.push(Shown { backend, records }),
            Err(error) => refused.push(Refused {
                backend,
                reason: error.to_string(),
            }),
        }
    }
    if shown.is_empty() {
        let reasons: Vec<&str> = refused.iter().map(|one| one.reason.as_str()).collect();
        return Err(Failure::unsupported(reasons.join("; ")));
    }
    if arguments.rows.is_none() {
        check_rows(&shown)?;
    }
    Ok((shown, refused))
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
            "* not stored: follows from the number of the row, or from other fields; `sixfold tables \
             --backend NAME` says what each field means",
        ),
    });
    for one in refused {
        text.print_line("");
        text.print_line(&hanging_indent("! ", &one.reason));
    }
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

/// Returns the table of records. Columns that are not stored have a `*`.
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
    let mark = if column.derived { "*" } else { "" };
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
        lines.push("* not stored: follows from the number of the row, or from other fields".into());
    }
    lines.join("\n")
}

/// Puts blocks of lines beside one another while they fit, and the rest below.
fn side_by_side(blocks: &[String]) -> String {
    const GAP: usize = 4;
    let widest = |block: &str| {
        block
            .lines()
            .map(|line| line.chars().count())
            .max()
            .unwrap_or(0)
    };
    let mut bands: Vec<Vec<&str>> = Vec::new();
    let mut used = 0;
    for block in blocks {
        let needed = widest(block) + GAP;
        match bands.last_mut() {
            Some(band) if used + needed <= width() + GAP => {
                band.push(block);
                used += needed;
            }
            _ => {
                bands.push(vec![block]);
                used = needed;
            }
        }
    }
    let band = |band: &Vec<&str>| {
        let height = band.iter().map(|block| block.lines().count()).max();
        let line = |i: usize| {
            let cells = band.iter().map(|block| {
                let width = widest(block) + GAP;
                format!("{:<width$}", block.lines().nth(i).unwrap_or_default())
            });
            cells.collect::<String>().trim_end().to_owned()
        };
        (0..height.unwrap_or(0))
            .map(line)
            .collect::<Vec<_>>()
            .join("\n")
    };
    bands.iter().map(band).collect::<Vec<_>>().join("\n\n\n")
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
            text += &format!(
                "| {} | {} |\n",
                records.element,
                heads.join(" | ").replace('*', "\\*")
            );
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
