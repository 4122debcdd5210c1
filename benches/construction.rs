//! How much time does it take to build each structure from flat arrays?

use criterion::Criterion;
use sixfold_study::Operation;

use crate::input::{bench_backends, inputs};

pub(crate) fn define(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("build");
    for input in &inputs() {
        bench_backends(&mut group, Operation::Build, input);
    }
    group.finish();
}
