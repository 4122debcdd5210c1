//! The report of a pick, in the format that `reports/SCHEMA.md` documents.

use std::io;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_with::{DeserializeAs, Map, Same};
use sixfold_workload::{Action, Workload};

use crate::environment::Environment;
use crate::numbers::grouped;
use crate::pick::needs::Need;
use crate::report::write_json;
use crate::timer::Timer;

/// The ranking of the backends, with intervals and reasons.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct PickReport {
    /// The version of the format.
    pub schema: u32,
    /// The names of the meshes.
    pub meshes: Vec<String>,
    /// The workload that was run.
    pub workload: Workload,
    /// The number of operations in one use of the mesh; the mean over the meshes.
    pub operations: f64,
    /// The capabilities that were required.
    pub needs: Vec<Need>,
    /// The maximum size of the structure that was allowed, in bytes.
    pub max_memory: Option<u64>,
    /// The backends that qualify, the fastest first; empty if no backend does.
    pub ranking: Vec<Ranked>,
    /// The other backends, with the reasons.
    #[serde(serialize_with = "by_name", deserialize_with = "from_names")]
    pub excluded: Vec<Excluded>,
    /// For each backend, the number of operations after which its building time is saved, compared
    /// with an indexed face set that exists already. Empty if the indexed face set did not take
    /// part.
    pub break_even: Vec<BreakEven>,
    /// The noise: the ratio, 1 or more, of the two times of a backend that was measured twice.
    pub noise: Option<f64>,
    /// Backends with other results than the rest for the same work: a fault in Sixfold.
    pub mismatches: Vec<String>,
    /// The fastest backend and the reasons, as sentences.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
    /// Possible faults of the measurement with remedies, as sentences.
    pub warnings: Vec<String>,
    /// Whether the measurement was stopped early, so that there are fewer samples.
    pub interrupted: bool,
    /// The costs of reading the clock.
    pub timer: Timer,
    /// The machine and the program version.
    pub environment: Environment,
    /// The results for each mesh if there are several; empty for one mesh.
    pub by_mesh: Vec<MeshRanking>,
}

/// The ranking on one of several meshes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct MeshRanking {
    /// The mesh.
    pub mesh: String,
    /// The ranking on this mesh, as in [`PickReport::ranking`].
    pub ranking: Vec<Ranked>,
    /// The break-even on this mesh, as in [`PickReport::break_even`].
    pub break_even: Vec<BreakEven>,
    /// The noise on this mesh, as in [`PickReport::noise`].
    pub noise: Option<f64>,
}

/// One backend in the ranking.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Ranked {
    /// The backend; `relation-tables` for flat tables of only the relations that the workload
    /// queries.
    pub backend: String,
    /// The structure from which the tables were made; `None` for a structure.
    #[serde(rename = "over")]
    pub made_from: Option<String>,
    /// The median, over rounds, of the time of one operation of the mix, rebuilding included, in
    /// nanoseconds.
    pub ns_per_operation: f64,
    /// The lower end of the 95 % interval of that time; `None` with fewer than three rounds.
    pub ns_ci_low: Option<f64>,
    /// The upper end of that interval.
    pub ns_ci_high: Option<f64>,
    /// The median, over rounds, of the time of this backend divided by the time of the fastest; 1
    /// for the fastest itself.
    pub ratio_to_best: f64,
    /// The lower end of the 95 % interval of that ratio.
    pub ci_low: Option<f64>,
    /// The upper end of that interval.
    pub ci_high: Option<f64>,
    /// Whether it is tied with the fastest: not measurably different from it.
    pub tied_with_best: bool,
    /// The time to build the backend from polygons, on pages that were freed before, in
    /// nanoseconds. For relation tables, this includes making the tables. Each rebuild takes this
    /// time.
    pub build_ns: f64,
    /// The time to build the backend on fresh pages, as in a program that builds it once. `None` if
    /// there was no time to measure it.
    #[serde(default)]
    pub first_build_ns: Option<f64>,
    /// The size of its tables, in bytes.
    pub bytes: usize,
    /// That size per vertex of the mesh.
    pub bytes_per_vertex: f64,
    /// Whether only a sample of the elements was queried, because a query scans all faces.
    pub sampled: bool,
    /// Whether the time of some part is an estimate, because a full run would exceed the budget.
    pub estimated: bool,
    /// The cost of each part of the mix, timed alone.
    pub parts: Vec<PartCost>,
    /// The number of rounds in which it was measured.
    pub samples: usize,
    /// The largest number of page faults in a sample; `None` if they were not counted.
    #[serde(default)]
    pub faults: Option<u64>,
    /// The packages to add as dependencies.
    pub crates: Vec<String>,
    /// The path of the type to use, for each package.
    #[serde(default)]
    pub types: Vec<String>,
}

/// The cost of one part of the mix on one backend.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct PartCost {
    /// The operation.
    pub operation: Action,
    /// Its share of all operations, from 0 to 1.
    pub share: f64,
    /// The time of one operation, timed alone in the access order of the workload, in nanoseconds;
    /// `None` if it was not measured.
    pub ns: Option<f64>,
}

impl Ranked {
    /// Returns the time of the first building: on fresh pages if measured, else [`Self::build_ns`].
    pub fn first_build_ns(&self) -> f64 {
        self.first_build_ns.unwrap_or(self.build_ns)
    }
}

impl PartCost {
    /// Returns the contribution of the part to the time of one operation of the mix, in
    /// nanoseconds.
    pub(crate) fn weighted_ns(&self) -> f64 {
        self.ns.unwrap_or(0.0) * self.share
    }
}

/// The number of operations after which building a backend has paid off.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct BreakEven {
    /// The backend.
    pub backend: String,
    /// The time to build it, in nanoseconds.
    pub build_ns: f64,
    /// The time that the backend saves per operation, compared with the indexed face set, in
    /// nanoseconds; negative if the backend is slower.
    pub saves_ns_per_operation: f64,
    /// The number of operations after which its building time is saved; `None` if never.
    pub operations: Option<f64>,
    /// The lower end of the 95 % interval of that number.
    pub ci_low: Option<f64>,
    /// The upper end of that interval; `None` if building may never pay off.
    pub ci_high: Option<f64>,
    /// The same number in uses of the mesh by this workload.
    pub uses: Option<f64>,
}

/// A backend that does not qualify.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excluded {
    /// The backend.
    pub backend: String,
    /// The reason.
    pub reason: String,
}

impl Excluded {
    pub(crate) fn new(backend: &str, reason: String) -> Self {
        Self {
            backend: backend.into(),
            reason,
        }
    }
}

/// Returns the reason why a backend of `bytes` bytes is excluded if at most `most` are allowed.
pub(crate) fn over_memory_limit(bytes: u64, most: u64) -> String {
    let [bytes, most] = [bytes, most].map(|bytes| grouped(bytes as usize));
    format!("it takes {bytes} bytes, but --max-memory allows only {most}")
}

impl PickReport {
    /// Writes the report as JSON.
    ///
    /// # Errors
    ///
    /// Returns the errors of `writer`.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// Serializes a map from names to reasons that keeps the order.
fn by_name<S: Serializer>(excluded: &[Excluded], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(excluded.iter().map(|e| (&e.backend, &e.reason)))
}

fn from_names<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Excluded>, D::Error> {
    let pairs: Vec<(String, String)> = Map::<Same, Same>::deserialize_as(deserializer)?;
    let excluded = pairs
        .into_iter()
        .map(|(backend, reason)| Excluded { backend, reason });
    Ok(excluded.collect())
}
