//! Passes of an operation over a mesh, and their results.

use std::hint::black_box;

use sixfold::MeshQuery;

use crate::operation::{checksum, sweep};
use crate::sweeps::{All, Outputs, SweepResult};
use sixfold_measure::{ElementKind, Operation, Outcome, Series, TimedRun};

/// Runs `operation` over all of `mesh` as `series` describes. Returns the time of all runs.
pub(crate) fn run_whole<M: MeshQuery>(
    mesh: &M,
    outputs: &mut Outputs<M>,
    operation: Operation,
    series: &Series<'_>,
) -> TimedRun {
    let mut results = [SweepResult::default(); 3];
    let time = series.time_together(|| {
        for kind in operation.kinds() {
            let result = sweep(operation, kind, black_box(mesh), &All, outputs);
            results[kind.index()] = black_box(result);
        }
        black_box(&mut *outputs);
    });
    let check = series.check;
    let values = |kind| outputs.sum(mesh, &All, kind);
    let outcome = check.then(|| outcome(operation, results, [1.0; 3], &values));
    TimedRun::done(time, outcome)
}

/// Returns the result of a pass. `results` are those of the kinds of elements, and `scale` is the number
/// of all elements of a kind, divided by the number of visited ones. `values` returns the sum of the
/// values that the pass stored for the visited elements of a kind.
pub(crate) fn outcome(
    operation: Operation,
    results: [SweepResult; 3],
    scale: [f64; 3],
    values: &dyn Fn(ElementKind) -> f64,
) -> Outcome {
    Outcome {
        checksum: checksum(operation, SweepResult::sum_of(results), values),
        elements: elements_of_all(operation, results, scale),
        refused: 0,
    }
}

/// Returns the number of elements that a pass over the whole mesh visits, or of its results if they are
/// the unit of the operation.
fn elements_of_all(operation: Operation, results: [SweepResult; 3], scale: [f64; 3]) -> u64 {
    let scaled = |kind: ElementKind, number: u64| number as f64 * scale[kind.index()];
    let visited = match operation.unit_element() {
        Some(kind) => scaled(kind, results[kind.index()].elements),
        None => {
            let kinds = ElementKind::ALL.into_iter();
            kinds.map(|k| scaled(k, results[k.index()].count)).sum()
        }
    };
    visited.round() as u64
}
