//! The result of a study of one mesh.

use serde::{Deserialize, Serialize};
use sixfold_workload::Operation;

use crate::engine::control::noise;
use crate::engine::timer::Timer;
use crate::labs::study::sentences::{how_sure, mean_over};
use crate::results::figure::{Figure, Rows};
use crate::results::finding::LabFinding;
use crate::results::pool::{Overall, Purpose, overall};
use crate::results::read::ReadError;
use crate::results::rows::{
    Agreement, BackendReport, Control, MeshReport, Refusal, ResultRow, Samples, Standing,
};
use crate::results::run::Run;
use sixfold_results::numbers::shown_ratio;

/// The result of a study.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct Report {
    /// How the study was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hashes of the mesh. In JSON, the finding has the place of the mesh in
    /// `meshes`.
    #[serde(skip)]
    pub mesh: MeshReport,
    /// The requested backends, in the order of [`Backend::structures`](crate::Backend::structures),
    /// then the external programs.
    pub backends: Vec<BackendReport>,
    /// The results, sorted by operation, then in the order of `backends`.
    pub results: Vec<ResultRow>,
    /// The operations that a backend cannot do, in the order of `results`.
    pub refusals: Vec<Refusal>,
    /// The noise: the difference between two measurements of one backend. `None` if no backend was
    /// measured twice.
    pub control: Option<Control>,
    /// The answer in at most three sentences: which backend is fastest for what, by how much, and how
    /// sure this is.
    pub sentences: Vec<String>,
    /// Sentences about single results: the subdivision methods, and merged vertices.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// The times of all samples.
    pub samples: Vec<Samples>,
    /// True if the study was stopped early. Some results may then be missing or have fewer samples.
    pub interrupted: bool,
    /// The resolution and the cost of reading the clock; `None` if nothing was run.
    pub timer: Option<Timer>,
}

impl Report {
    /// Iterates over the results of `operation`.
    pub fn rows(&self, operation: Operation) -> impl Iterator<Item = &ResultRow> {
        self.results
            .iter()
            .filter(move |row| row.operation == operation)
    }

    /// Returns the ratio of a result to the fastest backend of the operation, as the quotient of the
    /// shown times per element. `None` if the result is not ranked.
    pub fn shown_ratio(&self, row: &ResultRow) -> Option<f64> {
        row.ratio_to_best?;
        let mut rows = self.rows(row.operation);
        let best = rows.find(|row| row.ratio_to_best == Some(1.0))?;
        Some(shown_ratio(row.ns_per_element?, best.ns_per_element?))
    }

    /// Returns the mean time of each backend over the operations of each purpose. The backends of a
    /// purpose are sorted from the fastest to the slowest; those with a lower bound come last.
    pub fn overall(&self) -> Vec<Overall> {
        let names = self.backends.iter().map(|backend| backend.name.as_str());
        self.overall_of(&names.collect::<Vec<_>>())
    }

    /// Returns what [`overall`](Self::overall) returns, for those of the named backends that can hold the
    /// mesh. The ratios are to the fastest of them.
    pub fn overall_of(&self, names: &[&str]) -> Vec<Overall> {
        let holds = |name: &&&str| {
            let mut backends = self.backends.iter();
            backends.any(|backend| backend.holds && backend.name == **name)
        };
        let holding: Vec<&str> = names.iter().filter(holds).copied().collect();
        overall(&[self], &holding)
    }

    /// Returns whether at least one operation of a purpose has enough samples to be ranked.
    pub fn is_decided(&self, purpose: Purpose) -> bool {
        let mut rows = self.results.iter();
        rows.any(|row| {
            let ranked = row
                .standing
                .is_some_and(|standing| standing != Standing::Slower);
            ranked && Purpose::of(row.operation) == purpose
        })
    }

    /// Says over what the means of one purpose are, such as `geometric mean of 17 operations` or `fastest
    /// method of Loop`. Empty for one operation. `rows` are those of [`overall`](Self::overall).
    pub fn mean_over(&self, rows: &[Overall]) -> String {
        mean_over(self, rows)
    }

    /// Returns a sentence on the noise and on how many operations have a clear answer; `None` if
    /// nothing was measured.
    pub fn how_sure(&self) -> Option<String> {
        how_sure(self)
    }

    /// Iterates over the wrong results of Sixfold's structures: the checksum differs, for no known
    /// reason, from the checksums of other structures.
    pub fn mismatches(&self) -> impl Iterator<Item = &ResultRow> {
        let wrong = |row: &&ResultRow| row.agreement == Agreement::Mismatch;
        self.results
            .iter()
            .filter(wrong)
            .filter(|row| !self.is_external(&row.backend))
    }

    /// Iterates over the results of external programs that differ from the results of Sixfold.
    pub fn external_mismatches(&self) -> impl Iterator<Item = &ResultRow> {
        let wrong = |row: &&ResultRow| row.agreement == Agreement::Mismatch;
        self.results
            .iter()
            .filter(wrong)
            .filter(|row| self.is_external(&row.backend))
    }

    fn all_rows(&self) -> Rows<'_> {
        Rows {
            results: &self.results,
            refusals: &self.refusals,
            samples: &self.samples,
            control: self.control.as_ref(),
        }
    }

    fn is_external(&self, column: &str) -> bool {
        let mut columns = self.backends.iter().filter(|other| other.name == column);
        columns.any(|column| column.external.is_some())
    }
}

impl LabFinding for Report {
    fn mismatches(&self) -> usize {
        Self::mismatches(self).count()
    }

    fn figures(&self) -> Vec<Figure<'_>> {
        let bytes = |backend: &str| bytes_of(&self.backends, backend);
        let noise = |operation| noise(self.control.as_ref(), operation);
        self.all_rows().figures(Some(&self.mesh), bytes, noise)
    }

    fn check(&self) -> Result<(), ReadError> {
        self.all_rows().check()
    }
}

/// Returns the actual size of a backend in bytes; `None` if it was not measured.
pub(crate) fn bytes_of(backends: &[BackendReport], name: &str) -> Option<usize> {
    backends.iter().find(|backend| backend.name == name)?.bytes
}
