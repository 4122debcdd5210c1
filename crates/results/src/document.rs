//! The document that all measuring commands write.
//!
//! In JSON, the document lists each run and each mesh once, and a finding has their places in these
//! lists. In memory, each finding has its own copy, so that a finding can be used alone.

use std::collections::{HashMap, HashSet};
use std::io;

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::finding::Finding;
use crate::findings::study::Report;
use crate::json::write_json;
use crate::pool::Pool;
use crate::read::{ReadError, check_schema, parse_json};
use crate::rows::MeshReport;
use crate::run::{Run, Start};

/// The version of the format of [`Results`] in JSON. The number increases when older versions of
/// Sixfold could misread a new file.
pub const SCHEMA: u32 = 4;

/// The results of one or more measuring commands.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// The names of all meshes to study. Each name occurs once. Studies and failures are sorted in
    /// the order of this list.
    pub planned: Vec<String>,
    /// The findings: first the studies, then the findings of other commands.
    pub findings: Vec<Finding>,
    /// The meshes that could not be measured.
    pub failures: Vec<Failed>,
    /// The notes and warnings that the commands printed, for example about a file that was read.
    pub notices: Vec<String>,
}

/// A mesh that could not be studied.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Failed {
    /// Name of the mesh.
    pub mesh: String,
    /// Why the mesh could not be studied.
    pub reason: String,
    /// The kind of the reason.
    pub kind: FailureKind,
}

/// The kind of reason why a mesh could not be studied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The mesh could not be loaded or measured.
    NotMeasured,
    /// The mesh is valid, but none of the selected backends can hold it.
    NoneHolds,
}

/// The JSON form of a document, to be written.
#[derive(Serialize)]
struct Written<'r> {
    schema: u32,
    runs: Vec<&'r Run>,
    meshes: Vec<&'r MeshReport>,
    planned: &'r [String],
    missing: usize,
    failures: &'r [Failed],
    notices: &'r [String],
    findings: Vec<WrittenFinding<'r>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pool: Option<Pool>,
}

#[derive(Serialize)]
struct WrittenFinding<'r> {
    /// The place of the run in `runs`.
    run: usize,
    /// The places of the meshes in `meshes`.
    meshes: Vec<usize>,
    start: Start,
    #[serde(flatten)]
    finding: &'r Finding,
}

/// The JSON form of a document, as read.
#[derive(Deserialize)]
struct ReadDocument {
    runs: Vec<Run>,
    meshes: Vec<MeshReport>,
    planned: Vec<String>,
    failures: Vec<Failed>,
    notices: Vec<String>,
    findings: Vec<Box<RawValue>>,
}

#[derive(Deserialize)]
struct FindingHead {
    run: usize,
    meshes: Vec<usize>,
    start: Start,
    kind: String,
}

impl<F: Into<Finding>> From<F> for Results {
    /// Creates a document with one finding.
    fn from(finding: F) -> Self {
        let mut results = Self::default();
        results.add(finding.into());
        results
    }
}

impl Results {
    /// Creates a document without findings. `planned` are the names of the meshes to study.
    pub fn new(planned: Vec<String>) -> Self {
        Self {
            planned,
            ..Self::default()
        }
    }

    /// Adds a finding. If the finding is a study, it replaces an earlier study or failure of the
    /// same mesh.
    pub fn add(&mut self, finding: Finding) {
        self.extend([finding]);
    }

    /// Records that a mesh could not be studied. Replaces an earlier study or failure of the mesh.
    pub fn add_failure(&mut self, failed: Failed) {
        self.remove(&failed.mesh);
        self.plan([failed.mesh.clone()]);
        self.failures.push(failed);
        self.sort();
    }

    /// Adds names to the planned meshes, if they are new.
    pub fn plan(&mut self, meshes: impl IntoIterator<Item = String>) {
        let mut known: HashSet<String> = self.planned.iter().cloned().collect();
        let new = meshes.into_iter().filter(|mesh| known.insert(mesh.clone()));
        self.planned.extend(new);
    }

    /// Adds the failures of meshes that are neither studied nor failed. The meshes need not be planned: those of a
    /// pick are not.
    pub fn add_failures(&mut self, failures: impl IntoIterator<Item = Failed>) {
        let studied = self.studies().map(|study| study.mesh.name.clone());
        let failed = self.failures.iter().map(|failed| failed.mesh.clone());
        let mut done: HashSet<String> = studied.chain(failed).collect();
        let new = failures
            .into_iter()
            .filter(|failed| done.insert(failed.mesh.clone()));
        self.failures.extend(new);
        self.sort();
    }

    /// Removes the study and the failure of a mesh.
    fn remove(&mut self, mesh: &str) {
        self.findings.retain(|finding| match finding {
            Finding::Study(study) => study.mesh.name != mesh,
            _ => true,
        });
        self.failures.retain(|failed| failed.mesh != mesh);
    }

    /// Sorts the studies and the failures in the order of the planned meshes. Studies come before
    /// other findings. O(n log n).
    pub(crate) fn sort(&mut self) {
        let places = self.planned.iter().enumerate();
        let places: HashMap<&str, usize> =
            places.map(|(place, mesh)| (mesh.as_str(), place)).collect();
        let place = |mesh: &str| places.get(mesh).copied();
        self.findings.sort_by_key(|finding| match finding {
            Finding::Study(study) => (0, place(&study.mesh.name)),
            _ => (1, None),
        });
        self.failures.sort_by_key(|failed| place(&failed.mesh));
    }

    /// Iterates over the names of the planned meshes that have neither a study nor a failure.
    pub fn missing(&self) -> impl Iterator<Item = &str> {
        let planned = self.planned.iter().map(String::as_str);
        planned.filter(|mesh| !self.is_done(mesh))
    }

