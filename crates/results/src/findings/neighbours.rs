//! The times of spatial indices on one mesh.

use serde::{Deserialize, Serialize};

use super::spatial_task::QueryPoints;
use crate::figure::{Figure, Rows};
use crate::finding::LabFinding;
use crate::launches::LaunchRows;
use crate::read::ReadError;
use crate::rows::{Control, MeshReport, ResultRow, Samples};
use crate::run::Run;
use crate::timer::Timer;

/// The times of spatial indices on one mesh.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct NeighboursReport {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hashes of the mesh. In JSON, the finding has the place of the mesh in
    /// `meshes`.
    #[serde(skip)]
    pub mesh: MeshReport,
    /// Where the query points are.
    pub points: QueryPoints,
    /// The number of query points.
    pub queries: usize,
    /// The radius of `vertices_within`, in units of the coordinates.
    pub radius: f64,
    /// The indices and their sizes.
    pub backends: Vec<IndexReport>,
    /// The measured times, sorted by task, then by index.
    pub results: Vec<ResultRow>,
    /// For each kind of query, which index takes the least time in total.
    pub cheapest: Vec<CheapestIndices>,
    /// The difference between the two measurements of one index; `None` if no index was measured twice.
    pub control: Option<Control>,
    /// Sentences that describe the results.
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// The times of all samples, including the second measurement of the control.
    pub samples: Vec<Samples>,
    /// True if the measurement was stopped early.
    pub interrupted: bool,
    /// The resolution and the cost of reading the clock.
    pub timer: Timer,
}

/// The size of an index.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct IndexReport {
    /// The name of the index, such as `bvh`.
    pub name: String,
    /// The bytes of the index of the vertices and the index of the triangles, together.
    pub bytes: usize,
}

/// The indices that take the least time for one kind of query, building included.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct CheapestIndices {
    /// The kind of query.
    pub operation: String,
    /// Ranges of the number of queries, in ascending order.
    pub ranges: Vec<Cheapest>,
}

impl NeighboursReport {
    /// Iterates over the results of `task`.
    pub fn rows(&self, task: &str) -> impl Iterator<Item = &ResultRow> {
        self.results.iter().filter(move |row| row.operation == task)
    }

    /// Returns the rows of this launch, for [`pool_rows`](crate::launches::pool_rows()).
    pub fn launch_rows(&self) -> LaunchRows<'_> {
        LaunchRows {
            results: &self.results,
            refusals: &[],
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

impl LabFinding for NeighboursReport {
    fn figures(&self) -> Vec<Figure<'_>> {
        let bytes = |name: &str| {
            let mut backends = self.backends.iter();
            backends.find(|index| index.name == name).map(|i| i.bytes)
        };
        let mesh = Some(&self.mesh);
        let mut figures = self.all_rows().figures(mesh, bytes);
        for figure in &mut figures {
            figure.row.case = self.points.name().into();
        }
        figures
    }

    fn check(&self) -> Result<(), ReadError> {
        self.all_rows().check()
    }
}

/// The cheapest index for a range of numbers of queries.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Cheapest {
    /// The smallest number of queries of the range; at least 1. The range ends before the start of
    /// the next range.
    pub from: u64,
    /// The name of the index, such as `bvh`.
    pub index: String,
}
