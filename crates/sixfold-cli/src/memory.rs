//! `sixfold memory`: the memory of each backend, by its formula, its tables and the allocator.

use std::process::ExitCode;

use comfy_table::{Cell, CellAlignment, Table};
use sixfold_study::{
    Audit, Backend, BackendAudit, MAX_SCANNED_FACES, OperationBytes, Policy, Settings, audit,
    count_allocations,
};

use crate::AllocatorCounters;
use crate::arguments::Memory;
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::load;
use crate::measure::{Session, with_command};
use crate::progress::{StatusLine, exit_on_interrupt};
use crate::tables::table;
use crate::text::{TextOutput, print_stderr};
use sixfold_study::numbers::{counted, grouped};

/// The exit code if two of the three counts differ.
const COUNTS_DIFFER: u8 = 1;

pub(crate) fn run(
    arguments: &Memory,
    counters: &dyn AllocatorCounters,
) -> Result<ExitCode, Failure> {
    let mesh = arguments.mesh.as_deref();
    let mut session = Session::open(mesh, &arguments.files, Policy::System)?;
    // Counting cannot be resumed, so Ctrl-C ends it at once.
    exit_on_interrupt();
    let study_mesh = load::mesh_or_built_in(mesh, arguments.read, false, arguments.triangulate)?;
    let settings = Settings {
        backends: arguments.backends.clone(),
        ..Settings::default()
    };
    let backends = settings.chosen_backends().map_err(Failure::usage)?;
    print_before_measuring(&study_mesh, &settings, &mut session.text);
    let status = StatusLine::new();
    let mut audit = audit(&study_mesh, &backends, counters, &mut |backend| {
        status.show(format!("building {} and counting", backend.name()));
    });
    let mut counting = |backend: &Backend, operation| {
        status.show(format!(
            "running {operation} on {} and counting",
            backend.name()
        ));
    };
    count_allocations(&mut audit, &study_mesh, &backends, counters, &mut counting);
    status.clear();

    // If every backend refuses the mesh, the list of reasons is the result.
    let refusal_error = audit.refusal_error();
    if refusal_error.is_none() {
        print(&audit, &mut session.text);
    }
    let faults = audit.faults();
    let written = session.write(&with_command(audit, arguments.triangulate).into());
    match refusal_error {
        Some(none) => written.and(Err(Failure::unsupported(none))),
        None => {
            let code = report_faults(&faults);
            written.map(|()| code)
        }
    }
}

fn report_faults(faults: &[String]) -> ExitCode {
    for fault in faults {
        print_stderr(&format!(
            "error: {fault}: this is a fault in Sixfold, please report it"
        ));
    }
    match faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(COUNTS_DIFFER),
    }
}

/// Prints the counts, which follow [`print_before_measuring`].
fn print(audit: &Audit, text: &mut TextOutput) {
    text.print_line("");
    text.print_line(&bytes_table(audit));
    text.print_line("");
    text.print_line(&words_table(audit));
    text.print_line("");
    if let Some(table) = operations_table(audit) {
        text.print_line(&table);
        text.print_line("");
    }
    text.print_list("- ", sentences(audit));
}

/// Returns the three counts of each backend that holds the mesh, with a row for each table below.
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
    let mut table = new_table(&header);
    for entry in &audit.backends {
        let backend = &entry.backend;
        let bytes = |bytes: Option<usize>| bytes.map_or(String::new(), grouped);
        // The mark `!` follows a figure that differs from the figure before it.
        let marked_bytes = |figure: Option<usize>, before: Option<usize>| {
            let sign = if figure == before { " " } else { "!" };
            format!("{}{sign}", bytes(figure))
        };
        if !backend.holds {
            continue;
        }
        let ratio = entry.peak_to_counted;
        add_row(
            &mut table,
            [
                backend.name.clone(),
                String::new(),
                format!("{} ", bytes(backend.layout_bytes)),
                marked_bytes(backend.bytes, backend.layout_bytes),
                marked_bytes(entry.counted_bytes, backend.bytes),
                bytes(entry.peak_bytes),
                ratio.map_or("–".into(), |ratio| format!("{ratio:.2}")),
            ],
        );
        for part in &backend.tables {
            let name = format!("  {}", part.table);
            let table_bytes = format!("{} ", grouped(part.bytes));
            let blank = String::new;
            let cells = [
                name,
                grouped(part.rows),
                blank(),
                table_bytes,
                blank(),
                blank(),
                blank(),
            ];
            add_row(&mut table, cells);
        }
    }
    table.trim_fmt()
}

/// Returns the table of bytes and words per vertex.
fn words_table(audit: &Audit) -> String {
    let header = [
        "per vertex",
        "bytes",
        "words",
        "words in a closed triangle mesh",
    ];
    let mut table = new_table(&header);
    for entry in audit.backends.iter().filter(|entry| entry.backend.holds) {
        let figure = |figure: Option<f64>| figure.map_or("–".into(), |n| format!("{n:.1}"));
        let cells = [
            entry.backend.name.clone(),
            figure(entry.counted_bytes_per_vertex),
            figure(entry.layout_words_per_vertex),
            figure(Some(entry.closed_triangles_words_per_vertex)),
        ];
        add_row(&mut table, cells);
    }
    table.trim_fmt()
}

