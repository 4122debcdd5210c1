//! The repository's own benchmarks; one module asks one question.
//!
//! `cargo bench -p sixfold-benches -- zero_cost/` runs those whose name has the filter in it.

mod construction;
mod editing;
mod input;
mod query;
mod subdivision;
mod workload;
mod zero_cost;

use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use study::{Policy, pages};

/// Freed pages stay with the process, as in a study: what allocates is measured without page faults.
///
/// Short measurements: there are hundreds of benchmarks, and the ratios within a group settle early.
fn short() -> Criterion {
    pages::put_in_force(Policy::Kept);
    Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(400))
        .configure_from_args()
}

criterion_group! {
    name = all;
    config = short();
    targets = zero_cost::define, construction::define, workload::define, query::define,
        subdivision::define, editing::define
}
criterion_main!(all);
