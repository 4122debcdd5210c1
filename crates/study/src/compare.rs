//! Comparison of two studies of one mesh: what changed between machines, compilers or commits.
//!
//! Two studies have no common rounds. A ratio is therefore the quotient of two medians. The
//! interval is found by resampling both studies (bootstrap). A machine may also drift from one
//! study to the next, which the samples do not show. [`DRIFT`] is the default limit for the drift.

use std::io;

use serde::Serialize;
use sixfold_workload::Operation;

use crate::control::noise;
use crate::environment::Environment;
use crate::ranking::CLEAR_DIFFERENCE;
use crate::report::{RawSamples, Report, ResultRow, SCHEMA, Standing, write_json};
use crate::statistics::{Median, quotient};

/// Default limit for the drift of an unchanged machine, as a ratio of times. It is about twice the
/// typical drift of a virtual machine (reports/repeatability).
pub const DRIFT: f64 = 1.2;

/// Options of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareSettings {
    /// Whether to divide each ratio by the median ratio of all rows. This is useful for two
    /// machines of different speed.
    pub relative: bool,
    /// Maximum ratio that is ignored, even if the samples show a difference.
    pub drift: f64,
}

impl Default for CompareSettings {
    fn default() -> Self {
        Self {
            relative: false,
            drift: DRIFT,
        }
    }
}

/// The differences between two studies.
#[derive(Clone, Debug, Serialize)]
pub struct Changes {
    /// Version of the JSON schema.
    pub schema: u32,
    /// Names of the two meshes if their facts differ. The rows then compare different work.
    pub meshes: Option<[String; 2]>,
    /// Differences between the studies in machine, program and settings.
    pub environment: Vec<SettingChange>,
    /// Median over all rows of the second time divided by the first time.
    pub overall: Option<f64>,
    /// Whether each ratio was divided by `overall`.
    pub relative: bool,
    /// Maximum ratio that is ignored.
    pub drift: f64,
    /// The rows that both studies measured, in the order of the first study.
    pub rows: Vec<Change>,
    /// Backends whose size in bytes changed: name, size before, size after.
    pub bytes: Vec<(String, usize, usize)>,
    /// Operations whose fastest backend changed.
    pub winners: Vec<NewWinner>,
    /// Rows that only the first study has, as `operation on backend`.
    pub only_before: Vec<String>,
    /// Rows that only the second study has, as `operation on backend`.
    pub only_after: Vec<String>,
    /// The differences as sentences.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
}

/// A difference between two environments.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SettingChange {
    /// Name of the setting.
    pub what: &'static str,
    /// The value in the first study.
    pub before: String,
    /// The value in the second study.
    pub after: String,
}

/// One operation on one backend, in both studies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The backend.
    pub backend: String,
    /// The operation.
    pub operation: Operation,
    /// Median of the first study, in nanoseconds.
    pub before_ns: f64,
    /// Median of the second study, in nanoseconds.
    pub after_ns: f64,
    /// The second median divided by the first.
    pub ratio: f64,
    /// Lower end of the 95 % interval of `ratio`; `None` if a study has fewer than three samples.
    pub ci_low: Option<f64>,
    /// Upper end of the 95 % interval of `ratio`.
    pub ci_high: Option<f64>,
    /// Maximum ratio that is noise.
    pub noise: f64,
    /// The conclusion.
    pub verdict: Verdict,
    /// Whether the checksums differ. The two studies then did different work.
    pub other_checksum: bool,
}

/// The conclusion about one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The second study is faster by more than the noise.
    Faster,
    /// The second study is slower by more than the noise.
    Slower,
    /// The difference is within the noise.
    Same,
}

/// An operation whose fastest backend changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NewWinner {
    /// The operation.
    pub operation: Operation,
    /// The fastest backend of the first study.
    pub before: String,
    /// The fastest backend of the second study.
    pub after: String,
}

/// The reason why the times of two studies cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CompareError {
    /// The heap policies or the cache states differ.
    #[error(
        "the first study was measured with {option} {before}, the second with {option} {after}, \
         so their times cannot be compared: measure both with the same {option}"
    )]
    OtherMemory {
        option: &'static str,
        before: &'static str,
        after: &'static str,
    },
}