/// Returns the table of allocated bytes per byte of the result, with a row per operation and a
/// column per structure. Returns `None` if nothing was counted.
fn operations_table(audit: &Audit) -> Option<String> {
    let counted = |entry: &&BackendAudit| !entry.operations.is_empty();
    let columns: Vec<&BackendAudit> = audit.backends.iter().filter(counted).collect();
    let names = columns
        .iter()
        .map(|entry| entry.backend.name.replace('-', "\n"));
    let header = std::iter::once("allocated bytes\n/ result bytes".to_owned()).chain(names);
    let aligned = |(i, text): (usize, String)| Cell::new(text).set_alignment(column_alignment(i));
    let mut table = table(header.enumerate().map(aligned).collect());
    for (i, first) in columns.first()?.operations.iter().enumerate() {
        let cells: Vec<&OperationBytes> =
            columns.iter().map(|entry| &entry.operations[i]).collect();
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

fn new_table<const COLUMNS: usize>(header: &[&str; COLUMNS]) -> Table {
    let aligned = |(i, text): (usize, &&str)| Cell::new(text).set_alignment(column_alignment(i));
    table(header.iter().enumerate().map(aligned).collect())
}

fn add_row<const COLUMNS: usize>(table: &mut Table, cells: [String; COLUMNS]) {
    let cells = cells.into_iter().enumerate();
    table.add_row(
        cells
            .map(|(i, text)| Cell::new(text).set_alignment(column_alignment(i)))
            .collect::<Vec<_>>(),
    );
}

fn column_alignment(column: usize) -> CellAlignment {
    match column {
        0 => CellAlignment::Left,
        _ => CellAlignment::Right,
    }
}

fn sentences(audit: &Audit) -> Vec<String> {
    let holding: Vec<&BackendAudit> = audit.backends.iter().filter(|b| b.backend.holds).collect();
    let mut sentences = Vec::new();
    let faults = audit.faults();
    match faults.is_empty() {
        true => sentences.push(
            "Formula, tables and allocator agree to the byte: no table has spare capacity, and \
             there are no blocks outside the tables."
                .to_owned(),
        ),
        false => sentences.extend(faults.into_iter().map(|fault| format!("! {fault}."))),
    }
    sentences.push(
        "A word is 4 bytes: an index or a coordinate. The last column is computed by the formula \
         for a mesh with 2 faces and 3 edges per vertex, as in the literature."
            .to_owned(),
    );
    sentences.extend(operation_sentences(audit));
    for entry in holding {
        let backend = &entry.backend;
        if let Some(merged @ 1..) = backend.merged_vertices {
            sentences.push(format!(
                "{} merges {} with other vertices at the same position. The bytes do not change, \
                 because the structure stores corners. Figures per vertex refer to the vertices \
                 of the file.",
                backend.name,
                counted(merged, "vertex", "vertices")
            ));
        }
    }
    sentences
}

/// Returns the legend of the table of operations. The legend is empty if there is no such table.
fn operation_sentences(audit: &Audit) -> Vec<String> {
    let operations = || audit.backends.iter().flat_map(|entry| &entry.operations);
    let mut sentences = Vec::new();
    if operations().next().is_none() {
        return sentences;
    }
    sentences.push(
        "Allocated bytes are all bytes that one run of the operation requests from the allocator, \
         including temporary memory that the run frees again. If a block grows, only the added \
         bytes count. Native steps start with new tables."
            .to_owned(),
    );
    sentences.push(
        "Result bytes are the bytes of the structure (build), of the depth of each face (ff_bfs), \
         of the structure of the refined mesh (catmull_clark_* and loop_*), or of the mesh after \
         the edits (other operations)."
            .to_owned(),
    );
    if operations().any(|operation| operation.scans) {
        sentences.push(format!(
            "scans: the operation was not run, because the structure scans all faces for each \
             element, and the mesh has more than {} faces.",
            grouped(MAX_SCANNED_FACES)
        ));
    }
    sentences
}

#[cfg(test)]
mod tests {
    use sixfold::{HalfEdgeMesh, shapes};
    use sixfold_study::{Backend, Heap, StudyMesh};

    use super::*;
    use crate::text::WIDTH;

    struct ZeroHeap;

    impl Heap for ZeroHeap {
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
        let cube = StudyMesh::new("cube", shapes::cube());
        let audit = audit(
            &cube,
            &[Backend::new::<HalfEdgeMesh>()],
            &ZeroHeap,
            &mut |_| (),
        );
        // 24 half-edges of 12 bytes, 8 vertices of 16 bytes, and 6 faces.
        let table = bytes_table(&audit);
        let line = table.lines().find(|line| line.contains("half-edge"));
        let cells: Vec<&str> = line.expect("a row").split_whitespace().collect();
        assert_eq!(cells, ["half-edge", "440", "440", "0!", "0", "–"]);
        assert!(table.lines().all(|line| line.chars().count() <= WIDTH));
        let sentences = sentences(&audit);
        assert!(
            sentences[0].starts_with("! half-edge: the allocator counted 0 bytes"),
            "{sentences:?}"
        );
        assert!(
            sentences
                .iter()
                .all(|sentences| !sentences.contains("agree")),
            "{sentences:?}"
        );
        assert_eq!(
            report_faults(&audit.faults()),
            ExitCode::from(COUNTS_DIFFER)
        );
        assert_eq!(report_faults(&[]), ExitCode::SUCCESS);
    }
}