    /// Returns whether a mesh has a study or a failure.
    pub fn is_done(&self, mesh: &str) -> bool {
        self.studies().any(|study| study.mesh.name == mesh)
            || self.failures.iter().any(|failed| failed.mesh == mesh)
    }

    /// Counts the results that differ, for no known reason, from the results of other backends of
    /// Sixfold.
    pub fn mismatches(&self) -> usize {
        self.findings.iter().map(Finding::mismatches).sum()
    }

    /// Returns true if a measurement was stopped early.
    pub fn is_interrupted(&self) -> bool {
        self.findings.iter().any(Finding::is_interrupted)
    }

    /// Computes the results over all studied meshes, such as mean times.
    pub fn pool(&self) -> Pool {
        let studies: Vec<&Report> = self.studies().collect();
        Pool::new(&studies)
    }

    /// Writes the document as JSON, in the format that `reports/SCHEMA.md` explains. If several
    /// meshes were planned, the document also has the results over all studied meshes ([`Pool`]).
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        let mut runs: Vec<&Run> = Vec::new();
        let mut meshes: Vec<&MeshReport> = Vec::new();
        let written = |finding| {
            let run: &Run = Finding::run(finding);
            WrittenFinding {
                run: place_of(&mut runs, run, Run::is_same),
                meshes: finding
                    .meshes()
                    .iter()
                    .map(|mesh| place_of(&mut meshes, mesh, |a, b| a == b))
                    .collect(),
                start: run.start,
                finding,
            }
        };
        let findings = self.findings.iter().map(written).collect();
        let document = Written {
            schema: SCHEMA,
            runs,
            meshes,
            planned: &self.planned,
            missing: self.missing().count(),
            failures: &self.failures,
            notices: &self.notices,
            findings,
            pool: (self.planned.len() > 1).then(|| self.pool()),
        };
        write_json(&document, writer)
    }

    /// Reads the JSON that [`write_json`](Self::write_json) wrote.
    ///
    /// # Errors
    ///
    /// Returns an error if the text is truncated or is not JSON, if the schema is missing or has
    /// another version, if there are no `findings`, or if a field is missing or invalid.
    pub fn read_json(text: &str) -> Result<Self, ReadError> {
        check_schema(text)?;
        let document: ReadDocument = parse_json(text)?;
        let mut results = Self::new(document.planned);
        let mut findings = Vec::new();
        let no_entry = |list: &str, place: usize| ReadError::Malformed {
            cause: format!("a finding names entry {place} of `{list}`, which does not exist"),
        };
        for text in document.findings {
            let read: FindingHead = parse_json(text.get())?;
            let mut finding = Finding::parse(&read.kind, text.get())?;
            let run = document.runs.get(read.run);
            let run = run.ok_or_else(|| no_entry("runs", read.run))?;
            let mesh = |&place: &usize| {
                let mesh = document.meshes.get(place).cloned();
                mesh.ok_or_else(|| no_entry("meshes", place))
            };
            let meshes: Result<Vec<MeshReport>, ReadError> = read.meshes.iter().map(mesh).collect();
            let start = read.start;
            finding.complete(
                Run {
                    start,
                    ..run.clone()
                },
                meshes?,
            )?;
            findings.push(finding);
        }
        results.extend(findings);
        results.add_failures(document.failures);
        results.notices = document.notices;
        Ok(results)
    }
}

impl Extend<Finding> for Results {
    /// Adds findings, as [`add`](Results::add) does. O((n + m) log (n + m)) for n known and m new
    /// findings.
    fn extend<I: IntoIterator<Item = Finding>>(&mut self, findings: I) {
        self.findings.extend(findings);
        let mut studied: HashSet<String> = HashSet::new();
        let studies = self.studies().map(|study| study.mesh.name.clone());
        let studies: Vec<String> = studies.collect();
        // The last study of a mesh replaces the others.
        let mut is_last: Vec<bool> = studies
            .iter()
            .rev()
            .map(|s| studied.insert(s.clone()))
            .collect();
        self.findings.retain(|finding| match finding {
            Finding::Study(_) => is_last.pop().unwrap_or(true),
            _ => true,
        });
        self.failures
            .retain(|failed| !studied.contains(&failed.mesh));
        self.plan(studies);
        self.sort();
    }
}

/// Returns the place of `value` in `list`. Appends the value if the list has no equal one.
fn place_of<'r, T>(list: &mut Vec<&'r T>, value: &'r T, equal: impl Fn(&T, &T) -> bool) -> usize {
    let known = list.iter().position(|other| equal(other, value));
    known.unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pool::POOLED;

    /// A study of one mesh, without results.
    fn report(mesh: &str) -> Report {
        Report {
            mesh: MeshReport {
                name: mesh.into(),
                ..MeshReport::default()
            },
            ..Report::default()
        }
    }

    fn written(results: &Results) -> String {
        let mut json = Vec::new();
        results.write_json(&mut json).expect("written to memory");
        String::from_utf8(json).expect("UTF-8")
    }

    /// Pooling takes time for large collections, so results are pooled only when they are written.
    #[test]
    fn results_are_pooled_once_when_they_are_written() {
        let pooled = || POOLED.with(std::cell::Cell::take);
        pooled();
        let mut all = Results::default();
        for mesh in ["a", "b", "c", "d"] {
            let mut one = Results::default();
            one.add(report(mesh).into());
            all.merge(Results::read_json(&written(&one)).expect("as written"))
                .expect("the same settings");
            all.add(report(mesh).into());
        }
        assert_eq!(pooled(), 0, "adding, merging and reading");
        let text = written(&all);
        assert_eq!(pooled(), 1, "writing");
        Results::read_json(&text).expect("as written");
        assert_eq!(pooled(), 0, "reading");
    }
}
