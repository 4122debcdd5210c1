//! The order lab: measures one mesh in several orders on every structure.
//!
//! An order changes only the places of elements in memory. Two columns of one structure therefore
//! differ only in how well caches and prefetchers work. This effect can be larger than the effect
//! of the structure. A study of one file cannot show the effect, because a file has one order. All
//! orders use the same sampled elements, so that their checksums can be compared.

mod effects;
mod meshes;
mod sentences;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::{Deserialize, Serialize};
use serde_with::{KeyValueMap, serde_as};
use sixfold::PolygonMesh;
use sixfold::shapes::Order;
use sixfold_core::Counts;

pub use effects::{Comparison, Factor, Larger, OrderEffect, StructureEffect};

use crate::agreement::compare_checksums;
use crate::control::{control, measured_twice, noise};
use crate::environment::Environment;
use crate::heap::Memory;
use crate::inspect::StudyMesh;
use crate::measure::{Entry, Measurement, Progress};
use crate::report::{
    Agreement, BackendReport, Control, MeshReport, Refusal, ResultRow, SCHEMA, write_json,
};
use crate::study::{Settings, StudyError, is_skewed, prepare, refusals, results, scans};
use effects::OrderSamples;
use meshes::OrderedMeshes;
use sixfold_workload::{Backend, MachineClock, Operation, TimedBackend};

/// Operations that are measured by default.
pub const DEFAULT_OPERATIONS: [&str; 6] = [
    "vertex_vertices",
    "vertex_faces",
    "edge_faces",
    "face_vertices",
    "vertex_normal",
    "ff_bfs",
];

/// Minimum budget.
const MIN_BUDGET: Duration = Duration::from_millis(100);

/// The reason why orders cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum OrdersError {
    /// The study is not possible.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The budget is too short.
    #[error("a budget of {} ms is too short to compare orders: use {} ms or more", .budget.as_millis(), .least.as_millis())]
    BudgetTooSmall { budget: Duration, least: Duration },
}

/// The results of a comparison of orders.
#[serde_as]
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct OrdersReport {
    /// Version of the JSON schema.
    pub schema: u32,
    /// Name and facts of the mesh in its original order.
    pub mesh: MeshReport,
    /// The orders, as tables list them.
    pub orders: Vec<Order>,
    /// The requested backends, in the order of [`Backend::structures`], built from the original
    /// order.
    #[serde_as(as = "KeyValueMap<_>")]
    pub backends: Vec<BackendReport>,
    /// The rows, by operation, then structure, then order.
    pub results: Vec<OrderRow>,
    /// Requested operations that a backend cannot do.
    pub refusals: Vec<Refusal>,
    /// The effects of order and structure, for each operation.
    pub comparisons: Vec<Comparison>,
    /// One structure in the original order, measured twice.
    pub control: Option<Control>,
    /// Sentences about the tables.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
    /// Whether the run was interrupted.
    pub interrupted: bool,
    /// The machine and the program.
    pub environment: Environment,
}

/// One operation on one structure in one order.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct OrderRow {
    /// The order.
    pub order: Order,
    /// The times. `standing` and `ratio_to_best` compare the orders of this structure.
    #[serde(flatten)]
    pub row: ResultRow,
}

impl OrdersReport {
    /// Iterates over the rows of `operation`.
    pub fn rows(&self, operation: Operation) -> impl Iterator<Item = &OrderRow> {
        let of_it = move |row: &&OrderRow| row.row.operation == operation;
        self.results.iter().filter(of_it)
    }

