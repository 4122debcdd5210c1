//! Runs a mix without edits, or one kind of operation of the mix alone, on any mesh.

use std::ops::Range;

use crate::mix::schedule::Schedule;
use sixfold_measure::{Outcome, Series, TimedRun};

/// The numbers of operations, of results, and of refused edits.
pub(crate) type Counts = [u64; 3];

/// **Timed**: runs the operations on elements of some turns. `range_of` returns the operations of a part in a
/// turn, and `run_range` runs them.
pub(crate) fn run_turns(
    parts: usize,
    turns: Range<u64>,
    range_of: &dyn Fn(usize, u64) -> Range<u64>,
    run_range: &mut dyn FnMut(usize, Range<u64>) -> Counts,
) -> Counts {
    let mut sums = [0; 3];
    for turn in turns {
        for part in 0..parts {
            let range = range_of(part, turn);
            if !range.is_empty() {
                let [operations, results, refused] = run_range(part, range);
                sums[0] += operations;
                sums[1] += results;
                sums[2] += refused;
            }
        }
    }
    sums
}

/// Times turns of a mix from turn `first`, as `series` describes; one run is one turn.
pub(crate) fn time_turns(
    schedule: &Schedule,
    first: u64,
    series: &Series<'_>,
    run_range: &mut dyn FnMut(usize, Range<u64>) -> Counts,
) -> TimedRun {
    let parts = schedule.parts.len();
    let range_of = |part, turn| schedule.turn_range(part, turn);
    let timed = first + u64::from(series.untimed);
    run_turns(parts, first..timed, &range_of, run_range);
    let mut counts = [0; 3];
    let turns = timed..timed + u64::from(series.runs);
    let time = series.timed(|| counts = run_turns(parts, turns, &range_of, run_range));
    let [operations, yielded, _] = counts;
    // Turns have equal numbers of operations except for rounding.
    let each = time.scaled(schedule.turn_operations / operations.max(1) as f64);
    let outcome = series.check.then_some(Outcome {
        checksum: yielded as f64,
        elements: schedule.turn_operations as u64,
        refused: 0,
    });
    TimedRun::done(each, outcome)
}

/// Times operations of one part alone from operation `first`, as `series` describes; one run is one
/// operation. The result is that of all operations `all`; `None` if they would take too long.
pub(crate) fn time_part(
    first: u64,
    series: &Series<'_>,
    all: Option<u64>,
    run_range: &mut dyn FnMut(Range<u64>) -> Counts,
) -> TimedRun {
    let timed = first + u64::from(series.untimed);
    if series.untimed > 0 {
        run_range(first..timed);
    }
    let time = series.timed(|| {
        run_range(timed..timed + u64::from(series.runs));
    });
    let outcome = all.filter(|_| series.check).map(|all| Outcome {
        checksum: run_range(0..all)[1] as f64,
        elements: 1,
        refused: 0,
    });
    TimedRun::done(time.scaled(1.0 / f64::from(series.runs)), outcome)
}
