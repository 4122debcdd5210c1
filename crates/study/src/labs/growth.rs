//! Measures how the time of an operation grows with the size of the mesh.
//!
//! One shape is built with several numbers of faces. The ratio of two successive numbers of faces
//! is constant. At each size, all structures are measured in rounds, as in a study. A straight line
//! is fitted to the logarithms of the number of faces and of the time. The slope of the line is the
//! exponent of the growth. The exponent is 1 if the time per element is constant. The exponent is 2
//! if each element needs a scan of all faces.
//!
//! The time per element also depends on the processor caches. A second line is therefore fitted to
//! the sizes at which the structure fits into the last-level cache. A third line is fitted to the
//! sizes at which the structure is larger than the last-level cache.

mod budgets;
mod fits;
mod sentences;
mod settings;
mod shapes;

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_core::Counts;

pub use settings::{GrowthError, GrowthSettings, growth_bytes, growth_plan};
pub use shapes::{SCALABLE_SHAPES, ScalableShape};

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::Effort;
use crate::engine::machine::Machine;
use crate::engine::measure::Progress;
use crate::engine::warnings::warnings;
use crate::labs::study::{StudyError, prepare, scans};
use crate::refusal::BuildInput;
use budgets::SizeBudgets;
use fits::{cache_limits, fits};
use settings::Plan;
use sixfold_measure::launches::{pool_runs, pool_timers};
use sixfold_measure::{MachineClock, Operation, StudyMesh, TimedBackend, caches, is_skewed};
use sixfold_results::launches::{LaunchRows, pool_rows};
use sixfold_results::{
    BackendBytes, BackendRefusal, Cache, CacheLimit, Fit, GrowthReport, MeshReport, ResultRow,
    Samples, SizeReport, last_level_bytes,
};
use sixfold_workload::{Backend, Draw};

