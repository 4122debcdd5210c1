//! Measures spatial indices on one mesh: building them, and searching neighbours in space.
//!
//! All indices give the same answers. They differ in the time to build and the time of a query. A
//! program that asks few questions should not build a large index. The lab therefore also computes
//! which index takes the least time in total, for each number of queries.

mod cheapest;
mod sentences;

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::UnknownName;
use sixfold::spatial::SpatialError;
use sixfold_measure::{ElementSample, MachineClock, StudyMesh, Task, TimedBackend};
use sixfold_results::launches::{LaunchRows, pool_rows};
use sixfold_results::ranking::NO_DIFFERENCE;
use sixfold_results::{
    CheapestIndices, Confidence, IndexReport, NeighboursReport, Policy, QueryPoints, ResultRow,
    RunSettings, SpatialTask, noise,
};
use sixfold_workload::spatial::{IndexKind, Input, KINDS, LIST};

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::engine::measure::{Entry, Progress};
use crate::engine::warnings::machine_warnings;
use crate::labs::study::StudyError;
use cheapest::{Cost, cheapest};
use sixfold_measure::launches::{pool_runs, pool_timers};

/// Maximum number of elements that the list visits in one run.
const LIST_VISITS: usize = 4_000_000;
/// The number of visits of an element that take as long as a query of an index. A query takes some
/// hundred nanoseconds, and longer on a large mesh.
const VISITS_PER_QUERY: f64 = 50.0;

/// What [`neighbours`] measures.
#[derive(Clone, Debug)]
pub struct NeighboursSettings {
    /// The names of the indices; empty for all of `list`, `grid`, `octree`, `kd-tree` and `bvh`.
    pub indices: Vec<String>,
    /// Where the query points are.
    pub points: QueryPoints,
    /// How much is measured.
    pub effort: Effort,
    /// The confidence of all intervals.
    pub confidence: Confidence,
    /// Seed of the random numbers for the query points and the order of the measurements.
    pub seed: u64,
    /// What happens to freed memory pages.
    pub heap: Policy,
}

impl Default for NeighboursSettings {
    fn default() -> Self {
        Self {
            indices: Vec::new(),
            points: QueryPoints::Near,
            effort: Effort::Budget(Duration::from_secs(10)),
            confidence: Confidence::default(),
            seed: 1,
            heap: Policy::Kept,
        }
    }
}

/// The reason why the indices cannot be measured on a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NeighboursError {
    /// The name of an index is unknown, or the mesh has no faces.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A position of the mesh is not finite.
    #[error(transparent)]
    Spatial(#[from] SpatialError),
}

impl NeighboursSettings {
    /// Returns the requested kinds of indices.
    fn chosen(&self) -> Result<Vec<IndexKind>, StudyError> {
        UnknownName::check("index", &self.indices, neighbour_indices())?;
        let is_chosen = |kind: &IndexKind| {
            self.indices.is_empty() || self.indices.iter().any(|n| n == kind.name)
        };
        Ok(KINDS.into_iter().filter(is_chosen).collect())
    }
}

/// Returns the names of all indices that [`neighbours`] measures.
pub fn neighbour_indices() -> [&'static str; 5] {
    KINDS.map(|kind| kind.name)
}

/// Builds the requested spatial indices on the vertices and triangles of the mesh, and measures
/// building and queries.
///
/// The list visits every element for each query. On a large mesh, the list therefore answers only
/// a part of the queries, spread evenly over all of them, and its time is scaled. With a budget, so does an index
/// whose queries take too long, such as a grid that is asked for points far from any vertex. Setting `stop` to true ends the measurement after the
/// current sample, with a report of the finished part.
///
/// The heap policy of `settings` applies to the whole process until the function returns; see
/// [`pages`](crate::pages#effect-on-the-process).
///
/// # Errors
///
/// Returns an error if the name of an index is unknown, if the mesh has no faces, or if a position
/// is not finite.
/// Also returns an error if another heap policy is active in this process.
pub fn neighbours(
    study_mesh: &StudyMesh,
    settings: &NeighboursSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<NeighboursReport, NeighboursError> {
    neighbours_on(&MachineClock::start(), study_mesh, settings, stop, progress)
}

/// Does what [`neighbours`] does, on `machine`.
pub(crate) fn neighbours_on(
    machine: &dyn Machine,
    study_mesh: &StudyMesh,
    settings: &NeighboursSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<NeighboursReport, NeighboursError> {
    let budget = Budget::start(settings.effort, machine.clock());
    let chosen = settings.chosen()?;
    let polygons = &study_mesh.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces.into());
    }
    let input = Input::new(polygons, settings.points, settings.seed)?;
    let counts = polygons.counts(study_mesh.facts.edges);
    let build = |kind: &IndexKind| Ok(machine.host(kind.build(&input)?, &counts));
    let subjects: Vec<Box<dyn TimedBackend + '_>> = chosen
        .iter()
        .map(build)
        .collect::<Result<_, SpatialError>>()?;
    let backends = subjects.iter().map(|subject| IndexReport {
        name: subject.name().to_owned(),
        bytes: subject.bytes(),
    });
    let backends: Vec<IndexReport> = backends.collect();
    let needed: usize = backends.iter().map(|index| index.bytes).sum();
    let run_settings = RunSettings {
        backends: settings.indices.clone(),
        confidence: settings.confidence,
        seed: settings.seed,
        heap: settings.heap,
        ..settings.effort.run_settings()
    };
    let mut bench =
        Bench::start(machine, run_settings, needed as u64, stop).map_err(StudyError::from)?;
    let again = |first: usize| {
        build(&chosen[first])
            .ok()
            .filter(|_| chosen[first].name != LIST)
    };
    let columns = Columns::new(subjects, Vec::new(), again);
    let trial = Trial {
        polygons,
        counts,
        skewed: false,
        entries: entries(&columns, &input),
        columns,
        effort: budget.left(),
        named: true,
        forced: false,
        untimed: None,
        seed: settings.seed,
    };
    let measured = bench.measure(trial, progress);
    let (run, results, samples) = (bench.run(), measured.rows(), measured.samples());
    let control = measured.control.as_ref();
    let noise = |task: SpatialTask| noise(control, task.name());
    let mut report = NeighboursReport {
        warnings: machine_warnings(&run, &samples.iter().collect::<Vec<_>>()),
        run,
        mesh: study_mesh.report(),
        points: settings.points,
        queries: input.points.len(),
        radius: input.radius,
        backends,
        cheapest: cheapest_indices(&results, &noise),
        results,
        timer: bench.timer(measured.shortest_ns()),
        control: measured.control,
        sentences: Vec::new(),
        samples,
        interrupted: measured.interrupted,
    };
    report.sentences = sentences::sentences(&report);
    Ok(report)
}

