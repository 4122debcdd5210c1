//! The report of a pick, in the format that `reports/SCHEMA.md` documents.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::figure::{Figure, Status, samples_of};
use crate::finding::LabFinding;
use crate::numbers::{rounded_down, shown_ratio, times};
use crate::ranking::has_enough;
use crate::read::ReadError;
use crate::rows::{MeshReport, ResultRow, Samples, check_samples};
use crate::run::Run;
use crate::timer::Timer;

/// The name of the whole mix in samples and figures.
pub const MIX: &str = "mix";

/// The name of a run of a program in samples and figures.
pub const RUN: &str = "run";

/// The result of a pick: the backends, ranked by their times for a workload.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct PickReport {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The meshes. In JSON, the finding has the places of the meshes in `meshes`.
    #[serde(skip)]
    pub meshes: Vec<MeshReport>,
    /// The workload that was run.
    pub workload: WorkloadReport,
    /// The program of a user that was run in place of the workload; `None` for a workload. One
    /// operation is then one run of the program.
    pub program: Option<ProgramReport>,
    /// The number of operations that the program performs on one mesh, as a mean over the meshes.
    pub operations: f64,
    /// The capabilities that a backend must have.
    pub needs: Vec<Need>,
    /// The maximum size of a backend, in bytes; `None` for no limit.
    pub max_memory: Option<u64>,
    /// The backends that meet all requirements, the fastest backend first; those with a lower bound
    /// come last.
    pub ranking: Vec<Ranked>,
    /// The backend to use; `None` if no backend meets all requirements and was measured.
    pub choice: Option<Choice>,
    /// True if some times have too few samples for a confidence interval, because the time
    /// budget was too small.
    pub preliminary: bool,
    /// The backends that do not meet all requirements, each with the reason.
    pub excluded: Vec<Excluded>,
    /// For each backend, the number of operations after which the building time is saved. The
    /// comparison is with an indexed face set that is already built. The list is empty if the
    /// indexed face set was not measured.
    pub break_even: Vec<BreakEven>,
    /// The noise: one backend is measured twice, and the longer time is divided by the shorter
    /// time. `None` if no backend was measured twice.
    pub noise: Option<f64>,
    /// The time of the second measurement divided by the time of the first, in each launch. Empty if there are
    /// several meshes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub control_ratios: Vec<Option<f64>>,
    /// The names of the backends with wrong results. A wrong result is a fault in Sixfold.
    pub mismatches: Vec<String>,
    /// Sentences that name the fastest backend and explain the result.
    pub sentences: Vec<String>,
    /// How a program uses the chosen backend: the command that adds the package, then lines of Rust. Empty without a choice.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub usage: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// True if the measurement was stopped early. Backends may then have fewer samples.
    pub interrupted: bool,
    /// The cost of reading the clock.
    pub timer: Timer,
    /// The times of all samples; empty if there are several meshes.
    pub samples: Vec<Samples>,
    /// The results for each mesh; empty if there is only one mesh.
    pub by_mesh: Vec<MeshRanking>,
}

/// A workload: a mix of operations, with the order in which the elements are visited.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct WorkloadReport {
    /// The name of the workload.
    pub name: String,
    /// What the workload models.
    pub summary: String,
    /// The order in which the workload visits the elements, such as `random`.
    pub access: String,
    /// The number of operations for one mesh.
    pub operations: Amount,
    /// The number of times that the structure is built again.
    pub rebuilds: u64,
    /// The time that the program itself takes for one operation, in nanoseconds.
    pub own_ns: f64,
    /// The data of the program that are visited with each element.
    #[serde(default, skip_serializing_if = "OwnData::is_empty")]
    pub own_data: OwnData,
    /// The operations of the mix.
    pub mix: Vec<WorkloadPart>,
}

/// One operation of a mix, with its weight.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct WorkloadPart {
    /// The operation, such as `vertex_faces`.
    pub action: String,
    /// How often the operation runs, relative to the other operations of the mix.
    pub weight: Amount,
}

/// The data that a program keeps for each vertex, edge and face. They are read and written in the
/// access order of the workload, so that they share the caches with the structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct OwnData {
    /// The data of a vertex.
    #[serde(default)]
    pub vertex: OwnBytes,
    /// The data of an edge.
    #[serde(default)]
    pub edge: OwnBytes,
    /// The data of a face.
    #[serde(default)]
    pub face: OwnBytes,
}

