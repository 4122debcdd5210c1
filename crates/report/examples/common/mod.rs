//! Shared code of the programs that make reports.
//!
//! A program measures in launches: it starts itself several times with `--launch`, and each process measures everything
//! and writes its rows as JSON. What changes from process to process, such as addresses, is therefore part of the variation.

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde::de::DeserializeOwned;
use sixfold_results::{Policy, Run, RunSettings};
use sixfold_study::HeapGuard;

/// Describes the machine, and keeps freed memory pages from now on.
pub(crate) fn start() -> Run {
    let heap = HeapGuard::acquire(Policy::Kept).expect("the only guard");
    let mut run = sixfold_study::start_run(RunSettings::default());
    run.environment.heap = Some(heap.hold_until_exit());
    run
}

/// Number of rounds of a launch, each of which runs everything once. The time of a launch is their median.
pub(crate) const ROUNDS: usize = 3;

/// What the program is asked to do, from its arguments.
pub(crate) enum Task {
    /// To measure in this number of launches, and to write the report into the folder.
    Measure(PathBuf, usize),
    /// To measure once, and to write the rows to standard output.
    Launch,
    /// To draw the figure again, from the data in the folder.
    Draw(PathBuf),
}

pub(crate) fn task() -> Result<Task, Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    Ok(match words[..] {
        ["--launch"] => Task::Launch,
        [folder, "--draw"] => Task::Draw(folder.into()),
        [folder] => Task::Measure(folder.into(), 5),
        [folder, launches] => Task::Measure(folder.into(), launches.parse::<NonZeroUsize>()?.get()),
        _ => return Err("usage: FOLDER [LAUNCHES | --draw]".into()),
    })
}

/// Starts this program `count` times, one after the other, and returns the rows of each launch.
pub(crate) fn launches<Row: DeserializeOwned>(
    count: usize,
) -> Result<Vec<Vec<Row>>, Box<dyn Error>> {
    let mut launches = Vec::new();
    for launch in 1..=count {
        let mut command = Command::new(std::env::current_exe()?);
        let output = command.arg("--launch").stderr(Stdio::inherit()).output()?;
        if !output.status.success() {
            return Err(format!("launch {launch} failed: {}", output.status).into());
        }
        launches.push(serde_json::from_slice(&output.stdout)?);
        eprintln!("launch {launch} of {count} measured");
    }
    Ok(launches)
}

/// Returns the command that makes the report, as a code block, and a description of the machine. `times` has the times
/// of the launches for each row.
pub(crate) fn introduction<'a>(
    run: &Run,
    example: &str,
    folder: &str,
    times: impl Iterator<Item = &'a [f64]>,
) -> String {
    let flags = match &*run.environment.rustflags {
        "" => String::new(),
        flags => format!("RUSTFLAGS=\"{flags}\" "),
    };
    let times: Vec<&[f64]> = times.collect();
    let launches = times.iter().map(|row| row.len()).max().unwrap_or(0);
    let spreads: Vec<f64> = times.iter().filter_map(|row| spread(row)).collect();
    let varies = match spreads[..] {
        [] => String::new(),
        _ => format!(
            " From launch to launch, a time varies by {:.1} % (the standard deviation divided by the mean; median over all times).",
            100.0 * median(&spreads)
        ),
    };
    let machine = sixfold_report::machine(&run.environment);
    format!(
        "```sh\n{flags}cargo run --release -p sixfold-report --example {example} -- {folder} {launches}\n```\n\n\
         {machine}; one thread.\n\n\
         The times are medians of {launches} launches. A launch is a process of its own, and its time is the median of \
         {ROUNDS} rounds; a round runs every line of the tables once.{varies}"
    )
}

/// Returns the standard deviation divided by the mean; `None` for fewer than two times.
fn spread(times: &[f64]) -> Option<f64> {
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    let squares: f64 = times.iter().map(|time| (time - mean).powi(2)).sum();
    (times.len() > 1).then(|| (squares / (times.len() - 1) as f64).sqrt() / mean)
}

pub(crate) fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    f64::midpoint(sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2])
}
