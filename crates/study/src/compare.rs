//! Two studies of one mesh side by side: what changed between machines, compilers or commits.
//!
//! Samples of two studies have no rounds in common, so ratios are of medians, with intervals by drawing
//! the samples of both anew. What no sample within one study can show is how far a machine drifts from
//! one study to the next: [`DRIFT`] stands for it, unless whoever compares knows better.

use std::io;

use serde::Serialize;
use workload::Operation;

use crate::control::noise;
use crate::environment::Environment;
use crate::report::{RawSamples, Report, ResultRow, SCHEMA, Standing, write_json};
use crate::standing::BEYOND_DOUBT;
use crate::statistics::{Median, quotient};

/// Figures of two studies may differ by this on a machine where nothing changed: about twice what is
/// typical of a virtual machine with neighbours (reports/repeatability). A machine of one's own drifts
/// less.
pub const DRIFT: f64 = 1.2;

/// How two studies are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparing {
    /// Rows are judged by what is left of a change when the median change of all rows is taken out: for
    /// two machines, of which one is faster altogether.
    pub relative: bool,
    /// Ratios up to this are noise, whatever the samples say.
    pub drift: f64,
}

impl Default for Comparing {
    fn default() -> Self {
        Self {
            relative: false,
            drift: DRIFT,
        }
    }
}

/// What changed between two studies.
#[derive(Clone, Debug, Serialize)]
pub struct Changes {
    /// The version of the shape.
    pub schema: u32,
    /// The meshes, if they are not the same by their facts: then the rows compare two works.
    pub meshes: Option<[String; 2]>,
    /// In what the machines, programs and settings differ.
    pub environment: Vec<Setting>,
    /// The median over all rows of the time in the second by that in the first.
    pub overall: Option<f64>,
    /// Rows are judged after that factor is taken out.
    pub relative: bool,
    /// Ratios up to this are noise, whatever the samples say.
    pub drift: f64,
    /// What both have measured, in the order of the first.
    pub rows: Vec<Change>,
    /// Backends that hold more or fewer bytes: name, before, after.
    pub bytes: Vec<(String, usize, usize)>,
    /// Operations with another winner, where both studies have one alone.
    pub winners: Vec<NewWinner>,
    /// What only the first has, as `operation on backend`.
    pub only_before: Vec<String>,
    /// What only the second has.
    pub only_after: Vec<String>,
    /// The same in sentences.
    pub words: Vec<String>,
}

/// Something in which two environments differ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Setting {
    /// What.
    pub what: &'static str,
    /// In the first.
    pub before: String,
    /// In the second.
    pub after: String,
}

/// One operation on one backend, in both studies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The backend.
    pub backend: String,
    /// The operation.
    pub operation: Operation,
    /// The median in the first, in nanoseconds.
    pub before_ns: f64,
    /// The median in the second.
    pub after_ns: f64,
    /// The second by the first.
    pub ratio: f64,
    /// The lower end of its 95 % interval; `None` below three samples in either.
    pub ci_low: Option<f64>,
    /// Its upper end.
    pub ci_high: Option<f64>,
    /// Ratios up to this are noise.
    pub noise: f64,
    /// What that comes to.
    pub verdict: Verdict,
    /// It found something else: another work, whatever its time is.
    pub other_checksum: bool,
}

/// What a change comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The second is faster beyond the noise.
    Faster,
    /// The second is slower beyond the noise.
    Slower,
    /// No difference that the noise does not explain.
    Same,
}

/// An operation that somebody else wins now.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NewWinner {
    /// The operation.
    pub operation: Operation,
    /// Who won in the first.
    pub before: String,
    /// Who wins in the second.
    pub after: String,
}

/// Two studies whose times cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CompareError {
    /// Another heap policy, or another state of the caches.
    #[error(
        "the first was measured with {option} {before}, the second with {option} {after}: these times cannot be compared; measure one of them again"
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
/// Studies on heaps of another policy, or with caches in another state.
pub fn compare(before: &Report, after: &Report, how: Comparing) -> Result<Changes, CompareError> {
    let words = [before, after].map(|report| report.environment.memory_words());
    for (i, option) in ["--heap", "--caches"].into_iter().enumerate() {
        let [before, after] = [words[0][i], words[1][i]];
        if before != after {
            return Err(CompareError::OtherMemory {
                option,
                before,
                after,
            });
        }
    }
    let Comparing { relative, drift } = how;
    let mut rows = Vec::new();
    let (mut only_before, mut only_after) = (Vec::new(), Vec::new());
    for row in &before.results {
        match (twin(row, after), row.median_ns) {
            (_, None) => {} // an estimate is no measurement
            (Some(other), Some(_)) => rows.extend(change(before, row, after, other, drift)),
            (None, Some(_)) => only_before.push(named(row)),
        }
    }
    let alone = |row: &&ResultRow| row.median_ns.is_some() && twin(row, before).is_none();
    only_after.extend(after.results.iter().filter(alone).map(named));
    let overall = Median::of(rows.iter().map(|row| row.ratio)).map(|median| median.value);
    let taken_out = overall.filter(|_| relative).unwrap_or(1.0);
    for row in &mut rows {
        row.verdict = verdict(row, taken_out);
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
        words: Vec::new(),
    };
    changes.words = changes.words();
    Ok(changes)
}

