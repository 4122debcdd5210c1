//! `sixfold memory`: the memory of each backend, by its formula, its tables and the allocator.

use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment, Table};
use sixfold_study::{
    Audit, Audited, Backend, BackendReport, MOST_SCANNED_FACES, OperationBytes, Settings, audit,
    count_allocations,
};

use crate::arguments::Memory;
use crate::facts_text::{facts_text, verdicts_text};
use crate::failure::Failure;
use crate::heap::Counters;
use crate::load;
use crate::output::{Output, check_places, is_stdout};
use crate::progress::{Stage, end_on_interrupt};
use crate::tables::table;
use crate::text::{Text, complain, hanging};
use sixfold_study::numbers::{counted, grouped};

/// The exit code if two of the three counts differ.
const DIFFERENT: u8 = 1;

/// Counts the memory of the selected backends and shows it.
pub(crate) fn run(arguments: &Memory) -> Result<ExitCode, Failure> {
    end_on_interrupt();
    check_places(
        arguments.mesh.as_deref(),
        &[("--json", arguments.json.as_ref())],
    )?;
    let json = Output::open_if(arguments.json.as_ref())?;
    let specimen = match &arguments.mesh {
        Some(path) => load::for_study(path, false, arguments.triangulate)?,
        None => load::built_in(),
    };
    let settings = Settings {
        backends: arguments.backends.clone(),
        ..Settings::default()
    };
    let backends = settings.chosen_backends().map_err(Failure::usage)?;
    let stage = Stage::new();
    let mut audit = audit(&specimen, &backends, &Counters, &mut |backend| {
        stage.show(format!("building {} and counting", backend.name()));
    });
    let mut counting = |backend: &Backend, operation| {
        stage.show(format!(
            "running {operation} on {} and counting",
            backend.name()
        ));
    };
    count_allocations(&mut audit, &specimen, &backends, &Counters, &mut counting);
    stage.clear();

    let write = |json: Option<Output>| match json {
        Some(output) => output.finish(|writer| audit.write_json(writer)),
        None => Ok(()),
    };
    // This is also a result: the selected backends, and why each refuses the mesh.
    if let Some(none) = audit.none_holds() {
        write(json)?;
        return Err(Failure::unsupported(none));
    }
    let mut text = Text::shown(!arguments.json.as_deref().is_some_and(is_stdout));
    print(&audit, &mut text);
    // Text is printed first, so that it is not lost if a file fails.
    let done = text.finish().and(write(json));
    let code = judged(&audit.faults());
    done.map(|()| code)
}

/// Reports the `faults`, and returns the exit code for them.
fn judged(faults: &[String]) -> ExitCode {
    for fault in faults {
        complain(&format!(
            "error: {fault}: a fault in Sixfold, please report it"
        ));
    }
    match faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(DIFFERENT),
    }
}

fn print(audit: &Audit, text: &mut Text) {
    let reports: Vec<BackendReport> = audit.backends.iter().map(|b| b.backend.clone()).collect();
    text.say(&facts_text(&audit.mesh));
    text.say("");
    text.say(&verdicts_text(&audit.mesh, &reports));
    text.say("");
    text.say(&bytes_table(audit));
    text.say("");
    text.say(&words_table(audit));
    text.say("");
    if let Some(table) = operations_table(audit) {
        text.say(&table);
        text.say("");
    }
    for words in words(audit) {
        text.say(&hanging("- ", &words));
    }
}

