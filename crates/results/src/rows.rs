//! The rows of findings: times, samples, backends and meshes.

use serde::{Deserialize, Serialize};
use sixfold_core::{Capabilities, Facts, TableBytes};

use crate::confidence::Confidence;
use crate::ranking::{NO_DIFFERENCE, has_enough};
use crate::read::ReadError;
use crate::statistics::{Median, median, undisturbed};

/// All samples (timed series of runs) of one operation on one backend. All lists except `first_ns`
/// contain one value for each sample.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Samples {
    /// The same as [`ResultRow::case`].
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub case: String,
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The name of the measured operation, such as `vertex_normal`. In a pick, `mix` is the whole
    /// mix.
    pub operation: String,
    /// True if these samples belong to the control. The control is a second measurement of one
    /// backend, which shows the noise.
    pub control: bool,
    /// For each sample, the number of its launch, from 0; empty if there is one launch.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub launches: Vec<u32>,
    /// For each sample, the number of the round. Two launches have no round in common.
    pub rounds: Vec<u32>,
    /// For each sample, the processor time of one run, in nanoseconds. `None` if the processor time
    /// is unknown.
    pub cpu_ns: Option<Vec<f64>>,
    /// For each sample, the wall time of one run, in nanoseconds.
    pub wall_ns: Vec<f64>,
    /// For each sample, the number of page faults; `None` if page faults were not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faults: Option<Vec<u64>>,
    /// For each sample, the slowdown of the machine. A small fixed piece of work is timed before
    /// and after the sample. The slowdown is the longer time of the fixed work, divided by the time
    /// of the fixed work on an undisturbed machine. If at least half of the samples, and at least 6,
    /// have a slowdown of at most 1.3, the other samples do not count.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub slowdowns: Vec<f64>,
    /// The times of first runs, in nanoseconds. A first run uses fresh memory pages and new tables.
    /// First runs take place after the last round.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub first_ns: Vec<f64>,
}

impl Samples {
    /// Returns the times of all undisturbed samples, in nanoseconds. The times are processor times
    /// if known, else wall times. If less than half of the samples, or fewer than 6, are
    /// undisturbed, returns the times of all samples.
    pub fn counted_ns(&self) -> Vec<f64> {
        undisturbed(
            self.cpu_ns.as_ref().unwrap_or(&self.wall_ns),
            &self.slowdowns,
        )
    }
}

/// The name, the hash and the facts of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct MeshReport {
    /// The name of the mesh: a file name or a description.
    pub name: String,
    /// The SHA-256 of the positions and faces as measured, as 64 hexadecimal digits. All numbers
    /// have 32 bits and begin with the lowest byte: the number of vertices, three coordinates for
    /// each vertex, and for each face the number of corners and the vertices of the corners.
    pub sha256: String,
    /// The SHA-256 of the file; `None` if the mesh was not read from a file.
    pub file_sha256: Option<String>,
    /// The topological facts of the mesh.
    #[serde(flatten)]
    pub facts: Facts,
    /// Changes that were made to the mesh before the study, as phrases.
    pub changes: Vec<String>,
    /// The number of degenerate faces of the file that were left out.
    pub left_out_faces: usize,
    /// The number of faces of the file that were cut into triangles.
    pub cut_faces: usize,
    /// A picture of the mesh: a PNG file in Base64. `None` if no picture was drawn.
    pub picture: Option<String>,
}

/// The memory of a backend on one mesh, or the reason why the backend cannot hold the mesh.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct BackendReport {
    /// The name of the backend, such as `half-edge`.
    pub name: String,
    /// True if the backend can hold the mesh.
    pub holds: bool,
    /// Why the backend cannot hold the mesh; `None` if the backend can hold the mesh.
    pub reason: Option<String>,
    /// Actual size in bytes; `None` if the backend was not built.
    pub bytes: Option<usize>,
    /// Actual size per vertex of the mesh, in bytes.
    pub bytes_per_vertex: Option<f64>,
    /// Size by the layout formula of the backend, in bytes; `None` if the backend cannot hold the
    /// mesh or has no formula.
    pub layout_bytes: Option<usize>,
    /// Size by the layout formula per vertex of the mesh, in bytes.
    pub layout_bytes_per_vertex: Option<f64>,
    /// Actual size of each table, in bytes.
    pub tables: Vec<TableBytes>,
    /// Number of vertices that the backend merged with another vertex of equal coordinates.
    pub merged_vertices: Option<usize>,
    /// The capabilities of a structure; `None` for an external program.
    pub capabilities: Option<Capabilities>,
    /// The external program; `None` for a structure.
    pub external: Option<ExternalReport>,
}

