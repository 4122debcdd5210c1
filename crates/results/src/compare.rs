//! Comparison of two documents: what changed between machines, compilers or commits.
//!
//! Two measurements at different times have no rounds and no launches in common. The ratio of two times is the
//! quotient of the shown times, and its interval comes from the values of the launches of both. Whether a time
//! became longer is decided relative to the other times (see [`study_changes`]): the speed of a whole machine
//! changes from study to study. A comparison of many times must not call one slower by chance: if the program did not
//! change, all times of a comparison together do so with a probability of at most [`FALSE_ALARM`] (the same holds for
//! faster). A time that was measured in one launch only cannot be compared, because nothing shows how much it varies
//! from process to process; it is slower only if it is twice as long in three samples or more.

mod matching;
mod sentences;

use std::collections::BTreeSet;
use std::io;

use serde::Serialize;

use crate::confidence::Confidence;
use crate::document::{Results, SCHEMA};
use crate::environment::Environment;
use crate::finding::Finding;
use crate::json::write_json;
use crate::launches::{LASTING_SPEED, LaunchPair, StudyChange, study_changes};
use crate::ranking::{CLEAR_DIFFERENCE, EQUAL};
use crate::rows::Standing;
use crate::run::Run;
use crate::statistics::{median, quotient};
use matching::{AllMeasured, CommonMeshes, MeasuredFigure, measurements};
pub(crate) use sentences::{is_or_are, verdict_counts};

/// The probability with which a comparison calls any of its times slower though the program did not change; likewise faster.
pub const FALSE_ALARM: f64 = 1.0 / 200.0;

/// Options of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareSettings {
    /// If true, each ratio is divided by the median of all ratios. Use this option for two machines
    /// of different speed.
    pub relative: bool,
    /// Ratios of times up to this value count as equal, even if they are not due to chance. A time cannot be told
    /// if a change by the square of this value could be due to chance.
    pub noise: f64,
    /// The number of comparisons that are made together: all of them call a time slower or faster by chance as rarely
    /// as one does.
    pub comparisons: usize,
}

impl Default for CompareSettings {
    fn default() -> Self {
        Self {
            relative: false,
            noise: EQUAL,
            comparisons: 1,
        }
    }
}

/// The differences between two documents.
#[derive(Clone, Debug, Serialize)]
pub struct Changes {
    /// Version of the JSON schema.
    pub schema: u32,
    /// Differences of machines, programs and settings.
    pub environment: Vec<SettingChange>,
    /// The time in the second document divided by the time in the first, as the median over all
    /// entries of `rows`. `None` if `rows` is empty.
    pub overall: Option<f64>,
    /// True if each ratio was divided by `overall` before the ratio was compared with the noise.
    pub relative: bool,
    /// Ratios of times up to this value always count as equal.
    pub noise: f64,
    /// The confidence of the intervals, which is that of the first document; in JSON, left out if it is 0.95.
    #[serde(skip_serializing_if = "Confidence::is_default")]
    pub confidence: Confidence,
    /// The measured times that both documents have, in the order of the first document.
    pub rows: Vec<Change>,
    /// The counts of bytes that differ.
    pub bytes: Vec<BytesChange>,
    /// The operations of studies whose fastest backend changed.
    pub winners: Vec<NewWinner>,
    /// Measurements that only the first document has.
    pub only_before: Vec<Measurement>,
    /// Measurements that only the second document has.
    pub only_after: Vec<Measurement>,
    /// Sentences that describe the differences.
    pub sentences: Vec<String>,
}

/// A difference between the machines, programs or settings of two documents.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SettingChange {
    /// Name of the setting, or the key of a tag.
    pub what: String,
    /// The value in the first document.
    pub before: String,
    /// The value in the second document.
    pub after: String,
}