/// Compares `after` with `before`.
///
/// # Errors
///
/// Returns an error if the heap policies or the cache states differ.
pub fn compare(
    before: &Report,
    after: &Report,
    settings: CompareSettings,
) -> Result<Changes, CompareError> {
    let memory = [before, after].map(|report| report.environment.memory_settings());
    for (i, option) in ["--heap", "--caches"].into_iter().enumerate() {
        let [before, after] = [memory[0][i], memory[1][i]];
        if before != after {
            return Err(CompareError::OtherMemory {
                option,
                before,
                after,
            });
        }
    }
    let CompareSettings { relative, drift } = settings;
    let mut rows = Vec::new();
    let (mut only_before, mut only_after) = (Vec::new(), Vec::new());
    for row in &before.results {
        match (matching_row(row, after), row.median_ns) {
            (_, None) => {} // an estimate, not a measurement
            (Some(other), Some(_)) => rows.extend(change(before, row, after, other, drift)),
            (None, Some(_)) => only_before.push(row_name(row)),
        }
    }
    let alone = |row: &&ResultRow| row.median_ns.is_some() && matching_row(row, before).is_none();
    only_after.extend(after.results.iter().filter(alone).map(row_name));
    let overall = Median::from_samples(rows.iter().map(|row| row.ratio)).map(|median| median.value);
    let divisor = overall.filter(|_| relative).unwrap_or(1.0);
    for row in &mut rows {
        row.verdict = verdict(row, divisor);
    }
    let same_mesh = before.mesh.facts == after.mesh.facts;
    let mut changes = Changes {
        schema: SCHEMA,
        meshes: (!same_mesh).then(|| [before.mesh.name.clone(), after.mesh.name.clone()]),
        environment: differences(&before.environment, &after.environment),
        overall,
        relative,
        drift,
        rows,
        bytes: bytes(before, after),
        winners: winners(before, after),
        only_before,
        only_after,
        sentences: Vec::new(),
    };
    changes.sentences = changes.describe();
    Ok(changes)
}

fn row_name(row: &ResultRow) -> String {
    format!("{} on {}", row.operation, row.backend)
}

fn matching_row<'r>(row: &ResultRow, report: &'r Report) -> Option<&'r ResultRow> {
    let mut rows = report.rows(row.operation);
    rows.find(|other| other.backend == row.backend && other.median_ns.is_some())
}

fn change(
    before: &Report,
    row: &ResultRow,
    after: &Report,
    other: &ResultRow,
    drift: f64,
) -> Option<Change> {
    let [a, b] = [samples(before, row), samples(after, other)];
    let quotient = quotient(&b, &a).or_else(|| {
        let value = other.median_ns? / row.median_ns?;
        value.is_finite().then_some((value, None))
    });
    let (ratio, interval) = quotient?;
    let noises = [before, after].map(|report| noise(report.control.as_ref(), row.operation));
    let noise = noises.into_iter().fold(drift, f64::max);
    let both = row.checksum.zip(other.checksum);
    let comparable = row.sample_size == other.sample_size;
    Some(Change {
        backend: row.backend.clone(),
        operation: row.operation,
        before_ns: row.median_ns?,
        after_ns: other.median_ns?,
        ratio,
        ci_low: interval.map(|[low, _]| low),
        ci_high: interval.map(|[_, high]| high),
        noise,
        verdict: Verdict::Same,
        other_checksum: comparable && both.is_some_and(|(a, b)| !nearly_equal(a, b)),
    })
}

/// Returns whether two checksums may be of the same work. Sums of `f32` in different orders differ
/// by at most 10⁻⁴ of their size.
fn nearly_equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-4 * a.abs().max(b.abs())
}

fn samples(report: &Report, row: &ResultRow) -> Vec<f64> {
    let mut raw = report.raw.iter();
    let found = raw
        .find(|raw| !raw.control && raw.operation == row.operation && raw.backend == row.backend);
    found.map_or_else(Vec::new, RawSamples::counted_ns)
}

fn verdict(row: &Change, divisor: f64) -> Verdict {
    let ratio = row.ratio / divisor;
    let [low, high] = [row.ci_low, row.ci_high].map(|end| end.map(|end| end / divisor));
    let (slower, faster) = match low.zip(high) {
        Some((low, high)) => (low > 1.0, high < 1.0),
        None => (ratio > CLEAR_DIFFERENCE, ratio < CLEAR_DIFFERENCE.recip()),
    };
    if slower && ratio > row.noise {
        Verdict::Slower
    } else if faster && ratio < row.noise.recip() {
        Verdict::Faster
    } else {
        Verdict::Same
    }
}

