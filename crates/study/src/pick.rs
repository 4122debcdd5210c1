//! Picks the fastest backend for a mesh and a workload, with intervals and reasons.
//!
//! Every backend that qualifies runs the mix of the workload, in its access order, in interleaved
//! rounds as in a study. After the rounds each part of the mix is timed by itself, to explain the
//! result. If the mix does not change connectivity, tables of only the relations that it queries
//! take part as one more backend.

mod answer;
mod break_even;
mod contest;
mod entrant;
mod needs;
mod pooled;
mod reasons;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use sixfold_workload::pages::Policy;
use sixfold_workload::{
    Backend, Draw, MachineClock, MixRefusal, NoPlace, Operation, Route, Script, Workload,
};

pub use answer::{Answer, BreakEven, Excluded, OnMesh, PartCost, Ranked};
pub use needs::{Need, UnknownNeed};

use crate::environment::Environment;
use crate::heap::{CacheState, Memory};
use crate::inspect::Specimen;
use crate::study::{Settings, StudyError, needed_bytes};
use crate::timer::Timer;
use contest::Contest;
use entrant::Entrant;

/// The input of [`pick`].
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The workload of the program.
    pub workload: Workload,
    /// Names of the backends to compare; empty for all.
    pub backends: Vec<String>,
    /// Capabilities that the structure must have.
    pub needs: Vec<Need>,
    /// The maximum size of the structure, in bytes.
    pub max_memory: Option<u64>,
    /// Time limit of the measurement, for all meshes together.
    pub budget: Duration,
    /// Seed of the routes and of the random order in which backends are measured.
    pub seed: u64,
    /// What happens to pages that operations free.
    pub heap: Policy,
}

impl Question {
    /// Returns the backends to compare.
    fn chosen_backends(&self) -> Result<Vec<Backend>, StudyError> {
        let settings = Settings {
            backends: self.backends.clone(),
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
    /// The mesh has no faces, or a name is unknown.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The workload cannot be run on this mesh.
    #[error("{mesh}: {reason}")]
    Impossible { mesh: String, reason: NoPlace },
    /// The budget is too short for three rounds. `needed_ms` is rounded up and is for all meshes
    /// together.
    #[error(
        "{mesh}: a budget of {} ms is too small to measure anything: it has no room for three rounds; give --budget {needed_ms}ms or more", .budget.as_millis()
    )]
    BudgetTooSmall {
        mesh: String,
        budget: Duration,
        needed_ms: u64,
    },
    /// The list of meshes is empty.
    #[error("there is no mesh to pick a backend for")]
    NoMesh,
}

/// Ranks the backends for `question` on `specimens` by running its workload on each.
///
/// If no backend qualifies, the ranking is empty and `excluded` has the reasons. Setting `stop`
/// ends the measurement between two samples; the answer contains what is finished. `progress` is
/// called with the finished part, from 0 to 1, and the current step.
///
/// # Errors
///
/// [`PickError`]: unknown names, a mesh without faces, a workload that cannot be run on a mesh, or
/// a budget that is too small.
pub fn pick(
    specimens: &[Specimen],
    question: &Question,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(f64, &str),
) -> Result<Answer, PickError> {
    if specimens.is_empty() {
        return Err(PickError::NoMesh);
    }
    let environment = Environment::here(question.seed, question.budget.as_secs_f64());
    let needed = specimens.iter().map(|specimen| needed(specimen, question));
    let mut memory = Memory::start(question.heap, CacheState::Warm, needed.max().unwrap_or(0));
    let clock = MachineClock::start();
    let timer = Timer::of(&clock);
    let budget = question.budget / specimens.len() as u32;
    let mut answers = Vec::new();
    for (i, specimen) in specimens.iter().enumerate() {
        if stop.load(Ordering::Relaxed) && i > 0 {
            break;
        }
        let part = |done: f64| (i as f64 + done) / specimens.len() as f64;
        let mut progress = |done: f64, what: &str| progress(part(done), what);
        let measuring = Measuring {
            budget,
            clock: &clock,
            memory: &mut memory,
            stop,
            progress: &mut progress,
        };
        let answer = on_one(specimen, question, measuring);
        answers.push(answer.map_err(|error| for_all(error, question, specimens.len()))?);
    }
    let interrupted = stop.load(Ordering::Relaxed);
    Ok(pooled::pooled(
        answers,
        question,
        timer,
        environment.with_memory(&memory),
        interrupted,
    ))
}

/// Estimates how many bytes the measurement on one mesh holds at once.
fn needed(specimen: &Specimen, question: &Question) -> u64 {
    let counts = specimen.polygons.counts(specimen.facts.edges);
    // Unknown names are refused later.
    let backends = question.chosen_backends().unwrap_or_default();
    // Twice: for the relation tables, and for what edits and subdivision allocate.
    2 * needed_bytes(&backends, &Operation::ALL, &counts)
}

