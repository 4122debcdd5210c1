//! Picks the fastest backend for a mesh and a workload, and explains the result.
//!
//! A backend qualifies if it can hold the mesh and meets the requirements of the settings. Every
//! backend that qualifies runs the operations of the workload (the mix), in the access order of the
//! workload. The backends take turns in rounds, as in a study. Some rounds also time each operation
//! of the mix alone, to explain the result. If the mix does not change connectivity, relation
//! tables are measured as an additional backend. These tables contain only the relations that the
//! mix queries.

mod backend;
mod needs;
mod prediction;
mod recording;
mod tasks;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_measure::{MachineClock, Operation, StudyMesh};
use sixfold_results::{Confidence, Excluded, Need, PickReport, Policy, RunSettings};
use sixfold_workload::{
    Backend, Draw, EditPlaceError, MixRefusal, Route, Schedule, Workload, prepare_mix, tabulate,
};

pub use prediction::{Predicted, Prediction, predict};
pub use recording::{TraceWorkloadError, workload_of_trace};

use crate::engine::bench::Bench;
use crate::engine::effort::{Budget, Effort};
use crate::engine::machine::Machine;
use crate::labs::study::{Settings, StudyError, needed_bytes};
use crate::refusal::BuildInput;
use backend::{PickBackend, build_tables};
use sixfold_measure::pick::{
    MeasuredBackend as Contestant, MeshOutcome, PickMeasurement, Question, over_memory_limit,
    pooled,
};
use tasks::Tasks;

/// The settings of [`pick`].
#[derive(Clone, Debug, PartialEq)]
pub struct PickSettings {
    /// The workload to run.
    pub workload: Workload,
    /// The names of the backends. If the list is empty, all backends are compared.
    pub backends: Vec<String>,
    /// Additional structures that are not part of Sixfold.
    pub extra: Vec<Backend>,
    /// Capabilities that a backend must have.
    pub needs: Vec<Need>,
    /// The maximum size of a backend, in bytes; `None` for no limit.
    pub max_memory: Option<u64>,
    /// How much is measured. A time limit is for all meshes together.
    pub effort: Effort,
    /// The confidence of all intervals.
    pub confidence: Confidence,
    /// Seed of the random numbers that choose the elements and the order of the measurements.
    pub seed: u64,
    /// What happens to freed memory pages during the measurement.
    pub heap: Policy,
}

impl PickSettings {
    fn chosen_backends(&self) -> Result<Vec<Backend>, StudyError> {
        let settings = Settings {
            backends: self.backends.clone(),
            extra: self.extra.clone(),
            ..Settings::default()
        };
        settings.chosen_backends()
    }

    fn run_settings(&self) -> RunSettings {
        RunSettings {
            backends: self.backends.clone(),
            confidence: self.confidence,
            seed: self.seed,
            heap: self.heap,
            ..self.effort.run_settings()
        }
    }
}

/// The reason why [`pick`] fails.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum PickError {
    /// The mesh has no faces, or the name of a backend is unknown or not unique.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The workload cannot be run on this mesh.
    #[error("{mesh}: {reason}")]
    Impossible {
        mesh: String,
        reason: EditPlaceError,
    },
    /// The list of meshes is empty.
    #[error("the list of meshes is empty: give at least one mesh")]
    NoMesh,
}

/// Runs the workload of `settings` on each of `study_meshes`, and ranks the backends.
///
/// If no backend qualifies, the ranking is empty and `excluded` contains the reasons. Setting
/// `stop` to true ends the measurement after the current sample, with a report of the finished
/// part. `progress` is called with the finished part, from 0 to 1, and the current step.
///
/// The heap policy of `settings` applies to the whole process until the function returns; see
/// [`pages`](crate::pages#effect-on-the-process).
///
/// # Errors
///
/// Returns an error if `study_meshes` is empty, if the name of a backend is unknown or not unique,
/// if a mesh has no faces, or if the workload cannot be run on a mesh.
/// Also returns an error if another heap policy is active in this process.
pub fn pick(
    study_meshes: &[StudyMesh],
    settings: &PickSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(f64, &str),
) -> Result<PickReport, PickError> {
    pick_on(
        &MachineClock::start(),
        study_meshes,
        settings,
        stop,
        progress,
    )
}

/// Does what [`pick`] does, on `machine`.
pub(crate) fn pick_on(
    machine: &dyn Machine,
    study_meshes: &[StudyMesh],
    settings: &PickSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(f64, &str),
) -> Result<PickReport, PickError> {
    if study_meshes.is_empty() {
        return Err(PickError::NoMesh);
    }
    let clock = machine.clock();
    let budget = Budget::start(settings.effort, clock);
    let needed = study_meshes
        .iter()
        .map(|study_mesh| needed(study_mesh, settings));
    let needed = needed.max().unwrap_or(0);
    let mut bench =
        Bench::start(machine, settings.run_settings(), needed, stop).map_err(StudyError::from)?;
    let mut outcomes = Vec::new();
    for (i, study_mesh) in study_meshes.iter().enumerate() {
        if stop.load(Ordering::Relaxed) && i > 0 {
            break;
        }
        let part = |done: f64| (i as f64 + done) / study_meshes.len() as f64;
        let mut progress = |done: f64, what: &str| progress(part(done), what);
        let rest = study_meshes.len() - i;
        let budget = Budget::start(budget.share(1.0, rest as f64), clock);
        outcomes.push(measure_mesh(
            study_mesh,
            settings,
            &mut bench,
            budget,
            &mut progress,
        )?);
    }
    let interrupted = stop.load(Ordering::Relaxed);
    Ok(pooled(
        outcomes,
        Question {
            workload: settings.workload.report(),
            program: None,
            needs: settings.needs.clone(),
            max_memory: settings.max_memory,
            excluded: Vec::new(),
        },
        bench.timer(None),
        bench.run(),
        interrupted,
    ))
}