/// Pools the searches on one mesh, measured in several launches.
pub(crate) fn pool_neighbours(mut launches: Vec<NeighboursReport>) -> NeighboursReport {
    if launches.len() == 1 {
        return launches.remove(0);
    }
    let rows: Vec<LaunchRows<'_>> = launches.iter().map(NeighboursReport::launch_rows).collect();
    let confidence = launches[0].run.settings.confidence;
    let pooled = pool_rows(&rows, confidence, |row| row.operation.clone());
    let run = pool_runs(launches.iter().map(|launch| &launch.run));
    let timers = launches.iter().map(|launch| launch.timer);
    let first = &launches[0];
    let mut report = NeighboursReport {
        warnings: machine_warnings(&run, &pooled.samples.iter().collect::<Vec<_>>()),
        run,
        timer: pool_timers(timers).unwrap_or(first.timer),
        // The intervals of the launches decide.
        cheapest: cheapest_indices(&pooled.results, &|_| NO_DIFFERENCE),
        control: pooled.control,
        interrupted: launches.iter().any(|launch| launch.interrupted),
        results: pooled.results,
        samples: pooled.samples,
        ..first.clone()
    };
    report.sentences = sentences::sentences(&report);
    report
}

/// Returns an entry for each task on each index. The list gets a sample of the queries if it would
/// visit too many elements.
fn entries(columns: &Columns<'_>, input: &Input) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (part, task) in SpatialTask::ALL.into_iter().enumerate() {
        for (subject, index) in columns.subjects.iter().enumerate() {
            let mut entry = Entry::of_task(subject, Task::Part(part), task.name());
            entry.pauses_clock = task.build().is_none();
            entry.per = task.unit();
            entry.visits = VISITS_PER_QUERY;
            if !entry.pauses_clock && index.name() != LIST {
                entry.queries = input.points.len();
            }
            if index.name() == LIST {
                let items = match task.build() {
                    Some(SpatialTask::BuildVertices) => input.vertices.len(),
                    Some(_) => input.triangles.len(),
                    None => 0,
                };
                entry.visits = items as f64;
                let size = (LIST_VISITS / items.max(1)).max(1);
                if items > 0 && size < input.points.len() {
                    entry.scans = true;
                    let scanned = [true; 3];
                    entry.job.sample = Some(ElementSample { scanned, size });
                }
            }
            entries.push(entry);
        }
    }
    entries
}

/// Returns for each kind of query which index takes the least time, building included.
fn cheapest_indices(
    results: &[ResultRow],
    noise: &impl Fn(SpatialTask) -> f64,
) -> Vec<CheapestIndices> {
    let queries = SpatialTask::ALL.into_iter();
    let queries = queries.filter_map(|query| Some((query, query.build()?)));
    let ranges = queries.map(|(query, build)| {
        let costs = results.iter().filter(|row| row.operation == query.name());
        let costs = costs.filter_map(|row| {
            let mut builds = results
                .iter()
                .filter(|other| other.operation == build.name());
            let build = builds.find(|other| other.backend == row.backend)?;
            Some(Cost {
                index: &row.backend,
                build_ns: build.median_ns?,
                query_ns: row.ns_per_element?,
                is_fastest: row.is_fastest(),
            })
        });
        CheapestIndices {
            operation: query.to_string(),
            ranges: cheapest(&costs.collect::<Vec<_>>(), noise(query)),
        }
    });
    ranges.collect()
}

#[cfg(test)]
mod tests;
