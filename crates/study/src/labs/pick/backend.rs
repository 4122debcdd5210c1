//! A measured backend of a pick, with its samples.

use std::num::NonZeroU32;
use std::time::Duration;

use sixfold::{Edit, PolygonMesh};
use sixfold_core::Counts;
use sixfold_measure::Operation;
use sixfold_workload::{Action, Backend, EditPlaceError, MixBackend, Schedule};

use crate::engine::bench::{Bench, Columns, Trial};
use crate::engine::effort::Effort;
use crate::engine::machine::Machine;
use sixfold_measure::pick::{Candidate, MeasuredBackend as Contestant, position};

/// A structure or relation tables, ready for the mix.
pub(crate) struct PickBackend<'a> {
    pub(crate) mixer: Box<dyn MixBackend + 'a>,
    /// The structure; `None` for relation tables.
    pub(crate) structure: Option<Backend>,
    /// The structure from which relation tables were made; `None` for a structure.
    pub(crate) made_from: Option<&'static str>,
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

    /// Splits the properties from the backend to measure, which runs on `machine`.
    pub(crate) fn hosted(self, machine: &dyn Machine, counts: &Counts) -> Contestant<'a> {
        let (candidate, built) = self.split();
        (candidate, machine.host(built, counts))
    }

    /// Splits the properties from the backend to measure.
    pub(crate) fn split(self) -> Contestant<'a> {
        let candidate = Candidate {
            name: self.mixer.name().to_owned(),
            info: self.structure.map(|structure| structure.info),
            made_from: self.made_from,
            type_paths: self.mixer.type_paths(),
            tabulated: self.mixer.tabulated(),
            scans: self.mixer.scans(),
            bytes: self.mixer.bytes(),
        };
        (candidate, self.mixer)
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

/// How much longer than the fastest structure the chosen structure may take to make tables.
const TABLES_EQUAL_UP_TO: f64 = 2.0;
/// Number of times that each structure makes tables again before one structure is chosen, if the number
/// of rounds is fixed.
const TABLE_ROUNDS: NonZeroU32 = NonZeroU32::new(5).expect("above 0");
/// Time limit of these rounds, if there is a time limit.
const TABLES_BUDGET: Duration = Duration::from_millis(200);

/// Returns tables of the relations that the workload queries. Returns `None` if the workload has no
/// such relations.
///
/// The tables come from the structure with the fewest bytes among the structures that make them
/// fast: in at most twice the least time. So the choice does not depend on noise.
pub(crate) fn build_tables<'a>(
    structures: &[(&Candidate, Backend)],
    polygons: &'a PolygonMesh,
    counts: Counts,
    seed: u64,
    effort: Effort,
    bench: &mut Bench<'_>,
    tabulate: impl Fn(&Backend) -> Option<Box<dyn MixBackend + 'a>>,
) -> Option<Contestant<'a>> {
    let each = structures
        .iter()
        .filter(|(candidate, _)| !candidate.scans());
    let made = each.filter_map(|(candidate, structure)| {
        let tables = PickBackend {
            mixer: tabulate(structure)?,
            structure: None,
            made_from: Some(structure.name()),
        };
        let (tables, built) = tables.hosted(bench.machine, &counts);
        let size = (candidate.bytes, position(&candidate.name));
        Some(((size, tables), built))
    });
    let (tables, built): (Vec<_>, Vec<_>) = made.unzip();
    let columns = Columns::without_control(built);
    let effort = match effort {
        Effort::Budget(_) => Effort::Budget(TABLES_BUDGET),
        Effort::Rounds(_) => Effort::Rounds(TABLE_ROUNDS),
    };
    let trial = Trial {
        polygons,
        counts,
        skewed: false,
        entries: columns.entries(&[Operation::Build]),
        columns,
        effort,
        named: true,
        forced: false,
        untimed: None,
        seed,
    };
    let measured = bench.measure(trial, &mut |_| ());
    let times = measured.times.iter();
    let times: Vec<f64> = times.map(|ns| ns.unwrap_or(f64::INFINITY)).collect();
    let least = times.iter().copied().min_by(f64::total_cmp)?;
    let each = tables.into_iter().zip(measured.columns.subjects).zip(times);
    let fast = each.filter(|(_, ns)| *ns <= TABLES_EQUAL_UP_TO * least);
    let (((_, tables), built), _) = fast.min_by_key(|(((size, _), _), _)| *size)?;
    Some((tables, built))
}