fn needed(study_mesh: &StudyMesh, settings: &PickSettings) -> u64 {
    let counts = study_mesh.polygons.counts(study_mesh.facts.edges);
    // Unknown names cause an error later.
    let backends = settings.chosen_backends().unwrap_or_default();
    // The factor 2 includes relation tables and the allocations of edits and subdivision.
    2 * needed_bytes(&backends, &Operation::ALL, &counts)
}

/// Returns the backends that qualify, and the excluded backends with the reasons.
fn qualified(
    study_mesh: &StudyMesh,
    settings: &PickSettings,
) -> Result<(Vec<Backend>, Vec<Excluded>), PickError> {
    let polygons = &study_mesh.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces.into());
    }
    let input = BuildInput::from_study_mesh(study_mesh);
    let mut excluded = Vec::new();
    let mut qualified = Vec::new();
    for backend in settings.chosen_backends()? {
        let lacks = settings
            .needs
            .iter()
            .find_map(|need| needs::unmet_reason(*need, &backend));
        let bytes = (backend.layout_bytes)(&input.counts) as u64;
        let large = || over_memory_limit(bytes, settings.max_memory);
        let refused = || {
            let refusal = backend.info.check(polygons).err()?;
            Some(input.reason(&refusal, &backend.info.capabilities))
        };
        let excluded_because = lacks.or_else(large).or_else(refused);
        match excluded_because {
            Some(reason) => excluded.push(Excluded::new(backend.name(), reason)),
            None => qualified.push(backend),
        }
    }
    Ok((qualified, excluded))
}

fn measure_mesh(
    study_mesh: &StudyMesh,
    settings: &PickSettings,
    bench: &mut Bench<'_>,
    budget: Budget<'_>,
    progress: &mut dyn FnMut(f64, &str),
) -> Result<MeshOutcome, PickError> {
    let machine = bench.machine;
    let (qualifying, mut excluded) = qualified(study_mesh, settings)?;
    let polygons = &study_mesh.polygons;
    let counts = polygons.counts(study_mesh.facts.edges);
    let workload = &settings.workload;
    let mut schedule = Schedule::new(workload, &counts);
    schedule.editable |= settings.needs.contains(&Need::Edit);
    let route = Route::new(workload.access, polygons, settings.seed);
    let draw = Draw::new(polygons, settings.seed);
    let impossible = |reason: EditPlaceError| PickError::Impossible {
        mesh: study_mesh.name.clone(),
        reason,
    };
    let set_up = |backend: &Backend| prepare_mix(backend, polygons, &draw, &schedule, &route);

    let mut backends = Vec::new();
    for (i, backend) in qualifying.iter().enumerate() {
        progress(
            0.1 * i as f64 / qualifying.len() as f64,
            &format!("building {}", backend.name()),
        );
        match set_up(backend) {
            Ok(mixer) => backends.push(PickBackend::new(mixer, backend)),
            Err(MixRefusal::EditPlaceError(reason)) => return Err(impossible(reason)),
            Err(refusal) => excluded.push(Excluded::new(backend.name(), refusal.to_string())),
        }
    }
    let most = settings.max_memory;
    let too_large = |name: &str, bytes: usize| {
        let reason = over_memory_limit(bytes as u64, most)?;
        Some(Excluded::new(name, reason))
    };
    backends.retain(|PickBackend { mixer, .. }| {
        let large = too_large(mixer.name(), mixer.bytes());
        let is_small = large.is_none();
        excluded.extend(large);
        is_small
    });
    let again = backends
        .iter()
        .find(|b| !b.scans())
        .and_then(|b| b.structure);
    let again =
        again.and_then(|structure| Some(PickBackend::new(set_up(&structure).ok()?, &structure)));
    let has_control = again.is_some();
    backends.extend(again);
    backend::keep_common_places(&mut backends, &schedule).map_err(impossible)?;
    let structures = backends.iter().filter_map(|b| b.structure);
    let structures: Vec<Backend> = structures.collect();
    let hosted = backends.into_iter().map(|b| b.hosted(machine, &counts));
    let mut backends: Vec<Contestant<'_>> = hosted.collect();
    let control = backends.pop_if(|_| has_control);
    if settings.needs.contains(&Need::Edit) {
        let reason = "its flat tables cannot be edited".into();
        excluded.push(Excluded::new("relation-tables", reason));
    } else {
        progress(0.1, "tabulating");
        let tabulate = |backend: &Backend| tabulate(backend, polygons, &schedule, &route);
        let candidates = backends.iter().map(|(candidate, _)| candidate);
        let structures: Vec<_> = candidates.zip(structures).collect();
        let tables = build_tables(
            &structures,
            polygons,
            counts,
            settings.seed,
            settings.effort,
            bench,
            tabulate,
        );
        if let Some((tables, built)) = tables {
            match too_large(&tables.name, tables.bytes) {
                None => backends.push((tables, built)),
                large => excluded.extend(large),
            }
        }
    }
    let tasks = Tasks::new(workload, &schedule, polygons, &counts);
    let measurement = PickMeasurement {
        study_mesh,
        plan: &tasks,
        seed: settings.seed,
        counts,
        effort: budget.left(),
        bench,
        progress,
    };
    Ok(measurement.run(backends, control, excluded))
}
