//! Picks the fastest backend for a mesh and a workload, with intervals and reasons.
//!
//! Every backend that qualifies runs the mix of the workload in its access order. The backends run
//! in interleaved rounds, as in a study. After the rounds, each part of the mix is timed alone to
//! explain the result. If the mix does not change connectivity, relation tables are measured as one
//! more backend. These tables contain only the relations that the mix queries.

mod backend;
mod break_even;
mod measurement;
mod needs;
mod plan;
mod pooled;
mod reasons;
mod report;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use sixfold_workload::pages::Policy;
use sixfold_workload::{
    Backend, Draw, EditPlaceError, MachineClock, MixRefusal, Operation, Route, Schedule, Workload,
    prepare_mix, tabulate,
};

pub use needs::{Need, UnknownNeed};
pub use report::{BreakEven, Excluded, MeshRanking, PartCost, PickReport, Ranked};

use crate::environment::Environment;
use crate::heap::{CacheState, Memory};
use crate::inspect::StudyMesh;
use crate::study::{Settings, StudyError, needed_bytes};
use crate::timer::Timer;
use backend::PickBackend;
use measurement::PickMeasurement;

/// The input of [`pick`].
#[derive(Clone, Debug, PartialEq)]
pub struct PickSettings {
    /// The workload of the program.
    pub workload: Workload,
    /// The names of the backends. If the list is empty, all backends are compared.
    pub backends: Vec<String>,
    /// Additional structures that are not part of Sixfold.
    pub extra: Vec<Backend>,
    /// Capabilities that the structure must have.
    pub needs: Vec<Need>,
    /// The maximum size of the structure, in bytes.
    pub max_memory: Option<u64>,
    /// Time limit of the measurement of all meshes together.
    pub budget: Duration,
    /// Seed of the routes and of the measurement order.
    pub seed: u64,
    /// The policy for freed pages.
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
}

/// The reason why [`pick`] fails.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum PickError {
    /// The mesh has no faces or a name is unknown.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The workload cannot be run on this mesh.
    #[error("{mesh}: {reason}")]
    Impossible {
        mesh: String,
        reason: EditPlaceError,
    },
    /// The budget is too short for three rounds. `needed_ms` is the budget for all meshes, rounded
    /// up.
    #[error(
        "{mesh}: a budget of {} ms is too small to measure anything, because three rounds take \
         longer: use --budget {needed_ms}ms or more", .budget.as_millis()
    )]
    BudgetTooSmall {
        mesh: String,
        budget: Duration,
        needed_ms: u64,
    },
    /// The list of meshes is empty.
    #[error("the list of meshes is empty: give at least one mesh")]
    NoMesh,
}

