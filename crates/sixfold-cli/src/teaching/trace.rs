//! `sixfold trace`: steps through a query, and shows what an edit reads and writes.

mod edits;
mod walks;

use std::ffi::OsString;
use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

use console::{Key, Term};
use serde::Serialize;
use sixfold::PolygonMesh;
use sixfold_explain::{
    BuiltMesh, Cost, EditByName, ElementName, ExplainError, Read, Refused, Step, Trace,
};
use sixfold_results::numbers::{counted, grouped};

use crate::arguments::{self, Explained};
use crate::column_table::{Column, column_table};
use crate::failure::Failure;
use crate::output::{Output, check_outputs, is_stdout};
use crate::teaching::{explain, mesh, print_refused, side_by_side};
use crate::text::{TextOutput, hanging_indent};

#[derive(Serialize)]
struct Document<'d> {
    mesh: &'d str,
    traces: &'d [Trace],
    refused: &'d [Refused],
}

pub(crate) fn run(arguments: &arguments::Trace) -> Result<ExitCode, Failure> {
    let (path, query) = match arguments.query.as_slice() {
        [] => (None, None),
        [path] => (Some(Path::new(path)), None),
        [relation, element] => (None, Some([relation, element])),
        [path, relation, element, ..] => (Some(Path::new(path)), Some([relation, element])),
    };
    match (query, arguments.walk.as_deref()) {
        (Some(_), Some(_)) => Err(Failure::usage(
            "--walk takes the place of a relation and an element: name only the mesh, and compare with \
             --expect",
        )),
        (None, Some(walk)) => walks::run(path, walk, arguments),
        (Some(query), None) => queries(path, query, arguments),
        (None, None) if arguments.edit.is_empty() => Err(Failure::usage(
            "name a relation and an element, such as vertex_vertices v3, or an edit, such as --edit \
             \"flip_edge v0-v1\"",
        )),
        (None, None) if arguments.interactive => Err(Failure::usage(
            "--interactive steps through a query: name a relation and an element, such as vertex_vertices v3",
        )),
        (None, None) => edits::run(path, arguments),
    }
}

/// The mesh of a command, and the places where its results go.
struct Begun {
    json: Option<Output>,
    text: TextOutput,
    name: String,
    polygons: PolygonMesh,
    edits: Vec<EditByName>,
}

impl Begun {
    /// Returns the name of the mesh, with the edits that come before what is shown.
    fn name_after_edits(&self) -> String {
        match &self.edits[..] {
            [] => self.name.clone(),
            [edit] => format!("{} after {edit}", self.name),
            edits => format!("{} after {} edits", self.name, edits.len()),
        }
    }

    /// Shows the mesh after the edits in each of the selected structures.
    fn explain<T>(
        &self,
        explained: &Explained,
        explanation: impl Fn(&BuiltMesh) -> Result<T, ExplainError>,
    ) -> Result<(Vec<T>, Vec<Refused>), Failure> {
        explain(explained, |structure| {
            explanation(&structure.build_after(&self.polygons, &self.edits)?)
        })
    }
}

/// Opens the outputs, and reads the edits and the mesh.
fn begin(path: Option<&Path>, arguments: &arguments::Trace) -> Result<Begun, Failure> {
    check_outputs(path, &[("--json", arguments.json.as_ref())])?;
    let edits = arguments.edit.iter().map(|text| text.parse());
    let edits = edits.collect::<Result<_, _>>().map_err(Failure::usage)?;
    let json = Output::open_if(arguments.json.as_ref())?;
    let to_stdout = arguments.json.as_deref().is_some_and(is_stdout);
    let text = TextOutput::new(!to_stdout);
    let (name, polygons) = mesh(path, &arguments.explained)?;
    Ok(Begun {
        json,
        text,
        name,
        polygons,
        edits,
    })
}