/// Returns the three counts for each backend that holds the mesh, with its tables below it.
fn bytes_table(audit: &Audit) -> String {
    let header = [
        "bytes",
        "rows",
        "formula",
        "tables",
        "counted",
        "peak",
        "/ counted",
    ];
    let mut table = headed(&header);
    for one in &audit.backends {
        let backend = &one.backend;
        let bytes = |bytes: Option<usize>| bytes.map_or(String::new(), grouped);
        // A figure that differs from the one before it is marked `!`.
        let beside = |figure: Option<usize>, before: Option<usize>| {
            let sign = if figure == before { " " } else { "!" };
            format!("{}{sign}", bytes(figure))
        };
        if !backend.holds {
            continue;
        }
        let ratio = one.peak_to_counted;
        row(
            &mut table,
            [
                backend.name.clone(),
                String::new(),
                format!("{} ", bytes(backend.layout_bytes)),
                beside(backend.bytes, backend.layout_bytes),
                beside(one.counted_bytes, backend.bytes),
                bytes(one.peak_bytes),
                ratio.map_or("–".into(), |ratio| format!("{ratio:.2}")),
            ],
        );
        for part in &backend.tables {
            let name = format!("  {}", part.table);
            let held = format!("{} ", grouped(part.bytes));
            let blank = String::new;
            let cells = [
                name,
                grouped(part.rows),
                blank(),
                held,
                blank(),
                blank(),
                blank(),
            ];
            row(&mut table, cells);
        }
    }
    table.trim_fmt()
}

/// Returns bytes and words per vertex, and the words per vertex of a large closed triangle mesh.
fn words_table(audit: &Audit) -> String {
    let header = [
        "per vertex",
        "bytes",
        "words",
        "words in a closed triangle mesh",
    ];
    let mut table = headed(&header);
    for one in audit.backends.iter().filter(|one| one.backend.holds) {
        let figure = |figure: Option<f64>| figure.map_or("–".into(), |n| format!("{n:.1}"));
        let cells = [
            one.backend.name.clone(),
            figure(one.counted_bytes_per_vertex),
            figure(one.layout_words_per_vertex),
            figure(Some(one.closed_triangles_words_per_vertex)),
        ];
        row(&mut table, cells);
    }
    table.trim_fmt()
}

/// Returns the table of bytes that operations allocate per byte of their result: a row for each
/// operation that some structure can run, a column per structure. `None` if nothing was counted.
fn operations_table(audit: &Audit) -> Option<String> {
    let counted = |one: &&Audited| !one.operations.is_empty();
    let columns: Vec<&Audited> = audit.backends.iter().filter(counted).collect();
    let names = columns
        .iter()
        .map(|one| one.backend.name.replace('-', "\n"));
    let header = std::iter::once("allocated bytes\n/ result bytes".to_owned()).chain(names);
    let aligned = |(i, text): (usize, String)| Cell::new(text).set_alignment(side(i));
    let mut table = table(header.enumerate().map(aligned).collect());
    for (i, first) in columns.first()?.operations.iter().enumerate() {
        let cells: Vec<&OperationBytes> = columns.iter().map(|one| &one.operations[i]).collect();
        if cells.iter().all(|cell| cell.reason.is_some()) {
            continue;
        }
        let figure = |cell: &OperationBytes| match (cell.allocated_to_result, cell.scans) {
            (Some(ratio), _) => format!("{ratio:.2}"),
            (None, true) => "scans".to_owned(),
            (None, false) => "–".to_owned(),
        };
        let cells = cells.into_iter().map(figure);
        let cells = std::iter::once(first.operation.to_string()).chain(cells);
        table.add_row(cells.enumerate().map(aligned).collect::<Vec<_>>());
    }
    Some(table.trim_fmt())
}

/// Returns an empty table with `header`, with right-aligned figures.
fn headed<const COLUMNS: usize>(header: &[&str; COLUMNS]) -> Table {
    let aligned = |(i, text): (usize, &&str)| Cell::new(text).set_alignment(side(i));
    table(header.iter().enumerate().map(aligned).collect())
}

fn row<const COLUMNS: usize>(table: &mut Table, cells: [String; COLUMNS]) {
    let cells = cells.into_iter().enumerate();
    table.add_row(
        cells
            .map(|(i, text)| Cell::new(text).set_alignment(side(i)))
            .collect::<Vec<_>>(),
    );
}

