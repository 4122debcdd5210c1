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

/// The ranking of the backends.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct PickReport {
    /// The version of the format.
    pub schema: u32,
    /// The names of the meshes.
    pub meshes: Vec<String>,
    /// The workload that was run.
    pub workload: Workload,
    /// The number of operations in one use of the mesh, as the mean over the meshes.
    pub operations: f64,
    /// The capabilities that were required.
    pub needs: Vec<Need>,
    /// The maximum size of the structure, in bytes.
    pub max_memory: Option<u64>,
    /// The backends that qualify, the fastest first.
    pub ranking: Vec<Ranked>,
    /// The backends that do not qualify.
    #[serde(serialize_with = "by_name", deserialize_with = "from_names")]
    pub excluded: Vec<Excluded>,
    /// The number of operations after which building each backend pays off. The comparison is with
    /// an existing indexed face set. The list is empty if the indexed face set was not measured.
    pub break_even: Vec<BreakEven>,
    /// The noise: the ratio of the two times of a backend that was measured twice. At least 1.
    pub noise: Option<f64>,
    /// Backends with wrong results. This is a fault in Sixfold.
    pub mismatches: Vec<String>,
    /// Sentences about the fastest backend and the reasons.
    #[serde(rename = "words")]
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// Whether the measurement was stopped early. There are then fewer samples.
    pub interrupted: bool,
    /// The cost of reading the clock.
    pub timer: Timer,
    /// The machine and the program version.
    pub environment: Environment,
    /// The results for each mesh; empty if there is only one mesh.
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
    /// The name of the backend. `relation-tables` are flat tables of the relations that the
    /// workload queries.
    pub backend: String,
    /// The structure from which relation tables were made; `None` for a structure.
    #[serde(rename = "over")]
    pub made_from: Option<String>,
    /// The median time of one operation of the mix, in nanoseconds. It includes rebuilding.
    pub ns_per_operation: f64,
    /// The lower end of the 95 % interval of `ns_per_operation`; `None` with fewer than three
    /// rounds.
    pub ns_ci_low: Option<f64>,
    /// The upper end of the 95 % interval of `ns_per_operation`.
    pub ns_ci_high: Option<f64>,
    /// The median ratio to the fastest backend, over the rounds. The fastest backend has ratio 1.
    pub ratio_to_best: f64,
    /// The lower end of the 95 % interval of `ratio_to_best`.
    pub ci_low: Option<f64>,
    /// The upper end of the 95 % interval of `ratio_to_best`.
    pub ci_high: Option<f64>,
    /// Whether the backend is not measurably slower than the fastest backend.
    pub tied_with_best: bool,
    /// The time to build the backend from polygons on reused pages, in nanoseconds. For relation
    /// tables, it includes making the tables.
    pub build_ns: f64,
    /// The time to build the backend on fresh pages, in nanoseconds. A program that builds the
    /// backend once needs this time. `None` if there was no time to measure it.
    #[serde(default)]
    pub first_build_ns: Option<f64>,
    /// The size of the tables, in bytes.
    pub bytes: usize,
    /// The size of the tables per vertex of the mesh, in bytes.
    pub bytes_per_vertex: f64,
    /// Whether only some elements were queried, because a query scans all faces.
    pub sampled: bool,
    /// Whether the time of a part is an estimate, because a full run would exceed the budget.
    pub estimated: bool,
    /// The cost of each part of the mix, timed alone.
    pub parts: Vec<PartCost>,
    /// The number of rounds with a sample of this backend.
    pub samples: usize,
    /// The largest number of page faults in a sample; `None` if they were not counted.
    #[serde(default)]
    pub faults: Option<u64>,
    /// The packages to add as dependencies.
    pub crates: Vec<String>,
    /// The paths of the types to use.
    #[serde(default)]
    pub types: Vec<String>,
}

/// The cost of one part of the mix on one backend.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct PartCost {
    /// The operation.
    pub operation: Action,
    /// The share of this operation in all operations, from 0 to 1.
    pub share: f64,
    /// The time of one operation, timed alone in the access order of the workload, in nanoseconds.
    /// `None` if it was not measured.
    pub ns: Option<f64>,
}

impl Ranked {
    /// Returns the time to build on fresh pages if it was measured, else [`Self::build_ns`].
    pub fn first_build_ns(&self) -> f64 {
        self.first_build_ns.unwrap_or(self.build_ns)
    }
}

impl PartCost {
    /// Returns the time of this part in one operation of the mix, in nanoseconds.
    pub(crate) fn weighted_ns(&self) -> f64 {
        self.ns.unwrap_or(0.0) * self.share
    }
}

/// The number of operations after which building a backend pays off.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct BreakEven {
    /// The backend.
    pub backend: String,
    /// The time to build the backend, in nanoseconds.
    pub build_ns: f64,
    /// The time saved per operation, compared with the indexed face set, in nanoseconds. Negative
    /// if the backend is slower.
    pub saves_ns_per_operation: f64,
    /// The number of operations after which building pays off; `None` if never.
    pub operations: Option<f64>,
    /// The lower end of the 95 % interval of `operations`.
    pub ci_low: Option<f64>,
    /// The upper end of the 95 % interval of `operations`; `None` if building may never pay off.
    pub ci_high: Option<f64>,
    /// The number of uses of the mesh after which building pays off.
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

/// Serializes a map from names to reasons in the order of the list.
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