/// Traces a query.
fn queries(
    path: Option<&Path>,
    query: [&OsString; 2],
    arguments: &arguments::Trace,
) -> Result<ExitCode, Failure> {
    let [relation, element] = query.map(|word| word.to_string_lossy());
    let relation = arguments::relation(&relation).map_err(Failure::usage)?;
    let element: ElementName = element.parse().map_err(Failure::usage)?;
    let mut begun = begin(path, arguments)?;
    let name = begun.name_after_edits();
    let trace = |mesh: &BuiltMesh| mesh.trace(relation, element);
    let (traces, refused) = begun.explain(&arguments.explained, trace)?;
    if arguments.interactive {
        return step(&name, &traces).map(|()| ExitCode::SUCCESS);
    }
    let blocks: Vec<String> = traces.iter().map(|trace| block(&name, trace)).collect();
    begun.text.print_line(&side_by_side(&blocks));
    if traces.len() > 1 {
        begun.text.print_line(&format!("\n{}", costs(&traces)));
    }
    print_refused(&refused, &mut begun.text);
    let document = Document {
        mesh: &name,
        traces: &traces,
        refused: &refused,
    };
    begun.text.finish_with_document(begun.json, &document)
}

/// Returns the trace of one structure.
fn block(mesh: &str, trace: &Trace) -> String {
    let parts = [
        hanging_indent("", &headline(mesh, trace)),
        algorithm(&trace.algorithm, None),
        steps(&trace.steps, &trace.moved),
    ];
    parts
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("\n\n")
}

/// Returns what the query yields, and what this costs.
fn headline(mesh: &str, trace: &Trace) -> String {
    format!(
        "{} of {} in {}, {mesh}: {}",
        trace.relation,
        trace.element,
        trace.structure,
        cost(&trace.results, trace.cost)
    )
}

/// Returns the number of results, and what they cost.
fn cost(results: &[String], cost: Cost) -> String {
    let results = counted(results.len(), "result", "results");
    match cost.reads {
        0 => format!("{results}, no reads"),
        _ => format!(
            "{results}, {} of rows, {}, {}",
            counted(cost.reads, "read", "reads"),
            counted(cost.cache_lines, "cache line", "cache lines"),
            counted(cost.bytes, "byte", "bytes"),
        ),
    }
}

