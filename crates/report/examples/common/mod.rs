//! Shared code of the programs that make reports.
//!
//! A program measures in launches: it starts itself several times with `--launch`, and each process measures everything
//! and writes its rows as JSON. What changes from process to process, such as addresses, is therefore part of the variation.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::{Command, Stdio};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sixfold_results::{Environment, Policy, Run, RunSettings, Start};
use sixfold_study::HeapGuard;

/// Describes the machine, and keeps freed memory pages from now on.
fn start() -> Run {
    let heap = HeapGuard::acquire(Policy::Kept).expect("the only guard");
    sixfold_study::note_commit();
    let mut run = sixfold_study::start_run(RunSettings::default());
    run.environment.heap = Some(heap.hold_until_exit());
    run
}

/// A row of a report: what was measured, and one time in nanoseconds for each launch.
#[derive(Deserialize, Serialize)]
pub(crate) struct Row<W> {
    #[serde(flatten)]
    pub(crate) what: W,
    cpu_ns: Vec<f64>,
}

impl<W> Row<W> {
    /// Returns the median of the launches.
    pub(crate) fn ns(&self) -> f64 {
        median(&self.cpu_ns)
    }
}

/// The data of a report.
#[derive(Deserialize, Serialize)]
pub(crate) struct Data<W> {
    environment: Environment,
    start: Start,
    launches: usize,
    rounds: usize,
    pub(crate) results: Vec<Row<W>>,
}

/// Does what the arguments ask for: measures in launches and draws the report, or only draws it again (`--draw`), or is
/// one of the launches. The data are in `file` in the folder of the report. `measure` returns the times of a launch,
/// one for each of its `rounds`, of which the median counts. `draw` writes the text and the figure.
pub(crate) fn run<W: Ord + Serialize + DeserializeOwned>(
    file: &str,
    rounds: usize,
    measure: impl FnOnce() -> Result<BTreeMap<W, Vec<f64>>, Box<dyn Error>>,
    draw: impl FnOnce(&Path, &Data<W>) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (folder, launches) = match words[..] {
        ["--launch"] => {
            start();
            let rows = measure()?.into_iter().map(|(what, times)| Row {
                what,
                cpu_ns: vec![median(&times)],
            });
            let rows: Vec<Row<W>> = rows.collect();
            return Ok(serde_json::to_writer(std::io::stdout(), &rows)?);
        }
        [folder, "--draw"] => (Path::new(folder), None),
        [folder] => (Path::new(folder), Some(5)),
        [folder, launches] => (
            Path::new(folder),
            Some(launches.parse::<NonZeroUsize>()?.get()),
        ),
        _ => return Err("usage: FOLDER [LAUNCHES | --draw]".into()),
    };
    let path = folder.join(file);
    if let Some(launches) = launches {
        let data = Data::<W>::measure(launches, rounds)?;
        fs::create_dir_all(folder)?;
        fs::write(&path, serde_json::to_string_pretty(&data)? + "\n")?;
    }
    draw(folder, &serde_json::from_slice(&fs::read(path)?)?)
}

impl<W: Ord + DeserializeOwned> Data<W> {
    /// Starts this program `launches` times, one after the other, and collects the times of equal rows.
    fn measure(launches: usize, rounds: usize) -> Result<Self, Box<dyn Error>> {
        let run = start();
        let mut rows: BTreeMap<W, Vec<f64>> = BTreeMap::new();
        for launch in 1..=launches {
            let mut command = Command::new(std::env::current_exe()?);
            let output = command.arg("--launch").stderr(Stdio::inherit()).output()?;
            if !output.status.success() {
                return Err(format!("launch {launch} failed: {}", output.status).into());
            }
            for Row { what, cpu_ns } in serde_json::from_slice::<Vec<Row<W>>>(&output.stdout)? {
                rows.entry(what).or_default().extend(cpu_ns);
            }
            eprintln!("launch {launch} of {launches} measured");
        }
        let rows = rows.into_iter().map(|(what, cpu_ns)| Row { what, cpu_ns });
        Ok(Self {
            environment: run.environment,
            start: run.start,
            launches,
            rounds,
            results: rows.collect(),
        })
    }
}

impl<W> Data<W> {
    /// Returns the command that makes the report, as a code block, and a description of the machine.
    pub(crate) fn introduction(&self, example: &str, folder: &str) -> String {
        let Self { launches, .. } = self;
        let spreads: Vec<f64> = self
            .results
            .iter()
            .filter_map(|row| spread(&row.cpu_ns))
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

fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    f64::midpoint(sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2])
}
