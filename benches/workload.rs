//! How much time does each operation take on each structure?

use criterion::Criterion;
use sixfold_study::Operation;

use crate::input::{bench_backends, inputs};

const WORKLOADS: [Operation; 8] = [
    Operation::Circulate,
    Operation::FaceBarycenter,
    Operation::VertexNormal,
    Operation::VvSmooth,
    Operation::EdgeLength,
    Operation::Boundary,
    Operation::FfBfs,
    Operation::AllQueries,
];

pub(crate) fn define(criterion: &mut Criterion) {
    // Uses only the largest meshes. `query` shows how times grow with the mesh.
    let inputs = inputs().split_off(6);
    for operation in WORKLOADS {
        let mut group = criterion.benchmark_group(format!("workload/{}", operation.name()));
        for input in &inputs {
            bench_backends(&mut group, operation, input);
        }
        group.finish();
    }
}