/// What was measured: an operation on a backend.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Measurement {
    /// The name of the mesh. If the two documents have different names for the mesh, this is the
    /// name in the first document. Empty if the lab made its own mesh.
    pub mesh: String,
    /// The name of the command, such as `study`.
    pub kind: &'static str,
    /// The order, size or workload; empty in `study`, `why` and `memory`.
    pub case: String,
    /// The name of the operation, such as `vertex_normal`.
    pub operation: String,
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
}

/// The title of a part of measurements, and the function that returns this part.
pub type MeasurementPart = (&'static str, fn(&Measurement) -> &str);

impl Measurement {
    /// Returns which of mesh, command and case differ between `measurements`. A part that is the same
    /// for all is left out of tables and names.
    pub fn differing_parts<'m>(
        measurements: impl Iterator<Item = &'m Self> + Clone,
    ) -> Vec<MeasurementPart> {
        let parts: [MeasurementPart; 3] = [
            ("mesh", |m| &m.mesh),
            ("command", |m| m.kind),
            ("case", |m| &m.case),
        ];
        let differs = |of: fn(&Self) -> &str| {
            let mut values = measurements.clone().map(of);
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        let parts = parts.into_iter().filter(|(_, of)| differs(*of));
        parts.collect()
    }
}

/// The time of one operation on one backend in two documents.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// What was measured.
    #[serde(flatten)]
    pub measurement: Measurement,
    /// Median time in the first document, in nanoseconds.
    pub before_ns: f64,
    /// Median time in the second document, in nanoseconds.
    pub after_ns: f64,
    /// Number of samples in the first document.
    pub before_samples: usize,
    /// Number of samples in the second document.
    pub after_samples: usize,
    /// The time in the second document divided by the time in the first.
    pub ratio: f64,
    /// Lower end of the confidence interval of `ratio`; `None` if a document has fewer than
    /// two launches with this time, or one launch with fewer than three samples.
    pub ci_low: Option<f64>,
    /// Upper end of the confidence interval of `ratio`.
    pub ci_high: Option<f64>,
    /// The smallest ratio that this comparison can tell from chance; `None` if a document has fewer than two
    /// launches with this time.
    pub detectable: Option<f64>,
    /// Whether the second time is shorter, longer or equal, or cannot be told.
    pub verdict: Verdict,
    /// True if the checksums differ. The two measurements then did different work.
    pub other_checksum: bool,
}

/// A count of bytes that differs between two documents.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BytesChange {
    /// The name of the mesh; empty if the lab made its own mesh.
    pub mesh: String,
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The operation that allocates the bytes; `None` for the size of the backend.
    pub operation: Option<String>,
    /// The bytes in the first document.
    pub before: usize,
    /// The bytes in the second document.
    pub after: usize,
}

/// The conclusion about the times of one operation on one backend in two documents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The second time is shorter, by more than chance explains.
    Faster,
    /// The second time is longer, by more than chance explains.
    Slower,
    /// The times are equal, or differ by less than what counts.
    Same,
    /// A change that counts could be due to chance.
    CannotTell,
}

impl Verdict {
    /// Returns whether the time changed.
    pub const fn is_change(self) -> bool {
        matches!(self, Self::Faster | Self::Slower)
    }
}

/// An operation of a study whose fastest backend changed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NewWinner {
    /// The name of the mesh.
    pub mesh: String,
    /// The name of the operation, such as `vertex_normal`.
    pub operation: String,
    /// The name of the fastest backend in the first document.
    pub before: String,
    /// The name of the fastest backend in the second document.
    pub after: String,
}

/// The reason why the times of two documents cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CompareError {
    /// The two documents have different heap policies or different cache states.
    #[error(
        "the first was measured with {option} {before}, the second with {option} {after}, so \
         their times cannot be compared: measure both with the same {option}"
    )]
    OtherMemory {
        option: &'static str,
        before: &'static str,
        after: &'static str,
    },
    /// The documents have no mesh in common.
    #[error(
        "the first is of {before}, the second of {after}: times of different meshes cannot be \
         compared; measure one mesh twice"
    )]
    OtherMesh { before: String, after: String },
    /// The documents have no measurement in common.
    #[error(
        "no operation was measured on the same backend in both, so there is nothing to compare: \
         use the same command with the same --backends and --operations"
    )]
    NothingInCommon,
}