    /// Counts the results that differ from those of other structures without a known reason.
    pub fn mismatches(&self) -> usize {
        let wrong = |row: &&OrderRow| row.row.agreement == Agreement::Mismatch;
        self.results.iter().filter(wrong).count()
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// Returns the requested operations. If none is requested, returns [`DEFAULT_OPERATIONS`].
pub(crate) fn chosen_operations(settings: &Settings) -> Vec<Operation> {
    let requested = |operation: &Operation| match settings.operations.is_empty() {
        true => DEFAULT_OPERATIONS.contains(&operation.name()),
        false => settings.operations.contains(operation),
    };
    Operation::ALL.into_iter().filter(requested).collect()
}

/// Measures the mesh in every order on every requested backend. If `settings` name no operations,
/// [`DEFAULT_OPERATIONS`] are measured.
///
/// Setting `stop` ends the run after the current sample. The report then contains the finished
/// part.
///
/// # Errors
///
/// Returns an error if a backend is unknown, if the mesh has no faces, if no requested backend can
/// hold the mesh, or if the budget is too short.
pub fn orders(
    study_mesh: &StudyMesh,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<OrdersReport, OrdersError> {
    if settings.budget < MIN_BUDGET {
        return Err(OrdersError::BudgetTooSmall {
            budget: settings.budget,
            least: MIN_BUDGET,
        });
    }
    let chosen = settings.chosen_backends()?;
    let operations = chosen_operations(settings);
    let polygons = &study_mesh.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces.into());
    }
    let environment = Environment::detect(settings.seed, settings.budget.as_secs_f64());
    let counts = polygons.counts(study_mesh.facts.edges);
    let needed = orders_bytes(study_mesh, settings)?;
    let mut memory = Memory::start(settings.heap, settings.caches, needed);
    let skewed = is_skewed(&study_mesh.facts);
    let needs_draw = chosen.iter().any(|b| skewed || scans(b, &operations));
    let meshes = OrderedMeshes::new(polygons, settings.seed, needs_draw);

    let mut backends = Vec::new();
    let mut subjects: Vec<Box<dyn TimedBackend + '_>> = Vec::new();
    let mut columns: Vec<Column> = Vec::new();
    for backend in &chosen {
        for (order, mesh, draw) in meshes.iter() {
            let (report, subject) = prepare(backend, mesh, draw, &counts);
            if order == Order::Given {
                backends.push(report);
            }
            let Some(subject) = subject else { break };
            subjects.push(subject);
            columns.push(Column {
                backend: *backend,
                order,
            });
        }
    }
    if subjects.is_empty() {
        let reason = |b: BackendReport| (b.name, b.reason.unwrap_or_default());
        let refusals = backends.into_iter().map(reason).collect();
        return Err(StudyError::NoneHolds { refusals }.into());
    }
    let first = measured_twice(&subjects);
    let second = subjects.len();
    let again = meshes.iter().next().and_then(|(_, mesh, draw)| {
        let built = columns[first].backend.prepare(mesh, draw);
        built.ok()
    });
    subjects.extend(again.map(|(subject, _)| subject));

    let clock = MachineClock::start();
    let mut measurement = Measurement {
        control: (subjects.len() > second).then_some(second),
        subjects: &mut subjects,
        population: [counts.vertices, counts.edges, counts.faces],
        skewed,
        clock: &clock,
        memory: &mut memory,
        budget: settings.budget,
        named: !settings.operations.is_empty(),
        random: ChaCha8Rng::seed_from_u64(settings.seed),
        stop,
        progress,
    };
    let mut entries = measurement.measure(&operations);
    let control = control(&entries, first, second, subjects[first].name());
    entries.retain(|entry| entry.subject != second);
    let interrupted = stop.load(Ordering::Relaxed);
    let mut compare =
        |entries: &[Entry]| compare_checksums(entries, &mut subjects, polygons, &clock, stop);
    let agreements = agreements(&entries, &columns, &mut compare);

    let refusals = deduplicated(refusals(&entries, &subjects));
    let rows = rows(
        &entries,
        &agreements,
        &columns,
        &subjects,
        polygons,
        control.as_ref(),
    );
    let timed = |operation: Operation| {
        let of_it = entries.iter().filter(|e| e.job.operation == operation);
        let timed = of_it.map(|entry| OrderSamples {
            backend: columns[entry.subject].backend.name(),
            order: columns[entry.subject].order,
            scans: operation.scans(&columns[entry.subject].backend.info.costs) != [false; 3],
            samples: entry.times(),
        });
        let timed: Vec<OrderSamples> = timed.collect();
        Comparison::new(operation, &timed, noise(control.as_ref(), operation))
    };
    let comparisons: Vec<Comparison> = operations.into_iter().map(timed).collect();
    let sentences = sentences::sentences(&rows, &comparisons, control.as_ref());
    Ok(OrdersReport {
        schema: SCHEMA,
        mesh: study_mesh.report(),
        orders: Order::ALL.into(),
        backends,
        results: rows,
        refusals,
        comparisons,
        control,
        sentences,
        interrupted,
        environment: environment.with_memory(&memory),
    })
}

struct Column {
    backend: Backend,
    order: Order,
}

/// Returns whether the result depends on the order of the input.
fn depends_on_order(operation: Operation) -> bool {
    matches!(operation, Operation::FfBfs | Operation::EditPass(_))
}

/// Compares the checksums of all orders. If the result of an operation depends on the order,
/// compares the checksums only within each order.
fn agreements(
    entries: &[Entry],
    columns: &[Column],
    compare: &mut dyn FnMut(&[Entry]) -> Vec<Agreement>,
) -> Vec<Agreement> {
    let mut agreements = vec![Agreement::Unchecked; entries.len()];
    let mut compare_group = |takes_part: &dyn Fn(&Entry) -> bool| {
        let indices: Vec<usize> = (0..entries.len())
            .filter(|&e| takes_part(&entries[e]))
            .collect();
        let group: Vec<Entry> = indices.iter().map(|&e| entries[e].clone()).collect();
        for (e, agreement) in indices.into_iter().zip(compare(&group)) {
            agreements[e] = agreement;
        }
    };
    compare_group(&|entry| !depends_on_order(entry.job.operation));
    for order in Order::ALL {
        compare_group(&|entry| {
            depends_on_order(entry.job.operation) && columns[entry.subject].order == order
        });
    }
    agreements
}

/// Returns a row for each entry with a time. A row is compared with the other orders of its
/// structure.
fn rows(
    entries: &[Entry],
    agreements: &[Agreement],
    columns: &[Column],
    subjects: &[Box<dyn TimedBackend + '_>],
    polygons: &PolygonMesh,
    control: Option<&Control>,
) -> Vec<OrderRow> {
    let with_times: Vec<(&Entry, Agreement)> = entries
        .iter()
        .zip(agreements.iter().copied())
        .filter(|(entry, _)| !entry.times().is_empty() || entry.estimate.is_some())
        .collect();
    let mut rows = Vec::new();
    for group in with_times.chunk_by(|(a, _), (b, _)| {
        let backend = |entry: &Entry| columns[entry.subject].backend.name();
        a.job.operation == b.job.operation && backend(a) == backend(b)
    }) {
        let backend_entries: Vec<Entry> = group.iter().map(|(entry, _)| (*entry).clone()).collect();
        let agreements = group.iter().map(|(_, agreement)| *agreement).collect();
        let backend_rows = results(&backend_entries, agreements, subjects, polygons, control);
        rows.extend(
            backend_entries
                .iter()
                .zip(backend_rows)
                .map(|(entry, row)| OrderRow {
                    order: columns[entry.subject].order,
                    row,
                }),
        );
    }
    rows
}

fn deduplicated(refusals: Vec<Refusal>) -> Vec<Refusal> {
    let mut kept: Vec<Refusal> = Vec::new();
    for refusal in refusals {
        if !kept.contains(&refusal) {
            kept.push(refusal);
        }
    }
    kept
}

/// Estimates the peak memory of a comparison of orders, in bytes.
///
/// # Errors
///
/// Returns an error if a backend is unknown.
pub fn orders_bytes(study_mesh: &StudyMesh, settings: &Settings) -> Result<u64, StudyError> {
    let counts = study_mesh.polygons.counts(study_mesh.facts.edges);
    let chosen = settings.chosen_backends()?;
    let copies = Order::ALL.len() as u64;
    let bytes = chosen
        .iter()
        .map(|backend| prepared_bytes(backend, &counts));
    let (all, most) = bytes.fold((0, 0), |(all, most): (u64, u64), one| {
        (all + one, most.max(one))
    });
    // Three times the largest structure: the control, and memory for building one structure.
    Ok(copies * (all + draw_bytes(&counts)) + 3 * most)
}

/// Estimates the bytes of a structure and of its outputs.
pub(crate) fn prepared_bytes(backend: &Backend, counts: &Counts) -> u64 {
    /// Bytes of one position.
    const OUTPUTS: u64 = 12;
    let outputs = OUTPUTS * (counts.vertices + counts.faces) as u64;
    (backend.layout_bytes)(counts) as u64 + outputs
}

pub(crate) fn draw_bytes(counts: &Counts) -> u64 {
    let polygons = 12 * counts.vertices + 4 * counts.corners;
    let draw = 4 * (counts.vertices + counts.faces) + 12 * counts.edges;
    (polygons + draw) as u64
}