/// Measures a shape in several sizes, within the time budget of `settings`. A size is left out if
/// the structures of this size cannot be built in the remaining time.
///
/// Setting `stop` to true ends the measurement early, with a report of the finished sizes.
///
/// The heap policy of `settings` applies to the whole process until the function returns; see
/// [`pages`](crate::pages#effect-on-the-process).
///
/// # Errors
///
/// Returns an error if the settings are invalid or if no requested backend can hold the shape.
/// Also returns an error if another heap policy is active in this process.
pub fn growth(
    settings: &GrowthSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<GrowthReport, GrowthError> {
    growth_on(&MachineClock::start(), settings, stop, progress)
}

/// Does what [`growth`] does, on `machine`.
pub(crate) fn growth_on(
    machine: &dyn Machine,
    settings: &GrowthSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<GrowthReport, GrowthError> {
    let plan = settings.plan()?;
    let caches = caches();
    let clock = machine.clock();
    let study = &settings.study;
    let needed = growth_bytes(settings)?;
    let bench =
        Bench::start(machine, study.run_settings(), needed, stop).map_err(StudyError::from)?;
    let mut sweep = Sweep {
        settings,
        plan: &plan,
        caches: &caches,
        bench,
        refused_by: Vec::new(),
        counts: None,
        shortest_ns: None,
    };
    let time = SizeBudgets::new(&plan.sizes, study.effort, clock);
    let mut sizes: Vec<SizeReport> = Vec::new();
    let mut meshes = Vec::new();
    let mut left_out = Vec::new();
    // Time per face for building everything at the previous size, in nanoseconds.
    let mut building = 0.0;
    for (step, &faces) in plan.sizes.iter().enumerate() {
        if building * faces as f64 > time.left().limit_ns() {
            left_out = plan.sizes[step..].to_vec();
            break;
        }
        let start = clock.now().wall_ns;
        let built = Cell::new(0.0);
        let made = plan.shape.make(faces)?;
        let mesh = settings.order.apply(&made, settings.order_seed);
        drop(made);
        let mesh = StudyMesh::new(settings.shape.clone(), mesh);
        let range = time.range(step);
        let effort = || {
            built.set(clock.now().wall_ns - start);
            time.effort(step)
        };
        let mut report_progress = |at: Progress<'_>| {
            let stage = format!("{} faces: {}", mesh.facts.faces, at.stage);
            progress(Progress {
                done: range[0] + (range[1] - range[0]) * at.done,
                stage: &stage,
                ..at
            });
        };
        match sweep.size(&mesh, step, &effort, &mut report_progress)? {
            Some((size, mesh)) => {
                sizes.push(size);
                meshes.push(mesh);
            }
            None => break,
        }
        building = built.get() / faces as f64;
    }
    let interrupted = stop.load(Ordering::Relaxed);
    let backends: Vec<&Backend> = plan
        .backends
        .iter()
        .filter(|b| {
            sweep
                .refused_by
                .iter()
                .all(|other| other.backend != b.name())
        })
        .collect();
    let cache_limits = sweep
        .counts
        .map_or_else(Vec::new, |counts| cache_limits(&backends, &counts, &caches));
    let run = sweep.bench.run();
    let timer = sweep.bench.timer(sweep.shortest_ns);
    let mut report = GrowthReport {
        run,
        meshes,
        shape: settings.shape.clone(),
        order: settings.order.to_string(),
        backends: backends.iter().map(|b| b.name().to_owned()).collect(),
        refused_by: sweep.refused_by,
        sizes,
        left_out,
        fits: Vec::new(),
        cache_limits,
        caches,
        sentences: Vec::new(),
        warnings: Vec::new(),
        interrupted,
        timer,
    };
    conclude(&mut report, &backends, &plan.operations);
    Ok(report)
}

/// Adds the fitted lines, the sentences and the warnings.
fn conclude(report: &mut GrowthReport, backends: &[&Backend], operations: &[Operation]) {
    let GrowthReport { sizes, caches, .. } = &*report;
    let fits = fits(sizes, backends, operations, last_level_bytes(caches));
    let mut sentences = sentences::sentences(sizes, &fits, caches, &report.cache_limits);
    sentences.extend(sentences::left_out(&report.left_out));
    let rows: Vec<&ResultRow> = sizes.iter().flat_map(|size| &size.results).collect();
    let noisiest = sizes.iter().filter_map(|size| size.control.as_ref());
    let noisiest = noisiest.max_by(|a, b| a.typical.total_cmp(&b.typical));
    let samples: Vec<&Samples> = sizes.iter().flat_map(|size| &size.samples).collect();
    let warnings = warnings(&report.run, &report.timer, &rows, &samples, noisiest);
    (report.fits, report.sentences, report.warnings) = (fits, sentences, warnings);
}

/// Pools the sizes of one shape, measured in several launches. A size that some launches did not reach has the times of
/// the others.
pub(crate) fn pool_growth(mut launches: Vec<GrowthReport>) -> GrowthReport {
    if launches.len() == 1 {
        return launches.remove(0);
    }
    let farthest = launches.iter().max_by_key(|launch| launch.sizes.len());
    let Some(farthest) = farthest.cloned() else {
        return launches.remove(0);
    };
    let sizes = farthest.sizes.iter().map(|size| {
        let same = |other: &&SizeReport| other.faces == size.faces;
        let of_each = launches
            .iter()
            .filter_map(|launch| launch.sizes.iter().find(same));
        let rows: Vec<LaunchRows<'_>> = of_each.map(SizeReport::launch_rows).collect();
        let confidence = farthest.run.settings.confidence;
        let pooled = pool_rows(&rows, confidence, |row| row.operation.clone());
        SizeReport {
            results: pooled.results,
            refusals: pooled.refusals,
            samples: pooled.samples,
            control: pooled.control,
            ..size.clone()
        }
    });
    let sizes: Vec<SizeReport> = sizes.collect();
    let structures = Backend::structures();
    let backends = farthest.backends.iter().filter_map(|name| {
        let mut structures = structures.iter();
        structures.find(|structure| structure.name() == name)
    });
    let backends: Vec<&Backend> = backends.collect();
    let is_measured = |operation: &Operation| {
        let mut rows = sizes.iter().flat_map(|size| &size.results);
        rows.any(|row| row.operation == operation.name())
    };
    let operations: Vec<Operation> = Operation::ALL.into_iter().filter(is_measured).collect();
    let timers = launches.iter().map(|launch| launch.timer);
    let mut report = GrowthReport {
        run: pool_runs(launches.iter().map(|launch| &launch.run)),
        timer: pool_timers(timers).unwrap_or(farthest.timer),
        interrupted: launches.iter().any(|launch| launch.interrupted),
        sizes,
        ..farthest
    };
    conclude(&mut report, &backends, &operations);
    report
}

struct Sweep<'s> {
    settings: &'s GrowthSettings,
    plan: &'s Plan,
    caches: &'s [Cache],
    bench: Bench<'s>,
    refused_by: Vec<BackendRefusal>,
    /// Counts of the largest finished size.
    counts: Option<Counts>,
    /// The shortest timed sample, in nanoseconds.
    shortest_ns: Option<f64>,
}