/// Compares two documents. Two measurements are compared if they are of the same command, mesh,
/// case, operation and backend. Counts of bytes are also compared, estimated times are not.
///
/// Meshes are the same if their hashes are equal, or if their names and facts are equal. If each
/// document has only one mesh, equal facts are enough, and the names may differ.
///
/// # Errors
///
/// Returns an error if the documents have no mesh or no measurement in common, or if the heap
/// policies or the cache states differ.
pub fn compare(
    before: &Results,
    after: &Results,
    settings: CompareSettings,
) -> Result<Changes, CompareError> {
    let meshes = CommonMeshes::new(before, after);
    meshes.check()?;
    let [first, second] = [(before, false), (after, true)]
        .map(|(results, is_second)| measurements(results, |mesh| meshes.name(mesh, is_second)));
    let in_both = || {
        let both = first.in_order.iter().map(|a| (a, second.get(&a.key)));
        both.filter_map(|(a, b)| Some((a, b?)))
    };
    let Some((common, _)) = in_both().next() else {
        return Err(CompareError::NothingInCommon);
    };
    let confidence = common.finding.run().settings.confidence;
    in_both().try_for_each(|(a, b)| check_memory(a.finding, b.finding))?;

    let CompareSettings {
        relative,
        noise,
        comparisons,
    } = settings;
    let pairs: Vec<Pair<'_>> = in_both().collect();
    // The rows of two findings have their launches in common.
    let of_one = |a: &Pair<'_>, b: &Pair<'_>| {
        std::ptr::eq(a.0.finding, b.0.finding) && std::ptr::eq(a.1.finding, b.1.finding)
    };
    let mut compared = Vec::new();
    for pairs in pairs.chunk_by(of_one) {
        compared.extend(changes(pairs, relative, confidence));
    }
    let overall = median(compared.iter().map(|(row, _)| row.ratio).collect());
    let level = FALSE_ALARM / (compared.len().max(1) * comparisons.max(1)) as f64;
    let divisor = overall.filter(|_| relative).unwrap_or(1.0);
    let rows = compared.into_iter().map(|(row, change)| Change {
        detectable: change.map(|change| change.detectable(level)),
        verdict: verdict(&row, change, level, noise, divisor),
        ..row
    });
    let rows: Vec<Change> = rows.collect();
    let mut environment: Vec<SettingChange> = Vec::new();
    for (a, b) in in_both() {
        for change in differences(a.finding.run(), b.finding.run()) {
            if !environment.contains(&change) {
                environment.push(change);
            }
        }
    }
    let mut changes = Changes {
        schema: SCHEMA,
        environment,
        overall,
        relative,
        noise,
        confidence,
        rows,
        bytes: bytes(in_both()),
        winners: winners(&first, &second),
        only_before: first.without(&second),
        only_after: second.without(&first),
        sentences: Vec::new(),
    };
    changes.sentences = changes.describe();
    Ok(changes)
}

/// Returns an error if the heap policies or the cache states differ.
fn check_memory(before: &Finding, after: &Finding) -> Result<(), CompareError> {
    let [a, b] = [before, after].map(|finding| finding.run().environment.memory_settings());
    for (i, option) in ["--heap", "--caches"].into_iter().enumerate() {
        let (before, after) = (a[i], b[i]);
        if before != after {
            return Err(CompareError::OtherMemory {
                option,
                before,
                after,
            });
        }
    }
    Ok(())
}

/// One figure in both documents.
type Pair<'r> = (&'r MeasuredFigure<'r>, &'r MeasuredFigure<'r>);

