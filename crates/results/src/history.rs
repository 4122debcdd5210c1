//! How times went over several documents, such as one for each commit.
//!
//! Each document is compared with the first one of its group, by [`compare`]: a time changed if that comparison says
//! so. All comparisons of a group together call a time slower or faster by chance as rarely as one comparison does.
//!
//! Documents do not hold the times of their commits, so they are in the order in which they were measured.

use std::collections::{BTreeMap, BTreeSet};
use std::io;

use serde::Serialize;

use crate::compare::{
    CompareSettings, Measurement, SettingChange, Verdict, compare, is_or_are, verdict_counts,
};
use crate::confidence::Confidence;
#[cfg(feature = "csv")]
use crate::csv::into_io_error;
use crate::document::{Results, SCHEMA};
use crate::finding::Finding;
use crate::json::write_json;
use crate::numbers::{counted, times};

/// How times went over several documents.
#[derive(Clone, Debug, Serialize)]
pub struct History {
    /// Version of the JSON schema.
    pub schema: u32,
    /// The documents with measurements in common.
    pub groups: Vec<HistoryGroup>,
    /// The documents that cannot be compared with any other.
    pub alone: Vec<LoneDocument>,
}

/// Documents that are compared with the first of them.
#[derive(Clone, Debug, Serialize)]
pub struct HistoryGroup {
    /// The documents, in the order in which they were measured.
    pub documents: Vec<HistoryDocument>,
    /// True if each ratio was divided by the `overall` of its document before it was compared with the noise.
    pub relative: bool,
    /// Ratios of times up to this value count as equal.
    pub noise: f64,
    /// The confidence of the intervals, which is that of the first document; in JSON, left out if it is 0.95.
    #[serde(skip_serializing_if = "Confidence::is_default")]
    pub confidence: Confidence,
    /// The measured times that the first document and another one have, in the order of the first.
    pub rows: Vec<HistoryRow>,
    /// Sentences that describe the changes.
    pub sentences: Vec<String>,
}

/// A document of a history.
#[derive(Clone, Debug, Serialize)]
pub struct HistoryDocument {
    /// The place of the document among those that were given.
    #[serde(skip)]
    pub place: usize,
    /// The name of the document.
    pub name: String,
    /// The commits of the programs that measured; empty if unknown.
    pub commit: String,
    /// The start of the first measurement, in seconds since 1970.
    pub unix_time: u64,
    /// The other differences from the machine, program and settings of the first document.
    pub environment: Vec<SettingChange>,
    /// The median of the ratios of all its times to those of the first document.
    pub overall: Option<f64>,
    /// The number of its measurements that the first document does not have, so that no row shows them.
    pub unknown: usize,
}

/// One time in all documents of a group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HistoryRow {
    /// What was measured.
    #[serde(flatten)]
    pub measurement: Measurement,
    /// The time in the first document, and in each other one that has it.
    pub points: Vec<HistoryPoint>,
    /// The number of the document from which on the time is longer, or shorter, than in the first one, up to the last
    /// one; `None` if it is not.
    pub since: Option<usize>,
}

/// One time in one document.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HistoryPoint {
    /// The number of the document in its group, from 1.
    pub document: usize,
    /// The median time, in nanoseconds.
    pub median_ns: f64,
    /// The time divided by that in the first document.
    pub ratio: f64,
    /// Lower end of the confidence interval of `ratio`; `None` for the first document, and as in
    /// [`Change`](crate::Change).
    pub ci_low: Option<f64>,
    /// Upper end of the confidence interval of `ratio`.
    pub ci_high: Option<f64>,
    /// Whether the time is shorter than in the first document, longer or equal, or cannot be told.
    pub verdict: Verdict,
    /// True if the checksum differs from that of the first document, so that the work differs.
    pub other_checksum: bool,
}

/// A document that cannot be compared with the others.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LoneDocument {
    /// The name of the document.
    pub name: String,
    /// Why it cannot be compared.
    pub reason: String,
}

impl HistoryPoint {
    /// Returns whether the time of the same work changed.
    pub fn is_change(&self) -> bool {
        self.verdict.is_change() && !self.other_checksum
    }
}

impl HistoryRow {
    /// Returns whether the time of the same work changed in any document.
    pub fn is_changed(&self) -> bool {
        self.points.iter().any(HistoryPoint::is_change)
    }

    /// Returns the time in the last document that has it.
    pub fn last(&self) -> Option<&HistoryPoint> {
        self.points.last()
    }

    /// Returns the largest factor by which the time differs from that in the first document.
    pub fn largest_change(&self) -> f64 {
        let changes = self.points.iter().map(|point| point.ratio);
        changes.fold(1.0, |most, ratio| most.max(ratio).max(ratio.recip()))
    }
}

/// The first columns of a line of the CSV.
#[cfg(feature = "csv")]
#[derive(Serialize)]
struct DocumentColumns<'h> {
    group: usize,
    name: &'h str,
    commit: &'h str,
    unix_time: u64,
}

