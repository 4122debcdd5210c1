//! Measures spatial indices on one mesh: building them, and searching neighbours in space.
//!
//! All indices give the same answers. They differ in the time to build and the time of a query. A
//! program that asks few questions should not build a large index. The lab therefore also computes
//! which index takes the least time in total, for each number of queries.

mod cheapest;
mod index;
mod queries;
mod sentences;
mod tasks;

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use sixfold::UnknownName;
use sixfold::spatial::SpatialError;
use sixfold_workload::pages::Policy;
use sixfold_workload::{ElementSample, MachineClock, Task, Time, TimedBackend};

pub use cheapest::Cheapest;
pub use queries::QueryPoints;
pub use tasks::SpatialTask;

use crate::engine::agreement::compare_checksums;
use crate::engine::effort::{Budget, Effort};
use crate::engine::heap::CacheState;
use crate::engine::machine::Machine;
use crate::engine::measure::{Entry, Progress};
use crate::engine::ranking::{NO_DIFFERENCE, rank, ratio};
use crate::engine::statistics::Median;
use crate::engine::timer::Timer;
use crate::engine::trial::{Columns, Measured, Trial};
use crate::engine::warnings::machine_warnings;
use crate::inspect::StudyMesh;
use crate::labs::study::StudyError;
use crate::results::figure::{Figure, FigureRow, Status, samples_of};
use crate::results::finding::{Common, LabFinding, Meshes};
use crate::results::read::ReadError;
use crate::results::rows::{Agreement, MeshReport, Samples, Standing, check_samples};
use crate::results::run::{Run, RunSettings};
use cheapest::{Cost, cheapest};
use index::{IndexKind, KINDS, LIST};
use queries::Input;

/// Maximum number of elements that the list visits in one run.
const LIST_VISITS: usize = 4_000_000;

/// What [`neighbours`] measures.
#[derive(Clone, Debug)]
pub struct NeighboursSettings {
    /// The names of the indices; empty for all of `list`, `grid`, `octree`, `kd-tree` and `bvh`.
    pub indices: Vec<String>,
    /// Where the query points are.
    pub points: QueryPoints,
    /// How much is measured.
    pub effort: Effort,
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

/// The times of spatial indices on one mesh.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct NeighboursReport {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hashes of the mesh. In JSON, the finding has the place of the mesh in
    /// `meshes`.
    #[serde(skip)]
    pub mesh: MeshReport,
    /// Where the query points are.
    pub points: QueryPoints,
    /// The number of query points.
    pub queries: usize,
    /// The radius of `vertices_within`, in units of the coordinates.
    pub radius: f64,
    /// The indices and their sizes.
    pub backends: Vec<IndexReport>,
    /// The measured times, sorted by task, then by index.
    pub results: Vec<NeighbourRow>,
    /// For each kind of query, which index takes the least time in total.
    pub cheapest: Vec<CheapestIndices>,
    /// The largest difference of two measurements of the same index, as a ratio of times. `None` if
    /// no index was measured twice.
    pub noise: Option<f64>,
    /// Sentences that describe the results.
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// The times of all samples, including the second measurement of the control.
    pub samples: Vec<Samples>,
    /// True if the measurement was stopped early.
    pub interrupted: bool,
    /// The resolution and the cost of reading the clock.
    pub timer: Timer,
}

/// The size of an index.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct IndexReport {
    /// The name of the index, such as `bvh`.
    pub name: String,
    /// The bytes of the index of the vertices and the index of the triangles, together.
    pub bytes: usize,
}

/// The time of one task on one index.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct NeighbourRow {
    /// The task, such as `nearest_vertex`.
    pub operation: SpatialTask,
    /// The name of the index, such as `bvh`.
    pub backend: String,
    /// The median time of one run on all elements, in nanoseconds.
    pub median_ns: f64,
    /// The smallest time of a sample, in nanoseconds.
    pub min_ns: f64,
    /// The lower end of the 95 % confidence interval of `median_ns`; `None` with fewer than three
    /// samples.
    pub ci_low_ns: Option<f64>,
    /// The upper end of the 95 % confidence interval of `median_ns`.
    pub ci_high_ns: Option<f64>,
    /// The number of elements of one run: vertices, triangles, queries or rays.
    pub elements: u64,
    /// The unit of `elements`.
    pub per: String,
    /// `median_ns` divided by `elements`.
    pub ns_per_element: f64,
    /// The number of queries that were run. `None` if all queries were run, otherwise the time is
    /// scaled to all queries.
    pub sample_size: Option<usize>,
    /// A number computed from all answers.
    pub checksum: Option<f64>,
    /// The comparison of the answers with the answers of another index.
    pub agreement: Agreement,
    /// The comparison of the time with the times of the other indices.
    pub standing: Option<Standing>,
    /// The time divided by the time of the fastest index.
    pub ratio_to_best: Option<f64>,
    /// The lower end of the 95 % confidence interval of `ratio_to_best`.
    pub ratio_ci_low: Option<f64>,
    /// The upper end of the 95 % confidence interval of `ratio_to_best`.
    pub ratio_ci_high: Option<f64>,
    /// The number of samples that count.
    pub samples: usize,
}

