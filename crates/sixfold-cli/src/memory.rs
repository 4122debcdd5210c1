//! `sixfold memory`: the memory of each backend, by its formula, its tables and the allocator.

use std::process::ExitCode;

use sixfold_results::{Audit, BackendAudit, Policy};
use sixfold_study::{Backend, CROWDED, MAX_SCANNED_FACES, Settings, audit, count_allocations};

use crate::AllocatorCounters;
use crate::arguments::Memory;
use crate::column_table::{Column, column_table, short_figure};
use crate::facts_text::print_before_measuring;
use crate::failure::Failure;
use crate::faults_text::NO_BREAK;
use crate::load;
use crate::measure::{Session, with_command};
use crate::progress::{StatusLine, exit_on_interrupt};
use crate::text::{TextOutput, hanging_indent, print_stderr};
use sixfold_results::numbers::{counted, figure, grouped};

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
    let study_mesh = session.drawn(study_mesh);
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
    let refusal_error = sixfold_study::none_holds(&audit);
    if refusal_error.is_none() {
        print(&audit, &mut session.text);
    }
    let faults = audit.faults();
    let written = session.write(&mut with_command(audit, arguments.triangulate).into());
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

/// Prints the answer and the counts, which follow [`print_before_measuring`].
fn print(audit: &Audit, text: &mut TextOutput) {
    text.print_line("");
    text.print_list("- ", &audit.sentences);
    text.print_list("- ", merged_vertices(audit));
    text.print_line("");
    text.print_line(&bytes_table(audit));
    let words = "words of 4 bytes per vertex of a large closed triangle mesh, by the formula: the \
                 figure of the literature";
    text.print_line("");
    text.print_line(&hanging_indent("words  ", words));
    let peak = "the most bytes in use while the structure is built, without the input";
    text.print_line(&hanging_indent("peak   ", peak));
    text.print_line("");
    text.print_line(&tables_text(audit));
    if let Some(table) = operations_table(audit) {
        text.print_line("");
        text.print_line(&table);
        text.print_line("");
        text.print_list("", operations_legend(audit));
    }
}

/// Returns the table of the bytes of each backend that holds the mesh.
fn bytes_table(audit: &Audit) -> String {
    let holding = || audit.backends.iter().filter(|entry| entry.backend.holds);
    let bytes = |bytes: Option<usize>| bytes.map_or("–".into(), grouped);
    let ratio = |ratio: Option<f64>| ratio.map_or("–".into(), figure);
    let column = |head: &str, cell: &dyn Fn(&BackendAudit) -> String| {
        Column::figures(head, holding().map(cell))
    };
    let columns = [
        column("bytes", &|entry| bytes(entry.counted_bytes)),
        column("/ vertex", &|entry| ratio(entry.counted_bytes_per_vertex)),
        column("words", &|entry| {
            figure(entry.closed_triangles_words_per_vertex)
        }),
        column("peak", &|entry| bytes(entry.peak_bytes)),
        column("/ bytes", &|entry| ratio(entry.peak_to_counted)),
    ];
    let names = Column::words("", holding().map(|entry| entry.backend.name.clone()));
    column_table(&names, &columns)
}

/// Returns the bytes of the tables of each backend that holds the mesh. If the three counts of a
/// backend differ, a line has the counts. In this line, a `!` follows each count that differs from
/// the count before it.
fn tables_text(audit: &Audit) -> String {
    let holding = audit.backends.iter().filter(|entry| entry.backend.holds);
    let holding: Vec<&BackendAudit> = holding.collect();
    let width = holding.iter().map(|entry| entry.backend.name.len()).max();
    let width = width.unwrap_or(0);
    let mut lines = vec!["The bytes of the tables:".to_owned()];
    for entry in holding {
        let backend = &entry.backend;
        let tables = backend.tables.iter();
        let tables =
            tables.map(|table| format!("{}{NO_BREAK}{}", table.table, grouped(table.bytes)));
        let tables = tables.collect::<Vec<_>>().join(" + ");
        let name = &backend.name;
        lines.push(hanging_indent(&format!("{name:<width$}  "), &tables));
        if entry.agrees == Some(false) {
            let counts = [backend.layout_bytes, backend.bytes, entry.counted_bytes];
            let names = ["formula", "tables", "allocator"];
            let count = |i: usize| {
                let sign = if i > 0 && counts[i] != counts[i - 1] {
                    "!"
                } else {
                    ""
                };
                format!("{} {}{sign}", names[i], grouped(counts[i].unwrap_or(0)))
            };
            let differing = [count(0), count(1), count(2)].join(", ");
            lines.push(hanging_indent(&format!("{:<width$}  ", ""), &differing));
        }
    }
    lines.join("\n").replace(NO_BREAK, " ")
}