fn named(row: &ResultRow) -> String {
    format!("{} on {}", row.operation, row.backend)
}

/// The same operation on the same backend, if it was measured.
fn twin<'r>(row: &ResultRow, report: &'r Report) -> Option<&'r ResultRow> {
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
        other_checksum: comparable && both.is_some_and(|(a, b)| !near(a, b)),
    })
}

/// Whether two checksums may be of one work: sums of `f32` in another order are within 10⁻⁴.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-4 * a.abs().max(b.abs())
}

/// The samples of a row, without those of the control.
fn samples(report: &Report, row: &ResultRow) -> Vec<f64> {
    let mut raw = report.raw.iter();
    let of_it = raw
        .find(|raw| !raw.control && raw.operation == row.operation && raw.backend == row.backend);
    of_it.map_or_else(Vec::new, RawSamples::counted_ns)
}

fn verdict(row: &Change, taken_out: f64) -> Verdict {
    let ratio = row.ratio / taken_out;
    let [low, high] = [row.ci_low, row.ci_high].map(|end| end.map(|end| end / taken_out));
    let (slower, faster) = match low.zip(high) {
        Some((low, high)) => (low > 1.0, high < 1.0),
        None => (ratio > BEYOND_DOUBT, ratio < BEYOND_DOUBT.recip()),
    };
    if slower && ratio > row.noise {
        Verdict::Slower
    } else if faster && ratio < row.noise.recip() {
        Verdict::Faster
    } else {
        Verdict::Same
    }
}

/// What of the environments matters for times.
fn differences(before: &Environment, after: &Environment) -> Vec<Setting> {
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
    let of = |e: &Environment| -> [(&'static str, String); 13] {
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
    let pairs = of(before).into_iter().zip(of(after));
    let differs = pairs.filter(|((_, before), (_, after))| before != after);
    let setting = |((what, before), (_, after))| Setting {
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
    /// Those that are faster or slower, or found something else.
    pub fn changed(&self) -> impl Iterator<Item = &Change> {
        let changed = |row: &&Change| row.verdict != Verdict::Same || row.other_checksum;
        self.rows.iter().filter(changed)
    }

    /// How many came to this.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rows
            .iter()
            .filter(|row| row.verdict == verdict)
            .count()
    }

    /// Writes it as JSON.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }

    fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        if let Some([before, after]) = &self.meshes {
            words.push(format!(
                "The meshes differ ({before}, {after}): the times are of two works, and only ratios between backends can be compared."
            ));
        }
        let (slower, faster) = (self.count(Verdict::Slower), self.count(Verdict::Faster));
        let same = self.count(Verdict::Same);
        words.push(format!(
            "Of {} figures {faster} are faster, {slower} slower, {same} the same within the noise.",
            self.rows.len()
        ));
        if let Some(overall) = self.overall {
            let factor = overall.max(overall.recip());
            let way = if overall > 1.0 { "slower" } else { "faster" };
            let machines = self.environment.iter().any(|s| s.what == "processor");
            if factor > self.drift {
                let hint = match (self.relative, machines) {
                    (true, _) => "; rows are judged by what is left without that",
                    (false, true) => "; the machines differ: --relative takes that out of each row",
                    (false, false) => {
                        "; if the machine was busy or hot, --relative takes that out of each row"
                    }
                };
                words.push(format!(
                    "As a whole the second is {factor:.2} × {way} (the median of all rows){hint}."
                ));
            }
        }
        for winner in &self.winners {
            words.push(format!(
                "{} is won by {} now, and was by {}.",
                winner.operation, winner.after, winner.before
            ));
        }
        let others: Vec<String> = { self.rows.iter().filter(|row| row.other_checksum) }
            .map(|row| format!("{} on {}", row.operation, row.backend))
            .collect();
        if !others.is_empty() {
            words.push(format!(
                "Another checksum, so another work: {}.",
                others.join(", ")
            ));
        }
        words
    }
}

#[cfg(test)]
mod tests;
