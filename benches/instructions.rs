//! Instruction counts of the operations of a study on the four local structures. Callgrind counts
//! them, without the noise of a clock.
//!
//! ```text
//! apt-get install valgrind
//! cargo install gungraun-runner --version 0.20.0     # the version of gungraun in Cargo.lock
//! python3 benches/checks/instructions.py             # compares the counts with the baseline
//! ```
//!
//! The benchmarks are the lines of `instructions.txt`: a structure and an operation. Each runs the
//! operation twice on 2,000 triangles in random order, so that no loop profits from a regular order.
//!
//! The program builds on every platform and runs on those that valgrind supports. A plain `cargo
//! bench` leaves it out (`bench = false`), because it does not understand the options of criterion.

#![expect(missing_docs, reason = "gungraun's macros make public items without")]

use std::hint::black_box;

use gungraun::prelude::*;
use sixfold::shapes;
use sixfold_study::{Backend, BackendRun, BackendRunner, MachineClock, Operation};

/// An operation that is ready to run.
struct Prepared {
    runner: BackendRunner<'static>,
    operation: Operation,
    clock: MachineClock,
}

/// Builds the structure of a line such as `half-edge vertex_vertices`. The mesh is never freed,
/// because freeing would be counted too.
fn prepare(line: String) -> Prepared {
    let (structure, operation) = line.split_once(' ').expect("a structure and an operation");
    let backend = Backend::find(structure).expect("a structure");
    let sphere = shapes::geodesic(10).expect("a small frequency");
    let polygons = Box::leak(Box::new(shapes::shuffled(&sphere, 1)));
    Prepared {
        runner: BackendRunner::new(&backend, polygons).expect("a closed manifold of triangles"),
        operation: operation.parse().expect("an operation"),
        clock: MachineClock::start(),
    }
}

#[library_benchmark]
#[benches::study(file = "benches/instructions.txt", setup = prepare)]
fn operation(prepared: Prepared) -> (BackendRun, Prepared) {
    let mut prepared = black_box(prepared);
    let Prepared {
        runner,
        operation,
        clock,
    } = &mut prepared;
    let run = runner.run_times(*operation, 1, clock);
    black_box((run, prepared))
}

library_benchmark_group!(name = operations, benchmarks = [operation]);

main!(library_benchmark_groups = operations);
