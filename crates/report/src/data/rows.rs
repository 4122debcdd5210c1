//! The data of each figure. The columns of figures of times are those of the table of times; the others
//! have the columns of the types in this file.

use serde::Serialize;
use sixfold_results::{
    Change, Figure as TimeRow, GrowthReport, NeighboursReport, OrdersReport, PickReport, Pool,
    Report, Verdict, Why,
};

use super::{own_columns, times};

/// Returns the rows of all operations of a study on the backends that hold the mesh.
pub(crate) fn study(study: &Report) -> String {
    let holds = |row: &TimeRow<'_>| {
        let mut backends = study.backends.iter();
        backends.any(|backend| backend.holds && backend.name == row.row.backend)
    };
    let rows = study.figures().into_iter().filter(holds);
    times("study", rows)
}

/// Returns the rows of all operations in all orders.
pub(crate) fn orders(report: &OrdersReport) -> String {
    times("orders", report.figures())
}

/// Returns the rows of all operations on all sizes, with times or lower bounds.
pub(crate) fn growth(report: &GrowthReport) -> String {
    let shown = |row: &TimeRow<'_>| row.row.median_ns.or(row.row.estimated_ns).is_some();
    let rows = report.figures().into_iter().filter(shown);
    times("growth", rows)
}

/// Returns the ranked rows of all queries in space.
pub(crate) fn neighbours(report: &NeighboursReport) -> String {
    let ranked = |row: &TimeRow<'_>| row.row.ratio_to_best.is_some();
    let rows = report.figures().into_iter().filter(ranked);
    times("neighbours", rows)
}

/// One row of the mean over several meshes.
#[derive(Serialize)]
struct PooledRow<'r> {
    operation: &'r str,
    backend: &'r str,
    meshes: usize,
    ratio_to_best: f64,
    ratio_ci_low: Option<f64>,
    ratio_ci_high: Option<f64>,
    /// Whether `ratio_to_best` is a lower bound.
    lower_bound: bool,
    fastest_on_meshes: usize,
    tied_on_meshes: usize,
    not_run_on_meshes: usize,
    ns_per_element: Option<f64>,
}

/// Returns the means over several meshes.
pub(crate) fn pooled(pool: &Pool) -> String {
    let rows = pool.all().iter().map(|row| PooledRow {
        operation: &row.operation,
        backend: &row.backend,
        meshes: row.meshes,
        ratio_to_best: row.ratio_to_best,
        ratio_ci_low: row.ci_low,
        ratio_ci_high: row.ci_high,
        lower_bound: row.estimated > 0,
        fastest_on_meshes: row.best,
        tied_on_meshes: row.tied,
        not_run_on_meshes: row.estimated,
        ns_per_element: row.ns_per_element,
    });
    own_columns(rows)
}

/// One row of the ranking of a workload.
#[derive(Serialize)]
struct PickRow<'r> {
    workload: &'r str,
    backend: &'r str,
    ns_per_operation: f64,
    ci_low_ns: Option<f64>,
    ci_high_ns: Option<f64>,
    ratio_to_best: f64,
    ratio_ci_low: Option<f64>,
    ratio_ci_high: Option<f64>,
    /// Whether `ns_per_operation` and `ratio_to_best` are lower bounds.
    lower_bound: bool,
    tied_with_best: bool,
    sampled: bool,
    samples: usize,
    build_ns: f64,
    first_build_ns: Option<f64>,
    backend_bytes: usize,
}

/// Returns the ranking of a workload.
pub(crate) fn pick(report: &PickReport) -> String {
    let rows = report.ranking.iter().map(|ranked| PickRow {
        workload: &report.workload.name,
        backend: &ranked.backend,
        ns_per_operation: ranked.ns_per_operation,
        ci_low_ns: ranked.ns_ci_low,
        ci_high_ns: ranked.ns_ci_high,
        ratio_to_best: ranked.ratio_to_best,
        ratio_ci_low: ranked.ci_low,
        ratio_ci_high: ranked.ci_high,
        lower_bound: ranked.estimated,
        tied_with_best: ranked.tied_with_best,
        sampled: ranked.sampled,
        samples: ranked.samples,
        build_ns: ranked.build_ns,
        first_build_ns: ranked.first_build_ns,
        backend_bytes: ranked.bytes,
    });
    own_columns(rows)
}

/// The size of one table of a backend.
#[derive(Serialize)]
struct MemoryRow<'r> {
    mesh: &'r str,
    vertices: usize,
    backend: &'r str,
    table: String,
    rows: usize,
    bytes: usize,
    bytes_per_vertex: f64,
}

