//! The growth of times with the size of the mesh.

use serde::{Deserialize, Serialize};

use super::slope::Slope;
use crate::environment::Cache;
use crate::figure::{Figure, Rows};
use crate::finding::LabFinding;
use crate::launches::LaunchRows;
use crate::read::ReadError;
use crate::rows::{BackendRefusal, Control, MeshReport, Refusal, ResultRow, Samples};
use crate::run::Run;
use crate::timer::Timer;

/// The results for one shape in several sizes.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct GrowthReport {
    /// How the finding was measured. In JSON, the finding has the place of the run in `runs`.
    #[serde(skip)]
    pub run: Run,
    /// The name, facts and hash of the mesh of each size, in the order of `sizes`. In JSON, the finding has the places of the meshes in
    /// `meshes`.
    #[serde(skip)]
    pub meshes: Vec<MeshReport>,
    /// Name of the shape.
    pub shape: String,
    /// Order of the elements in memory.
    pub order: String,
    /// The names of the measured backends.
    pub backends: Vec<String>,
    /// The backends that cannot hold the shape.
    pub refused_by: Vec<BackendRefusal>,
    /// The results at each measured size, beginning with the smallest size.
    pub sizes: Vec<SizeReport>,
    /// Approximate numbers of faces of the sizes that were left out because there was too little
    /// time.
    pub left_out: Vec<usize>,
    /// The fitted lines, sorted by operation, then by backend.
    pub fits: Vec<Fit>,
    /// The processor caches of this machine; empty if unknown.
    pub caches: Vec<Cache>,
    /// The number of faces at which each structure becomes larger than each cache. The list is
    /// sorted by cache, then by backend.
    pub cache_limits: Vec<CacheLimit>,
    /// Sentences that describe the results.
    pub sentences: Vec<String>,
    /// Sentences about possible faults of the measurement and their remedies.
    pub warnings: Vec<String>,
    /// True if the measurement was stopped early. Some sizes may then be missing.
    pub interrupted: bool,
    /// The resolution and the cost of reading the clock.
    pub timer: Timer,
}

/// The results at one size of the shape.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct SizeReport {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Size of each backend in bytes.
    pub backend_bytes: Vec<BackendBytes>,
    /// The times of each operation on each backend.
    pub results: Vec<ResultRow>,
    /// The times of all samples.
    pub samples: Vec<Samples>,
    /// Operations that a backend cannot do.
    pub refusals: Vec<Refusal>,
    /// The comparison of two measurements of one backend, which shows the noise. `None` if no
    /// backend was measured twice.
    pub control: Option<Control>,
}

impl SizeReport {
    /// Returns the rows of this launch, for [`pool_rows`](crate::launches::pool_rows()).
    pub fn launch_rows(&self) -> LaunchRows<'_> {
        LaunchRows {
            results: &self.results,
            refusals: &self.refusals,
            samples: &self.samples,
            control: self.control.as_ref(),
        }
    }
}

/// The size of a backend in bytes.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct BackendBytes {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// Allocated bytes, including spare capacity.
    pub bytes: usize,
    /// Smallest level of a cache that can hold these bytes; `None` if no known cache is large
    /// enough.
    pub fits_in: Option<u8>,
}

impl SizeReport {
    fn all_rows<'s>(&'s self, run: &'s Run) -> Rows<'s> {
        Rows {
            run,
            rows: self.launch_rows(),
        }
    }
}

impl LabFinding for GrowthReport {
    fn figures<'s>(&'s self) -> Vec<Figure<'s>> {
        let of_size = |(i, size): (usize, &'s SizeReport)| {
            let bytes = |name: &str| {
                let mut bytes = size.backend_bytes.iter();
                bytes.find(|bytes| bytes.backend == name).map(|b| b.bytes)
            };
            let mut figures = size.all_rows(&self.run).figures(self.meshes.get(i), bytes);
            for figure in &mut figures {
                figure.elements_of_mesh = [size.vertices, size.edges, size.faces];
                let faces = size.faces;
                figure.row.case = format!("{}, {}, {faces} faces", self.shape, self.order);
            }
            figures
        };
        self.sizes.iter().enumerate().flat_map(of_size).collect()
    }

    fn check(&self) -> Result<(), ReadError> {
        let [count, sizes] = [self.meshes.len(), self.sizes.len()];
        if count != sizes {
            return Err(ReadError::Malformed {
                cause: format!("a finding of the kind `growth` has {count} meshes, not {sizes}"),
            });
        }
        let mut sizes = self.sizes.iter();
        sizes.try_for_each(|size| size.all_rows(&self.run).check())
    }
}

/// How the time of one operation on one backend grows with the number of faces.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Fit {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// The measured operation, such as `vertex_normal`.
    pub operation: String,
    /// True if the operation scans all faces of the mesh for each element on this backend.
    pub scans: bool,
    /// The line fitted to the measured times at all sizes; `None` with fewer than two such sizes.
    /// An estimate is not on the line, because it assumes how the time grows.
    pub all: Option<Slope>,
    /// The line fitted to the times at the sizes for which the structure fits into the last-level
    /// cache. `None` if the structure fits at fewer than two sizes, or if the caches are unknown.
    pub in_cache: Option<Slope>,
    /// The line fitted to the times at the sizes for which the structure is larger than the
    /// last-level cache. `None` if the structure is larger than the cache at fewer than two sizes,
    /// or if the caches are unknown.
    pub beyond: Option<Slope>,
    /// Number of sizes at which the time is an estimate, and the line has no point.
    pub estimated: usize,
}

/// The number of faces at which a structure becomes larger than a cache.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct CacheLimit {
    /// The name of the backend, such as `half-edge`.
    pub backend: String,
    /// Level of the cache.
    pub level: u8,
    /// Size of the cache, in bytes.
    pub cache_bytes: u64,
    /// The smallest number of faces at which the structure is larger than the cache.
    pub faces: usize,
}
