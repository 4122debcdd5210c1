//! The report: everything a study found, in the shape that `reports/SCHEMA.md` documents.

use std::io;

use serde::{Deserialize, Serialize};
use serde_json::Serializer;
use serde_json::ser::{Formatter, PrettyFormatter};
use serde_with::{KeyValueMap, serde_as};
use sixfold::{Capabilities, Facts, TableBytes};

use crate::environment::Environment;
use crate::external::ExternalReport;
use crate::gauge::undisturbed;
use crate::timer::Timer;
use workload::Operation;

/// The version of the shape; it changes when a reader of the old one would go wrong.
pub const SCHEMA: u32 = 1;

/// What an inspection finds: the mesh, and what each backend says to it.
#[serde_as]
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Inspection {
    /// The version of the shape.
    pub schema: u32,
    /// What the mesh is.
    pub mesh: MeshReport,
    /// By name, in the order of the roster.
    #[serde_as(as = "KeyValueMap<_>")]
    pub backends: Vec<BackendReport>,
}

/// What a study finds.
#[serde_as]
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Report {
    /// The version of the shape.
    pub schema: u32,
    /// What the mesh is.
    pub mesh: MeshReport,
    /// By name, in the order of the roster.
    #[serde_as(as = "KeyValueMap<_>")]
    pub backends: Vec<BackendReport>,
    /// Operation by operation, and within each in the order of the roster.
    pub results: Vec<ResultRow>,
    /// What was asked for and cannot be done, in the same order.
    pub refusals: Vec<Refusal>,
    /// What differs where nothing does; `None` where nothing was measured twice.
    pub control: Option<Control>,
    /// What the table shows, in words.
    pub words: Vec<String>,
    /// What may be wrong with it, and what helps, in words.
    pub warnings: Vec<String>,
    /// Every sample that was taken.
    pub raw: Vec<RawSamples>,
    /// Told to stop before the end: some rows are missing, or rest on fewer samples.
    pub interrupted: bool,
    /// What the clock and the engine cost; `None` where nothing was run.
    pub timer: Option<Timer>,
    /// The machine and the program.
    pub environment: Environment,
}

/// The samples of one operation on one backend, as three columns of one length.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct RawSamples {
    /// The backend.
    pub backend: String,
    /// The operation.
    pub operation: Operation,
    /// It is the second entry of the backend, which the control is made of.
    pub control: bool,
    /// The round that each sample was taken in: samples of one round can be compared.
    pub rounds: Vec<u32>,
    /// Processor time of one run, in nanoseconds; `None` where the platform does not tell.
    pub cpu_ns: Option<Vec<f64>>,
    /// Wall time of one run, in nanoseconds.
    pub wall_ns: Vec<f64>,
    /// Page faults in each sample; `None` where they were not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faults: Option<Vec<u64>>,
    /// For each sample the time of a small fixed piece of work before or after it, whichever is longer,
    /// divided by the undisturbed time of that work. A sample above 1.3 does not count if at least a
    /// quarter of the samples are below.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub slowdowns: Vec<f64>,
    /// Time of one run on fresh pages and tables, in nanoseconds: samples of their own, of no round.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub first_ns: Vec<f64>,
}

impl RawSamples {
    /// Returns the times of the samples that count: processor time if it is known, else wall time.
    pub fn counted_ns(&self) -> Vec<f64> {
        undisturbed(
            self.cpu_ns.as_ref().unwrap_or(&self.wall_ns),
            &self.slowdowns,
        )
    }
}

/// A mesh, as its file has it.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct MeshReport {
    /// Where it comes from.
    pub name: String,
    /// Its topology.
    #[serde(flatten)]
    pub facts: Facts,
    /// What was changed before the study: `triangulated`, faces left out.
    pub changes: Vec<String>,
}

/// What a backend says to the mesh.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct BackendReport {
    /// What users call it: the key of the map.
    #[serde(rename = "$key$")]
    pub name: String,
    /// Whether it can hold the mesh.
    pub holds: bool,
    /// Why not.
    pub reason: Option<String>,
    /// Bytes really held; `None` if it was not built.
    pub bytes: Option<usize>,
    /// The same for each vertex of the mesh.
    pub bytes_per_vertex: Option<f64>,
    /// Bytes that the layout takes in theory; `None` if it does not hold the mesh.
    pub layout_bytes: Option<usize>,
    /// The same for each vertex of the mesh.
    pub layout_bytes_per_vertex: Option<f64>,
    /// Bytes really held, table by table.
    pub tables: Vec<TableBytes>,
    /// Vertices of the mesh that are no vertices of their own here: they share coordinates.
    pub merged_vertices: Option<usize>,
    /// What it can hold at all; `None` for a program of somebody else.
    pub capabilities: Option<Capabilities>,
    /// The program, where it is one of somebody else.
    pub external: Option<ExternalReport>,
}