/// The number of bytes that one visit of an element reads and writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct OwnBytes {
    /// Bytes that a visit reads.
    #[serde(default)]
    pub read: u32,
    /// Bytes that a visit writes.
    #[serde(default)]
    pub written: u32,
}

impl OwnData {
    /// Returns true if there are no data.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// A number of operations.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Amount {
    /// A fixed number.
    Number(f64),
    /// A number for each element of one kind, such as `2 per face`.
    PerElement(String),
}

/// A program of a user that was measured.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct ProgramReport {
    /// What the program does with the mesh: `queries`, `walks`, `moves`, `edits` or `refines`.
    pub kind: String,
    /// What one run asks of the first mesh, the most frequent first; `None` if no structure could
    /// record this.
    pub asked: Option<Vec<AskedCount>>,
}

/// How often a program asks one thing in one run.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct AskedCount {
    /// A relation such as `vertex_vertices`, an edit such as `flip_edge`, `position` for reading the
    /// position of a vertex, or `side_step` for a step from a side to another.
    pub operation: String,
    /// The number of times.
    pub count: u64,
}

/// The ranking on one of several meshes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct MeshRanking {
    /// The name of the mesh.
    pub mesh: String,
    /// The ranking on this mesh, as in [`PickReport::ranking`].
    pub ranking: Vec<Ranked>,
    /// The break-even of each backend on this mesh, as in [`PickReport::break_even`].
    pub break_even: Vec<BreakEven>,
    /// The noise on this mesh, as in [`PickReport::noise`].
    pub noise: Option<f64>,
    /// The ratios of the control on this mesh, as in [`PickReport::control_ratios`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub control_ratios: Vec<Option<f64>>,
    /// The number of operations that the program performs on this mesh.
    #[serde(default)]
    pub operations: f64,
    /// The times of all samples on this mesh.
    pub samples: Vec<Samples>,
}

/// The times and the memory of one backend in the ranking.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Ranked {
    /// The name of the backend. The backend `relation-tables` consists of flat tables of the
    /// relations that the workload queries.
    pub backend: String,
    /// The structure from which the relation tables were made; `None` if the backend is a
    /// structure.
    pub made_from: Option<String>,
    /// The median time of one operation of the workload, in nanoseconds. If the workload rebuilds
    /// the structure, this time includes a share of the rebuilding time.
    pub ns_per_operation: f64,
    /// The time in each launch, if there are several; `None` in a launch without a time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub launch_ns: Vec<Option<f64>>,
    /// The lower end of the confidence interval of `ns_per_operation`; `None` with fewer than
    /// two launches, or three rounds of the only launch.
    pub ns_ci_low: Option<f64>,
    /// The upper end of the confidence interval of `ns_per_operation`.
    pub ns_ci_high: Option<f64>,
    /// The time of this backend divided by the time of the fastest backend, as the median over the
    /// rounds. The fastest backend has the ratio 1.
    pub ratio_to_best: f64,
    /// The lower end of the confidence interval of `ratio_to_best`.
    pub ci_low: Option<f64>,
    /// The upper end of the confidence interval of `ratio_to_best`.
    pub ci_high: Option<f64>,
    /// True if the backend is not measurably slower than the fastest backend.
    pub tied_with_best: bool,
    /// The time to build the backend from polygons in memory pages that were used before, in
    /// nanoseconds. For relation tables, this time includes the computation of the tables.
    pub build_ns: f64,
    /// The value of `build_ns` in each launch, if there are several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub build_launch_ns: Vec<Option<f64>>,
    /// The time to build the backend in fresh memory pages, in nanoseconds. Use this time for a
    /// program that builds the backend only once. `None` if this time was not measured.
    pub first_build_ns: Option<f64>,
    /// The size of the tables, in bytes.
    pub bytes: usize,
    /// The size of the tables per vertex of the mesh, in bytes.
    pub bytes_per_vertex: f64,
    /// True if only some of the elements were queried, because a query scans all faces.
    pub sampled: bool,
    /// True if the time of some operation of the workload is an estimate, because a full run would
    /// exceed the time budget. `ns_per_operation` and `ratio_to_best` are then lower bounds, and the
    /// backend is not ranked before others or chosen.
    pub estimated: bool,
    /// The cost of each operation of the workload, timed alone.
    pub parts: Vec<PartCost>,
    /// The number of rounds in which the workload was timed on this backend.
    pub samples: usize,
    /// True if the time is that of a single run with cold caches, because there was no time for a round. In JSON, left out
    /// if it is false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub warm_up_only: bool,
    /// The largest number of page faults in a sample; `None` if page faults were not counted.
    pub faults: Option<u64>,
    /// The result of a run of a program; `None` for a workload.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<f64>,
    /// The number of elements that a run of a program visits; `None` for a workload.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<u64>,
    /// The Rust paths of the types that a program needs to use this backend: the structure, and relation tables made
    /// from it.
    pub types: Vec<String>,
    /// The relations of the tables. In JSON, left out for a structure.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tabulated: Vec<String>,
}

