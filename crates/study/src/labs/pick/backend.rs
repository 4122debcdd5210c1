//! A measured backend of a pick, with its samples.

use crate::engine::effort::Effort;
use crate::labs::pick::choice::position;
use sixfold::Edit;
use sixfold_workload::{
    Action, Backend, Clock, EditPlaceError, Job, MixBackend, Operation, Schedule, Series,
};

use crate::labs::pick::measurement::Contestant;
use sixfold_results::Excluded;

/// A structure or relation tables, ready for the mix.
pub(crate) struct PickBackend<'a> {
    pub(crate) mixer: Box<dyn MixBackend + 'a>,
    /// The structure; `None` for relation tables.
    pub(crate) structure: Option<Backend>,
    /// The structure from which relation tables were made; `None` for a structure.
    pub(crate) made_from: Option<&'static str>,
}

/// The properties of a backend that the evaluation needs. Its index is that of the measured
/// subject.
pub(crate) struct Candidate {
    pub(crate) name: String,
    pub(crate) structure: Option<Backend>,
    pub(crate) made_from: Option<&'static str>,
    /// The paths of the types that a program needs to use the backend.
    pub(crate) type_paths: Vec<&'static str>,
    /// By part of the mix: whether one operation scans all faces.
    pub(crate) scans: Vec<bool>,
    pub(crate) bytes: usize,
}

impl Candidate {
    /// Returns whether some part scans all faces. If so, the parts are timed one by one: the part
    /// that scans dominates the others, and the state of the caches hardly matters.
    pub(crate) fn scans(&self) -> bool {
        self.scans.contains(&true)
    }
}

impl<'a> PickBackend<'a> {
    pub(crate) fn new(mixer: Box<dyn MixBackend + 'a>, structure: &Backend) -> Self {
        Self {
            mixer,
            structure: Some(*structure),
            made_from: None,
        }
    }

    /// Returns whether some part of the mix scans all faces.
    pub(crate) fn scans(&self) -> bool {
        self.mixer.scans().contains(&true)
    }

    /// Splits the properties from the backend to measure.
    pub(crate) fn split(self) -> Contestant<'a> {
        let candidate = Candidate {
            name: self.mixer.name().to_owned(),
            structure: self.structure,
            made_from: self.made_from,
            type_paths: self.mixer.type_paths(),
            scans: self.mixer.scans(),
            bytes: self.mixer.bytes(),
        };
        (candidate, self.mixer)
    }
}

/// Removes the backends that are larger than `most` bytes, and records them in `excluded`.
pub(crate) fn exclude_large(
    backends: &mut Vec<PickBackend<'_>>,
    most: Option<u64>,
    excluded: &mut Vec<Excluded>,
) {
    let Some(most) = most else { return };
    backends.retain(|backend| {
        let bytes = backend.mixer.bytes() as u64;
        if bytes > most {
            let reason = super::needs::over_memory_limit(bytes, most);
            excluded.push(Excluded::new(backend.mixer.name(), reason));
        }
        bytes <= most
    });
}

/// Tries the edits at their places on all backends. Keeps only the places that all backends accept,
/// so that all backends do the same work.
pub(crate) fn keep_common_places(
    backends: &mut [PickBackend<'_>],
    schedule: &Schedule,
) -> Result<(), EditPlaceError> {
    let edits: Vec<Edit> = schedule
        .edits()
        .filter_map(|part| match schedule.parts[part].action {
            Action::Edit(edit) => Some(edit),
            _ => None,
        })
        .collect();
    if edits.is_empty() {
        return Ok(());
    }
    let mut common: Option<Vec<Vec<bool>>> = None;
    for backend in backends.iter_mut() {
        let accepted = backend.mixer.accepted_places();
        let both = |(a, b): (bool, bool)| a && b;
        common = Some(match common {
            None => accepted,
            Some(common) => common
                .into_iter()
                .zip(accepted)
                .map(|(a, b)| a.into_iter().zip(b).map(both).collect())
                .collect(),
        });
    }
    let common = common.unwrap_or_default();
    if let Some(part) = common.iter().position(|places| !places.contains(&true)) {
        return Err(EditPlaceError::NowhereAccepted { edit: edits[part] });
    }
    for backend in backends {
        backend.mixer.keep_places(&common);
    }
    Ok(())
}

/// How much longer than the fastest structure the chosen structure may take to make tables.
const TABLES_EQUAL_UP_TO: f64 = 2.0;
/// Maximum number of times that each structure makes tables again before one structure is chosen.
const TABLE_ROUNDS: usize = 5;
/// Maximum time of these rounds, in nanoseconds, if there is a time limit.
const TABLE_ROUNDS_NS: f64 = 200e6;

/// Returns tables of the relations that the workload queries. Returns `None` if the workload has no
/// such relations.
///
/// The tables come from the structure with the fewest bytes among the structures that make them
/// fast: in at most twice the least time. So the choice does not depend on noise.
pub(crate) fn build_tables<'a>(
    backends: &[PickBackend<'a>],
    clock: &dyn Clock,
    effort: Effort,
    tabulate: impl Fn(&Backend) -> Option<Box<dyn MixBackend + 'a>>,
) -> Option<PickBackend<'a>> {
    let start = clock.now();
    let structures = backends.iter().filter(|b| !b.scans());
    let mut made: Vec<_> = structures
        .filter_map(|backend| {
            let start = clock.now();
            let tables = tabulate(&backend.structure?)?;
            Some((backend, tables, (clock.now() - start).ns()))
        })
        .collect();
    for _ in 0..TABLE_ROUNDS {
        if effort.rounds().is_none() && (clock.now() - start).ns() > TABLE_ROUNDS_NS {
            break;
        }
        for (_, tables, least) in &mut made {
            let build = Job::from(Operation::Build);
            *least = least.min(tables.run(&build, &Series::once(clock)).time.ns());
        }
    }
    let least = made.iter().map(|(.., ns)| *ns).min_by(f64::total_cmp)?;
    made.retain(|(.., ns)| *ns <= TABLES_EQUAL_UP_TO * least);
    let size = |backend: &PickBackend<'_>| (backend.mixer.bytes(), position(backend.mixer.name()));
    let (backend, mixer, _) = made.into_iter().min_by_key(|(backend, ..)| size(backend))?;
    Some(PickBackend {
        mixer,
        structure: None,
        made_from: Some(backend.structure?.name()),
    })
}
