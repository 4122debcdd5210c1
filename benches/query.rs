//! How much time does each relation take on each structure? The meshes have different sizes, and
//! regular or random order.

use criterion::Criterion;
use sixfold::Relation;
use sixfold_study::Operation;

use crate::input::{bench_backends, inputs};

pub(crate) fn define(criterion: &mut Criterion) {
    let inputs = inputs();
    for relation in Relation::ALL {
        let mut group = criterion.benchmark_group(format!("query/{relation}"));
        for input in &inputs {
            bench_backends(&mut group, Operation::Relation(relation), input);
        }
        group.finish();
    }
}
