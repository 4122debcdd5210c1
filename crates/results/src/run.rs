//! How results were measured: the command, its settings, and the machine.

use std::collections::BTreeMap;
use std::num::NonZeroU32;

use serde::{Deserialize, Serialize};

use crate::confidence::Confidence;
use crate::environment::{CacheState, Environment, Policy};
use crate::merge::MergeError;
use crate::numbers::counted;
use crate::operation::{OperationInfo, Purpose};

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
    /// The operations that this version of Sixfold can measure, in the order of tables. Empty for a
    /// command that measures no operations.
    pub operations: Vec<OperationInfo>,
    /// What the user calls this measurement, such as the name of an experiment.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tags: BTreeMap<String, String>,
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
    pub operations: Vec<String>,
    /// Time budget of the finding, in seconds; `None` if the number of rounds was given instead.
    pub budget_s: Option<f64>,
    /// The number of rounds of each launch; `None` if the time budget was given instead.
    pub rounds: Option<NonZeroU32>,
    /// The number of launches: fresh processes of the command that measured the same. `None` if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub launches: Option<NonZeroU32>,
    /// Seed of the random numbers. The seed determines the order in which samples take elements,
    /// the order of the measurements, and the order `shuffled`, but not the size of a sample.
    pub seed: u64,
    /// The requested policy for freed memory pages. The environment has the policy in force.
    pub heap: Policy,
    /// State of the processor caches when a timed series of runs begins.
    pub caches: CacheState,
    /// The number of untimed runs before each sample, if it was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warm_up: Option<u32>,
    /// The confidence of all intervals; in JSON, left out if it is 0.95.
    #[serde(default, skip_serializing_if = "Confidence::is_default")]
    pub confidence: Confidence,
    /// True if faces with more than three corners were cut into triangles before the measurement.
    pub triangulate: bool,
    /// True if files with degenerate faces were refused.
    pub strict: bool,
    /// The options with which a study read mesh files, such as `--as-stored`; empty for the default.
    #[serde(default)]
    pub reading: Vec<String>,
}

impl Run {
    /// Returns what is known about an operation; `None` if the run cannot measure it.
    pub fn operation(&self, name: &str) -> Option<&OperationInfo> {
        self.operations.iter().find(|info| info.name == name)
    }

    /// Returns the purpose that an operation serves; `None` if the run cannot measure it.
    pub fn purpose_of(&self, operation: &str) -> Option<Purpose> {
        Some(self.operation(operation)?.group.purpose())
    }

    /// Returns the subdivision scheme of an operation; `None` if the operation is not a subdivision.
    pub fn scheme_of(&self, operation: &str) -> Option<&str> {
        self.operation(operation)?.scheme.as_deref()
    }

    /// Adds the launches of `other`, which measured the same.
    pub fn add_launches(&mut self, other: &Self) {
        let launches = |run: &Self| run.settings.launches.map_or(1, NonZeroU32::get);
        let count = launches(self) + launches(other);
        let budgets = self.settings.budget_s.zip(other.settings.budget_s);
        self.settings.budget_s = budgets.map(|(ours, theirs)| ours + theirs);
        self.settings.launches = NonZeroU32::new(count);
    }

    /// Returns an error if `other` has other settings than the seed and the budget, so that it is no further
    /// launch of this run.
    pub(crate) fn check_repeats(&self, other: &Self) -> Result<(), MergeError> {
        let theirs = RunSettings {
            seed: self.settings.seed,
            budget_s: other.settings.budget_s.and(self.settings.budget_s),
            launches: self.settings.launches,
            ..other.settings.clone()
        };
        self.settings.check_equal(&theirs)?;
        let [ours, theirs] = [self, other].map(|run| run.environment.memory_settings());
        match ours == theirs {
            true => Ok(()),
            false => Err(MergeError::other_memory(ours, theirs)),
        }
    }

    /// Returns whether the command, the settings and the environment are the same. The start may
    /// differ.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let parts = |run: &Self| (run.command.clone(), run.settings.clone());
        parts(self) == parts(other)
            && self.tags == other.tags
            && (&self.environment, &self.operations) == (&other.environment, &other.operations)
    }
}

impl RunSettings {
    /// Returns the time budget or the number of rounds as text, such as `20 s`, `5 rounds` or
    /// `60 s in 8 launches`.
    pub fn effort_text(&self) -> String {
        let effort = match (self.budget_s, self.rounds) {
            (_, Some(rounds)) => counted(rounds.get() as usize, "round", "rounds"),
            // The budgets of the meshes of a folder are quotients.
            (budget_s, None) => format!("{} s", (100.0 * budget_s.unwrap_or(0.0)).round() / 100.0),
        };
        let of_each = if self.rounds.is_some() { " each" } else { "" };
        match self.launches {
            Some(launches) => format!("{effort}{of_each} in {launches} launches"),
            None => effort,
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
        match self.difference(other) {
            Some((what, ours, theirs)) => Err(MergeError::OtherSettings { what, ours, theirs }),
            None => Ok(()),
        }
    }

    /// Returns the first option in which `other` differs, with the value of each; `None` if the settings are the same.
    pub fn difference(&self, other: &Self) -> Option<(&'static str, String, String)> {
        let effort = match (self.rounds, other.rounds) {
            (Some(_), Some(_)) => "--rounds",
            _ => "--budget",
        };
        let options = |settings: &Self| -> [(&'static str, String); 12] {
            [
                ("--backends", settings.backends.join(",")),
                ("--external", settings.externals.join(",")),
                ("--operations", settings.operations.join(",")),
                (effort, settings.effort_text()),
                ("--seed", settings.seed.to_string()),
                ("--heap", settings.heap.to_string()),
                ("--caches", settings.caches.name().into()),
                (
                    "--warmup",
                    settings.warm_up.map_or(String::new(), |n| n.to_string()),
                ),
                ("--confidence", settings.confidence.to_string()),
                ("--triangulate", settings.triangulate.to_string()),
                ("--strict", settings.strict.to_string()),
                ("reading of mesh files", settings.reading.join(" ")),
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
                return Some((what, ours, theirs));
            }
        }
        None
    }
}