/// The indices that take the least time for one kind of query, building included.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct CheapestIndices {
    /// The kind of query.
    pub operation: SpatialTask,
    /// Ranges of the number of queries, in ascending order.
    pub ranges: Vec<Cheapest>,
}

impl NeighboursReport {
    /// Iterates over the results of `task`.
    pub fn rows(&self, task: SpatialTask) -> impl Iterator<Item = &NeighbourRow> {
        self.results.iter().filter(move |row| row.operation == task)
    }
}

impl LabFinding for NeighboursReport {
    fn common(&self) -> Common<'_> {
        Common {
            run: &self.run,
            meshes: std::slice::from_ref(&self.mesh),
            sentences: &self.sentences,
            warnings: &self.warnings,
            interrupted: self.interrupted,
        }
    }

    fn parts_mut(&mut self) -> (&mut Run, Meshes<'_>) {
        (&mut self.run, Meshes::One(&mut self.mesh))
    }

    fn mismatches(&self) -> usize {
        let wrong = |row: &&NeighbourRow| row.agreement == Agreement::Mismatch;
        self.results.iter().filter(wrong).count()
    }

    fn figures(&self) -> Vec<Figure<'_>> {
        let figure = |row| {
            let row: &NeighbourRow = row;
            let name = row.operation.name();
            let mut backends = self.backends.iter();
            let backend = backends.find(|backend| backend.name == row.backend);
            let bytes = backend.map(|backend| backend.bytes);
            let status = match row.sample_size {
                Some(_) => Status::Sampled,
                None => Status::Measured,
            };
            let pair = |low: Option<f64>, high: Option<f64>| low.zip(high).map(<[f64; 2]>::from);
            let figure_row = FigureRow {
                ns: Some(row.median_ns),
                min_ns: Some(row.min_ns),
                interval_ns: pair(row.ci_low_ns, row.ci_high_ns),
                elements: Some(row.elements),
                unit: row.per.clone(),
                ratio_to_best: row.ratio_to_best,
                ratio_interval: pair(row.ratio_ci_low, row.ratio_ci_high),
                standing: row.standing,
                agreement: Some(row.agreement),
                samples: row.samples,
                checksum: row.checksum,
                sample_size: row.sample_size,
                ..FigureRow::new(name.into(), &row.backend, status)
            };
            Figure {
                case: self.points.name().into(),
                samples: samples_of(&self.samples, name, &row.backend),
                noise: self.noise.unwrap_or(1.0),
                ..Figure::new(&self.mesh, bytes, figure_row)
            }
        };
        self.results.iter().map(figure).collect()
    }

    fn check(&self) -> Result<(), ReadError> {
        check_samples(&self.samples)?;
        let is_time = |row: &&NeighbourRow| row.median_ns.is_finite() && row.median_ns >= 0.0;
        match self.results.iter().find(|row| !is_time(row)) {
            None => Ok(()),
            Some(row) => Err(ReadError::Malformed {
                cause: format!("invalid time of {} on {}", row.operation, row.backend),
            }),
        }
    }
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
/// the first queries, and its time is scaled. Setting `stop` to true ends the measurement after the
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
    let clock = machine.clock();
    let budget = Budget::start(settings.effort, clock);
    let chosen = settings.chosen()?;
    let polygons = &study_mesh.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces.into());
    }
    let run = Run::start(RunSettings {
        backends: settings.indices.clone(),
        seed: settings.seed,
        heap: settings.heap,
        ..RunSettings::of_effort(settings.effort)
    });
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
    let mut memory = machine
        .start_memory(settings.heap, CacheState::Warm, needed as u64)
        .map_err(StudyError::from)?;
    let again = |first: usize| {
        build(&chosen[first])
            .ok()
            .filter(|_| chosen[first].name != LIST)
    };
    let mut columns = Columns::new(subjects, Vec::new(), again);
    let timer = Timer::measure(clock);
    let entries = entries(&columns, &input);
    let mut trial = Trial {
        counts,
        skewed: false,
        machine,
        memory: &mut memory,
        effort: budget.left(),
        named: true,
        seed: settings.seed,
        stop,
        progress,
    };
    let measured = trial.run(&mut columns, entries);
    let samples = measured.samples(&columns);
    let Measured {
        entries,
        second,
        interrupted,
        ..
    } = measured;
    let control = columns.control;
    let subjects = &mut columns.subjects;
    let agreements = compare_checksums(&entries, subjects, polygons, clock, stop);
    let noise = |task| difference(control?[0], &entries, &second, task);
    let results = results(&entries, &agreements, subjects, noise);
    let run = run.with_memory(&memory);
    let mut report = NeighboursReport {
        warnings: machine_warnings(&run),
        run,
        mesh: study_mesh.report(),
        points: settings.points,
        queries: input.points.len(),
        radius: input.radius,
        backends,
        cheapest: cheapest_indices(&results),
        results,
        noise: SpatialTask::ALL
            .into_iter()
            .filter_map(noise)
            .reduce(f64::max),
        sentences: Vec::new(),
        samples,
        interrupted,
        timer: timer.with_entries(&entries),
    };
    report.sentences = sentences::sentences(&report);
    Ok(report)
}