/// The cost of one operation of the workload on one backend.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct PartCost {
    /// The operation of the workload.
    pub operation: String,
    /// The share of this operation in all operations of the workload, from 0 to 1.
    pub share: f64,
    /// The time of this operation, timed alone in the access order of the workload, in nanoseconds.
    /// `None` if the operation was not timed alone.
    pub ns: Option<f64>,
    /// The value of `ns` in each launch, if there are several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub launch_ns: Vec<Option<f64>>,
    /// True if `ns` is an estimate, and so a lower bound.
    pub estimated: bool,
}

impl Ranked {
    /// Returns whether the time is from enough launches or samples to be ranked.
    pub fn has_enough_samples(&self) -> bool {
        has_enough(self.samples, &self.launch_ns)
    }

    /// Returns whether the whole interval of the ratio to the fastest lies within 5 % of 1.
    pub fn is_equal_to_best(&self) -> bool {
        let interval = self.ci_low.zip(self.ci_high);
        interval.is_some_and(|(low, high)| EQUAL_UP_TO.recip() <= low && high <= EQUAL_UP_TO)
    }

    /// Returns the quotient of the shown times of this backend and of `other`, for tables and
    /// sentences that show the times.
    pub fn shown_ratio(&self, other: &Self) -> f64 {
        shown_ratio(self.ns_per_operation, other.ns_per_operation)
    }

    /// Formats the quotient of [`Self::shown_ratio`]: `1.31 ×`, or `≥ 900 ×` for a lower bound.
    pub fn times(&self, other: &Self) -> String {
        let ratio = self.shown_ratio(other);
        match self.estimated {
            true => format!("≥ {}", times(rounded_down(ratio))),
            false => times(ratio),
        }
    }

    /// Orders by the ratio to the fastest, lower bounds last: the true time may be longer.
    pub fn measured_first(&self, other: &Self) -> Ordering {
        let by_ratio = self.ratio_to_best.total_cmp(&other.ratio_to_best);
        self.estimated.cmp(&other.estimated).then(by_ratio)
    }

    /// Returns the time to build in fresh memory pages. If this time was not measured, returns
    /// [`Self::build_ns`].
    pub fn first_build_ns(&self) -> f64 {
        self.first_build_ns.unwrap_or(self.build_ns)
    }
}

impl PartCost {
    /// Returns the time of this part in one operation of the mix, in nanoseconds.
    pub fn weighted_ns(&self) -> f64 {
        self.ns.unwrap_or(0.0) * self.share
    }
}

/// The number of operations after which the time to build a backend is saved, compared with an
/// indexed face set that is already built.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct BreakEven {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The time to build the backend, in nanoseconds.
    pub build_ns: f64,
    /// The time saved per operation, compared with the indexed face set, in nanoseconds. The value
    /// is negative if the backend is slower than the indexed face set.
    pub saves_ns_per_operation: f64,
    /// The number of operations after which the building time is saved; `None` if the building time
    /// is never saved.
    pub operations: Option<f64>,
    /// The lower end of the confidence interval of `operations`.
    pub ci_low: Option<f64>,
    /// The upper end of the confidence interval of `operations`; `None` if the building time
    /// may never be saved.
    pub ci_high: Option<f64>,
    /// The number of uses of a mesh after which the building time is saved: `operations` divided by
    /// the number of operations in one use.
    pub uses: Option<f64>,
}