fn differences(before: &Environment, after: &Environment) -> Vec<SettingChange> {
    fn shown<T: ToString>(value: Option<&T>) -> String {
        value.map_or_else(|| "not known".into(), ToString::to_string)
    }
    let heap = |e: &Environment| {
        let heap = e.heap.as_ref()?;
        let pages = heap
            .transparent_huge_pages
            .as_deref()
            .unwrap_or("not known");
        Some(format!("{}, huge pages: {pages}", heap.allocator))
    };
    let facts = |e: &Environment| -> [(&'static str, String); 13] {
        [
            ("processor", shown(e.cpu_model.as_ref())),
            ("cores", shown(e.cores.as_ref())),
            ("system", format!("{} {}", e.os, e.arch)),
            ("kernel", shown(e.kernel.as_ref())),
            ("governor", shown(e.governor.as_ref())),
            ("boost", shown(e.boost.as_ref())),
            ("compiler", e.rustc.clone()),
            ("profile", format!("{} -O{}", e.profile, e.opt_level)),
            ("flags", e.rustflags.clone()),
            ("sixfold", e.sixfold.clone()),
            ("commit", shown(e.commit.as_ref())),
            ("clock", e.clock.clone()),
            ("allocator", shown(heap(e).as_ref())),
        ]
    };
    let pairs = facts(before).into_iter().zip(facts(after));
    let differs = pairs.filter(|((_, before), (_, after))| before != after);
    let setting = |((what, before), (_, after))| SettingChange {
        what,
        before,
        after,
    };
    differs.map(setting).collect()
}

fn bytes(before: &Report, after: &Report) -> Vec<(String, usize, usize)> {
    let changed = before.backends.iter().filter_map(|column| {
        let other = after
            .backends
            .iter()
            .find(|other| other.name == column.name)?;
        let (before, after) = column.bytes.zip(other.bytes)?;
        (before != after).then(|| (column.name.clone(), before, after))
    });
    changed.collect()
}

fn winners(before: &Report, after: &Report) -> Vec<NewWinner> {
    let winner = |report: &Report, operation: Operation| {
        let mut rows = report.rows(operation);
        let best = rows.find(|row| row.standing == Some(Standing::Best));
        best.map(|row| row.backend.clone())
    };
    let new = Operation::ALL.into_iter().filter_map(|operation| {
        let (before, after) = (winner(before, operation)?, winner(after, operation)?);
        (before != after).then_some(NewWinner {
            operation,
            before,
            after,
        })
    });
    new.collect()
}

impl Changes {
    /// Iterates over the rows that are faster or slower, or have a different checksum.
    pub fn changed(&self) -> impl Iterator<Item = &Change> {
        let changed = |row: &&Change| row.verdict != Verdict::Same || row.other_checksum;
        self.rows.iter().filter(changed)
    }

    /// Counts the rows with `verdict`.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rows
            .iter()
            .filter(|row| row.verdict == verdict)
            .count()
    }

    /// Writes the changes as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }

    fn describe(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if let Some([before, after]) = &self.meshes {
            sentences.push(format!(
                "The meshes differ ({before}, {after}), so the two studies did different work: \
                 compare only the ratios between backends."
            ));
        }
        let (slower, faster) = (self.count(Verdict::Slower), self.count(Verdict::Faster));
        let same = self.count(Verdict::Same);
        sentences.push(format!(
            "Of {} figures, {faster} are faster in the second study, {slower} are slower, and \
             {same} are equal within the noise.",
            self.rows.len()
        ));
        if let Some(overall) = self.overall {
            let factor = overall.max(overall.recip());
            let machines = self.environment.iter().any(|s| s.what == "processor");
            if factor > self.drift {
                let hint = match (self.relative, machines) {
                    (true, _) => ". Each ratio is divided by this median before it is judged",
                    (false, true) => {
                        ". The machines differ: to divide each ratio by this median, \
                                      use --relative"
                    }
                    (false, false) => {
                        ". If a machine was busy or hot, use --relative to divide each ratio by \
                         this median"
                    }
                };
                sentences.push(format!(
                    "Overall, the second study takes {overall:.2} × the time of the first (median \
                     of all ratios){hint}."
                ));
            }
        }
        for winner in &self.winners {
            sentences.push(format!(
                "{}: the fastest backend was {} and is now {}.",
                winner.operation, winner.before, winner.after
            ));
        }
        let others: Vec<String> = self
            .rows
            .iter()
            .filter(|row| row.other_checksum)
            .map(|row| format!("{} on {}", row.operation, row.backend))
            .collect();
        if !others.is_empty() {
            sentences.push(format!(
                "The checksums of these figures differ, so the two studies did different work: {}.",
                others.join(", ")
            ));
        }
        sentences
    }
}

#[cfg(test)]
mod tests;
