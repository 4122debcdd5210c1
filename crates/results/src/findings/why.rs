//! The memory that queries read, compared with the times of the queries.

use serde::{Deserialize, Serialize};
use sixfold_core::Relation;

use crate::figure::{Counted, Figure, Status, samples_of};
use crate::finding::LabFinding;
use crate::read::ReadError;
use crate::rows::{
    Agreement, BackendReport, Control, MeshReport, ResultRow, Samples, bytes_of, check_control,
    check_samples,
};
use crate::run::Run;
use crate::timer::Timer;

/// The memory that queries read on each structure, compared with the times of the queries.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Why {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hashes of the mesh. In JSON, the finding has the place of the mesh in
    /// `meshes`.
    #[serde(skip)]
    pub mesh: MeshReport,
    /// The backends, in the order of tables.
    pub backends: Vec<BackendReport>,
    /// The model of the processor cache with which reads are counted.
    pub model: Model,
    /// The speed of reading buffers of growing size; `None` if no times were measured.
    pub memory: Option<Vec<BufferSpeed>>,
    /// The results, sorted by relation, then in the order of `backends`.
    pub rows: Vec<WhyRow>,
    /// The comparison of two measurements of one backend, which shows the noise. `None` if no backend was measured
    /// twice.
    #[serde(default)]
    pub control: Option<Control>,
    /// The times of all samples; empty if no times were measured.
    pub samples: Vec<Samples>,
    /// Sentences about the results; empty if the counting was stopped.
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// True if the measurement was stopped early. Some rows or times may then be missing.
    pub interrupted: bool,
    /// The resolution and the cost of reading the clock; `None` if no times were measured.
    #[serde(default)]
    pub timer: Option<Timer>,
}

/// The model of the processor cache with which reads are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Model {
    /// Size of a cache line, in bytes.
    pub line_bytes: usize,
    /// Number of cache lines in the modelled cache. A full cache drops the line that was loaded
    /// first.
    pub cache_lines: u64,
    /// A jump is the loading of a cache line that is more than this number of cache lines away from
    /// every cached line.
    pub reach: usize,
    /// Number of queried elements if only a sample of the elements is queried.
    pub sample: usize,
    /// If a query reads more table rows than this number on average, only a sample of the elements
    /// is queried.
    pub most_reads: u64,
}

/// The reads and the time of one relation on one backend.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct WhyRow {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The kind of the elements that are queried: `vertex`, `edge` or `face`.
    pub per: String,
    /// The numbers of table reads.
    #[serde(flatten)]
    pub reads: Reads,
    /// The time of the queries; `None` if no time was measured.
    pub timed: Option<Timed>,
}

/// The time of querying a relation at all elements (a sweep), and the explanation of this time.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Timed {
    /// The median time per element, in nanoseconds; with several launches, the time over the launches.
    pub ns_per_element: f64,
    /// With several launches, `ns_per_element` in each of them; `None` in a launch without a time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub launch_ns: Vec<Option<f64>>,
    /// Lower end of the interval of `ns_per_element`; `None` with fewer than two launches and three rounds.
    #[serde(default)]
    pub ci_low_ns: Option<f64>,
    /// Upper end of the interval of `ns_per_element`.
    #[serde(default)]
    pub ci_high_ns: Option<f64>,
    /// True if only a sample of the elements was timed.
    pub sampled: bool,
    /// The comparison of the checksum with the checksums of other backends.
    pub agreement: Agreement,
    /// The speed of reading a buffer as large as the memory that all queries together read.
    pub speed: BufferSpeed,
    /// The computed time for a sequential read of the bytes that one element needs, in nanoseconds.
    pub floor_ns: f64,
    /// The computed time for the jumps of one element if the jumps do not overlap, in nanoseconds.
    /// A jump loads a cache line that is not near any cached line.
    pub waits_ns: f64,
    /// The factor that limits the speed of the queries.
    pub bound: Bound,
}

sixfold_core::named! {
    /// The factor that limits the speed of a sweep (querying a relation at all elements).
    pub enum Bound: "limiting factor" {
        /// The transfer of bytes from memory limits the speed.
        Bandwidth = "bandwidth",
        /// The wait for cache lines that a prefetcher cannot predict limits the speed.
        Latency = "latency",
        /// Computation on data in the cache limits the speed.
        Work = "work",
    }
}

impl LabFinding for Why {
    fn figures<'s>(&'s self) -> Vec<Figure<'s>> {
        let figure = |row: &'s WhyRow| {
            let operation = row.reads.relation.name();
            let status = match row.timed.as_ref().map(|timed| timed.sampled) {
                None => Status::Counted,
                Some(true) => Status::Sampled,
                Some(false) => Status::Measured,
            };
            let bytes = bytes_of(&self.backends, &row.backend);
            Figure {
                samples: samples_of(&self.samples, "", operation, &row.backend),
                counted: Counted::from(&row.reads),
                ..Figure::new(Some(&self.mesh), bytes, status, self.result(row))
            }
        };
        self.rows.iter().map(figure).collect()
    }

    fn check(&self) -> Result<(), ReadError> {
        check_samples(&self.samples)?;
        check_control(self.control.as_ref())
    }
}

