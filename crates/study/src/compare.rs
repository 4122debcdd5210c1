//! Comparison of two studies of one mesh: what changed between machines, compilers or commits.
//!
//! Two studies have no rounds in common. The time in one study is therefore compared with the time
//! in the other study by the ratio of the medians. The confidence interval of the ratio is computed
//! by resampling both studies (bootstrap). The speed of a machine may also drift between two
//! studies, and the samples of a study do not show this drift. [`DRIFT`] is the default limit for
//! the drift.

use std::io;

use serde::Serialize;
use sixfold_workload::Operation;

use crate::control::noise;
use crate::environment::Environment;
use crate::numbers::counted;
use crate::ranking::CLEAR_DIFFERENCE;
use crate::report::{RawSamples, Report, ResultRow, SCHEMA, Standing, write_json};
use crate::statistics::{Median, quotient};

/// Default limit for the drift between two studies on an unchanged machine, as a ratio of times.
/// The limit of 20 % is about twice the typical drift of a virtual machine (reports/repeatability).
pub const DRIFT: f64 = 1.2;

/// Options of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareSettings {
    /// If true, each ratio is divided by the median ratio of all operations and backends. Use this
    /// option for two machines of different speed.
    pub relative: bool,
    /// Ratios of times up to this value are ignored, even if the samples show a difference.
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
    /// Differences of machines, programs and settings.
    pub environment: Vec<SettingChange>,
    /// The time in the second study divided by the time in the first study, as the median over all
    /// entries of `rows`. `None` if `rows` is empty.
    pub overall: Option<f64>,
    /// True if each ratio was divided by `overall` before the ratio was compared with the noise.
    pub relative: bool,
    /// Ratios of times up to this value are ignored.
    pub drift: f64,
    /// The times of the operations and backends that both studies measured, in the order of the
    /// first study.
    pub rows: Vec<Change>,
    /// Backends whose size changed: the name, the bytes in the first study, and the bytes in the
    /// second study.
    pub bytes: Vec<(String, usize, usize)>,
    /// Operations whose fastest backend changed.
    pub winners: Vec<NewWinner>,
    /// Measurements that only the first study contains, as texts such as `build on half-edge`.
    pub only_before: Vec<String>,
    /// Measurements that only the second study contains, as texts such as `build on half-edge`.
    pub only_after: Vec<String>,
    /// Sentences that describe the differences.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
}

/// A difference between the machines, programs or settings of two studies.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SettingChange {
    /// Name of the setting.
    pub what: &'static str,
    /// The value in the first study.
    pub before: String,
    /// The value in the second study.
    pub after: String,
}

/// The times of one operation on one backend in two studies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The measured operation, such as `vertex_normal`.
    pub operation: Operation,
    /// Median time in the first study, in nanoseconds.
    pub before_ns: f64,
    /// Median time in the second study, in nanoseconds.
    pub after_ns: f64,
    /// The median time in the second study divided by the median time in the first study.
    pub ratio: f64,
    /// Lower end of the 95 % confidence interval of `ratio`; `None` if a study has fewer than three
    /// samples.
    pub ci_low: Option<f64>,
    /// Upper end of the 95 % confidence interval of `ratio`.
    pub ci_high: Option<f64>,
    /// Ratios of times up to this value count as noise.
    pub noise: f64,
    /// Whether the second study is faster, slower or equal within the noise.
    pub verdict: Verdict,
    /// True if the checksums differ. The two studies then did different work.
    pub other_checksum: bool,
}

/// The conclusion about the times of one operation on one backend in two studies.
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
    /// The measured operation, such as `vertex_normal`.
    pub operation: Operation,
    /// The name of the fastest backend in the first study.
    pub before: String,
    /// The name of the fastest backend in the second study.
    pub after: String,
}

/// The reason why the times of two studies cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CompareError {
    /// The two studies have different heap policies or different cache states.
    #[error(
        "the first study was measured with {option} {before}, the second with {option} {after}, \
         so their times cannot be compared: measure both with the same {option}"
    )]
    OtherMemory {
        option: &'static str,
        before: &'static str,
        after: &'static str,
    },
    /// The studies are of different meshes.
    #[error(
        "the first is of {before} ({before_counts}), the second of {after} ({after_counts}): times of different meshes cannot be compared; measure one mesh twice"
    )]
    OtherMesh {
        before: String,
        before_counts: String,
        after: String,
        after_counts: String,
    },
}

/// Compares two studies of one mesh.
///
/// # Errors
///
/// Returns an error if the meshes, the heap policies or the cache states of the studies differ.
pub fn compare(
    before: &Report,
    after: &Report,
    settings: CompareSettings,
) -> Result<Changes, CompareError> {
    if before.mesh.facts != after.mesh.facts {
        let counts = |report: &Report| {
            let facts = &report.mesh.facts;
            let vertices = counted(facts.vertices, "vertex", "vertices");
            format!("{vertices}, {}", counted(facts.faces, "face", "faces"))
        };
        return Err(CompareError::OtherMesh {
            before: before.mesh.name.clone(),
            before_counts: counts(before),
            after: after.mesh.name.clone(),
            after_counts: counts(after),
        });
    }
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
    let mut changes = Changes {
        schema: SCHEMA,
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

fn is_or_are(count: usize) -> &'static str {
    match count {
        1 => "is",
        _ => "are",
    }
}

impl Changes {
    /// Iterates over the entries of `rows` in which the second study is faster or slower, or has
    /// another checksum than the first study.
    pub fn changed(&self) -> impl Iterator<Item = &Change> {
        let changed = |row: &&Change| row.verdict != Verdict::Same || row.other_checksum;
        self.rows.iter().filter(changed)
    }

    /// Counts the entries of `rows` with the given verdict.
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
        let (slower, faster) = (self.count(Verdict::Slower), self.count(Verdict::Faster));
        let same = self.count(Verdict::Same);
        sentences.push(format!(
            "Of {}, {faster} {} faster in the second study, {slower} {} slower, and {same} {} \
             equal within the noise.",
            counted(self.rows.len(), "measurement", "measurements"),
            is_or_are(faster),
            is_or_are(slower),
            is_or_are(same)
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
                "The checksums of these results differ, so the two studies did different work: {}.",
                others.join(", ")
            ));
        }
        sentences
    }
}

#[cfg(test)]
mod tests;
