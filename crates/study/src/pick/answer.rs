//! The answer, in the shape that `reports/SCHEMA.md` documents.

use std::io;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_with::{DeserializeAs, Map, Same};
use workload::{Action, Workload};

use crate::environment::Environment;
use crate::numbers::grouped;
use crate::pick::needs::Need;
use crate::report::write_json;
use crate::timer::Timer;

/// Which backend, how sure, and why.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Answer {
    /// The version of the shape.
    pub schema: u32,
    /// The meshes that it is for.
    pub meshes: Vec<String>,
    /// The workload that was run.
    pub workload: Workload,
    /// How many operations one use of the mesh comes to; the mean over the meshes.
    pub operations: f64,
    /// What the structure had to be able to do.
    pub needs: Vec<Need>,
    /// How many bytes it might hold.
    pub max_memory: Option<u64>,
    /// The backends that qualify, the fastest first; empty where none does.
    pub ranking: Vec<Ranked>,
    /// The others, and why.
    #[serde(serialize_with = "by_name", deserialize_with = "from_names")]
    pub excluded: Vec<Excluded>,
    /// After how many operations each pays for being built, beside an indexed face set that is there
    /// already; empty where that did not take part.
    pub break_even: Vec<BreakEven>,
    /// The difference between two entries of one backend, as a ratio of 1 or more: the noise.
    pub noise: Option<f64>,
    /// Backends that found something else than the others for the same work: a fault in Sixfold.
    pub mismatches: Vec<String>,
    /// The answer and its reasons, in words.
    pub words: Vec<String>,
    /// What may be wrong with it, and what helps, in words.
    pub warnings: Vec<String>,
    /// Told to stop before the end: it rests on fewer samples.
    pub interrupted: bool,
    /// What the clock and the engine cost.
    pub timer: Timer,
    /// The machine and the program.
    pub environment: Environment,
    /// Mesh by mesh, where there are several; each in the shape of this whole, without what is common.
    pub by_mesh: Vec<OnMesh>,
}

/// The answer for one of several meshes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct OnMesh {
    /// The mesh.
    pub mesh: String,
    /// As in the whole.
    pub ranking: Vec<Ranked>,
    /// As in the whole.
    pub break_even: Vec<BreakEven>,
    /// As in the whole.
    pub noise: Option<f64>,
}

/// One backend that qualifies.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Ranked {
    /// The backend; `relation-tables` for flat tables of just the relations that the workload asks.
    pub backend: String,
    /// The structure that the tables were made of.
    pub over: Option<String>,
    /// The median over the rounds, rebuilding included, in nanoseconds of one operation of the mix.
    pub ns_per_operation: f64,
    /// The lower end of its 95 % interval; `None` below three rounds.
    pub ns_ci_low: Option<f64>,
    /// Its upper end.
    pub ns_ci_high: Option<f64>,
    /// The median, over rounds, of its time by that of the fastest; 1 for the fastest itself.
    pub ratio_to_best: f64,
    /// The lower end of the 95 % interval of that ratio.
    pub ci_low: Option<f64>,
    /// Its upper end.
    pub ci_high: Option<f64>,
    /// Nobody can tell it from the fastest.
    pub tied_with_best: bool,
    /// What building it from polygons takes, tabulating included, where freed pages are there to be used
    /// again: what each rebuilding costs.
    pub build_ns: f64,
    /// The same on fresh pages: what a program pays that builds it once. `None` where there was no time.
    #[serde(default)]
    pub first_build_ns: Option<f64>,
    /// The bytes it holds.
    pub bytes: usize,
    /// The same for each vertex.
    pub bytes_per_vertex: f64,
    /// A sample of elements stands for all, for it looks at all faces to answer.
    pub sampled: bool,
    /// Some part was not run in full, for that would outlast the budget: its time is an estimate.
    pub estimated: bool,
    /// What each part of the mix costs by itself.
    pub parts: Vec<PartCost>,
    /// How many rounds it took part in.
    pub samples: usize,
    /// The most page faults in any sample; `None` where they were not counted.
    #[serde(default)]
    pub faults: Option<u64>,
    /// The crates to depend on.
    pub crates: Vec<String>,
}

/// One part of the mix on one backend.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct PartCost {
    /// What is done.
    pub operation: Action,
    /// What part of all operations it is.
    pub share: f64,
    /// What one takes by itself, in the order of the workload; `None` where nothing was measured.
    pub ns: Option<f64>,
}

impl Ranked {
    /// What the first building takes: on fresh pages, where that is known.
    pub fn first_build_ns(&self) -> f64 {
        self.first_build_ns.unwrap_or(self.build_ns)
    }
}

impl PartCost {
    /// What it adds to an operation of the mix.
    pub(crate) fn weighed(&self) -> f64 {
        self.ns.unwrap_or(0.0) * self.share
    }
}

/// From when on a backend pays.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct BreakEven {
    /// The backend.
    pub backend: String,
    /// What building it takes.
    pub build_ns: f64,
    /// How much less an operation takes than on the indexed face set; negative where it takes more.
    pub saves_ns_per_operation: f64,
    /// After so many operations it has paid for its building; `None` if never.
    pub operations: Option<f64>,
    /// The lower end of the 95 % interval of that number.
    pub ci_low: Option<f64>,
    /// Its upper end; `None` where it may be never.
    pub ci_high: Option<f64>,
    /// The same in uses of the mesh by this workload.
    pub uses: Option<f64>,
}

/// A backend that does not qualify.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excluded {
    /// The backend.
    pub backend: String,
    /// Why.
    pub reason: String,
}

impl Excluded {
    pub(crate) fn of(backend: &str, reason: String) -> Self {
        Self {
            backend: backend.into(),
            reason,
        }
    }
}

/// That so many bytes are too many.
pub(crate) fn too_heavy(bytes: u64, most: u64) -> String {
    let [bytes, most] = [bytes, most].map(|bytes| grouped(bytes as usize));
    format!("it takes {bytes} bytes, and --max-memory allows {most}")
}

impl Answer {
    /// Writes the answer as JSON.
    ///
    /// # Errors
    ///
    /// What `writer` reports.
    pub fn write_json(&self, writer: impl io::Write) -> io::Result<()> {
        write_json(self, writer)
    }
}

/// As a map from names to reasons that keeps the order.
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