/// Returns the table of allocated bytes per byte of the result, with a row per operation and a
/// column per structure. Returns `None` if nothing was counted.
fn operations_table(audit: &Audit) -> Option<String> {
    let counted = |entry: &&BackendAudit| !entry.operations.is_empty();
    let backends: Vec<&BackendAudit> = audit.backends.iter().filter(counted).collect();
    let was_run = |row: &usize| {
        let mut cells = backends.iter().map(|entry| &entry.operations[*row]);
        cells.any(|cell| cell.reason.is_none())
    };
    let operations = &backends.first()?.operations;
    let rows: Vec<usize> = (0..operations.len()).filter(was_run).collect();
    let names = rows
        .iter()
        .map(|&row| operations[row].operation.to_string());
    let columns = backends.iter().map(|entry| {
        let ratios = rows
            .iter()
            .map(|&row| entry.operations[row].allocated_to_result);
        let cells = ratios.map(|ratio| ratio.map_or("–".into(), short_figure));
        Column::figures(&entry.backend.name.replace('-', "\n"), cells)
    });
    let columns: Vec<Column> = columns.collect();
    let head = "allocated bytes\n/ result bytes";
    Some(column_table(&Column::words(head, names), &columns))
}

/// Returns the legend of the table of operations.
fn operations_legend(audit: &Audit) -> Vec<String> {
    let scanning = audit
        .backends
        .iter()
        .filter(|entry| entry.operations.iter().any(|o| o.scans));
    let scanning: Vec<&str> = scanning.map(|entry| entry.backend.name.as_str()).collect();
    let scans = match scanning.is_empty() {
        true => String::new(),
        false => format!(
            ", or it scans all faces for each element ({}), and the mesh has more than {} faces or {} \
             corners",
            scanning.join(", "),
            grouped(MAX_SCANNED_FACES),
            grouped(4 * MAX_SCANNED_FACES)
        ),
    };
    let mut operations = audit.backends.iter().flat_map(|entry| &entry.operations);
    let rings = match operations.any(|o| o.reason.as_deref() == Some(CROWDED)) {
        true => format!(", or {CROWDED}"),
        false => String::new(),
    };
    vec![
        "Allocated bytes are all that one run requests, also those that it frees again. The result \
         is the structure (build), the depths of the faces (ff_bfs), the refined mesh, or the mesh \
         after the edits."
            .to_owned(),
        format!("–: not run, because the structure or the mesh does not allow the operation{scans}{rings}."),
    ]
}

/// Returns notes on backends that merge vertices.
fn merged_vertices(audit: &Audit) -> impl Iterator<Item = String> {
    let merging = |entry: &BackendAudit| match entry.backend.merged_vertices {
        Some(merged @ 1..) => Some(format!(
            "{} merges {} with other vertices at the same position. The bytes do not change, \
             because the structure stores corners. Figures per vertex refer to the vertices of the \
             file.",
            entry.backend.name,
            counted(merged, "vertex", "vertices")
        )),
        _ => None,
    };
    audit.backends.iter().filter_map(merging)
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
        let table = bytes_table(&audit);
        let row = table.lines().find(|line| line.starts_with("half-edge"));
        let cells: Vec<&str> = row.expect("a row").split_whitespace().collect();
        assert_eq!(cells, ["half-edge", "0", "0", "24.0", "0", "–"]);
        // 24 half-edges of 12 bytes, 8 vertices of 16 bytes, and 6 faces.
        let tables = tables_text(&audit);
        let sum = "half-edge  positions 96 + leaving 32 + halves 288 + first 24";
        assert!(tables.contains(sum), "{tables}");
        let counts = "           formula 440, tables 440, allocator 0!";
        assert!(tables.ends_with(counts), "{tables}");
        assert!(table.lines().all(|line| line.chars().count() <= WIDTH));
        let sentences = &audit.sentences;
        assert!(
            sentences[0].starts_with("half-edge: the allocator counted 0 bytes"),
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