impl History {
    /// Compares documents with the first of them that has measurements in common. Each has a name.
    ///
    /// O(documents · rows · launches · log launches) for the documents of one group.
    pub fn new(documents: &[(&str, &Results)], settings: CompareSettings) -> Self {
        let mut order: Vec<usize> = (0..documents.len()).collect();
        order.sort_by_key(|&i| (start(documents[i].1), documents[i].0));
        let compared =
            |a: usize, b: usize, settings| compare(documents[a].1, documents[b].1, settings);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for &i in &order {
            let mut known = groups.iter_mut();
            match known.find(|group| compared(group[0], i, settings).is_ok()) {
                Some(group) => group.push(i),
                None => groups.push(vec![i]),
            }
        }
        let first = groups.iter().max_by_key(|group| group.len());
        let first = first.map_or(0, |group| group[0]);
        let (groups, alone): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.len() > 1);
        let alone = alone.into_iter().map(|group| LoneDocument {
            name: documents[group[0]].0.to_owned(),
            reason: match compared(first, group[0], settings) {
                Err(error) if first != group[0] => {
                    format!("compared with {}: {error}", documents[first].0)
                }
                _ => "no other document has the same measurements".to_owned(),
            },
        });
        Self {
            schema: SCHEMA,
            alone: alone.collect(),
            groups: groups
                .iter()
                .map(|group| HistoryGroup::new(documents, group, settings))
                .collect(),
        }
    }

    /// Writes the history as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }

    /// Writes the times as CSV: one row for each time in each document.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    #[cfg(feature = "csv")]
    pub fn write_csv(&self, writer: impl io::Write) -> io::Result<()> {
        write_lines(&self.groups, writer)
    }
}

#[cfg(feature = "csv")]
fn write_lines(groups: &[HistoryGroup], writer: impl io::Write) -> io::Result<()> {
    let mut lines = csv::Writer::from_writer(writer);
    for (number, group) in (1..).zip(groups) {
        for row in &group.rows {
            for point in &row.points {
                let document = &group.documents[point.document - 1];
                let columns = DocumentColumns {
                    group: number,
                    name: &document.name,
                    commit: &document.commit,
                    unix_time: document.unix_time,
                };
                let line = (columns, &row.measurement, point);
                lines.serialize(line).map_err(into_io_error)?;
            }
        }
    }
    lines.flush()
}

impl HistoryGroup {
    /// Writes the times of the group as [`History::write_csv`] does; the group has the number 1.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    #[cfg(feature = "csv")]
    pub fn write_csv(&self, writer: impl io::Write) -> io::Result<()> {
        write_lines(std::slice::from_ref(self), writer)
    }

    fn new(documents: &[(&str, &Results)], group: &[usize], settings: CompareSettings) -> Self {
        let settings = CompareSettings {
            comparisons: group.len() - 1,
            ..settings
        };
        let first = documents[group[0]].1;
        let document = |place: usize| HistoryDocument {
            place,
            name: documents[place].0.to_owned(),
            commit: commits(documents[place].1),
            unix_time: start(documents[place].1),
            environment: Vec::new(),
            overall: Some(1.0),
            unknown: 0,
        };
        let mut all = vec![document(group[0])];
        let mut rows: Vec<HistoryRow> = Vec::new();
        let mut places: BTreeMap<Measurement, usize> = BTreeMap::new();
        let (mut slower, mut confidence) = (None, Confidence::default());
        for (number, &place) in (2..).zip(&group[1..]) {
            let Ok(mut changes) = compare(first, documents[place].1, settings) else {
                continue; // its group is of documents that can be compared
            };
            slower = changes.slower_as_a_whole();
            confidence = changes.confidence;
            changes.environment.retain(|change| change.what != "commit");
            all.push(HistoryDocument {
                environment: changes.environment,
                overall: changes.overall,
                unknown: changes.only_after.len(),
                ..document(place)
            });
            for change in changes.rows {
                let row = *places.entry(change.measurement.clone()).or_insert_with(|| {
                    rows.push(HistoryRow {
                        measurement: change.measurement,
                        points: vec![HistoryPoint {
                            document: 1,
                            median_ns: change.before_ns,
                            ratio: 1.0,
                            ci_low: None,
                            ci_high: None,
                            verdict: Verdict::Same,
                            other_checksum: false,
                        }],
                        since: None,
                    });
                    rows.len() - 1
                });
                rows[row].points.push(HistoryPoint {
                    document: number,
                    median_ns: change.after_ns,
                    ratio: change.ratio,
                    ci_low: change.ci_low,
                    ci_high: change.ci_high,
                    verdict: change.verdict,
                    other_checksum: change.other_checksum,
                });
            }
        }
        for row in &mut rows {
            row.since = since(&row.points);
        }
        let mut history = Self {
            documents: all,
            relative: settings.relative,
            noise: settings.noise,
            confidence,
            rows,
            sentences: Vec::new(),
        };
        history.sentences = history.describe(slower);
        history
    }

