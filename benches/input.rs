//! The meshes of the benchmarks, and the function that measures a backend with criterion.

use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Throughput};
use sixfold::{Facts, PolygonMesh, shapes};
use sixfold_study::{Backend, BackendRunner, MachineClock, Operation};

/// Frequencies of the geodesic spheres. The spheres have 320, 1,280 and 5,120 triangles.
const FREQUENCIES: [usize; 3] = [4, 8, 16];

/// A mesh and its name in a benchmark.
pub(crate) struct Input {
    /// The name, for example `regular/320`.
    pub(crate) name: String,
    pub(crate) mesh: PolygonMesh,
}

/// Returns closed triangle meshes of three sizes: regular meshes, irregular meshes, and regular
/// meshes in random order.
pub(crate) fn inputs() -> Vec<Input> {
    let mut inputs = Vec::new();
    for frequency in FREQUENCIES {
        let regular = shapes::geodesic(frequency).expect("a small frequency");
        let faces = regular.face_count();
        let irregular = irregular(faces);
        let shuffled = shapes::shuffled(&regular, 1);
        let named = [
            ("regular", regular),
            ("irregular", irregular),
            ("shuffled", shuffled),
        ];
        for (order, mesh) in named {
            inputs.push(Input {
                name: format!("{order}/{faces}"),
                mesh,
            });
        }
    }
    inputs
}

/// Builds a closed surface of about `faces` triangles with varying valences.
pub(crate) fn irregular(faces: usize) -> PolygonMesh {
    let blobs = shapes::generator("blobs").expect("the shape exists");
    let mesh = blobs
        .build(&[("faces", faces as f64)])
        .expect("a size within its range");
    let valence = Facts::from_polygons(&mesh).valence.expect("edges");
    assert!(valence.max > valence.min + 2, "{valence:?} is regular");
    mesh
}

/// Times `operation` on every backend that can hold `input`, with the same code as a study.
pub(crate) fn bench_backends(
    group: &mut BenchmarkGroup<'_, WallTime>,
    operation: Operation,
    input: &Input,
) {
    let clock = MachineClock::start();
    for backend in Backend::structures() {
        let Ok(mut runner) = BackendRunner::new(&backend, &input.mesh) else {
            continue; // it cannot hold the mesh; the conformance tests check that this is right
        };
        let elements = runner.run(operation, &clock).elements;
        group.throughput(Throughput::Elements(elements));
        group.bench_function(BenchmarkId::new(backend.name(), &input.name), |bench| {
            bench.iter_custom(|runs| {
                let times = u32::try_from(runs).unwrap_or(u32::MAX);
                let run = runner.run_times(operation, times, &clock);
                Duration::from_nanos((run.time.wall_ns * runs as f64) as u64)
            });
        });
    }
}
