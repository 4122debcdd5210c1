//! Measures one mesh with its elements in several orders, on every structure.
//!
//! The order of the elements changes only the addresses of the elements in memory. The times of one
//! structure in two orders therefore differ only because of caches and prefetchers. The effect of
//! the order can be larger than the effect of the structure. A study of one file cannot show the
//! effect of the order, because a file has only one order. If an operation is run on only some of
//! the elements, the same elements are used in all orders. Checksums of different orders can
//! therefore be compared.

mod effects;
mod meshes;
mod sentences;

use std::sync::atomic::AtomicBool;

use sixfold::shapes::Order;
use sixfold_core::Counts;

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::Budget;
use crate::engine::machine::Machine;
use crate::engine::measure::Progress;
use crate::engine::warnings::warnings;
use sixfold_measure::launches::{pool_runs, pool_timers};
use sixfold_measure::{MachineClock, Operation, StudyMesh, TimedBackend, is_skewed};

use crate::labs::study::{Settings, StudyError, prepare, scans};
use crate::refusal::BuildInput;
use effects::{OrderTime, Values, comparison};
use meshes::OrderedMeshes;
use sixfold_results::launches::{LaunchRows, pool_rows};
use sixfold_results::{Comparison, OrdersReport, Refusal, ResultRow, Samples, noise};
use sixfold_workload::Backend;

/// Names of the operations that [`orders`] measures if the settings name no operations.
pub const DEFAULT_OPERATIONS: [&str; 6] = [
    "vertex_vertices",
    "vertex_faces",
    "edge_faces",
    "face_vertices",
    "vertex_normal",
    "ff_bfs",
];

/// Returns the requested operations. If none is requested, returns [`DEFAULT_OPERATIONS`].
pub(crate) fn chosen_operations(settings: &Settings) -> Vec<Operation> {
    let requested = |operation: &Operation| match settings.operations.is_empty() {
        true => DEFAULT_OPERATIONS.contains(&operation.name()),
        false => settings.operations.contains(operation),
    };
    Operation::ALL.into_iter().filter(requested).collect()
}

/// Measures the mesh in every element order on every requested backend. If `settings` name no
/// operations, [`DEFAULT_OPERATIONS`] are measured.
///
/// Setting `stop` to true ends the measurement after the current sample, with a report of the
/// finished part.
///
/// The heap policy of `settings` applies to the whole process until the function returns; see
/// [`pages`](crate::pages#effect-on-the-process).
///
/// # Errors
///
/// Returns an error if the name of a backend is unknown or not unique, if the mesh has no faces, or
/// if no requested backend can hold the mesh.
/// Also returns an error if another heap policy is active in this process.
pub fn orders(
    study_mesh: &StudyMesh,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<OrdersReport, StudyError> {
    orders_on(&MachineClock::start(), study_mesh, settings, stop, progress)
}

/// Does what [`orders`] does, on `machine`.
pub(crate) fn orders_on(
    machine: &dyn Machine,
    study_mesh: &StudyMesh,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<OrdersReport, StudyError> {
    let budget = Budget::start(settings.effort, machine.clock());
    let chosen = settings.chosen_backends()?;
    let operations = chosen_operations(settings);
    let polygons = &study_mesh.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces);
    }
    let counts = polygons.counts(study_mesh.facts.edges);
    let needed = orders_bytes(study_mesh, settings)?;
    let mut bench = Bench::start(machine, settings.run_settings(), needed, stop)?;
    let skewed = is_skewed(&study_mesh.facts);
    let needs_draw = chosen.iter().any(|b| skewed || scans(b, &operations));
    let meshes = OrderedMeshes::new(polygons, settings.seed, needs_draw);

    let mut backends = Vec::new();
    let mut subjects: Vec<Box<dyn TimedBackend + '_>> = Vec::new();
    let mut columns: Vec<Column> = Vec::new();
    let inputs: Vec<_> = meshes
        .iter()
        .map(|(order, mesh, draw)| (order, BuildInput::new(mesh, study_mesh.facts.edges), draw))
        .collect();
    for backend in &chosen {
        for &(order, ref input, draw) in &inputs {
            let (report, subject) = prepare(backend, input, draw);
            if order == Order::Given {
                backends.push(report);
            }
            let Some(subject) = subject else { break };
            subjects.push(machine.host(subject, &counts));
            columns.push(Column {
                backend: *backend,
                order,
            });
        }
    }
    if subjects.is_empty() {
        return Err(StudyError::none_holds(backends));
    }
    // The control is a structure in the given order, which comes first.
    let built = Columns::new(subjects, Vec::new(), |first| {
        let (_, mesh, draw) = meshes.iter().next()?;
        let (subject, _) = columns[first].backend.prepare(mesh, draw).ok()?;
        Some(machine.host(subject, &counts))
    });
    if let Some([first, _]) = built.control {
        columns.push(columns[first]);
    }
    let mut entries = built.entries(&operations);
    for entry in &mut entries {
        entry.case = columns[entry.subject].order.name();
    }
    let trial = Trial {
        polygons,
        counts,
        skewed,
        entries,
        columns: built,
        effort: budget.left(),
        named: !settings.operations.is_empty(),
        forced: settings.force,
        untimed: None,
        seed: settings.seed,
    };
    // One correction for all orders of all structures, so that all their times can be compared.
    let measured = bench.measure(trial, progress);
    // A row is compared with the other orders of its structure.
    let results = measured.rows_by(|entry| columns[entry.subject].backend.name());
    let control = measured.control.as_ref();
    let timed = |operation: Operation| {
        let all = measured.entries.iter().zip(&measured.times);
        let of_it = all.filter(|(entry, _)| entry.operation() == Some(operation));
        let timed = of_it.map(|(entry, &ns)| OrderTime {
            backend: columns[entry.subject].backend.name(),
            order: columns[entry.subject].order,
            scans: operation.scans(&columns[entry.subject].backend.info.costs) != [false; 3],
            values: Values::Rounds(entry.times()),
            ns,
        });
        let timed: Vec<OrderTime<'_>> = timed.collect();
        let noise = noise(control, operation.name());
        comparison(operation, &timed, noise, settings.confidence)
    };
    let comparisons: Vec<Comparison> = operations.into_iter().map(timed).collect();
    let timer = bench.timer(measured.shortest_ns());
    let mut report = OrdersReport {
        run: bench.run(),
        mesh: study_mesh.report(),
        orders: Order::ALL.map(|order| order.to_string()).into(),
        backends,
        sentences: Vec::new(),
        warnings: Vec::new(),
        samples: measured.samples(),
        results,
        refusals: deduplicated(measured.refusals()),
        comparisons,
        interrupted: measured.interrupted,
        control: measured.control,
        timer,
    };
    conclude(&mut report);
    Ok(report)
}