    /// Returns sentences that describe the changes. `slower` is the ratio of all times in the last document, if the
    /// whole program became slower.
    fn describe(&self, slower: Option<f64>) -> Vec<String> {
        if self.rows.is_empty() {
            let none = "The documents have no time in common: `sixfold compare` compares two of them by their counts of bytes.";
            return vec![none.to_owned()];
        }
        let last = self.rows.iter().filter_map(HistoryRow::last);
        let (others, same): (Vec<&HistoryPoint>, Vec<_>) =
            last.partition(|point| point.other_checksum);
        let verdicts: Vec<Verdict> = same.iter().map(|point| point.verdict).collect();
        let mut sentences = vec![format!(
            "Of {} over {}, {}.",
            counted(verdicts.len(), "measurement", "measurements"),
            counted(self.documents.len(), "document", "documents"),
            verdict_counts(&verdicts, "in the last one than in the first"),
        )];
        if !others.is_empty() {
            sentences.push(format!(
                "{} did different work in the last document than in the first: the checksums differ.",
                counted(others.len(), "other measurement", "other measurements")
            ));
        }
        let starts: BTreeSet<usize> = self.rows.iter().filter_map(|row| row.since).collect();
        for number in starts {
            let of_start = self.rows.iter().filter(|row| row.since == Some(number));
            let is_slower = |row: &&HistoryRow| row.last().is_some_and(|p| p.ratio > 1.0);
            let (slower, faster): (Vec<_>, Vec<_>) = of_start.partition(is_slower);
            let document = &self.documents[number - 1];
            let commit = match document.commit.as_str() {
                "" => String::new(),
                commit => format!(", commit {commit}"),
            };
            sentences.push(format!(
                "Since document {number} ({}{commit}), {} {} slower and {} {} faster.",
                document.name,
                slower.len(),
                is_or_are(slower.len()),
                faster.len(),
                is_or_are(faster.len()),
            ));
        }
        let passing = self.rows.iter();
        let passing = passing.filter(|row| row.is_changed() && row.since.is_none());
        match passing.count() {
            0 => {}
            count => sentences.push(format!(
                "{} changed in between; in the last document, this is no longer so or cannot be told.",
                counted(count, "measurement", "measurements")
            )),
        }
        sentences.extend(slower.map(|overall| {
            format!(
                "In the last document, all times together take {} those of the first: the whole program is slower.",
                times(overall)
            )
        }));
        let unknown = self.documents.iter().map(|document| document.unknown).max();
        if let Some(unknown @ 1..) = unknown {
            sentences.push(format!(
                "{} of later documents are not in the first, so they have no history.",
                counted(unknown, "measurement", "measurements")
            ));
        }
        sentences
    }
}

/// Returns the number of the document from which on the time is longer, or shorter, up to the last one, if the last
/// one is. Documents in between may be unable to tell.
fn since(points: &[HistoryPoint]) -> Option<usize> {
    let last = points.last().filter(|last| last.is_change())?;
    let is_same = |point: &&HistoryPoint| point.verdict == last.verdict && !point.other_checksum;
    let backwards = points.iter().rev();
    let run = backwards.take_while(|point| is_same(point) || point.verdict == Verdict::CannotTell);
    run.filter(is_same).last().map(|point| point.document)
}

/// Returns the start of the first measurement of a document, in seconds since 1970.
fn start(results: &Results) -> u64 {
    let starts = results.findings.iter();
    let starts = starts.map(|finding| finding.run().start.unix_time);
    starts.min().unwrap_or(0)
}

/// Returns the commits of the programs that measured a document.
fn commits(results: &Results) -> String {
    let runs = results.findings.iter().map(Finding::run);
    let commits = runs.filter_map(|run| run.environment.commit.as_deref());
    let commits: BTreeSet<&str> = commits.collect();
    commits.into_iter().collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_lasts_since_the_first_document_from_which_on_none_says_otherwise() {
        use Verdict::{CannotTell as Open, Faster, Same, Slower};
        let since_of = |verdicts: &[Verdict]| {
            let points = (1..)
                .zip(verdicts)
                .map(|(document, &verdict)| HistoryPoint {
                    document,
                    median_ns: 1.0,
                    ratio: 1.0,
                    ci_low: None,
                    ci_high: None,
                    verdict,
                    other_checksum: false,
                });
            since(&points.collect::<Vec<_>>())
        };
        assert_eq!(since_of(&[Same, Same, Slower]), Some(3));
        assert_eq!(since_of(&[Same, Slower, Open, Slower]), Some(2));
        assert_eq!(since_of(&[Same, Open, Slower, Slower]), Some(3));
        assert_eq!(since_of(&[Same, Faster, Slower, Slower]), Some(3));
        assert_eq!(since_of(&[Same, Slower, Same]), None);
        assert_eq!(since_of(&[Same, Slower, Open]), None);
    }
}