/// A backend that does not meet the requirements of a pick.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct Excluded {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// Why the backend does not meet the requirements.
    pub reason: String,
    /// True if the program of a user fails on the backend: it panics, crashes or does not end, or has no result that can be
    /// compared. In JSON, left out if it is false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub failed: bool,
}

impl Excluded {
    /// Creates the exclusion of a backend that does not meet the requirements.
    pub fn new(backend: &str, reason: String) -> Self {
        Self {
            backend: backend.into(),
            reason,
            failed: false,
        }
    }

    /// Creates the exclusion of a backend on which the program of a user fails.
    pub fn failed(backend: &str, reason: String) -> Self {
        Self {
            failed: true,
            ..Self::new(backend, reason)
        }
    }
}

impl LabFinding for PickReport {
    fn mismatches(&self) -> usize {
        self.mismatches.len()
    }

    fn figures(&self) -> Vec<Figure<'_>> {
        let figures = self.on_meshes().into_iter().flat_map(|on_mesh| {
            let of_each = on_mesh.ranking.iter();
            of_each.flat_map(move |ranked| {
                let rows = self.rows_of(ranked).into_iter();
                rows.map(move |row| on_mesh.figure(ranked, row))
            })
        });
        figures.collect()
    }

    fn check(&self) -> Result<(), ReadError> {
        check_samples(&self.samples)?;
        let by_mesh = self.by_mesh.iter();
        by_mesh
            .map(|of_mesh| &of_mesh.samples)
            .try_for_each(|samples| check_samples(samples))
    }
}

/// The results of a pick on one of its meshes.
#[derive(Clone, Copy, Debug)]
pub struct OnMesh<'r> {
    /// The mesh.
    pub mesh: &'r MeshReport,
    /// The backends, the fastest first.
    pub ranking: &'r [Ranked],
    /// The times of all samples.
    pub samples: &'r [Samples],
    /// The ratio of the two measurements of one backend in each launch.
    pub control_ratios: &'r [Option<f64>],
    /// The number of operations that the program performs.
    pub operations: f64,
}

impl<'r> OnMesh<'r> {
    fn figure(&self, ranked: &'r Ranked, row: ResultRow) -> Figure<'r> {
        let samples = samples_of(self.samples, "", &row.operation, &row.backend);
        let count = samples.map_or(0, |samples| samples.rounds.len());
        let status = match (row.estimated_ns, row.sampled) {
            (Some(_), _) => Status::Estimated,
            (None, true) => Status::Sampled,
            (None, false) => Status::Measured,
        };
        let row = ResultRow {
            samples: row.samples.max(count),
            ..row
        };
        Figure {
            samples,
            ..Figure::new(Some(self.mesh), Some(ranked.bytes), status, row)
        }
    }
}

impl PickReport {
    /// Returns the name of what is timed: an operation of a workload, or a run of a program.
    pub fn unit(&self) -> &'static str {
        match self.program {
            Some(_) => "run",
            None => "operation",
        }
    }