/// Compares the figures of one finding in both documents, without the verdicts. Leaves out figures without a time
/// and ratios that are not finite.
fn changes(
    pairs: &[Pair<'_>],
    relative: bool,
    confidence: Confidence,
) -> Vec<(Change, Option<StudyChange>)> {
    let timed = pairs.iter().filter_map(|&(a, b)| {
        let times = [a.figure.row.median_ns?, b.figure.row.median_ns?];
        (times[1] / times[0]).is_finite().then_some((a, b, times))
    });
    let timed: Vec<_> = timed.collect();
    let launches = timed.iter().map(|(a, b, ns)| LaunchPair {
        ns: *ns,
        launches: [&a.figure.row.launch_ns, &b.figure.row.launch_ns],
    });
    let found = study_changes(&launches.collect::<Vec<_>>(), relative, confidence);
    let rows = timed.iter().zip(found.rows);
    rows.map(|((a, b, ns), change)| (row(a, b, *ns, change, confidence), change))
        .collect()
}

fn row(
    before: &MeasuredFigure<'_>,
    after: &MeasuredFigure<'_>,
    [before_ns, after_ns]: [f64; 2],
    change: Option<StudyChange>,
    confidence: Confidence,
) -> Change {
    let [a, b] = [before, after].map(|measured| &measured.figure);
    let ratio = after_ns / before_ns;
    let of_samples = || {
        let (value, interval) = quotient(&b.counted_ns(), &a.counted_ns(), confidence)?;
        Some(interval?.map(|end| end / value * ratio))
    };
    let interval = change.map(|change| change.interval).or_else(of_samples);
    let both = a.row.checksum.zip(b.row.checksum);
    // The seed chooses the elements of a sample.
    let seed = |measured: &MeasuredFigure<'_>| measured.finding.run().settings.seed;
    let comparable = match (a.row.sample_size, b.row.sample_size) {
        (None, None) => true,
        (own, other) => own == other && seed(before) == seed(after),
    };
    Change {
        measurement: before.key.clone(),
        before_ns,
        after_ns,
        before_samples: a.row.samples,
        after_samples: b.row.samples,
        ratio,
        ci_low: interval.map(|[low, _]| low),
        ci_high: interval.map(|[_, high]| high),
        detectable: None,
        verdict: Verdict::CannotTell,
        other_checksum: comparable && both.is_some_and(|(a, b)| !nearly_equal(a, b)),
    }
}

/// Returns whether two checksums may be of the same work. Sums of `f32` in different orders may
/// have a relative difference of up to 10⁻⁴.
fn nearly_equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-4 * a.abs().max(b.abs())
}

/// Returns the verdict of a row. Without launches, its ratio is divided by `divisor`.
fn verdict(
    row: &Change,
    change: Option<StudyChange>,
    level: f64,
    noise: f64,
    divisor: f64,
) -> Verdict {
    let Some(change) = change else {
        // One or two samples tell nothing.
        let Some((low, high)) = row.ci_low.zip(row.ci_high) else {
            return Verdict::CannotTell;
        };
        let [ratio, low, high] = [row.ratio, low, high].map(|end| end / divisor);
        return match () {
            () if ratio > CLEAR_DIFFERENCE.max(noise) && low > 1.0 => Verdict::Slower,
            () if ratio < CLEAR_DIFFERENCE.max(noise).recip() && high < 1.0 => Verdict::Faster,
            () => Verdict::CannotTell,
        };
    };
    match change.beyond_chance(level, noise) {
        Some(ratio) if ratio > 1.0 => Verdict::Slower,
        Some(_) => Verdict::Faster,
        None if change.detectable(level) > noise * noise => Verdict::CannotTell,
        None => Verdict::Same,
    }
}

