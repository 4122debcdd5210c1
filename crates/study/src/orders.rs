//! The order lab: one mesh in several orders, on every structure, measured in one interleaved run.
//!
//! An order changes where elements lie in memory, and nothing else, so all that differs between two
//! columns is how well the caches foresee what comes next. That can outweigh the choice of a
//! structure, and a study of one file never shows it: its order is whatever wrote the file.
//! Samples are of the same elements in every order, so that checksums can be compared.

mod effects;
mod meshes;
mod words;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::{Deserialize, Serialize};
use serde_with::{KeyValueMap, serde_as};
use sixfold::shapes::Order;
use sixfold::{Counts, PolygonMesh};

pub use effects::{Comparison, Factor, Larger, OrderEffect, StructureEffect};

use crate::agreement::judge;
use crate::control::{control, entered_twice, noise};
use crate::environment::Environment;
use crate::heap::Memory;
use crate::inspect::Specimen;
use crate::measure::{Bench, Entry, Progress};
use crate::report::{
    Agreement, BackendReport, Control, MeshReport, Refusal, ResultRow, SCHEMA, write_json,
};
use crate::study::{Settings, StudyError, is_skewed, put_on_the_bench, refusals, results, scans};
use effects::Timed;
use meshes::Meshes;
use workload::{Backend, MachineClock, Operation, Subject};

/// What is measured where no operations are named: around vertices, faces and edges, a sum over
/// faces, and a walk through the whole mesh.
pub const FEW_OPERATIONS: [&str; 6] = [
    "vertex_vertices",
    "vertex_faces",
    "edge_faces",
    "face_vertices",
    "vertex_normal",
    "ff_bfs",
];

/// Less is no measurement.
const SHORTEST: Duration = Duration::from_millis(100);

/// Why there are no orders to compare.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum OrdersError {
    /// There is nothing to study.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// There is no time to measure.
    #[error("a budget of {} ms is too short to compare orders: take {} ms or more", .budget.as_millis(), .least.as_millis())]
    BudgetTooSmall { budget: Duration, least: Duration },
}

/// What a comparison of orders finds.
#[serde_as]
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct OrdersReport {
    /// The version of the shape.
    pub schema: u32,
    /// What the mesh is, as given.
    pub mesh: MeshReport,
    /// The orders, as tables show them.
    pub orders: Vec<Order>,
    /// Those asked for, in the order of the roster, built from the mesh as given.
    #[serde_as(as = "KeyValueMap<_>")]
    pub backends: Vec<BackendReport>,
    /// Operation by operation, then structure by structure, then order by order.
    pub results: Vec<OrderRow>,
    /// What was asked for and cannot be done.
    pub refusals: Vec<Refusal>,
    /// How much the order matters, and how much the structure, for each operation.
    pub comparisons: Vec<Comparison>,
    /// One structure in the order given, entered twice.
    pub control: Option<Control>,
    /// What the tables show, in words.
    pub words: Vec<String>,
    /// Told to stop before the end.
    pub interrupted: bool,
    /// The machine and the program.
    pub environment: Environment,
}

/// One operation on one structure in one order.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct OrderRow {
    /// The order.
    pub order: Order,
    /// Its time; `standing` and the ratio to the best are among the orders of this structure.
    #[serde(flatten)]
    pub row: ResultRow,
}

impl OrdersReport {
    /// The rows of `operation`.
    pub fn rows(&self, operation: Operation) -> impl Iterator<Item = &OrderRow> {
        let of_it = move |row: &&OrderRow| row.row.operation == operation;
        self.results.iter().filter(of_it)
    }

