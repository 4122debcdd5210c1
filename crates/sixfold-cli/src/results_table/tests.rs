use sixfold::{Facts, PolygonMesh, structure_infos};
use sixfold_results::{Agreement, Control, MeshReport, Refusal, RefusalKind, Run};

use super::*;
use crate::left_out::left_out_notes;
use crate::text::WIDTH;

fn backend(name: &str, bytes: usize) -> BackendReport {
    BackendReport {
        name: name.into(),
        holds: true,
        reason: None,
        bytes: Some(bytes),
        bytes_per_vertex: Some(bytes as f64 / 100.0),
        layout_bytes: Some(bytes),
        layout_bytes_per_vertex: Some(bytes as f64 / 100.0),
        tables: Vec::new(),
        merged_vertices: Some(0),
        capabilities: Some(structure_infos()[0].capabilities),
        external: None,
    }
}

fn row(name: &str, operation: &str, median_ns: f64, standing: Standing) -> ResultRow {
    let operation: Operation = operation.parse().expect("a name");
    ResultRow {
        median_ns: Some(median_ns),
        min_ns: Some(median_ns * 0.99),
        ci_low_ns: Some(median_ns * 0.995),
        ci_high_ns: Some(median_ns * 1.03),
        elements: Some(100),
        ns_per_element: Some(median_ns / 100.0),
        wall_median_ns: Some(median_ns),
        wall_min_ns: Some(median_ns),
        checksum: Some(1.0),
        agreement: Agreement::Same,
        standing: Some(standing),
        ratio_to_best: Some(1.0),
        samples: 9,
        ..ResultRow::new(name, operation.name(), operation.unit())
    }
}

fn control(operation: &str, [ratio, low, high]: [f64; 3]) -> ControlRow {
    ControlRow {
        operation: operation.into(),
        ratio,
        ci_low: Some(low),
        ci_high: Some(high),
        launches: Vec::new(),
    }
}

fn report() -> Report {
    let mut scanned = row("polygon-soup", "vertex_vertices", 4e6, Standing::Slower);
    scanned.sampled = true;
    let mut wrong = row("half-edge", "ff_bfs", 900.0, Standing::Best);
    wrong.agreement = Agreement::Mismatch;
    let mut unrun = row("polygon-soup", "ff_bfs", 0.0, Standing::Slower);
    (unrun.median_ns, unrun.ns_per_element, unrun.standing) = (None, None, None);
    unrun.estimated_ns = Some(7.3e9);
    let mut fresh = row("half-edge", "build", 1240.0, Standing::Undecided);
    (fresh.first_ns, fresh.first_samples) = (Some(3120.0), 5);
    let mut merged = row("polygon-soup", "build", 1234.0, Standing::Undecided);
    merged.agreement = Agreement::Merged;
    let mut left_out = row("polygon-soup", "loop_gather", 0.0, Standing::Slower);
    (
        left_out.median_ns,
        left_out.ns_per_element,
        left_out.standing,
    ) = (None, None, None);
    (left_out.estimated_ns, left_out.by_name_only) = (Some(1.4e9), true);
    let refusal = |operation: &str, reason: &str| Refusal {
        backend: "polygon-soup".into(),
        operation: operation.into(),
        kind: RefusalKind::Impossible,
        reason: reason.into(),
    };
    let mesh = PolygonMesh::default();
    Report {
        run: Run {
            operations: Operation::ALL.map(Operation::info).into(),
            ..Run::default()
        },
        mesh: MeshReport {
            name: "fixed".into(),
            facts: Facts::from_polygons(&mesh),
            changes: Vec::new(),
            sha256: String::new(),
            file_sha256: None,
            left_out_faces: 0,
            cut_faces: 0,
            picture: None,
        },
        backends: vec![backend("polygon-soup", 7200), backend("half-edge", 9600)],
        results: vec![
            merged,
            fresh,
            scanned,
            row("half-edge", "vertex_vertices", 1.2e6, Standing::Best),
            unrun,
            wrong,
            left_out,
            row("half-edge", "loop_gather", 8e4, Standing::Alone),
            row("half-edge", "loop_native", 2e3, Standing::Alone),
        ],
        refusals: vec![
            refusal("catmull_clark_native", "it cannot split its own tables"),
            refusal("loop_native", "it cannot split its own tables"),
        ],
        control: Some(Control {
            backend: "half-edge".into(),
            operations: vec![
                control("build", [1.124, 1.08, 1.15]),
                control("vertex_vertices", [1.2, 0.99, 1.5]),
                control("ff_bfs", [1.03, 1.02, 1.04]),
            ],
            typical: 1.12,
            worst: 1.2,
        }),
        sentences: Vec::new(),
        notes: Vec::new(),
        warnings: Vec::new(),
        samples: Vec::new(),
        timer: None,
        interrupted: false,
    }
}

#[test]
fn golden() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/table.txt");
    let text = results_table(&report(), false) + "\n";
    if std::env::var_os("SIXFOLD_GOLDEN").is_some_and(|value| value == "write") {
        std::fs::write(path, &text).expect("the file");
    }
    assert_eq!(text, std::fs::read_to_string(path).unwrap_or_default());
}

#[test]
fn best_is_bold_on_a_terminal_and_marked_everywhere() {
    let (plain, bold) = (
        results_table(&report(), false),
        results_table(&report(), true),
    );
    assert!(!plain.contains('\u{1b}') && bold.contains('\u{1b}'));
    assert!(plain.contains('*') && bold.contains('*'));
    assert!(plain.lines().all(|line| line.chars().count() <= WIDTH));
}

#[test]
fn each_reason_for_a_missing_figure_is_said_once() {
    let notes = left_out_notes(&report()).join("\n");
    assert_eq!(
        notes.matches("it cannot split its own tables").count(),
        1,
        "{notes}"
    );
    assert!(
        notes.contains("catmull_clark_native, loop_native on "),
        "{notes}"
    );
    let by_budget = "≥ not run, because a run would take long (ff_bfs on polygon-soup: 7.30 s or \
                     more): ff_bfs on polygon-soup. To run them, use a longer --budget.";
    let by_name = "≥ not run, because a run would take long (loop_gather on polygon-soup: 1.40 s or \
                   more): loop_gather on polygon-soup. To run them, name them in --operations.";
    assert!(
        notes.contains(by_budget) && notes.contains(by_name),
        "{notes}"
    );
}

#[test]
fn a_tie_that_may_be_a_large_difference_shows_the_end_of_its_interval() {
    let mut report = report();
    let wide = |report: &mut Report, ratio: f64| {
        let tied = &mut report.results[1];
        (tied.ratio_to_best, tied.ratio_ci_high) = (Some(ratio), Some(1.4));
    };
    wide(&mut report, 1.09);
    assert!(!results_table(&report, false).contains("ratio up to"));
    wide(&mut report, 1.12);
    let table = results_table(&report, false);
    let line = table.lines().find(|line| line.contains("  ratio up to"));
    assert_eq!(
        line.map(str::split_whitespace).and_then(Iterator::last),
        Some("1.40")
    );
    assert!(
        table.contains("ratio up to: upper end of the 95 %"),
        "{table}"
    );
}