/// One operation on one backend. Times are of one whole run, in nanoseconds.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct ResultRow {
    /// The backend.
    pub backend: String,
    /// The operation.
    pub operation: Operation,
    /// The median of the samples; `None` where nothing was measured.
    pub median_ns: Option<f64>,
    /// The smallest sample.
    pub min_ns: Option<f64>,
    /// The lower end of the 95 % interval of the median; `None` below three samples.
    pub ci_low_ns: Option<f64>,
    /// Its upper end.
    pub ci_high_ns: Option<f64>,
    /// How many elements a whole run visits.
    pub elements: Option<u64>,
    /// What one of them is: `vertex`, `edge`, `face`, `new face`, or `visit`.
    pub per: String,
    /// `median_ns` for each of them.
    pub ns_per_element: Option<f64>,
    /// The median on the wall clock.
    pub wall_median_ns: Option<f64>,
    /// The smallest sample on the wall clock.
    pub wall_min_ns: Option<f64>,
    /// A sample of the elements stands for all: times and elements are scaled.
    pub sampled: bool,
    /// How many elements of each kind that is scanned for.
    pub sample_size: Option<usize>,
    /// Not measured: the estimate of a whole run.
    pub estimated_ns: Option<f64>,
    /// A number that depends on all results, on the sample where there is one; `None` where nothing
    /// was measured or the arithmetic overflows.
    pub checksum: Option<f64>,
    /// Whether other backends found the same.
    pub agreement: Agreement,
    /// How it stands beside the other backends; `None` where nothing was measured.
    pub standing: Option<Standing>,
    /// The median, over rounds, of its time by that of the fastest; 1 for the fastest itself.
    pub ratio_to_best: Option<f64>,
    /// The lower end of the 95 % interval of that ratio.
    pub ratio_ci_low: Option<f64>,
    /// Its upper end.
    pub ratio_ci_high: Option<f64>,
    /// How many samples there are.
    pub samples: usize,
    /// How many runs in a row make one.
    pub runs_per_sample: u32,
    /// There was time for no more than the warm-up: that one run, with its cold caches, is the sample.
    pub warm_up_only: bool,
    /// It was left to an estimate because nobody asked for it by name: the budget has room for a run.
    pub by_name_only: bool,
    /// The most page faults in any sample; `None` where they were not counted.
    #[serde(default)]
    pub faults: Option<u64>,
    /// How many samples were taken again because pages faulted in them, or other work disturbed the
    /// machine.
    #[serde(default)]
    pub retaken: u32,
    /// How many samples do not count, because other work disturbed the machine beside them.
    #[serde(default)]
    pub disturbed: usize,
    /// The time of a first run, as in a program that does this once, on fresh pages and with tables of exact
    /// size: `median_ns` multiplied by the median ratio of first runs to runs right after them. `None` for
    /// what does not allocate, and if there was no time for it.
    #[serde(default)]
    pub first_ns: Option<f64>,
    /// How many samples that stands on.
    #[serde(default)]
    pub first_samples: usize,
    /// The most page faults in any of them.
    #[serde(default)]
    pub first_faults: Option<u64>,
}

impl ResultRow {
    /// A row of `operation` on `backend` with nothing measured: to be filled.
    pub fn new(backend: &str, operation: Operation) -> Self {
        Self {
            backend: backend.into(),
            operation,
            median_ns: None,
            min_ns: None,
            ci_low_ns: None,
            ci_high_ns: None,
            elements: None,
            per: operation.per().into(),
            ns_per_element: None,
            wall_median_ns: None,
            wall_min_ns: None,
            sampled: false,
            sample_size: None,
            estimated_ns: None,
            checksum: None,
            agreement: Agreement::Unchecked,
            standing: None,
            ratio_to_best: None,
            ratio_ci_low: None,
            ratio_ci_high: None,
            samples: 0,
            runs_per_sample: 1,
            warm_up_only: false,
            by_name_only: false,
            faults: None,
            retaken: 0,
            disturbed: 0,
            first_ns: None,
            first_samples: 0,
            first_faults: None,
        }
    }

    /// By how much the first time takes longer than the median, where both are known.
    pub fn first_ratio(&self) -> Option<f64> {
        let (first, median) = self.first_ns.zip(self.median_ns)?;
        (median > 0.0).then(|| first / median)
    }
}

/// A first time that differs by more than this from the kept one is shown.
pub const FIRST_TIME_SHOWN: f64 = 1.1;

/// One backend, entered twice (an A/A control): by how much its two columns differ, the machine and
/// the clock alone are to blame.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Control {
    /// The backend.
    pub backend: String,
    /// Operation by operation, where both columns have samples.
    pub operations: Vec<ControlRow>,
    /// The median difference, as a ratio of 1 or more.
    pub typical: f64,
    /// The greatest.
    pub worst: f64,
}

/// The two columns of a control should not differ by more than this.
const UNSTEADY: f64 = 1.05;

/// What the second column of a control says of one operation.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct ControlRow {
    /// The operation.
    pub operation: Operation,
    /// The median, over rounds, of the time of the second by that of the first.
    pub ratio: f64,
    /// The lower end of the 95 % interval of that ratio; `None` below three rounds.
    pub ci_low: Option<f64>,
    /// Its upper end.
    pub ci_high: Option<f64>,
}

