//! Shared code of the programs that make reports.
//!
//! A program measures in launches: it starts itself several times with `--launch`, and each process measures everything
//! and writes its rows as JSON. What changes from process to process, such as addresses, is therefore part of the variation.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::error::Error;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sixfold_results::{Environment, Policy, Run, RunSettings, Start};
use sixfold_study::HeapGuard;

/// Describes the machine, and keeps freed memory pages from now on.
pub(crate) fn start() -> Run {
    let heap = HeapGuard::acquire(Policy::Kept).expect("the only guard");
    let mut run = sixfold_study::start_run(RunSettings::default());
    run.environment.heap = Some(heap.hold_until_exit());
    run
}

/// What the program is asked to do, from its arguments.
pub(crate) enum Task {
    /// To measure in this number of launches, and to write the report into the folder.
    Measure(PathBuf, usize),
    /// To measure once, and to write the rows to standard output.
    Launch,
    /// To write the text and the figure again, from the data in the folder.
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

/// A row of a report: what was measured, and one time for each launch.
pub(crate) trait Row: DeserializeOwned + Serialize {
    /// What was measured.
    type Key: Ord;
    fn key(&self) -> Self::Key;
    fn times(&self) -> &[f64];
    fn add_times(&mut self, times: &[f64]);
}

/// The data of a report.
#[derive(Deserialize, Serialize)]
pub(crate) struct Data<R> {
    environment: Environment,
    start: Start,
    launches: usize,
    rounds: usize,
    pub(crate) results: Vec<R>,
}

impl<R: Row> Data<R> {
    /// Starts this program `launches` times, one after the other, and collects the times of equal rows. A launch has
    /// this number of `rounds`, each of which runs everything once; its time is their median.
    pub(crate) fn measure(launches: usize, rounds: usize) -> Result<Self, Box<dyn Error>> {
        let run = start();
        let mut rows: BTreeMap<R::Key, R> = BTreeMap::new();
        for launch in 1..=launches {
            let mut command = Command::new(std::env::current_exe()?);
            let output = command.arg("--launch").stderr(Stdio::inherit()).output()?;
            if !output.status.success() {
                return Err(format!("launch {launch} failed: {}", output.status).into());
            }
            for row in serde_json::from_slice::<Vec<R>>(&output.stdout)? {
                match rows.entry(row.key()) {
                    Entry::Vacant(entry) => _ = entry.insert(row),
                    Entry::Occupied(mut entry) => entry.get_mut().add_times(row.times()),
                }
            }
            eprintln!("launch {launch} of {launches} measured");
        }
        Ok(Self {
            environment: run.environment,
            start: run.start,
            launches,
            rounds,
            results: rows.into_values().collect(),
        })
    }

    pub(crate) fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        Ok(serde_json::from_slice(&fs::read(path)?)?)
    }

    pub(crate) fn write(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        fs::create_dir_all(path.parent().unwrap_or(path))?;
        Ok(fs::write(path, serde_json::to_string_pretty(self)? + "\n")?)
    }

    /// Returns the command that makes the report, as a code block, and a description of the machine.
    pub(crate) fn introduction(&self, example: &str, folder: &str) -> String {
        let Self { launches, .. } = self;
        let spreads: Vec<f64> = self
            .results
            .iter()
            .filter_map(|row| spread(row.times()))
            .collect();
        let varies = match spreads[..] {
            [] => String::new(),
            _ => format!(
                " From launch to launch, a time varies by {:.1} % (the standard deviation divided by the mean; median over all times).",
                100.0 * median(&spreads)
            ),
        };
        let machine = sixfold_report::machine(&self.environment);
        let rounds = match self.rounds {
            1 => " that runs every line of the tables once".to_owned(),
            rounds => format!(
                "; its time is the median of {rounds} rounds, each of which runs every line of the tables once"
            ),
        };
        format!(
            "```sh\ncargo run --release -p sixfold-report --example {example} -- {folder} {launches}\n```\n\n\
             {machine}; one thread.\n\n\
             The times are medians of {launches} launches. A launch is a process of its own{rounds}.{varies}"
        )
    }
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