/// Returns the differences between machines, programs, settings and tags.
pub fn differences(before: &Run, after: &Run) -> Vec<SettingChange> {
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
    let facts = |run: &Run| -> [(&'static str, String); 17] {
        let e = &run.environment;
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
            ("features", e.features.join(", ")),
            ("sixfold", e.sixfold.clone()),
            ("commit", shown(e.commit.as_ref())),
            ("clock", e.clock.to_string()),
            ("allocator", shown(heap(e).as_ref())),
            ("budget", run.settings.effort_text()),
            ("seed", run.settings.seed.to_string()),
            ("confidence", run.settings.confidence.to_string()),
        ]
    };
    let pairs = facts(before).into_iter().zip(facts(after));
    let facts = pairs.map(|((what, before), (_, after))| (what.to_owned(), before, after));
    let keys: BTreeSet<&String> = before.tags.keys().chain(after.tags.keys()).collect();
    let tags = keys.into_iter().map(|key| {
        let [own, other] = [before, after].map(|run| run.tags.get(key).cloned());
        (
            key.clone(),
            own.unwrap_or_default(),
            other.unwrap_or_default(),
        )
    });
    let differs = facts
        .chain(tags)
        .filter(|(_, before, after)| before != after);
    let setting = |(what, before, after)| SettingChange {
        what,
        before,
        after,
    };
    differs.map(setting).collect()
}

/// Returns the counts of bytes that differ.
fn bytes<'r>(
    pairs: impl Iterator<Item = (&'r MeasuredFigure<'r>, &'r MeasuredFigure<'r>)>,
) -> Vec<BytesChange> {
    let mut changes: Vec<BytesChange> = Vec::new();
    for (a, b) in pairs {
        let size = (a.figure.backend_bytes, b.figure.backend_bytes, None);
        let allocated = (
            a.figure.counted.allocated_bytes,
            b.figure.counted.allocated_bytes,
            Some(a.key.operation.clone()),
        );
        for (before, after, operation) in [size, allocated] {
            let change = before.zip(after).filter(|(before, after)| before != after);
            changes.extend(change.map(|(before, after)| BytesChange {
                mesh: a.key.mesh.clone(),
                backend: a.key.backend.clone(),
                operation,
                before,
                after,
            }));
        }
    }
    let mut known = BTreeSet::new();
    changes.retain(|c| {
        known.insert((
            c.mesh.clone(),
            c.backend.clone(),
            c.operation.clone(),
            c.before,
        ))
    });
    changes
}

/// Returns the operations of studies that have a single fastest backend in each document, but a
/// different one.
fn winners(before: &AllMeasured<'_>, after: &AllMeasured<'_>) -> Vec<NewWinner> {
    let best = |all: &AllMeasured<'_>| {
        let best = all.in_order.iter().filter(|measured| {
            matches!(measured.finding, Finding::Study(_))
                && measured.figure.row.standing == Some(Standing::Best)
        });
        let best: Vec<Measurement> = best.map(|measured| measured.key.clone()).collect();
        best
    };
    let after = best(after);
    let new = best(before).into_iter().filter_map(|before| {
        let same = |other: &&Measurement| {
            (&other.mesh, &other.operation) == (&before.mesh, &before.operation)
        };
        let now = after.iter().find(same)?;
        (now.backend != before.backend).then(|| NewWinner {
            mesh: before.mesh,
            operation: before.operation,
            before: before.backend,
            after: now.backend.clone(),
        })
    });
    new.collect()
}

impl Changes {
    /// Iterates over the entries of `rows` in which the second time is shorter or longer, or which
    /// have different checksums.
    pub fn changed(&self) -> impl Iterator<Item = &Change> {
        let changed = |row: &&Change| row.verdict.is_change() || row.other_checksum;
        self.rows.iter().filter(changed)
    }

    /// Returns the number by which each ratio is divided before it is compared with the noise:
    /// `overall` if the comparison is relative, 1 otherwise.
    pub fn divisor(&self) -> f64 {
        self.overall.filter(|_| self.relative).unwrap_or(1.0)
    }

    /// Returns the ratio of all times together if it is larger than the speed of a machine changes between two
    /// studies, so that the whole program became slower; `None` if it is not, and if the comparison is relative.
    pub fn slower_as_a_whole(&self) -> Option<f64> {
        let has_launches = self.rows.iter().any(|row| row.detectable.is_some());
        let limit = LASTING_SPEED.max(self.noise);
        self.overall
            .filter(|&overall| has_launches && !self.relative && overall > limit)
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
}