/// Runs the workload of `settings` on each of `study_meshes`, and ranks the backends.
///
/// If no backend qualifies, the ranking is empty and `excluded` has the reasons. Setting `stop`
/// ends the measurement after the current sample. The report then contains the finished part.
/// `progress` is called with the finished part, from 0 to 1, and the current step.
///
/// # Errors
///
/// Returns an error if a name is unknown, if a mesh has no faces, if the workload cannot be run on
/// a mesh, or if the budget is too small.
pub fn pick(
    study_meshes: &[StudyMesh],
    settings: &PickSettings,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(f64, &str),
) -> Result<PickReport, PickError> {
    if study_meshes.is_empty() {
        return Err(PickError::NoMesh);
    }
    let environment = Environment::detect(settings.seed, settings.budget.as_secs_f64());
    let needed = study_meshes
        .iter()
        .map(|study_mesh| needed(study_mesh, settings));
    let mut memory = Memory::start(settings.heap, CacheState::Warm, needed.max().unwrap_or(0));
    let clock = MachineClock::start();
    let timer = Timer::measure(&clock);
    let budget = settings.budget / study_meshes.len() as u32;
    let mut outcomes = Vec::new();
    for (i, study_mesh) in study_meshes.iter().enumerate() {
        if stop.load(Ordering::Relaxed) && i > 0 {
            break;
        }
        let part = |done: f64| (i as f64 + done) / study_meshes.len() as f64;
        let mut progress = |done: f64, what: &str| progress(part(done), what);
        let context = MeasureContext {
            budget,
            clock: &clock,
            memory: &mut memory,
            stop,
            progress: &mut progress,
        };
        let outcome = measure_mesh(study_mesh, settings, context);
        outcomes
            .push(outcome.map_err(|error| for_all_meshes(error, settings, study_meshes.len()))?);
    }
    let interrupted = stop.load(Ordering::Relaxed);
    Ok(pooled::pooled(
        outcomes,
        settings,
        timer,
        environment.with_memory(&memory),
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

pub(crate) struct MeasureContext<'m> {
    budget: Duration,
    clock: &'m MachineClock,
    memory: &'m mut Memory,
    stop: &'m AtomicBool,
    progress: &'m mut dyn FnMut(f64, &str),
}

/// Converts the budget in an error from one mesh to all meshes.
fn for_all_meshes(error: PickError, settings: &PickSettings, meshes: usize) -> PickError {
    match error {
        PickError::BudgetTooSmall {
            mesh, needed_ms, ..
        } => PickError::BudgetTooSmall {
            mesh,
            budget: settings.budget,
            needed_ms: needed_ms.saturating_mul(meshes as u64),
        },
        other => other,
    }
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
    let counts = polygons.counts(study_mesh.facts.edges);
    let mut excluded = Vec::new();
    let mut qualified = Vec::new();
    for backend in settings.chosen_backends()? {
        let lacks = settings
            .needs
            .iter()
            .find_map(|need| need.unmet_reason(&backend));
        let bytes = (backend.layout_bytes)(&counts) as u64;
        let reason = match (lacks, settings.max_memory) {
            (Some(lacks), _) => Some(lacks),
            (None, Some(most)) if bytes > most => Some(report::over_memory_limit(bytes, most)),
            _ => backend
                .info
                .check(polygons)
                .err()
                .map(|refusal| refusal.to_string()),
        };
        match reason {
            Some(reason) => excluded.push(Excluded::new(backend.name(), reason)),
            None => qualified.push(backend),
        }
    }
    Ok((qualified, excluded))
}

fn measure_mesh(
    study_mesh: &StudyMesh,
    settings: &PickSettings,
    context: MeasureContext<'_>,
) -> Result<measurement::Outcome, PickError> {
    let MeasureContext {
        budget,
        clock,
        memory,
        stop,
        progress,
    } = context;
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
            0.05 * i as f64 / qualifying.len() as f64,
            &format!("building {}", backend.name()),
        );
        match set_up(backend) {
            Ok(mixer) => backends.push(PickBackend::with_structure(mixer, backend)),
            Err(MixRefusal::EditPlaceError(reason)) => return Err(impossible(reason)),
            Err(refusal) => excluded.push(Excluded::new(backend.name(), refusal.to_string())),
        }
    }
    if let Some(most) = settings.max_memory {
        let too_large = |b: &PickBackend<'_>| b.mixer.bytes() as u64 > most;
        for backend in backends.iter().filter(|b| too_large(b)) {
            let reason = report::over_memory_limit(backend.mixer.bytes() as u64, most);
            excluded.push(Excluded::new(backend.mixer.name(), reason));
        }
        backends.retain(|backend| !too_large(backend));
    }
    let again = backends.iter().find(|b| !b.scans());
    if let Some(structure) = again.and_then(|b| b.structure)
        && let Ok(mixer) = set_up(&structure)
    {
        backends.push(PickBackend {
            structure: Some(structure),
            ..PickBackend::control(mixer)
        });
    }
    backend::keep_common_places(&mut backends, &schedule).map_err(impossible)?;
    if settings.needs.contains(&Need::Edit) {
        excluded.push(Excluded::new(
            "relation-tables",
            "they cannot be edited".into(),
        ));
    } else {
        progress(0.05, "tabulating");
        let tabulate = |backend: &Backend| tabulate(backend, polygons, &schedule, &route);
        let tables = backend::build_tables(&backends, clock, tabulate);
        match tables {
            Some(tables)
                if settings
                    .max_memory
                    .is_some_and(|m| tables.mixer.bytes() as u64 > m) =>
            {
                let bytes = tables.mixer.bytes() as u64;
                let reason = report::over_memory_limit(bytes, settings.max_memory.unwrap_or(0));
                excluded.push(Excluded::new("relation-tables", reason));
            }
            Some(tables) => backends.push(tables),
            None => {}
        }
    }
    let measurement = PickMeasurement {
        study_mesh,
        settings,
        counts,
        schedule: &schedule,
        budget,
        clock,
        memory,
        stop,
        progress,
    };
    measurement.run(backends, excluded)
}
