//! The result of a study of one mesh.

use serde::{Deserialize, Serialize};

use crate::figure::{Figure, Rows};
use crate::finding::LabFinding;
use crate::launches::LaunchRows;
use crate::numbers::{counted, list, shown_ratio};
use crate::operation::Purpose;
use crate::pool::{Overall, overall};
use crate::read::ReadError;
use crate::rows::{
    Agreement, BackendReport, Control, ControlRow, MeshReport, Refusal, ResultRow, Samples,
    Standing, bytes_of,
};
use crate::run::Run;
use crate::timer::Timer;

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
    /// The requested backends, in the order of the list of all structures,
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
    pub fn rows(&self, operation: &str) -> impl Iterator<Item = &ResultRow> {
        let of_it = move |row: &&ResultRow| row.operation == operation;
        self.results.iter().filter(of_it)
    }

    /// Returns the result of `operation` on `backend`.
    pub fn row(&self, operation: &str, backend: &str) -> Option<&ResultRow> {
        self.rows(operation).find(|row| row.backend == backend)
    }

    /// Returns the memory of a backend, or why it cannot hold the mesh; `None` if the backend was not
    /// requested.
    pub fn backend(&self, name: &str) -> Option<&BackendReport> {
        self.backends.iter().find(|backend| backend.name == name)
    }

    /// Returns the ratio of a result to the fastest backend of the operation, as the quotient of the
    /// shown times per element. `None` if the result is not ranked.
    pub fn shown_ratio(&self, row: &ResultRow) -> Option<f64> {
        row.ratio_to_best?;
        let mut rows = self.rows(&row.operation);
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
        let holds = |name: &&&str| self.backend(name).is_some_and(|backend| backend.holds);
        let holding: Vec<&str> = names.iter().filter(holds).copied().collect();
        overall(&[self], &holding)
    }

    /// Returns whether a time of an operation is from too few samples to name the fastest backend.
    pub fn is_provisional(&self, operation: &str) -> bool {
        self.rows(operation).any(ResultRow::is_provisional)
    }

    /// Returns whether at least one operation of a purpose has enough samples to be ranked.
    pub fn is_decided(&self, purpose: Purpose) -> bool {
        let mut rows = self.results.iter();
        rows.any(|row| {
            let ranked = row
                .standing
                .is_some_and(|standing| standing != Standing::Slower);
            ranked && self.run.purpose_of(&row.operation) == Some(purpose)
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

    /// Returns the rows as those of one or more launches.
    pub fn launch_rows(&self) -> LaunchRows<'_> {
        LaunchRows {
            results: &self.results,
            refusals: &self.refusals,
            samples: &self.samples,
            control: self.control.as_ref(),
        }
    }

    fn all_rows(&self) -> Rows<'_> {
        Rows {
            run: &self.run,
            rows: self.launch_rows(),
        }
    }

    fn is_external(&self, column: &str) -> bool {
        let column = self.backend(column);
        column.is_some_and(|column| column.external.is_some())
    }
}

impl LabFinding for Report {
    fn mismatches(&self) -> usize {
        Self::mismatches(self).count()
    }

    fn figures(&self) -> Vec<Figure<'_>> {
        let bytes = |backend: &str| bytes_of(&self.backends, backend);
        self.all_rows().figures(Some(&self.mesh), bytes)
    }

    fn check(&self) -> Result<(), ReadError> {
        self.all_rows().check()
    }
}

/// Says over what a mean is, such as `geometric mean of 17 operations` or `fastest method of Loop`. Empty
/// for one operation.
fn mean_over(report: &Report, rows: &[Overall]) -> String {
    match (rows[0].purpose, rows[0].cases) {
        (Purpose::Subdivide, _) => {
            format!("fastest method of {}", list(schemes(report, rows)))
        }
        (_, 1) => String::new(),
        (_, cases) => format!("geometric mean of {cases} operations"),
    }
}

/// Returns the names of the schemes of which all backends of `rows` have a time.
fn schemes<'r>(report: &'r Report, rows: &[Overall]) -> Vec<&'r str> {
    let mut schemes: Vec<&str> = Vec::new();
    for scheme in report
        .run
        .operations
        .iter()
        .filter_map(|info| info.scheme.as_deref())
    {
        let has = |backend: &str| {
            let mut results = report.results.iter().filter(|row| row.backend == backend);
            results.any(|row| report.run.scheme_of(&row.operation) == Some(scheme))
        };
        if !schemes.contains(&scheme) && rows.iter().all(|row| has(&row.backend)) {
            schemes.push(scheme);
        }
    }
    schemes
}

/// Describes the noise, and counts the operations with a clear answer.
fn how_sure(report: &Report) -> Option<String> {
    let rows = report.results.chunk_by(|a, b| a.operation == b.operation);
    let compared: Vec<&[ResultRow]> = rows
        .filter(|rows| rows.iter().filter(|row| row.median_ns.is_some()).count() > 1)
        .collect();
    let decision = |rows: &&[ResultRow]| {
        let has = |standing| rows.iter().any(|row| row.standing == Some(standing));
        let order = [Standing::Best, Standing::Undecided, Standing::Equal];
        order.into_iter().position(has).unwrap_or(order.len())
    };
    let mut counts = [0; 4];
    compared.iter().for_each(|rows| counts[decision(rows)] += 1);
    let [clear, undecided, equal, few] = counts;
    let counts = [
        (clear, "with a clear winner"),
        (equal, "with equal winners"),
        (undecided, "undecided"),
        (few, "with too few samples"),
    ];
    let counts = counts.into_iter().filter(|(count, _)| *count > 0);
    let counts = counts.map(|(count, what)| format!("{count} {what}"));
    let counts = list(counts);
    let noise = report.control.as_ref().and_then(describe_noise);
    match (compared.len(), noise) {
        (0, None) => None,
        (0, Some(noise)) => Some(format!("How sure: {noise}.")),
        (all, noise) => {
            let noise = noise.map_or(String::new(), |noise| format!("; {noise}"));
            let operations = counted(all, "operation", "operations");
            Some(format!("How sure: of {operations}, {counts}{noise}."))
        }
    }
}

/// Describes the difference between the two measurements of the control, without a full stop.
pub fn describe_noise(control: &Control) -> Option<String> {
    let difference = |row: &&ControlRow| row.difference();
    let worst = control
        .operations
        .iter()
        .max_by(|a, b| difference(a).total_cmp(&difference(b)))?;
    let percent = |ratio: f64| format!("{:.1} %", 100.0 * (ratio - 1.0));
    let at_most = match control.operations.len() {
        1 => String::new(),
        _ => format!(
            " (median; at most {} in {})",
            percent(control.worst),
            worst.operation
        ),
    };
    Some(format!(
        "two measurements of {} differ by {}{at_most}",
        control.backend,
        percent(control.typical),
    ))
}
