//! The benchmarks of this repository; each module answers one question.
//!
//! `cargo bench -p sixfold-benches -- zero_cost/` runs only benchmarks whose name contains
//! `zero_cost/`.

mod construction;
mod editing;
mod input;
mod query;
mod spatial;
mod subdivision;
mod values;
mod workload;
mod zero_cost;

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use sixfold_results::Policy;
use sixfold_study::HeapGuard;

/// Configures criterion for short measurements. Freed pages stay in the process, so that
/// allocations cause no page faults.
fn short_runs() -> Criterion {
    let heap = HeapGuard::acquire(Policy::Kept).expect("all benchmarks have the same policy");
    heap.hold_until_exit();
    Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(400))
        .configure_from_args()
}

criterion_group! {
    name = all;
    config = short_runs();
    targets = zero_cost::define, construction::define, workload::define, query::define,
        subdivision::define, editing::define,
        spatial::define, values::define
}
criterion_main!(all);