impl Why {
    /// Returns the measured times as rows, for [`pool_rows`](crate::launches::pool_rows()).
    pub fn results(&self) -> Vec<ResultRow> {
        let timed = self.rows.iter().filter(|row| row.timed.is_some());
        timed.map(|row| self.result(row)).collect()
    }

    /// Returns the time of a row, which is empty if no time was measured.
    fn result(&self, row: &WhyRow) -> ResultRow {
        let (operation, elements) = (row.reads.relation.name(), row.reads.elements);
        let untimed = ResultRow {
            elements: Some(elements),
            ..ResultRow::new(&row.backend, operation, &row.per)
        };
        let Some(timed) = &row.timed else {
            return untimed;
        };
        let of_run = |each: f64| each * elements as f64;
        let samples = samples_of(&self.samples, "", operation, &row.backend);
        let count = samples.map_or(0, |samples| samples.rounds.len());
        let faults = samples.and_then(|samples| samples.faults.as_ref());
        let launches = timed.launch_ns.iter();
        ResultRow {
            median_ns: Some(of_run(timed.ns_per_element)),
            ns_per_element: Some(timed.ns_per_element),
            launch_ns: launches.map(|each| each.map(of_run)).collect(),
            ci_low_ns: timed.ci_low_ns.map(of_run),
            ci_high_ns: timed.ci_high_ns.map(of_run),
            sampled: timed.sampled,
            agreement: timed.agreement,
            samples: count,
            warm_up_only: count == 0,
            faults: faults.and_then(|faults| faults.iter().copied().max()),
            ..untimed
        }
    }
}

impl Bound {
    /// Returns the factor that limits a query that takes `ns` nanoseconds. `floor_ns` is the time
    /// for the transfer of the bytes that the query reads. `waits_ns` is the time for all jumps to
    /// distant cache lines if the jumps do not overlap.
    ///
    /// - `Bandwidth` if `floor_ns` is at least half of `ns`.
    /// - `Latency` if `floor_ns` is less than half of `ns`, and `waits_ns` is at least half of
    ///   `ns`. A processor overlaps jumps, so the jumps may take less time than `waits_ns`.
    /// - `Work` in all other cases.
    pub fn from_times(ns: f64, floor_ns: f64, waits_ns: f64) -> Self {
        if 2.0 * floor_ns >= ns {
            Self::Bandwidth
        } else if 2.0 * waits_ns >= ns {
            Self::Latency
        } else {
            Self::Work
        }
    }
}

/// The table reads of one relation. The relation is queried at all elements in the order of the
/// structure, or at a sample of evenly spaced elements.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Reads {
    /// The queried relation.
    pub relation: Relation,
    /// Number of elements at which the relation can be queried.
    pub elements: u64,
    /// Number of elements at which the relation was queried.
    #[serde(rename = "asked")]
    pub queried: u64,
    /// True if only a sample of evenly spaced elements was queried. If true, values per query are
    /// means over the sample.
    pub sampled: bool,
    /// Mean number of results per query.
    pub answers: f64,
    /// Mean number of table rows that a query reads. A row that a query reads twice counts twice.
    pub reads: f64,
    /// Mean number of bytes that a query reads. A byte that a query reads twice counts once.
    pub bytes: f64,
    /// Mean number of cache lines that a query touches. A cache line that a query touches twice
    /// counts once.
    pub lines: f64,
    /// Number of table rows that are read to list the elements, divided by the number of elements.
    pub listing_reads: f64,
    /// Mean number of cache lines per element that a small simulated cache fetches from memory. The
    /// lines that are read to list the elements are included.
    pub fetched: f64,
    /// Mean number of jumps per element. A jump is the fetch of a cache line that is not near any
    /// line in the simulated cache.
    pub jumps: f64,
    /// Number of distinct cache lines that are touched while the elements are listed and queried.
    /// If only a sample of the elements is queried, the number does not include lines that only
    /// queries of other elements would touch.
    pub sweep_lines: u64,
    /// The bytes per element of the cache lines that the whole pass touches. If all elements are
    /// queried, each touched cache line counts once for the whole mesh. If only a sample is
    /// queried, each cache line counts once for each query that touches the line.
    pub moved_bytes: f64,
    /// The number of rows that a query reads from each table.
    pub tables: Vec<TableReads>,
}

impl Reads {
    /// Returns the bytes of all distinct cache lines that are touched while the elements are
    /// queried. A cache line has `line_bytes` bytes.
    pub fn sweep_bytes(&self, line_bytes: usize) -> usize {
        usize::try_from(self.sweep_lines).map_or(usize::MAX, |lines| lines * line_bytes)
    }
}

/// The reads of one table by the queries of one relation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct TableReads {
    /// The name of the table.
    pub table: String,
    /// Bytes of one row of the table.
    pub row_bytes: usize,
    /// Mean number of rows of the table that a query reads.
    pub reads: f64,
}

/// The read speed of a buffer of one size.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct BufferSpeed {
    /// The size of the buffer in bytes.
    pub bytes: usize,
    /// The bandwidth of sequential reads, in GB/s.
    pub gb_per_s: f64,
    /// The time of one dependent read, in nanoseconds.
    pub latency_ns: f64,
}
