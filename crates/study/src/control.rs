//! One backend entered twice: the noise of this very run.

use sixfold::QueryCost;

use crate::measure::Entry;
use crate::report::{Control, ControlRow};
use crate::standing::{NO_DIFFERENCE, ratio};
use crate::statistics::Median;
use workload::Operation;
use workload::Subject;

/// Which of the subjects is entered twice: the first that never looks at all faces, for what scans is
/// slow and steady.
pub(crate) fn entered_twice(subjects: &[Box<dyn Subject + '_>]) -> usize {
    let scans = |subject: &dyn Subject| subject.costs().contains(&QueryCost::Scan);
    let found = subjects.iter().position(|subject| !scans(subject.as_ref()));
    found.unwrap_or(0)
}

/// What the second column of `backend` says: `entries` are those of all subjects, of which the last
/// is the same as `first`.
pub(crate) fn control(
    entries: &[Entry],
    first: usize,
    second: usize,
    backend: &str,
) -> Option<Control> {
    let of = |subject: usize, operation: Operation| {
        let same = |e: &&Entry| e.subject == subject && e.job.operation == operation;
        entries.iter().find(same)
    };
    let mut operations = Vec::new();
    for again in entries.iter().filter(|e| e.subject == second) {
        let operation = again.job.operation;
        let Some(once) = of(first, operation) else {
            continue;
        };
        // A time of zero, on a coarse clock, has no ratio.
        let ratio = ratio(&again.times(), &once.times());
        let known = |ratio: &Median| ratio.value.is_finite() && ratio.value > 0.0;
        if let Some(ratio) = ratio.filter(known) {
            operations.push(ControlRow {
                operation,
                ratio: ratio.value,
                ci_low: ratio.interval.map(|[low, _]| low),
                ci_high: ratio.interval.map(|[_, high]| high),
            });
        }
    }
    let differences = || operations.iter().map(ControlRow::difference);
    let typical = Median::of(differences())?.value;
    let worst = differences().fold(1.0, f64::max);
    Some(Control {
        backend: backend.to_owned(),
        operations,
        typical,
        worst,
    })
}

/// Ratios up to this say nothing: the difference that the control shows in this operation, or what
/// nobody would choose by.
pub(crate) fn noise(control: Option<&Control>, operation: Operation) -> f64 {
    let rows = control.map_or(&[][..], |control| &control.operations);
    let row = rows.iter().find(|row| row.operation == operation);
    row.map_or(1.0, ControlRow::difference).max(NO_DIFFERENCE)
}