/// Returns an entry for each task on each index. The list gets a sample of the queries if it would
/// visit too many elements.
fn entries(columns: &Columns<'_>, input: &Input) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (part, task) in SpatialTask::ALL.into_iter().enumerate() {
        for (subject, index) in columns.subjects.iter().enumerate() {
            let mut entry = Entry::of_task(subject, Task::Part(part), task.name());
            entry.pauses_clock = task.build().is_none();
            if index.name() == LIST {
                let items = match task.build() {
                    Some(SpatialTask::BuildVertices) => input.vertices.len(),
                    Some(_) => input.triangles.len(),
                    None => 0,
                };
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

/// Returns the longer time of the two measurements of the index `first`, divided by the shorter
/// time.
fn difference(first: usize, entries: &[Entry], second: &[Entry], task: SpatialTask) -> Option<f64> {
    let of_task = |entry: &&Entry| entry.name == task.name();
    let once = entries
        .iter()
        .filter(of_task)
        .find(|entry| entry.subject == first)?;
    let again = second.iter().find(of_task)?;
    let ratio = ratio(&again.times(), &once.times())?.value;
    (ratio.is_finite() && ratio > 0.0).then(|| ratio.max(ratio.recip()))
}

/// Returns a row for each entry with a time. Indices with wrong answers are not ranked.
fn results(
    entries: &[Entry],
    agreements: &[Agreement],
    subjects: &[Box<dyn TimedBackend + '_>],
    noise: impl Fn(SpatialTask) -> Option<f64>,
) -> Vec<NeighbourRow> {
    let mut rows = Vec::new();
    let mut agreements = agreements.iter().copied();
    let groups = entries.chunk_by(|a, b| a.job.task == b.job.task);
    for (group, task) in groups.zip(SpatialTask::ALL) {
        let agreements: Vec<Agreement> = agreements.by_ref().take(group.len()).collect();
        let times: Vec<Vec<(u32, Time)>> = group.iter().map(Entry::times).collect();
        let right = times.iter().zip(&agreements);
        let right = right.map(|(times, agreement)| match agreement {
            Agreement::Mismatch => Vec::new(),
            _ => times.clone(),
        });
        let ranks = rank(
            &right.collect::<Vec<_>>(),
            noise(task).unwrap_or(1.0).max(NO_DIFFERENCE),
        );
        for (((entry, times), rank), agreement) in
            group.iter().zip(&times).zip(ranks).zip(agreements)
        {
            let median = Median::from_samples(times.iter().map(|(_, time)| time.ns()));
            // An entry has no times if the measurement was stopped before.
            let (Some(median), Some(outcome)) = (median, entry.outcome) else {
                continue;
            };
            let ratio = rank.and_then(|rank| rank.ratio.interval);
            rows.push(NeighbourRow {
                operation: task,
                backend: subjects[entry.subject].name().to_owned(),
                median_ns: median.value,
                min_ns: median.least,
                ci_low_ns: median.interval.map(|[low, _]| low),
                ci_high_ns: median.interval.map(|[_, high]| high),
                elements: outcome.elements,
                per: task.unit().to_owned(),
                ns_per_element: median.value / outcome.elements.max(1) as f64,
                sample_size: entry.job.sample.map(|sample| sample.size),
                checksum: Some(outcome.checksum),
                agreement,
                standing: rank.map(|rank| rank.standing),
                ratio_to_best: rank.map(|rank| rank.ratio.value),
                ratio_ci_low: ratio.map(|[low, _]| low),
                ratio_ci_high: ratio.map(|[_, high]| high),
                samples: times.len(),
            });
        }
    }
    rows
}

/// Returns for each kind of query which index takes the least time, building included.
fn cheapest_indices(results: &[NeighbourRow]) -> Vec<CheapestIndices> {
    let queries = SpatialTask::ALL.into_iter();
    let queries = queries.filter_map(|query| Some((query, query.build()?)));
    let ranges = queries.map(|(query, build)| {
        let costs = results.iter().filter(|row| row.operation == query);
        let costs = costs.filter_map(|row| {
            let mut builds = results.iter().filter(|other| other.operation == build);
            let build = builds.find(|other| other.backend == row.backend)?;
            Some(Cost {
                index: &row.backend,
                build_ns: build.median_ns,
                query_ns: row.ns_per_element,
            })
        });
        CheapestIndices {
            operation: query,
            ranges: cheapest(&costs.collect::<Vec<_>>()),
        }
    });
    ranges.collect()
}

#[cfg(test)]
mod tests;
