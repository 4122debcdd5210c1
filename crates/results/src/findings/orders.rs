//! The times of one mesh with its elements in several orders.

use serde::{Deserialize, Serialize};

use crate::figure::{Figure, Rows};
use crate::finding::LabFinding;
use crate::launches::LaunchRows;
use crate::read::ReadError;
use crate::rows::{BackendReport, Control, MeshReport, Refusal, ResultRow, Samples, bytes_of};
use crate::run::Run;
use crate::timer::Timer;

/// Assumed error factor of a ratio without an interval.
const ASSUMED_ERROR: f64 = 1.5;

/// The results of one mesh with its elements in several orders.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct OrdersReport {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hashes of the mesh in its original order. In JSON, the finding has the
    /// place of the mesh in `meshes`.
    #[serde(skip)]
    pub mesh: MeshReport,
    /// The measured orders.
    pub orders: Vec<String>,
    /// The requested backends with their memory, built from the mesh in its original order.
    pub backends: Vec<BackendReport>,
    /// The measured times, sorted by operation, then by structure, then by order. The order is the
    /// `case`. `standing` and `ratio_to_best` compare it with the other orders on the structure.
    pub results: Vec<ResultRow>,
    /// Requested operations that a backend cannot do.
    pub refusals: Vec<Refusal>,
    /// The effects of the order and of the structure, for each operation.
    pub comparisons: Vec<Comparison>,
    /// The comparison of two measurements of one structure in the original order, which shows the
    /// noise. `None` if no structure was measured twice.
    pub control: Option<Control>,
    /// Sentences that describe the results.
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// The times of all samples, without the second measurement of the control.
    pub samples: Vec<Samples>,
    /// True if the measurement was stopped early.
    pub interrupted: bool,
    /// The resolution and the cost of reading the clock.
    pub timer: Timer,
}

impl OrdersReport {
    /// Iterates over the results of `operation`.
    pub fn rows(&self, operation: &str) -> impl Iterator<Item = &ResultRow> {
        let of_it = move |row: &&ResultRow| row.operation == operation;
        self.results.iter().filter(of_it)
    }

    /// Returns the rows of this launch, for [`pool_rows`](crate::launches::pool_rows()).
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
}

impl LabFinding for OrdersReport {
    fn figures(&self) -> Vec<Figure<'_>> {
        let bytes = |backend: &str| bytes_of(&self.backends, backend);
        self.all_rows().figures(Some(&self.mesh), bytes)
    }

    fn check(&self) -> Result<(), ReadError> {
        self.all_rows().check()
    }
}

/// The time of one measurement divided by the time of another measurement, with a confidence
/// interval.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct Factor {
    /// The quotient of the two times.
    pub ratio: f64,
    /// Lower end of the confidence interval of `ratio`; `None` with fewer than three rounds.
    pub ci_low: Option<f64>,
    /// Upper end of the confidence interval of `ratio`.
    pub ci_high: Option<f64>,
}

impl Factor {
    /// Returns whether the ratio is larger than the noise and its interval lies above 1.
    pub fn is_beyond(&self, noise: f64) -> bool {
        self.ratio > noise && self.low() > 1.0
    }

    /// Returns the lower end of the interval, or a guess without an interval.
    pub fn low(&self) -> f64 {
        self.ci_low.unwrap_or(self.ratio / ASSUMED_ERROR)
    }

    /// Returns the upper end of the interval, or a guess without an interval.
    pub fn high(&self) -> f64 {
        self.ci_high.unwrap_or(self.ratio * ASSUMED_ERROR)
    }
}

/// The effect of the element order on the time of one operation on one structure.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct OrderEffect {
    /// The name of the structure.
    pub backend: String,
    /// True if the operation scans all faces of the mesh for each element on this structure.
    pub scans: bool,
    /// The order with the smallest time.
    pub best: String,
    /// The order with the largest time.
    pub worst: String,
    /// Time in the order `worst` divided by the time in the order `best`.
    pub worst_to_best: Factor,
    /// Time in the original order of the mesh divided by the time in the order `best`. `None` if
    /// the original order was not measured.
    pub given_to_best: Option<Factor>,
    /// True if `worst_to_best` is larger than the noise, and the confidence interval of
    /// `worst_to_best` lies above 1.
    pub matters: bool,
}

/// The effect of the structure on the time of one operation. For each structure, the time in the
/// fastest order of this structure counts. Structures that scan all faces for each element are left
/// out.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct StructureEffect {
    /// The name of the structure with the smallest time.
    pub fastest: String,
    /// The order with the smallest time on the fastest structure.
    pub fastest_order: String,
    /// The name of the structure with the largest time.
    pub slowest: String,
    /// The order with the smallest time on the slowest structure.
    pub slowest_order: String,
    /// Time of the slowest structure divided by the time of the fastest structure.
    pub slowest_to_fastest: Factor,
    /// True if `slowest_to_fastest` is larger than the noise, and the confidence interval of
    /// `slowest_to_fastest` lies above 1.
    pub matters: bool,
}

/// Whether the element order or the structure has the larger effect on a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Larger {
    /// The order of the elements has a larger effect than the choice of the structure, for every
    /// structure that does not scan all faces.
    Order,
    /// The choice of the structure has a larger effect than the order of the elements, for every
    /// structure that does not scan all faces.
    Structure,
    /// The order has the larger effect only for some structures, or the confidence intervals
    /// overlap.
    Depends,
}

/// The effects of the element order and of the structure on the time of one operation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Comparison {
    /// The measured operation, such as `vertex_normal`.
    pub operation: String,
    /// Ratios of times up to this value count as noise.
    pub noise: f64,
    /// Effect of the order on each structure that was measured in at least two orders.
    pub orders: Vec<OrderEffect>,
    /// Effect of the structure; `None` if fewer than two structures do the operation without
    /// scanning all faces.
    pub structures: Option<StructureEffect>,
    /// The larger effect; `None` if an effect is unknown.
    pub larger: Option<Larger>,
}