fn side(column: usize) -> CellAlignment {
    match column {
        0 => CellAlignment::Left,
        _ => CellAlignment::Right,
    }
}

/// Describes the tables in sentences.
fn words(audit: &Audit) -> Vec<String> {
    let held: Vec<&Audited> = audit.backends.iter().filter(|b| b.backend.holds).collect();
    let mut words = Vec::new();
    let faults = audit.faults();
    match faults.is_empty() {
        true => words.push(
            "Formula, tables and allocator agree to the byte: no table has spare capacity, and \
             there are no blocks outside the tables."
                .to_owned(),
        ),
        false => words.extend(faults.into_iter().map(|fault| format!("! {fault}."))),
    }
    words.push(
        "A word is 4 bytes: an index or a coordinate. The last column is the formula for 2 faces \
         and 3 edges per vertex, as in the literature."
            .to_owned(),
    );
    words.extend(words_of_operations(audit));
    for one in held {
        let backend = &one.backend;
        if let Some(merged @ 1..) = backend.merged_vertices {
            words.push(format!(
                "{} merges {} with others at the same position. Its bytes do not change, because it \
                 stores corners; figures per vertex count the vertices of the file.",
                backend.name,
                counted(merged, "vertex", "vertices")
            ));
        }
    }
    words
}

/// Returns the legend of the table of operations; empty without that table.
fn words_of_operations(audit: &Audit) -> Vec<String> {
    let operations = || audit.backends.iter().flat_map(|one| &one.operations);
    let mut words = Vec::new();
    if operations().next().is_none() {
        return words;
    }
    words.push(
        "Allocated bytes are all bytes that one run of the operation requests from the allocator, \
         including scratch that it frees. A block that grows counts by its growth. Native steps \
         start with new tables."
            .to_owned(),
    );
    words.push(
        "The result of build is the structure, of ff_bfs the depth of each face, of catmull_clark_* \
         and loop_* the structure of the refined mesh, and of the other operations the mesh after \
         the edits."
            .to_owned(),
    );
    if operations().any(|operation| operation.scans) {
        words.push(format!(
            "scans: not run, because the structure scans all faces for each element and the mesh has \
             more than {} faces.",
            grouped(MOST_SCANNED_FACES)
        ));
    }
    words
}

#[cfg(test)]
mod tests {
    use sixfold::{HalfEdgeMesh, shapes};
    use sixfold_study::{Backend, Heap, Specimen};

    use super::*;
    use crate::text::WIDTH;

    /// An allocator that never counts anything.
    struct Idle;

    impl Heap for Idle {
        fn live(&self) -> usize {
            0
        }

        fn restart_peak(&self) {}

        fn peak(&self) -> usize {
            0
        }
    }

    #[test]
    fn counts_that_differ_are_marked_and_reported_with_an_exit_code() {
        let cube = Specimen::new("cube", shapes::cube());
        let audit = audit(&cube, &[Backend::of::<HalfEdgeMesh>()], &Idle, &mut |_| ());
        // 24 halves of 12 bytes, 8 vertices of 16, and 6 faces.
        let table = bytes_table(&audit);
        let line = table.lines().find(|line| line.contains("half-edge"));
        let cells: Vec<&str> = line.expect("a row").split_whitespace().collect();
        assert_eq!(cells, ["half-edge", "440", "440", "0!", "0", "–"]);
        assert!(table.lines().all(|line| line.chars().count() <= WIDTH));
        let words = words(&audit);
        assert!(
            words[0].starts_with("! half-edge: the allocator counted 0 bytes"),
            "{words:?}"
        );
        assert!(
            words.iter().all(|words| !words.contains("agree")),
            "{words:?}"
        );
        assert_eq!(judged(&audit.faults()), ExitCode::from(DIFFERENT));
        assert_eq!(judged(&[]), ExitCode::SUCCESS);
    }
}
