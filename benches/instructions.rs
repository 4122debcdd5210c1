//! Instruction counts of the operations of a study on the four local structures. Callgrind counts
//! the instructions, so the results contain no timing noise.
//!
//! ```text
//! apt-get install valgrind
//! cargo install gungraun-runner --version 0.20.0     # the version of gungraun in Cargo.lock
//! python3 benches/checks/instructions.py             # compares the counts with the baseline
//! ```
//!
//! The benchmarks are the lines of `instructions.txt`: a structure and an operation. Each benchmark
//! runs the operation on 2,000 triangles in random order. Subdivisions run once; other operations
//! run twice.
//!
//! The program builds on every platform, but runs only on platforms that valgrind supports. A plain
//! `cargo bench` does not run this program (`bench = false`), because the program does not
//! understand the options of criterion.

#![expect(missing_docs, reason = "gungraun's macros make public items without")]

use std::hint::black_box;

use gungraun::{Callgrind, prelude::*};
use rayon::ThreadPoolBuilder;
use sixfold::{Creases, shapes};
use sixfold_study::{Backend, BackendRunner, MachineClock, Operation, SubdivisionJob};

/// An operation that is ready to run.
type Prepared = Box<dyn FnMut()>;

/// Prepares the operation of a line such as `half-edge vertex_vertices`. The mesh is not freed,
/// because Callgrind would also count the instructions for freeing.
fn prepare(line: String) -> Prepared {
    let (structure, operation) = line.split_once(' ').expect("a structure and an operation");
    let backend = Backend::find(structure).expect("a structure");
    let operation: Operation = operation.parse().expect("an operation");
    let sphere = shapes::geodesic(10).expect("a small frequency");
    let polygons = Box::leak(Box::new(shapes::shuffled(&sphere, 1)));
    // Callgrind counts only this thread. A pool of one thread runs subdivisions on this thread.
    let pool = ThreadPoolBuilder::new().num_threads(1).build_global();
    pool.expect("the only pool");
    if let Some(job) = SubdivisionJob::of(operation) {
        let refiner = job.prepare(&backend, polygons, &Creases::default());
        let refiner = refiner.expect("a way of this structure");
        let mut refiner = refiner.expect("a closed manifold of triangles");
        refiner.run().expect("a triangle mesh");
        return Box::new(move || refiner.run().expect("a triangle mesh"));
    }
    let runner = BackendRunner::new(&backend, polygons);
    let mut runner = runner.expect("a closed manifold of triangles");
    let clock = MachineClock::start();
    let mut run = move || {
        black_box(runner.run_times(operation, 1, &clock));
    };
    // Only the first run reads the sizes of the caches from the system.
    run();
    Box::new(run)
}

#[library_benchmark]
#[benches::study(file = "benches/instructions.txt", setup = prepare)]
fn operation(mut run: Prepared) -> Prepared {
    run();
    run
}

library_benchmark_group!(name = operations, benchmarks = [operation]);

main!(
    config = LibraryBenchmarkConfig::default()
        .pass_through_env("GLIBC_TUNABLES") // set by the script
        .tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = operations
);