/// Budget, clock, memory and callbacks of the measurement on one mesh.
pub(crate) struct Measuring<'m> {
    budget: Duration,
    clock: &'m MachineClock,
    memory: &'m mut Memory,
    stop: &'m AtomicBool,
    progress: &'m mut dyn FnMut(f64, &str),
}

/// Converts an error about the budget of one mesh to the budget of all meshes.
fn for_all(error: PickError, question: &Question, meshes: usize) -> PickError {
    match error {
        PickError::BudgetTooSmall {
            mesh, needed_ms, ..
        } => PickError::BudgetTooSmall {
            mesh,
            budget: question.budget,
            needed_ms: needed_ms.saturating_mul(meshes as u64),
        },
        other => other,
    }
}

/// Returns the backends that qualify, and the others with their reasons.
fn qualified(
    specimen: &Specimen,
    question: &Question,
) -> Result<(Vec<Backend>, Vec<Excluded>), PickError> {
    let polygons = &specimen.polygons;
    if polygons.face_count() == 0 {
        return Err(StudyError::NoFaces.into());
    }
    let counts = polygons.counts(specimen.facts.edges);
    let mut excluded = Vec::new();
    let mut qualified = Vec::new();
    for backend in question.chosen_backends()? {
        let lacks = question
            .needs
            .iter()
            .find_map(|need| need.lacking(&backend));
        let bytes = (backend.layout_bytes)(&counts) as u64;
        let reason = match (lacks, question.max_memory) {
            (Some(lacks), _) => Some(lacks),
            (None, Some(most)) if bytes > most => Some(answer::too_heavy(bytes, most)),
            _ => backend
                .info
                .verdict(polygons)
                .err()
                .map(|refusal| refusal.to_string()),
        };
        match reason {
            Some(reason) => excluded.push(Excluded::of(backend.name(), reason)),
            None => qualified.push(backend),
        }
    }
    Ok((qualified, excluded))
}

fn on_one(
    specimen: &Specimen,
    question: &Question,
    measuring: Measuring<'_>,
) -> Result<contest::Outcome, PickError> {
    let Measuring {
        budget,
        clock,
        memory,
        stop,
        progress,
    } = measuring;
    let (backends, mut excluded) = qualified(specimen, question)?;
    let polygons = &specimen.polygons;
    let counts = polygons.counts(specimen.facts.edges);
    let workload = &question.workload;
    let mut script = Script::of(workload, &counts);
    script.editable |= question.needs.contains(&Need::Edit);
    let route = Route::of(workload.access, polygons, question.seed);
    let draw = Draw::of(polygons, question.seed);
    let impossible = |reason: NoPlace| PickError::Impossible {
        mesh: specimen.name.clone(),
        reason,
    };
    let set_up = |name: &str| sixfold_workload::set_up(name, polygons, &draw, &script, &route);

    let mut entrants = Vec::new();
    for (i, backend) in backends.iter().enumerate() {
        progress(
            0.05 * i as f64 / backends.len() as f64,
            &format!("building {}", backend.name()),
        );
        match set_up(backend.name()) {
            Some(Ok(mixer)) => entrants.push(Entrant::of(mixer)),
            Some(Err(MixRefusal::NoPlace(reason))) => return Err(impossible(reason)),
            Some(Err(refusal)) => excluded.push(Excluded::of(backend.name(), refusal.to_string())),
            None => {}
        }
    }
    if let Some(most) = question.max_memory {
        let heavy = |e: &Entrant<'_>| e.mixer.bytes() as u64 > most;
        for entrant in entrants.iter().filter(|e| heavy(e)) {
            let reason = answer::too_heavy(entrant.mixer.bytes() as u64, most);
            excluded.push(Excluded::of(entrant.mixer.name(), reason));
        }
        entrants.retain(|entrant| !heavy(entrant));
    }
    if let Some(again) = entrants.iter().find(|e| !e.scans()).map(|e| e.mixer.name())
        && let Some(Ok(mixer)) = set_up(again)
    {
        entrants.push(Entrant::control(mixer));
    }
    entrant::agree_on_places(&mut entrants, &script).map_err(impossible)?;
    if question.needs.contains(&Need::Edit) {
        excluded.push(Excluded::of(
            "relation-tables",
            "they cannot be edited".into(),
        ));
    } else {
        progress(0.05, "tabulating");
        let tabulate = |name: &str| sixfold_workload::tabulate(name, polygons, &script, &route);
        let tables = entrant::tables(&entrants, clock, tabulate);
        match tables {
            Some(tables)
                if question
                    .max_memory
                    .is_some_and(|m| tables.mixer.bytes() as u64 > m) =>
            {
                let bytes = tables.mixer.bytes() as u64;
                let reason = answer::too_heavy(bytes, question.max_memory.unwrap_or(0));
                excluded.push(Excluded::of("relation-tables", reason));
            }
            Some(tables) => entrants.push(tables),
            None => {}
        }
    }
    let contest = Contest {
        specimen,
        question,
        counts,
        script: &script,
        budget,
        clock,
        memory,
        stop,
        progress,
    };
    contest.held(entrants, excluded)
}
