//! Shared code of the programs that make reports.

use sixfold_results::{Policy, Run, RunSettings};
use sixfold_study::HeapGuard;

/// Describes the machine, and keeps freed memory pages from now on.
pub(crate) fn start() -> Run {
    let heap = HeapGuard::acquire(Policy::Kept).expect("the only guard");
    let mut run = sixfold_study::start_run(RunSettings::default());
    run.environment.heap = Some(heap.hold_until_exit());
    run
}

/// Returns the command that makes the report, as a code block, and a description of the machine.
pub(crate) fn introduction(run: &Run, example: &str, folder: &str, rounds: usize) -> String {
    let machine = &run.environment;
    let cpu = machine.cpu_model.as_deref().unwrap_or("unknown processor");
    let load = run.start.load_average.unwrap_or(f64::NAN);
    let flags = match machine.rustflags.as_str() {
        "" => String::new(),
        flags => format!("RUSTFLAGS=\"{flags}\" "),
    };
    format!(
        "```sh\n{flags}cargo run --release -p sixfold-report --example {example} -- {folder} {rounds}\n```\n\n\
         {cpu}, {} cores, load {load:.1} at the start; {} {} {}; one thread, processor time of the thread, \
         medians of {rounds} rounds (each round runs every line of the tables once).",
        machine.cores.unwrap_or(0),
        machine.rustc,
        machine.profile,
        machine.rustflags,
    )
}

pub(crate) fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    f64::midpoint(sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2])
}