/// Facts about an external program.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct ExternalReport {
    /// The program and its arguments, with `{mesh}` for the path of the mesh.
    pub command: Vec<String>,
    /// The library that the program measures, with its version.
    pub library: Option<String>,
    /// True if freed memory pages are kept for Sixfold's structures but not for this program.
    /// Allocations of this program may then cause page faults.
    pub own_heap: bool,
    /// Why the program was given up: it ended, gave no answer in time, or broke the protocol. Its results are then
    /// incomplete. `None` if it did not fail; a program may refuse the mesh or an operation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
}

/// A backend that cannot hold the mesh.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct BackendRefusal {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// Why the backend cannot hold the mesh.
    pub reason: String,
}

impl BackendReport {
    /// Returns why the backend cannot hold the mesh; `None` if the mesh is not refused.
    pub fn refusal(&self) -> Option<BackendRefusal> {
        Some(BackendRefusal {
            backend: self.name.clone(),
            reason: self.reason.clone()?,
        })
    }
}

/// Returns the actual size of a backend in bytes; `None` if it was not measured.
pub(crate) fn bytes_of(backends: &[BackendReport], name: &str) -> Option<usize> {
    backends.iter().find(|backend| backend.name == name)?.bytes
}

impl From<BackendReport> for BackendRefusal {
    fn from(report: BackendReport) -> Self {
        Self {
            backend: report.name,
            reason: report.reason.unwrap_or_default(),
        }
    }
}

/// The result of one operation in one case on one backend; in `neighbours`, of one spatial task. All times are times of one run on the whole mesh, in nanoseconds. The fields are the columns
/// of the table of times in CSV.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct ResultRow {
    /// What was measured besides the task and the backend: in `orders`, the name of the order. Empty
    /// if there is only one case.
    pub case: String,
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The measured task, such as `vertex_normal`.
    pub operation: String,
    /// The time of a run: the median of the samples, corrected for the drift of the machine, so
    /// that the ratio of two backends is the quotient of their times. `None` if nothing was
    /// measured.
    pub median_ns: Option<f64>,
    /// The median of the samples without correction.
    pub uncorrected_ns: Option<f64>,
    /// The smallest time of a sample.
    pub min_ns: Option<f64>,
    /// The lower end of the confidence interval of `median_ns`; `None` with fewer than three
    /// samples.
    pub ci_low_ns: Option<f64>,
    /// The upper end of the confidence interval of `median_ns`.
    pub ci_high_ns: Option<f64>,
    /// The number of elements that a whole run visits.
    pub elements: Option<u64>,
    /// The kind of the visited elements: `vertex`, `edge`, `face`, `new face`, or `visit`.
    pub per: String,
    /// The median time per element, in nanoseconds.
    pub ns_per_element: Option<f64>,
    /// The median of the wall times (elapsed times).
    pub wall_median_ns: Option<f64>,
    /// The smallest wall time (elapsed time) of a sample.
    pub wall_min_ns: Option<f64>,
    /// True if the operation was run on only some of the elements. The times and the number of
    /// elements are scaled to the whole mesh.
    pub sampled: bool,
    /// The number of elements of each kind on which the operation was run; `None` if the operation
    /// was run on all elements.
    pub sample_size: Option<usize>,
    /// The estimated time of a whole run, if no run was measured.
    pub estimated_ns: Option<f64>,
    /// A checksum of all results of the operation, for comparison with other backends. `None` if
    /// nothing was measured or if the sum overflows.
    pub checksum: Option<f64>,
    /// The comparison of the checksum with the checksums of other backends.
    pub agreement: Agreement,
    /// The comparison of the time with the times of the other backends; in `orders`, with the other
    /// orders on this backend. `None` if nothing was measured, if the backend did other work than the
    /// others, or if there are too few samples: a backend with fewer than four samples is neither
    /// the fastest nor equal to it, and it is slower only if it takes at least twice the time.
    pub standing: Option<Standing>,
    /// The time of this backend divided by the time of the fastest backend. The fastest backend has
    /// the ratio 1.
    pub ratio_to_best: Option<f64>,
    /// The lower end of the confidence interval of `ratio_to_best`.
    pub ratio_ci_low: Option<f64>,
    /// The upper end of the confidence interval of `ratio_to_best`.
    pub ratio_ci_high: Option<f64>,
    /// The time in each launch, if there are several: the corrected median of its samples. `None` in a launch
    /// without a time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub launch_ns: Vec<Option<f64>>,
    /// The number of samples (timed series of runs).
    pub samples: usize,
    /// The number of consecutive runs in one sample.
    pub runs_per_sample: u32,
    /// True if the only sample is the warm-up run, which has cold caches.
    pub warm_up_only: bool,
    /// True if the time is only an estimate because the settings do not name the operation.
    pub by_name_only: bool,
    /// The largest number of page faults in a sample; `None` if page faults were not counted.
    pub faults: Option<u64>,
    /// The number of samples that were measured again because of page faults or other programs.
    pub retaken: u32,
    /// The number of samples that do not count because other programs disturbed them.
    pub disturbed: usize,
    /// The time of a first run, which uses fresh memory pages and tables of exact size. Use this
    /// time for a program that runs the operation only once. The value is `median_ns` multiplied by
    /// the median ratio of a first run to the following run. `None` if first runs were not
    /// measured, for example because the operation does not allocate.
    pub first_ns: Option<f64>,
    /// The number of measured first runs.
    pub first_samples: usize,
    /// The largest number of page faults in a first run; `None` if page faults were not counted.
    pub first_faults: Option<u64>,
}