/// Adds the sentences and the warnings.
fn conclude(report: &mut OrdersReport) {
    let control = report.control.as_ref();
    report.sentences = sentences::sentences(&report.results, &report.comparisons, control);
    report.warnings = sentences::mismatches(&report.results).collect();
    let rows: Vec<&ResultRow> = report.results.iter().collect();
    let samples: Vec<&Samples> = report.samples.iter().collect();
    let measured = warnings(&report.run, &report.timer, &rows, &samples, control);
    report.warnings.extend(measured);
}

/// Pools the orders of one mesh, measured in several launches.
pub(crate) fn pool_orders(mut launches: Vec<OrdersReport>) -> OrdersReport {
    if launches.len() == 1 {
        return launches.remove(0);
    }
    let rows: Vec<LaunchRows<'_>> = launches.iter().map(OrdersReport::launch_rows).collect();
    // A row is compared with the other orders of its structure.
    let confidence = launches[0].run.settings.confidence;
    let pooled = pool_rows(&rows, confidence, |row| {
        (row.operation.clone(), row.backend.clone())
    });
    let structures = Backend::structures();
    let compared = |operation: Operation| {
        let of_it = pooled
            .results
            .iter()
            .filter(|row| row.operation == operation.name());
        let timed = of_it.filter_map(|row| {
            let structure = structures.iter().find(|known| known.name() == row.backend);
            Some(OrderTime {
                backend: &row.backend,
                order: row.case.parse().ok()?,
                scans: structure.is_some_and(|s| operation.scans(&s.info.costs) != [false; 3]),
                values: Values::Launches(&row.launch_ns),
                ns: row.median_ns,
            })
        });
        let mut timed: Vec<OrderTime<'_>> = timed.collect();
        // Those of one structure are adjacent.
        timed.sort_by_key(|time| structures.iter().position(|s| s.name() == time.backend));
        let noise = noise(pooled.control.as_ref(), operation.name());
        comparison(operation, &timed, noise, confidence)
    };
    let known = launches[0].comparisons.iter();
    let operations = known.filter_map(|known| known.operation.parse().ok());
    let comparisons: Vec<Comparison> = operations.map(compared).collect();
    let timers = launches.iter().map(|launch| launch.timer);
    let first = &launches[0];
    let mut report = OrdersReport {
        run: pool_runs(launches.iter().map(|launch| &launch.run)),
        timer: pool_timers(timers).unwrap_or(first.timer),
        interrupted: launches.iter().any(|launch| launch.interrupted),
        comparisons,
        results: pooled.results,
        refusals: pooled.refusals,
        samples: pooled.samples,
        control: pooled.control,
        ..first.clone()
    };
    conclude(&mut report);
    report
}

#[derive(Clone, Copy)]
struct Column {
    backend: Backend,
    order: Order,
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

/// Estimates the peak memory of [`orders`] with these settings, in bytes.
///
/// # Errors
///
/// Returns an error if the name of a backend is unknown or not unique.
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

#[cfg(test)]
mod tests;