impl Sweep<'_> {
    /// Measures one size. Returns its results and its mesh; `None` if interrupted.
    fn size(
        &mut self,
        study_mesh: &StudyMesh,
        step: usize,
        effort: &dyn Fn() -> Effort,
        progress: &mut dyn FnMut(Progress<'_>),
    ) -> Result<Option<(SizeReport, MeshReport)>, GrowthError> {
        let Plan {
            backends,
            operations,
            ..
        } = self.plan;
        let machine = self.bench.machine;
        let (mesh, facts) = (&study_mesh.polygons, &study_mesh.facts);
        let counts = mesh.counts(facts.edges);
        let skewed = is_skewed(facts);
        let seed = self.settings.study.seed;
        let needs_draw = backends.iter().any(|b| skewed || scans(b, operations));
        let draw = needs_draw.then(|| Draw::new(mesh, seed));
        let input = BuildInput::with_facts(mesh, facts);
        let mut subjects: Vec<Box<dyn TimedBackend + '_>> = Vec::new();
        let (mut backend_bytes, mut refused_by) = (Vec::new(), Vec::new());
        for backend in backends {
            if self.bench.stopped() {
                return Ok(None);
            }
            let (report, subject) = prepare(backend, &input, draw.as_ref());
            match subject {
                Some(subject) => {
                    backend_bytes
                        .push(self.bytes_with_cache(report.name, report.bytes.unwrap_or(0)));
                    subjects.push(machine.host(subject, &counts));
                }
                None => refused_by.push(report.into()),
            }
        }
        if subjects.is_empty() {
            return Err(StudyError::none_holds(refused_by).into());
        }
        self.refused_by = refused_by;
        let names: Vec<String> = subjects.iter().map(|s| s.name().to_owned()).collect();
        let columns = Columns::new(subjects, Vec::new(), |first| {
            let backend = backends.iter().find(|b| b.name() == names[first])?;
            let (subject, _) = backend.prepare(mesh, draw.as_ref()).ok()?;
            Some(machine.host(subject, &counts))
        });
        let trial = Trial {
            polygons: mesh,
            counts,
            skewed,
            entries: columns.entries(operations),
            columns,
            effort: effort(),
            named: !self.settings.study.operations.is_empty(),
            forced: self.settings.study.force,
            untimed: None,
            seed: seed.wrapping_add(step as u64),
        };
        let measured = self.bench.measure(trial, progress);
        if self.bench.stopped() {
            return Ok(None);
        }
        self.counts = Some(counts);
        let shortest = [measured.shortest_ns(), self.shortest_ns]
            .into_iter()
            .flatten();
        self.shortest_ns = shortest.min_by(f64::total_cmp);
        let size = SizeReport {
            vertices: counts.vertices,
            edges: counts.edges,
            faces: counts.faces,
            backend_bytes,
            results: measured.rows(),
            samples: measured.samples(),
            refusals: measured.refusals(),
            control: measured.control,
        };
        Ok(Some((size, study_mesh.report())))
    }

    fn bytes_with_cache(&self, backend: String, bytes: usize) -> BackendBytes {
        let data = self.caches.iter().filter(|cache| cache.holds_data());
        let room = data.filter(|cache| cache.bytes >= bytes as u64);
        BackendBytes {
            backend,
            bytes,
            fits_in: room.map(|cache| cache.level).min(),
        }
    }
}

#[cfg(test)]
mod tests;