/// Returns the lines of the algorithm, with a mark at the current line.
fn algorithm(lines: &[impl Display], current: Option<usize>) -> String {
    let lines = lines.iter().enumerate().map(|(i, line)| {
        let mark = if current == Some(i) { '>' } else { ' ' };
        format!("{mark} {}  {line}", i + 1)
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Maximum number of steps that are printed.
const MOST_STEPS: usize = 200;

/// Returns the steps as a table. Its last column is broken into lines. A row that an edit moved has also the
/// name of its element, as in f9 = f8.
fn steps(steps: &[Step], moved: &[[String; 2]]) -> String {
    const HEADS: [&str; 4] = ["line", "reads", "because", "finds"];
    let shown = &steps[..steps.len().min(MOST_STEPS)];
    let cells: Vec<[String; 4]> = shown.iter().map(|step| cells(step, moved)).collect();
    let width = |i: usize| {
        let widths = cells.iter().map(|cells| cells[i].chars().count());
        widths.max().unwrap_or(0).max(HEADS[i].len())
    };
    let widths = [0, 1, 2].map(width);
    let start = |cells: [&str; 3]| {
        let [line, reads, because] = cells;
        let [a, b, c] = widths;
        format!("{line:>a$}  {reads:<b$}  {because:<c$}  ")
    };
    let mut lines = vec![start([HEADS[0], HEADS[1], HEADS[2]]) + HEADS[3]];
    lines.push("─".repeat(lines[0].chars().count()));
    for [line, reads, because, finds] in &cells {
        let line = hanging_indent(&start([line, reads, because]), finds);
        lines.push(line.trim_end().to_owned());
    }
    if steps.len() > shown.len() {
        let more = counted(steps.len() - shown.len(), "more step", "more steps");
        lines.push(format!("… {more}: --json FILE has all"));
    }
    lines.join("\n")
}

/// Returns the line, what is read, why, and what is found.
fn cells(step: &Step, moved: &[[String; 2]]) -> [String; 4] {
    let number =
        |line: &Option<usize>| line.map_or_else(String::new, |line| (line + 1).to_string());
    match step {
        Step::Read(read) => [
            number(&read.line),
            with_names(
                &format!("{} {}", read.table, rows(&read.row, read.rows)),
                moved,
            ),
            with_names(&read.reason.text, moved),
            with_names(&fields(read), moved),
        ],
        Step::Yield { result, line } => [
            number(line),
            format!("yield {result}"),
            String::new(),
            String::new(),
        ],
    }
}

/// Returns a text in which the name of the element follows each row that an edit moved.
fn with_names(text: &str, moved: &[[String; 2]]) -> String {
    let words = text.split_inclusive(|c: char| !c.is_alphanumeric());
    let named = words.map(|word| {
        let row = word.trim_end_matches(|c: char| !c.is_alphanumeric());
        match moved.iter().find(|[at, _]| at == row) {
            Some([_, name]) => format!("{row} = {name}{}", &word[row.len()..]),
            None => word.to_owned(),
        }
    });
    named.collect()
}

/// Returns the letter and the number of a row.
fn parts(row: &str) -> (&str, usize) {
    let letter = row.trim_end_matches(|c: char| c.is_ascii_digit());
    (letter, row[letter.len()..].parse().unwrap_or(0))
}

/// Returns the names of `rows` rows from `first` on, such as `c1 to c5`.
fn rows(first: &str, rows: usize) -> String {
    let (letter, number) = parts(first);
    match rows {
        1 => first.to_owned(),
        _ => format!("{first} to {letter}{}", number + rows - 1),
    }
}

fn fields(read: &Read) -> String {
    if read.rows > 1 {
        return counted(read.rows, "row", "rows");
    }
    let fields = read
        .fields
        .iter()
        .map(|(name, value)| format!("{name} {value}"));
    fields.collect::<Vec<_>>().join(", ")
}

/// Returns what the query costs in each structure.
fn costs(traces: &[Trace]) -> String {
    let names = Column::words("", traces.iter().map(|trace| trace.structure.to_owned()));
    let figures = |head, figure: fn(&Trace) -> usize| {
        Column::figures(head, traces.iter().map(|trace| grouped(figure(trace))))
    };
    column_table(
        &names,
        &[
            figures("reads", |trace| trace.cost.reads),
            figures("cache lines", |trace| trace.cost.cache_lines),
            figures("bytes", |trace| trace.cost.bytes),
        ],
    )
}

/// Steps through the traces by keys, one trace after the other.
fn step(mesh: &str, traces: &[Trace]) -> Result<(), Failure> {
    let terminal = Term::stdout();
    if !terminal.is_term() {
        return Err(Failure::usage("--interactive needs a terminal"));
    }
    let failed = |cause| crate::output::cannot_write("the terminal", &cause);
    for trace in traces {
        let mut count: usize = 0;
        loop {
            let current = count
                .checked_sub(1)
                .and_then(|last| match &trace.steps[last] {
                    Step::Read(read) => read.line,
                    Step::Yield { line, .. } => *line,
                });
            terminal.clear_screen().map_err(failed)?;
            let parts = [
                headline(mesh, trace),
                algorithm(&trace.algorithm, current),
                steps(&trace.steps[..count], &trace.moved),
                format!(
                    "step {count} of {}: space next, b back, n next structure, q quit",
                    trace.steps.len()
                ),
            ];
            terminal.write_line(&parts.join("\n\n")).map_err(failed)?;
            match terminal.read_key().map_err(failed)? {
                Key::Char('q') | Key::Escape | Key::CtrlC => return Ok(()),
                Key::Char('b') | Key::ArrowLeft | Key::ArrowUp | Key::Backspace => {
                    count = count.saturating_sub(1);
                }
                Key::Char('n') => break,
                Key::Char(_) | Key::Enter | Key::ArrowRight | Key::ArrowDown => {
                    if count == trace.steps.len() {
                        break;
                    }
                    count += 1;
                }
                _ => {}
            }
        }
    }
    Ok(())
}
