//! A measured backend of a pick, with its samples.

use sixfold::Edit;
use sixfold_workload::{
    Action, Backend, Clock, EditPlaceError, MixBackend, Schedule, Series, Time,
};

/// A structure or relation tables, with samples.
pub(crate) struct PickBackend<'a> {
    pub(crate) mixer: Box<dyn MixBackend + 'a>,
    /// The structure; `None` for relation tables.
    pub(crate) structure: Option<Backend>,
    /// The structure from which relation tables were made; `None` for a structure.
    pub(crate) made_from: Option<&'static str>,
    /// Whether this is the control: a backend that is measured a second time.
    pub(crate) control: bool,
    /// For each part, the plan for timing a pass.
    pub(crate) passes: Vec<PassPlan>,
    /// For each part, the number of operations in one sample of that part alone.
    pub(crate) part_operations: Vec<u64>,
    /// For each round, the time of one operation of the mix, with rebuilding.
    pub(crate) samples: Vec<(u32, Time)>,
    /// For each sample, the larger of the slowdowns before and after the sample.
    pub(crate) slowdowns: Vec<f64>,
    pub(crate) builds: Vec<Time>,
    /// The building time on fresh pages divided by the time directly afterwards on kept pages.
    pub(crate) first_builds: Vec<f64>,
    /// For each part, the times of one operation, timed alone, in nanoseconds.
    pub(crate) parts: Vec<Vec<f64>>,
    /// For each part, the number of results on all elements, or the checksum of a pass. `None` if
    /// not all elements were queried.
    pub(crate) results: Vec<Option<f64>>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PassPlan {
    /// The operation of the pass on this backend; `None` if the part is not a pass.
    pub(crate) operation: Option<sixfold_workload::Operation>,
    /// Number of consecutive runs in one sample.
    pub(crate) runs: u32,
    /// The sampled elements of a pass that scans.
    pub(crate) sample: Option<sixfold_workload::ElementSample>,
    /// The estimated time of a pass whose run would exceed the budget.
    pub(crate) estimate: Option<Time>,
}

impl<'a> PickBackend<'a> {
    pub(crate) fn new(mixer: Box<dyn MixBackend + 'a>) -> Self {
        let parts = mixer.scans().len();
        Self {
            mixer,
            structure: None,
            made_from: None,
            control: false,
            passes: vec![PassPlan::default(); parts],
            part_operations: vec![0; parts],
            samples: Vec::new(),
            slowdowns: Vec::new(),
            builds: Vec::new(),
            first_builds: Vec::new(),
            parts: vec![Vec::new(); parts],
            results: vec![None; parts],
        }
    }

    pub(crate) fn with_structure(mixer: Box<dyn MixBackend + 'a>, structure: &Backend) -> Self {
        Self {
            structure: Some(*structure),
            ..Self::new(mixer)
        }
    }

    pub(crate) fn control(mixer: Box<dyn MixBackend + 'a>) -> Self {
        Self {
            control: true,
            ..Self::new(mixer)
        }
    }

    /// Returns whether some part scans all faces. The parts are then timed one by one.
    pub(crate) fn scans(&self) -> bool {
        self.mixer.scans().contains(&true)
    }
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

/// Returns tables of the relations that the workload queries. The tables come from the structure
/// that builds them fastest. Returns `None` if the workload has no such relations.
pub(crate) fn build_tables<'a>(
    backends: &[PickBackend<'a>],
    clock: &dyn Clock,
    tabulate: impl Fn(&Backend) -> Option<Box<dyn MixBackend + 'a>>,
) -> Option<PickBackend<'a>> {
    let usable = backends.iter().filter(|b| !b.control && !b.scans());
    let mut best: Option<(f64, PickBackend<'a>)> = None;
    for backend in usable {
        let Some(structure) = backend.structure else {
            continue;
        };
        let Some(tables) = tabulate(&structure) else {
            continue;
        };
        let ns = tables.build(&Series::once(clock)).ns();
        if best.as_ref().is_none_or(|(least, _)| ns < *least) {
            best = Some((
                ns,
                PickBackend {
                    made_from: Some(structure.name()),
                    ..PickBackend::new(tables)
                },
            ));
        }
    }
    best.map(|(_, backend)| backend)
}