    /// Results that no difference between the structures explains.
    pub fn mismatches(&self) -> usize {
        let wrong = |row: &&OrderRow| row.row.agreement == Agreement::Mismatch;
        self.results.iter().filter(wrong).count()
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// The operations asked for, or those few, in the order in which tables show them.
pub(crate) fn chosen_operations(settings: &Settings) -> Vec<Operation> {
    let asked = |operation: &Operation| match settings.operations.is_empty() {
        true => FEW_OPERATIONS.contains(&operation.name()),
        false => settings.operations.contains(operation),
    };
    Operation::ALL.into_iter().filter(asked).collect()
}

/// Measures the mesh in every order on every backend asked for; `settings` as for a study, but that
/// no operations mean the few that show most.
///
/// `stop` ends it early, between two samples; what is finished by then is in the report.
///
/// # Errors
///
/// An unknown backend, a mesh without faces or that no backend asked for can hold, or a budget that
/// leaves no time to measure.
pub fn orders(
    specimen: &Specimen,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<OrdersReport, OrdersError> {
    if settings.budget < SHORTEST {
        return Err(OrdersError::BudgetTooSmall {
            budget: settings.budget,
            least: SHORTEST,
        });
    }
    let chosen = settings.chosen_backends()?;
    let operations = chosen_operations(settings);
    let polygons = &specimen.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces.into());
    }
    let environment = Environment::here(settings.seed, settings.budget.as_secs_f64());
    let counts = polygons.counts(specimen.facts.edges);
    let needed = orders_bytes(specimen, settings)?;
    let mut memory = Memory::start(settings.heap, settings.caches, needed);
    let skewed = is_skewed(&specimen.facts);
    let drawn = chosen.iter().any(|b| skewed || scans(b, &operations));
    let meshes = Meshes::of(polygons, settings.seed, drawn);

    let mut backends = Vec::new();
    let mut subjects: Vec<Box<dyn Subject + '_>> = Vec::new();
    let mut held: Vec<Held> = Vec::new();
    for backend in &chosen {
        for (order, mesh, draw) in meshes.iter() {
            let (report, subject) = put_on_the_bench(backend, mesh, draw, &counts);
            if order == Order::Given {
                backends.push(report);
            }
            let Some(subject) = subject else { break };
            subjects.push(subject);
            held.push(Held {
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
    // Whichever never scans; of its orders the one given comes first.
    let first = entered_twice(&subjects);
    let second = subjects.len();
    let again = meshes.iter().next().and_then(|(_, mesh, draw)| {
        let built = held[first].backend.put_on_the_bench(mesh, draw);
        built.ok()
    });
    subjects.extend(again.map(|(subject, _)| subject));

    let clock = MachineClock::start();
    let mut bench = Bench {
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
    let mut entries = bench.measure(&operations);
    let control = control(&entries, first, second, subjects[first].name());
    entries.retain(|entry| entry.subject != second);
    let interrupted = stop.load(Ordering::Relaxed);
    let mut judged = |entries: &[Entry]| judge(entries, &mut subjects, polygons, &clock, stop);
    let agreements = agreements(&entries, &held, &mut judged);

    let refusals = once_each(refusals(&entries, &subjects));
    let rows = rows(
        &entries,
        &agreements,
        &held,
        &subjects,
        polygons,
        control.as_ref(),
    );
    let timed = |operation: Operation| {
        let of_it = entries.iter().filter(|e| e.job.operation == operation);
        let timed = of_it.map(|entry| Timed {
            backend: held[entry.subject].backend.name(),
            order: held[entry.subject].order,
            scans: operation.scans(&held[entry.subject].backend.info.costs) != [false; 3],
            samples: entry.times(),
        });
        let timed: Vec<Timed> = timed.collect();
        Comparison::of(operation, &timed, noise(control.as_ref(), operation))
    };
    let comparisons: Vec<Comparison> = operations.into_iter().map(timed).collect();
    let words = words::words(&rows, &comparisons, control.as_ref());
    Ok(OrdersReport {
        schema: SCHEMA,
        mesh: specimen.report(),
        orders: Order::ALL.into(),
        backends,
        results: rows,
        refusals,
        comparisons,
        control,
        words,
        interrupted,
        environment: environment.with_memory(&memory),
    })
}

/// What a subject was built as.
struct Held {
    backend: Backend,
    order: Order,
}

/// Whether what it finds depends on the order of the input: it begins at the first face, or edits
/// one element after the other.
fn follows_the_order(operation: Operation) -> bool {
    matches!(operation, Operation::FfBfs | Operation::Editing(_))
}

/// What `judge` says of every entry. All orders are held against each other, but for what follows
/// the order: there, the structures within each.
fn agreements(
    entries: &[Entry],
    held: &[Held],
    judge: &mut dyn FnMut(&[Entry]) -> Vec<Agreement>,
) -> Vec<Agreement> {
    let mut agreements = vec![Agreement::Unchecked; entries.len()];
    let mut judge_those = |takes_part: &dyn Fn(&Entry) -> bool| {
        let those: Vec<usize> = (0..entries.len())
            .filter(|&e| takes_part(&entries[e]))
            .collect();
        let group: Vec<Entry> = those.iter().map(|&e| entries[e].clone()).collect();
        for (e, agreement) in those.into_iter().zip(judge(&group)) {
            agreements[e] = agreement;
        }
    };
    judge_those(&|entry| !follows_the_order(entry.job.operation));
    for order in Order::ALL {
        judge_those(&|entry| {
            follows_the_order(entry.job.operation) && held[entry.subject].order == order
        });
    }
    agreements
}

/// A row for each entry with a figure, compared among the orders of its structure.
fn rows(
    entries: &[Entry],
    agreements: &[Agreement],
    held: &[Held],
    subjects: &[Box<dyn Subject + '_>],
    polygons: &PolygonMesh,
    control: Option<&Control>,
) -> Vec<OrderRow> {
    let figured: Vec<(&Entry, Agreement)> = entries
        .iter()
        .zip(agreements.iter().copied())
        .filter(|(entry, _)| !entry.times().is_empty() || entry.estimate.is_some())
        .collect();
    let mut rows = Vec::new();
    for group in figured.chunk_by(|(a, _), (b, _)| {
        let backend = |entry: &Entry| held[entry.subject].backend.name();
        a.job.operation == b.job.operation && backend(a) == backend(b)
    }) {
        let of_one: Vec<Entry> = group.iter().map(|(entry, _)| (*entry).clone()).collect();
        let agreements = group.iter().map(|(_, agreement)| *agreement).collect();
        let of_one_rows = results(&of_one, agreements, subjects, polygons, control);
        rows.extend(of_one.iter().zip(of_one_rows).map(|(entry, row)| OrderRow {
            order: held[entry.subject].order,
            row,
        }));
    }
    rows
}

/// Every order of a structure is refused alike.
fn once_each(refusals: Vec<Refusal>) -> Vec<Refusal> {
    let mut kept: Vec<Refusal> = Vec::new();
    for refusal in refusals {
        if !kept.contains(&refusal) {
            kept.push(refusal);
        }
    }
    kept
}

/// About how many bytes a comparison of orders holds at its worst moment.
///
/// # Errors
///
/// An unknown backend.
pub fn orders_bytes(specimen: &Specimen, settings: &Settings) -> Result<u64, StudyError> {
    let counts = specimen.polygons.counts(specimen.facts.edges);
    let chosen = settings.chosen_backends()?;
    let copies = Order::ALL.len() as u64;
    let weights = chosen
        .iter()
        .map(|backend| on_the_bench_bytes(backend, &counts));
    let (all, most) = weights.fold((0, 0), |(all, most): (u64, u64), one| {
        (all + one, most.max(one))
    });
    // The control, and what building one takes besides.
    Ok(copies * (all + draw_bytes(&counts)) + 3 * most)
}

/// Bytes of a structure with the outputs of operations beside it.
pub(crate) fn on_the_bench_bytes(backend: &Backend, counts: &Counts) -> u64 {
    /// A position for each vertex and face.
    const OUTPUTS: u64 = 12;
    let outputs = OUTPUTS * (counts.vertices + counts.faces) as u64;
    (backend.layout_bytes)(counts) as u64 + outputs
}

/// Bytes of a mesh as polygons, and of the draw from it.
pub(crate) fn draw_bytes(counts: &Counts) -> u64 {
    let polygons = 12 * counts.vertices + 4 * counts.corners;
    let draw = 4 * (counts.vertices + counts.faces) + 12 * counts.edges;
    (polygons + draw) as u64
}