impl ResultRow {
    /// Creates a result without measurements. `per` is the kind of the visited elements.
    pub fn new(backend: &str, operation: &str, per: &str) -> Self {
        Self {
            backend: backend.into(),
            operation: operation.into(),
            per: per.into(),
            runs_per_sample: 1,
            ..Self::default()
        }
    }

    /// Returns whether the time is from enough launches or samples to be ranked.
    pub fn has_enough_samples(&self) -> bool {
        has_enough(self.samples, &self.launch_ns)
    }

    /// Returns whether the time is from too few samples to say how it compares with the fastest.
    pub fn is_provisional(&self) -> bool {
        self.median_ns.is_some() && self.standing.is_none() && !self.has_enough_samples()
    }

    /// Returns `first_ns` divided by `median_ns`; `None` if a value is unknown.
    pub fn first_ratio(&self) -> Option<f64> {
        let (first, median) = self.first_ns.zip(self.median_ns)?;
        (median > 0.0).then(|| first / median)
    }

    /// Returns whether the backend is the fastest, or shares the first place.
    pub fn is_fastest(&self) -> bool {
        self.standing == Some(Standing::Best) || self.shares_first()
    }

    /// Returns whether the backend [shares the first place](Standing::shares_first).
    pub fn shares_first(&self) -> bool {
        self.standing.is_some_and(Standing::shares_first)
    }
}

/// Tables show the time of a first run if [`ResultRow::first_ratio`] is above this value.
pub const FIRST_TIME_SHOWN: f64 = 1.1;

/// Two measurements of the same backend (an A/A control). The difference between the two
/// measurements is the noise of the machine and of the clock.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Control {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The ratio of the two measurements for each operation.
    pub operations: Vec<ControlRow>,
    /// The longer time divided by the shorter time, as the median over the operations.
    pub typical: f64,
    /// The longer time divided by the shorter time, as the maximum over the operations.
    pub worst: f64,
}

impl Control {
    /// Creates a control from the ratios of the operations; `None` without operations.
    pub fn new(backend: &str, operations: Vec<ControlRow>) -> Option<Self> {
        let differences = || operations.iter().map(ControlRow::difference);
        let typical = median(differences().collect())?;
        let worst = differences().fold(1.0, f64::max);
        Some(Self {
            backend: backend.to_owned(),
            operations,
            typical,
            worst,
        })
    }
}

/// Maximum acceptable ratio between the two columns of a control.
const UNSTEADY: f64 = 1.05;

/// The difference between two measurements of the same backend in one operation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct ControlRow {
    /// The measured operation, such as `vertex_normal`.
    pub operation: String,
    /// The time of the second measurement divided by the time of the first measurement, as the
    /// median over the rounds.
    pub ratio: f64,
    /// The lower end of the confidence interval of `ratio`; `None` with fewer than three
    /// rounds.
    pub ci_low: Option<f64>,
    /// The upper end of the confidence interval of `ratio`.
    pub ci_high: Option<f64>,
    /// The ratio in each launch, if there are several; `None` in a launch without both times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub launches: Vec<Option<f64>>,
}

impl ControlRow {
    /// Creates the row of an operation. `launches` has the ratio in each launch, if there are several.
    pub fn new(
        operation: &str,
        ratio: Median,
        confidence: Confidence,
        launches: Vec<Option<f64>>,
    ) -> Self {
        let interval = ratio.interval(confidence);
        Self {
            operation: operation.to_owned(),
            ratio: ratio.value,
            ci_low: interval.map(|[low, _]| low),
            ci_high: interval.map(|[_, high]| high),
            launches,
        }
    }

    /// Returns true if the times of the two measurements differ by more than 5 % and the confidence
    /// interval of `ratio` does not contain 1.
    pub fn is_unsteady(&self) -> bool {
        let interval = self.ci_low.zip(self.ci_high);
        let beyond_chance = interval.is_some_and(|(low, high)| low > 1.0 || high < 1.0);
        self.difference() > UNSTEADY && beyond_chance
    }