/// Returns the size of each table of each backend.
pub(crate) fn memory(study: &Report) -> String {
    let vertices = study.mesh.facts.vertices;
    let tables = study.backends.iter().flat_map(|backend| {
        backend.tables.iter().map(move |part| MemoryRow {
            mesh: &study.mesh.name,
            vertices,
            backend: &backend.name,
            table: part.table.to_string(),
            rows: part.rows,
            bytes: part.bytes,
            bytes_per_vertex: part.bytes as f64 / vertices.max(1) as f64,
        })
    });
    own_columns(tables)
}

/// The reads and the time of one query. All values are means per queried element.
#[derive(Serialize)]
struct RooflineRow<'r> {
    mesh: &'r str,
    relation: String,
    backend: &'r str,
    per: &'r str,
    moved_bytes: f64,
    jumps: f64,
    ns_per_element: f64,
    /// The time to read the moved bytes in order.
    floor_ns: f64,
    /// The time of the jumps if they do not overlap.
    waits_ns: f64,
    bound_by: &'static str,
    /// The two lines of the figure.
    smallest_buffer_bytes: Option<usize>,
    smallest_buffer_gb_per_s: Option<f64>,
    largest_buffer_bytes: Option<usize>,
    largest_buffer_gb_per_s: Option<f64>,
}

/// Returns the queries with a time that move bytes.
pub(crate) fn roofline(why: &Why) -> String {
    let buffers = why.memory.as_deref().unwrap_or_default();
    let [smallest, largest] = [buffers.first(), buffers.last()];
    let rows = why.rows.iter().filter_map(|row| {
        let timed = row.timed.as_ref()?;
        (row.reads.moved_bytes > 0.0).then(|| RooflineRow {
            mesh: &why.mesh.name,
            relation: row.reads.relation.to_string(),
            backend: &row.backend,
            per: &row.per,
            moved_bytes: row.reads.moved_bytes,
            jumps: row.reads.jumps,
            ns_per_element: timed.ns_per_element,
            floor_ns: timed.floor_ns,
            waits_ns: timed.waits_ns,
            bound_by: timed.bound.name(),
            smallest_buffer_bytes: smallest.map(|buffer| buffer.bytes),
            smallest_buffer_gb_per_s: smallest.map(|buffer| buffer.gb_per_s),
            largest_buffer_bytes: largest.map(|buffer| buffer.bytes),
            largest_buffer_gb_per_s: largest.map(|buffer| buffer.gb_per_s),
        })
    });
    own_columns(rows)
}

/// The line of one backend in a figure of the break-even. The total time of n runs is `build_ns` + n ·
/// `run_ns`.
#[derive(Serialize)]
pub(crate) struct BreakEvenRow<'r> {
    pub(crate) subject: &'r str,
    /// What one run is: an operation on the whole mesh, or one operation of a workload.
    pub(crate) run: &'r str,
    pub(crate) backend: &'r str,
    /// 0 for the structure of the input, which need not be built.
    pub(crate) build_ns: f64,
    pub(crate) run_ns: f64,
    /// The number of runs after which the time to build is saved. Missing if it is never saved, or if
    /// the structure of the input was not measured.
    pub(crate) pays_after_runs: Option<f64>,
    /// The interval of `pays_after_runs`. The upper end is missing if the time may never be saved.
    pub(crate) pays_after_low: Option<f64>,
    pub(crate) pays_after_high: Option<f64>,
}

/// One time of a comparison.
#[derive(Serialize)]
struct ChangeRow<'r> {
    mesh: &'r str,
    kind: &'r str,
    case: &'r str,
    operation: &'r str,
    backend: &'r str,
    before_ns: f64,
    after_ns: f64,
    before_samples: usize,
    after_samples: usize,
    ratio: f64,
    ci_low: Option<f64>,
    ci_high: Option<f64>,
    detectable: Option<f64>,
    verdict: Verdict,
    other_checksum: bool,
}

/// Returns the times of a comparison, in the order of `changes`.
pub(crate) fn changes<'c>(changes: impl Iterator<Item = &'c Change>) -> String {
    let rows = changes.map(|change| ChangeRow {
        mesh: &change.measurement.mesh,
        kind: change.measurement.kind,
        case: &change.measurement.case,
        operation: &change.measurement.operation,
        backend: &change.measurement.backend,
        before_ns: change.before_ns,
        after_ns: change.after_ns,
        before_samples: change.before_samples,
        after_samples: change.after_samples,
        ratio: change.ratio,
        ci_low: change.ci_low,
        ci_high: change.ci_high,
        detectable: change.detectable,
        verdict: change.verdict,
        other_checksum: change.other_checksum,
    });
    own_columns(rows)
}
