//! Checks whether the time of an operation depends on the number of runs in a sample (runs that are
//! timed together).
//!
//! ```sh
//! cargo run --release -p sixfold-study --example runs_per_sample -- 21
//! ```
//!
//! Argument: the number of rounds. Each round runs the operations that build or change a mesh, and
//! a workload with edits, in samples of 1 run and of 50 runs. The rounds are divided into five
//! passes. Each pass builds the structures again, because addresses and machine speed can stay the
//! same for seconds. For each operation, the program prints a ratio: the time per run in samples of
//! 1 run, divided by the time per run in samples of 50 runs, as the median over the rounds. The
//! exit code is 1 if the ratio of an operation differs from 1 by more than 5 %.

use std::collections::BTreeMap;
use std::process::ExitCode;

use sixfold::{Facts, PolygonMesh, shapes};
use sixfold_measure::{Job, Task};
use sixfold_results::Policy;
use sixfold_study::{Backend, Clock, HeapGuard, MachineClock, Operation, Series};
use sixfold_workload::{Access, Draw, Route, Schedule, built_in, prepare_mix};

const STRUCTURES: [&str; 4] = ["face-vertex", "winged-edge", "half-edge", "corner-table"];
const OPERATIONS: [&str; 8] = [
    "build",
    "vv_smooth",
    "catmull_clark_native",
    "loop_native",
    "split_collapse",
    "flip_all",
    "decimate_half",
    "decimate_tenth",
];
const MANY: u32 = 50;
const PASSES: usize = 5;

/// A number of faces, the index of a structure, and the index and name of an operation.
type Cell = (usize, usize, usize, String);

fn main() -> ExitCode {
    let _heap = HeapGuard::acquire(Policy::Kept).expect("the only guard");
    let rounds = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let rounds: usize = rounds.unwrap_or(21);
    let clock = MachineClock::start();
    let mut ratios: BTreeMap<Cell, Vec<f64>> = BTreeMap::new();
    for _ in 0..PASSES {
        for frequency in [10, 32] {
            let polygons = shapes::geodesic(frequency).expect("a sphere");
            for (s, structure) in STRUCTURES.into_iter().enumerate() {
                let rounds = rounds.div_ceil(PASSES);
                let mut lines = operations(structure, &polygons, rounds, &clock);
                lines.push(mix(structure, &polygons, rounds, &clock));
                for (i, (name, new)) in lines.into_iter().enumerate() {
                    let cell = (polygons.face_count(), s, i, name);
                    ratios.entry(cell).or_default().extend(new);
                }
            }
        }
    }
    let mut worst = 1.0_f64;
    for ((faces, s, _, name), ratios) in ratios {
        let ratio = median(ratios);
        println!(
            "{faces:>6} faces  {:<13} {name:<22} {ratio:.3}",
            STRUCTURES[s]
        );
        worst = worst.max(ratio.max(ratio.recip()));
    }
    println!("largest ratio or reciprocal: {worst:.3}");
    match worst <= 1.05 {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

/// Returns for each operation and round the time in samples of 1 run divided by the time in samples
/// of 50 runs.
fn operations(
    structure: &str,
    polygons: &PolygonMesh,
    rounds: usize,
    clock: &dyn Clock,
) -> Vec<(String, Vec<f64>)> {
    let built = Backend::find(structure)
        .expect("a structure")
        .prepare(polygons, None);
    let (mut subject, _) = built.expect("it holds a sphere");
    let mut lines = Vec::new();
    for name in OPERATIONS {
        let operation: Operation = name.parse().expect("an operation");
        let job = Job::from(operation);
        let mut time = |runs| {
            let run = subject.run(&job, &Series::with_runs(runs, clock).with_untimed(1));
            run.refusal.is_none().then(|| run.time.ns())
        };
        let ratios = (0..rounds).map(|_| Some(time(1)? / time(MANY)?));
        if let Some(ratios) = ratios.collect::<Option<Vec<f64>>>() {
            lines.push((name.to_owned(), ratios));
        }
    }
    lines
}

/// Returns the same ratios for a workload with edits.
fn mix(
    structure: &str,
    polygons: &PolygonMesh,
    rounds: usize,
    clock: &dyn Clock,
) -> (String, Vec<f64>) {
    let name = "remeshing";
    let workload = built_in(name).expect("a built-in workload");
    let schedule = Schedule::new(
        &workload,
        &polygons.counts(Facts::from_polygons(polygons).edges),
    );
    let route = Route::new(Access::Patches, polygons, 1);
    let draw = Draw::new(polygons, 1);
    let backend = Backend::find(structure).expect("a structure");
    let prepared = prepare_mix(&backend, polygons, &draw, &schedule, &route);
    let mut mixer = prepared.expect("it can be edited");
    let job = Job::new(Task::Mix);
    let mut time = |runs| {
        // Untimed runs for as long as the longer sample, as in a pick.
        let series = Series::with_runs(runs, clock).with_untimed(MANY);
        mixer.run(&job, &series).time.ns()
    };
    let ratios = (0..rounds).map(|_| time(1) / time(MANY));
    (format!("mix of {name}"), ratios.collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}