    /// Returns the longer time of the two measurements divided by the shorter time.
    pub fn difference(&self) -> f64 {
        self.ratio.max(self.ratio.recip())
    }
}

/// Returns the maximum ratio that is noise: the difference of the control in this operation, at
/// least [`NO_DIFFERENCE`].
pub fn noise(control: Option<&Control>, operation: &str) -> f64 {
    let rows = control.map_or(&[][..], |control| &control.operations);
    let row = rows.iter().find(|row| row.operation == operation);
    row.map_or(1.0, ControlRow::difference).max(NO_DIFFERENCE)
}

/// An operation without a result on a backend: the backend cannot do it, or it was not run.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Refusal {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The operation without a result, such as `loop_native`.
    pub operation: String,
    /// Whether the backend cannot do the operation, or the budget ended.
    pub kind: RefusalKind,
    /// Why there is no result.
    pub reason: String,
}

/// The kind of reason why an operation has no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RefusalKind {
    /// The backend cannot do the operation on this mesh.
    Impossible,
    /// The operation was not run, because the budget ended.
    BudgetEnded,
}

/// The result of comparing the checksums of one operation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Agreement {
    /// The checksum is the same as on another backend, so both backends did the same work.
    Same,
    /// The checksum differs because vertices with equal coordinates were merged.
    Merged,
    /// The backend refuses different edits than the other backends, so the checksum may differ. For
    /// example, only some structures can hold the result of an edge collapse.
    OtherEdits,
    /// The checksum differs for no known reason, so at least one result is wrong.
    Mismatch,
    /// The checksum was not compared, for example because no other backend has a result.
    #[default]
    Unchecked,
}

/// The comparison of the time of a backend with the times of the other backends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// The fastest: all other backends are measurably slower.
    Best,
    /// As fast as the fastest: the whole interval of the ratio lies within 5 % of 1. The fastest backend
    /// is equal if another one is equal to it and none is undecided.
    Equal,
    /// Not decided: the interval of the ratio to the fastest contains 1 and reaches beyond 5 %, or the ratio
    /// is not above the noise. The fastest backend is undecided if another one is.
    #[serde(alias = "tied")]
    Undecided,
    /// Measurably slower than the fastest backend.
    Slower,
    /// No other backend was measured.
    Alone,
}

impl Standing {
    /// Returns whether the backend shares the first place, because it is equal to the fastest or because it is
    /// not decided which is faster.
    pub const fn shares_first(self) -> bool {
        matches!(self, Self::Equal | Self::Undecided)
    }
}

/// Returns an error if the lists of samples have different lengths, or for an impossible time.
pub(crate) fn check_samples(samples: &[Samples]) -> Result<(), ReadError> {
    for one in samples {
        let of = format!("the samples of {} on {}", one.operation, one.backend);
        let cpu = one.cpu_ns.as_ref().unwrap_or(&one.wall_ns);
        let optional = [
            one.slowdowns.len(),
            one.faults.as_ref().map_or(0, Vec::len),
            one.launches.len(),
        ];
        let fits = |len: usize| len == one.rounds.len();
        let fit = fits(one.wall_ns.len()) && fits(cpu.len());
        if !fit || !optional.into_iter().all(|len| len == 0 || fits(len)) {
            return malformed(format!("{of} have columns of different lengths"));
        }
        if !one.wall_ns.iter().chain(cpu).all(is_time) {
            return malformed(format!(
                "{of} include a time that is negative or not finite"
            ));
        }
    }
    Ok(())
}

/// Returns an error for an impossible time or ratio.
pub(crate) fn check_results<'r>(
    rows: impl IntoIterator<Item = &'r ResultRow>,
) -> Result<(), ReadError> {
    for row in rows {
        if !row.median_ns.iter().all(is_time) || row.ratio_to_best.is_some_and(|r| r <= 0.0) {
            let (operation, backend) = (&row.operation, &row.backend);
            return malformed(format!("invalid time or ratio of {operation} on {backend}"));
        }
    }
    Ok(())
}

/// Returns an error for a ratio that is not positive.
pub(crate) fn check_control(control: Option<&Control>) -> Result<(), ReadError> {
    let mut rows = control.into_iter().flat_map(|control| &control.operations);
    match rows.find(|row| row.ratio <= 0.0) {
        Some(row) => malformed(format!(
            "the control of {} has a ratio that is not positive",
            row.operation
        )),
        None => Ok(()),
    }
}

fn is_time(ns: &f64) -> bool {
    *ns >= 0.0 && ns.is_finite()
}

fn malformed(cause: String) -> Result<(), ReadError> {
    Err(ReadError::Malformed { cause })
}
