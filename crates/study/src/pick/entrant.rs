//! Who takes part in a contest, and what each has done so far.

use sixfold::Edit;
use workload::{Action, Clock, Mixer, NoPlace, Script, Series, Time};

/// A backend, or tables, with its samples.
pub(crate) struct Entrant<'a> {
    pub(crate) mixer: Box<dyn Mixer + 'a>,
    /// The structure that tables were made of.
    pub(crate) over: Option<&'static str>,
    /// It is another a second time.
    pub(crate) control: bool,
    /// By part: how many runs in a row, or on how large a sample, a pass is timed.
    pub(crate) passes: Vec<PassPlan>,
    /// By part, where it is timed by itself: how many operations make a sample.
    pub(crate) part_operations: Vec<u64>,
    /// By round: the time of one operation of the mix, rebuilding included.
    pub(crate) samples: Vec<(u32, Time)>,
    /// By sample: the larger slowdown of the gauge before and after it.
    pub(crate) slowdowns: Vec<f64>,
    /// What building took.
    pub(crate) builds: Vec<Time>,
    /// How much longer building took on fresh pages than right after.
    pub(crate) first_builds: Vec<f64>,
    /// By part: the times of one operation by itself.
    pub(crate) parts: Vec<Vec<f64>>,
    /// By part: how much its operations yielded on all elements, or the checksum of a pass; `None` where
    /// not all were asked.
    pub(crate) found: Vec<Option<f64>>,
}

/// How a pass is timed on one entrant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PassPlan {
    /// Which operation it comes to on this backend; `None` for parts that are no passes.
    pub(crate) operation: Option<workload::Operation>,
    /// So many runs in a row make a sample.
    pub(crate) runs: u32,
    /// On a sample, where it scans.
    pub(crate) sample: Option<workload::Sample>,
    /// Its time, where a run would outlast the budget.
    pub(crate) estimate: Option<Time>,
}

impl<'a> Entrant<'a> {
    pub(crate) fn of(mixer: Box<dyn Mixer + 'a>) -> Self {
        let parts = mixer.scans().len();
        Self {
            mixer,
            over: None,
            control: false,
            passes: vec![PassPlan::default(); parts],
            part_operations: vec![0; parts],
            samples: Vec::new(),
            slowdowns: Vec::new(),
            builds: Vec::new(),
            first_builds: Vec::new(),
            parts: vec![Vec::new(); parts],
            found: vec![None; parts],
        }
    }

    pub(crate) fn control(mixer: Box<dyn Mixer + 'a>) -> Self {
        Self {
            control: true,
            ..Self::of(mixer)
        }
    }

    /// Whether some part looks at all faces: its parts are timed one by one then, on a few elements.
    pub(crate) fn scans(&self) -> bool {
        self.mixer.scans().contains(&true)
    }
}

/// Has everybody try the edits at their places, and go on with those that all accept: so that all do
/// the same work.
pub(crate) fn agree_on_places(
    entrants: &mut [Entrant<'_>],
    script: &Script,
) -> Result<(), NoPlace> {
    let edits: Vec<Edit> = script
        .edits()
        .filter_map(|part| match script.parts[part].action {
            Action::Edit(edit) => Some(edit),
            _ => None,
        })
        .collect();
    if edits.is_empty() {
        return Ok(());
    }
    let mut common: Option<Vec<Vec<bool>>> = None;
    for entrant in entrants.iter_mut() {
        let accepted = entrant.mixer.accepted();
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
    if let Some(nowhere) = common.iter().position(|places| !places.contains(&true)) {
        return Err(NoPlace::NowhereTaken {
            edit: edits[nowhere],
        });
    }
    for entrant in entrants {
        entrant.mixer.keep(&common);
    }
    Ok(())
}

/// Tables of what the workload asks, over the structure from which they are made soonest; `None`
/// where it asks nothing that could be tabulated.
pub(crate) fn tables<'a>(
    entrants: &[Entrant<'a>],
    clock: &dyn Clock,
    tabulate: impl Fn(&str) -> Option<Box<dyn Mixer + 'a>>,
) -> Option<Entrant<'a>> {
    let able = entrants.iter().filter(|e| !e.control && !e.scans());
    let mut best: Option<(f64, Entrant<'a>)> = None;
    for entrant in able {
        let over = entrant.mixer.name();
        let Some(tables) = tabulate(over) else {
            continue;
        };
        let ns = tables.build(&Series::once(clock)).ns();
        if best.as_ref().is_none_or(|(least, _)| ns < *least) {
            let over = Some(over);
            best = Some((
                ns,
                Entrant {
                    over,
                    ..Entrant::of(tables)
                },
            ));
        }
    }
    best.map(|(_, entrant)| entrant)
}