impl ControlRow {
    /// Whether the two differ by more than 5 %, and not by chance: smaller differences between backends
    /// are no result then.
    pub fn is_unsteady(&self) -> bool {
        let interval = self.ci_low.zip(self.ci_high);
        let beyond_chance = interval.is_some_and(|(low, high)| low > 1.0 || high < 1.0);
        self.difference() > UNSTEADY && beyond_chance
    }

    /// How far the two are apart, whichever is slower: 1 or more.
    pub fn difference(&self) -> f64 {
        self.ratio.max(self.ratio.recip())
    }
}

/// An operation that a backend cannot do on this mesh: it has no row among the results.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Refusal {
    /// The backend.
    pub backend: String,
    /// The operation.
    pub operation: Operation,
    /// Why not.
    pub reason: String,
}

/// The fields of a row, for a file without any.
const COLUMNS: [&str; 30] = [
    "backend",
    "operation",
    "median_ns",
    "min_ns",
    "ci_low_ns",
    "ci_high_ns",
    "elements",
    "per",
    "ns_per_element",
    "wall_median_ns",
    "wall_min_ns",
    "sampled",
    "sample_size",
    "estimated_ns",
    "checksum",
    "agreement",
    "standing",
    "ratio_to_best",
    "ratio_ci_low",
    "ratio_ci_high",
    "samples",
    "runs_per_sample",
    "warm_up_only",
    "by_name_only",
    "faults",
    "retaken",
    "disturbed",
    "first_ns",
    "first_samples",
    "first_faults",
];

/// What the checksums of one operation say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Agreement {
    /// All did the same work.
    Same,
    /// It differs, as it may where vertices that share coordinates are one.
    Merged,
    /// It differs, and nothing explains that: a fault in Sixfold.
    Mismatch,
    /// There is nothing to compare with.
    Unchecked,
}

/// How a result stands beside those of other backends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Faster than all others.
    Best,
    /// Nobody is faster beyond doubt, and another is as fast.
    Tied,
    /// Another is faster.
    Slower,
    /// No other backend was measured.
    Alone,
}

impl Report {
    /// The rows of `operation`.
    pub fn rows(&self, operation: Operation) -> impl Iterator<Item = &ResultRow> {
        self.results
            .iter()
            .filter(move |row| row.operation == operation)
    }

    /// Results of ours that no difference between the backends explains.
    pub fn mismatches(&self) -> impl Iterator<Item = &ResultRow> {
        let wrong = |row: &&ResultRow| row.agreement == Agreement::Mismatch;
        self.results
            .iter()
            .filter(wrong)
            .filter(|row| !self.is_external(&row.backend))
    }

    /// Results of programs of others that did another work than ours.
    pub fn other_work(&self) -> impl Iterator<Item = &ResultRow> {
        let wrong = |row: &&ResultRow| row.agreement == Agreement::Mismatch;
        self.results
            .iter()
            .filter(wrong)
            .filter(|row| self.is_external(&row.backend))
    }

    fn is_external(&self, column: &str) -> bool {
        let mut columns = self.backends.iter().filter(|other| other.name == column);
        columns.any(|column| column.external.is_some())
    }

    /// Writes the report as JSON.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }

    /// Writes one line for each result, under a line with the names of the fields.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_csv(&self, writer: impl io::Write) -> io::Result<()> {
        let mut lines = csv::Writer::from_writer(writer);
        if self.results.is_empty() {
            lines.write_record(COLUMNS).map_err(unwrapped)?;
        }
        for row in &self.results {
            lines.serialize(row).map_err(unwrapped)?;
        }
        lines.flush()
    }
}

impl Inspection {
    /// Writes the inspection as JSON.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// What went wrong with a place, as it was before it was an error of CSV: a pipe that nobody reads is known
/// by its kind.
pub(crate) fn unwrapped(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(cause) => cause,
        other => io::Error::other(format!("{other:?}")),
    }
}

pub(crate) fn write_json(value: &impl Serialize, mut writer: impl io::Write) -> io::Result<()> {
    let mut serializer = Serializer::with_formatter(&mut writer, Rows::default());
    value.serialize(&mut serializer).map_err(io::Error::from)?;
    writeln!(writer)
}

/// JSON with a line for each field, and arrays without lines of their own: columns of samples would
/// be thousands of them.
#[derive(Default)]
struct Rows<'a>(PrettyFormatter<'a>);

impl Formatter for Rows<'_> {
    fn begin_array_value<W: ?Sized + io::Write>(
        &mut self,
        w: &mut W,
        first: bool,
    ) -> io::Result<()> {
        if first { Ok(()) } else { w.write_all(b", ") }
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.begin_object(w)
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.end_object(w)
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        w: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.0.begin_object_key(w, first)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.begin_object_value(w)
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        self.0.end_object_value(w)
    }
}