    /// Returns the name of the operation that stands for the whole mix or run in figures and samples.
    pub fn whole(&self) -> &'static str {
        match self.program {
            Some(_) => RUN,
            None => MIX,
        }
    }

    /// Returns the backends on which the program of a user fails.
    pub fn failed(&self) -> impl Iterator<Item = &Excluded> {
        self.excluded.iter().filter(|excluded| excluded.failed)
    }

    /// Returns the results on each mesh.
    pub fn on_meshes(&self) -> Vec<OnMesh<'_>> {
        if let ([], [mesh]) = (&self.by_mesh[..], &self.meshes[..]) {
            return vec![OnMesh {
                mesh,
                ranking: &self.ranking,
                samples: &self.samples,
                control_ratios: &self.control_ratios,
                operations: self.operations,
            }];
        }
        let on_meshes = self.by_mesh.iter().filter_map(|of_mesh| {
            Some(OnMesh {
                mesh: self.meshes.iter().find(|mesh| mesh.name == of_mesh.mesh)?,
                ranking: &of_mesh.ranking,
                samples: &of_mesh.samples,
                control_ratios: &of_mesh.control_ratios,
                operations: of_mesh.operations,
            })
        });
        on_meshes.collect()
    }

    /// Returns the times of a backend as rows: of the mix, of its parts, and of building.
    pub fn rows_of(&self, ranked: &Ranked) -> Vec<ResultRow> {
        let unit = self.unit();
        let row =
            |operation: &str, unit: &str, ns: f64, estimated: bool, launches: &[Option<f64>]| {
                ResultRow {
                    case: self.workload.name.clone(),
                    backend: ranked.backend.clone(),
                    operation: operation.to_owned(),
                    median_ns: (!estimated).then_some(ns),
                    ns_per_element: (!estimated).then_some(ns),
                    launch_ns: launches.to_vec(),
                    estimated_ns: estimated.then_some(ns),
                    elements: Some(1),
                    per: unit.to_owned(),
                    sampled: ranked.sampled,
                    ..ResultRow::default()
                }
            };
        let whole = ranked.ns_per_operation;
        let mut rows = vec![ResultRow {
            ci_low_ns: ranked.ns_ci_low,
            ci_high_ns: ranked.ns_ci_high,
            ratio_to_best: (!ranked.estimated).then_some(ranked.ratio_to_best),
            ratio_ci_low: ranked.ci_low,
            ratio_ci_high: ranked.ci_high,
            faults: ranked.faults,
            samples: ranked.samples,
            warm_up_only: ranked.warm_up_only,
            ..row(
                self.whole(),
                unit,
                whole,
                ranked.estimated,
                &ranked.launch_ns,
            )
        }];
        rows.extend(ranked.parts.iter().filter_map(|part| {
            let (ns, launches) = (part.ns?, &part.launch_ns);
            Some(row(
                &part.operation,
                "operation",
                ns,
                part.estimated,
                launches,
            ))
        }));
        rows.push(row(
            "build",
            "mesh",
            ranked.build_ns,
            false,
            &ranked.build_launch_ns,
        ));
        rows
    }
}

/// Two backends count as equally fast if the ratio of their times is at most this value. Another
/// program, compiler or machine can change the ratio by 5 %.
pub const EQUAL_UP_TO: f64 = 1.05;

/// The backend that is recommended for the workload.
///
/// A backend of which only a lower bound of the time is known is never chosen. Backends are equally
/// fast if the interval of the ratio of their times contains 1, or if the times differ by at most 5 %. Among the backends that are as fast as the fastest backend, the choice is the
/// backend with the fewest bytes. If the bytes are equal, the choice is the first backend in this
/// order: polygon-soup, indexed-face-set, face-vertex, corner-table, half-edge, winged-edge,
/// others.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Choice {
    /// The name of the chosen backend.
    pub backend: String,
    /// The names of the other backends that are as fast as the fastest backend.
    pub equally_fast: Vec<String>,
    /// The smallest change of one weight in the workload after which a slower backend would be as
    /// fast as the chosen backend. `None` if the weight must change by a factor of more than 100.
    pub turning_point: Option<TurningPoint>,
}

/// A change of one weight in the workload after which another backend would be as fast as the
/// chosen backend. The change is computed from times of the single operations.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct TurningPoint {
    /// The operation whose weight in the workload grows.
    pub operation: String,
    /// The factor by which the weight of the operation grows.
    pub factor: f64,
    /// The name of the backend that would be as fast as the chosen backend after the change.
    pub backend: String,
}

sixfold_core::named! {
    /// A required capability of a structure.
    pub enum Need: "need" {
        /// The structure can be edited: its edges can be split, collapsed and flipped.
        Edit = "edit",
        /// The structure can hold edges with three or more faces, and vertices whose faces form
        /// several fans (groups of faces that are connected by edges).
        NonManifold = "non-manifold",
        /// The structure can hold faces with any number of corners.
        Polygons = "polygons",
        /// The structure can hold adjacent faces with different orientations, which run along the
        /// common edge in the same direction.
        MixedOrientation = "mixed-orientation",
        /// The structure can hold vertices without a face.
        IsolatedVertices = "isolated-vertices",
        /// The structure keeps vertices with equal coordinates separate.
        CoincidentVertices = "coincident-vertices",
        /// The structure can subdivide by splitting the elements in its own tables.
        Refine = "refine",
    }
}
