//! How results were measured: the command, its settings, and the machine.

use std::num::NonZeroU32;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};
use sixfold_workload::Operation;
use sixfold_workload::pages::Policy;
use sysinfo::System;

use crate::engine::effort::Effort;
use crate::engine::heap::{CacheState, Memory};
use crate::labs::study::Settings;
use crate::results::environment::Environment;
use crate::results::merge::MergeError;
use sixfold_results::numbers::counted;

/// How results were measured: the command, its settings, the program and the machine.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Run {
    /// The command line that repeats the measurement; `None` if the results were not made by the
    /// command `sixfold`.
    pub command: Option<String>,
    /// The settings that all measuring commands share. The settings of one command, such as the
    /// workload of a pick, are in its finding.
    pub settings: RunSettings,
    /// The program and the machine.
    pub environment: Environment,
    /// The start of the measurement. In JSON, the field `start` of the finding.
    #[serde(skip)]
    pub start: Start,
}

/// The start of a measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Start {
    /// The time, in seconds since 1970.
    pub unix_time: u64,
    /// Mean number of runnable threads in the minute before the measurement; `None` if unknown.
    pub load_average: Option<f64>,
}

/// The settings that all measuring commands share.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct RunSettings {
    /// The names of the requested backends. An empty list means all backends.
    pub backends: Vec<String>,
    /// The names of the external programs.
    pub externals: Vec<String>,
    /// The requested operations. An empty list means the default of the command.
    pub operations: Vec<Operation>,
    /// Time budget of the finding, in seconds; `None` if the number of rounds was given instead.
    pub budget_s: Option<f64>,
    /// The number of rounds; `None` if the time budget was given instead.
    #[serde(default)]
    pub rounds: Option<NonZeroU32>,
    /// Seed of the random numbers. The seed determines the order in which samples take elements,
    /// the order of the measurements, and the order `shuffled`, but not the size of a sample.
    pub seed: u64,
    /// The requested policy for freed memory pages. The environment has the policy in force.
    pub heap: Policy,
    /// State of the processor caches when a timed series of runs begins.
    pub caches: CacheState,
    /// True if faces with more than three corners were cut into triangles before the measurement.
    pub triangulate: bool,
    /// True if files with degenerate faces were refused.
    pub strict: bool,
}

impl Run {
    /// Describes a measurement that begins now.
    pub fn start(settings: RunSettings) -> Self {
        Self {
            command: None,
            settings,
            environment: Environment::detect(),
            start: Start::now(),
        }
    }

    /// Returns whether the command, the settings and the environment are the same. The start may
    /// differ.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let parts = |run: &Self| (run.command.clone(), run.settings.clone());
        parts(self) == parts(other) && self.environment == other.environment
    }

    /// Adds the heap policy and the cache state that are in force.
    pub(crate) fn with_memory(self, memory: &Memory) -> Self {
        Self {
            environment: self.environment.with_memory(memory),
            ..self
        }
    }
}

impl Start {
    /// Returns the current time and load.
    fn now() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            unix_time: since.map_or(0, |time| time.as_secs()),
            load_average: cfg!(unix).then(|| System::load_average().one),
        }
    }
}

impl RunSettings {
    /// Returns the default settings with `effort`.
    pub fn of_effort(effort: Effort) -> Self {
        Self {
            budget_s: effort.budget().map(|budget| budget.as_secs_f64()),
            rounds: effort.rounds(),
            ..Self::default()
        }
    }

    /// Returns the time budget or the number of rounds as text, such as `20 s` or `5 rounds`.
    pub fn effort_text(&self) -> String {
        match (self.budget_s, self.rounds) {
            (_, Some(rounds)) => counted(rounds.get() as usize, "round", "rounds"),
            // The budgets of the meshes of a folder are quotients.
            (budget_s, None) => format!("{} s", (100.0 * budget_s.unwrap_or(0.0)).round() / 100.0),
        }
    }

    /// Returns the settings of a study. The study does not know `triangulate` and `strict`, so both
    /// are false.
    pub fn of_study(settings: &Settings) -> Self {
        let externals = settings.externals.iter().map(|other| other.name.clone());
        Self {
            backends: settings.backends.clone(),
            externals: externals.collect(),
            operations: settings.operations.clone(),
            seed: settings.seed,
            heap: settings.heap,
            caches: settings.caches,
            ..Self::of_effort(settings.effort)
        }
    }

    /// Returns what gives more samples: a longer budget or more rounds.
    pub fn more_samples(&self) -> &'static str {
        match self.rounds {
            None => "a longer --budget",
            Some(_) => "more --rounds",
        }
    }

    /// Returns an error if `other` has other settings, because the times of two studies can then
    /// not be pooled.
    pub(crate) fn check_equal(&self, other: &Self) -> Result<(), MergeError> {
        let effort = match (self.rounds, other.rounds) {
            (Some(_), Some(_)) => "--rounds",
            _ => "--budget",
        };
        let options = |settings: &Self| -> [(&'static str, String); 9] {
            let operations: Vec<&str> = settings.operations.iter().map(|o| o.name()).collect();
            [
                ("--backends", settings.backends.join(",")),
                ("--external", settings.externals.join(",")),
                ("--operations", operations.join(",")),
                (effort, settings.effort_text()),
                ("--seed", settings.seed.to_string()),
                ("--heap", settings.heap.to_string()),
                ("--caches", settings.caches.name().into()),
                ("--triangulate", settings.triangulate.to_string()),
                ("--strict", settings.strict.to_string()),
            ]
        };
        for ((what, ours), (_, theirs)) in options(self).into_iter().zip(options(other)) {
            if ours != theirs {
                let none = match what {
                    "--backends" => "all",
                    "--external" => "not given",
                    _ => "the default",
                };
                let [ours, theirs] = [ours, theirs].map(|text| match text.is_empty() {
                    true => none.into(),
                    false => text,
                });
                return Err(MergeError::OtherSettings { what, ours, theirs });
            }
        }
        Ok(())
    }
}
