//! Predicts the size of a subdivision, and checks that enough memory is free.

use sixfold::subdivision::{Extent, Method, Subdivision};
use sixfold::{Point, PolygonMesh, VertexId};
use sixfold_core::{Counts, MAX_ROWS};
use sixfold_study::Backend;

use crate::failure::Failure;
use crate::free_memory::check_free_memory;
use sixfold_results::numbers::{bytes, counted};

/// Bytes per edge of the sums in a pass over the faces. Without rows for edges, the sums are in a
/// hash map.
const SUMS_BYTES: usize = 120;

/// Bytes per vertex while limits are computed.
const LIMIT_BYTES: usize = 128;

/// The sizes of all levels, and the peak memory of the subdivision.
pub(crate) struct Forecast {
    /// Counts of the control mesh and of each level.
    levels: Vec<Counts>,
    peak: usize,
    /// Vertices of the control mesh without faces.
    pub(crate) isolated_vertices: usize,
}

impl Forecast {
    pub(crate) fn new(
        subdivision: &Subdivision,
        method: Method,
        backend: &str,
        polygons: &PolygonMesh,
        levels: u32,
        limit: bool,
    ) -> Result<Self, Failure> {
        let mut extent = Extent::from_polygons(polygons);
        let isolated_vertices = extent.isolated_vertices;
        let mut counts = vec![extent.counts];
        for level in 0..levels {
            extent = subdivision.refined_extent(&extent, level);
            let Counts {
                vertices,
                edges,
                corners,
                ..
            } = extent.counts;
            let rows = [
                ("vertices", vertices),
                ("half-edges", edges.saturating_mul(2)),
                ("corners", corners),
            ];
            if let Some((elements, _)) = rows.iter().find(|(_, number)| *number > MAX_ROWS) {
                return Err(Failure::unsupported(format!(
                    "level {} of {levels} would have more than {MAX_ROWS} {elements}, but handles have 32 bits: take fewer levels, or split the mesh",
                    level + 1
                )));
            }
            counts.push(extent.counts);
        }
        let peaks = counts.windows(2).map(|pair| {
            let [old, new] = [&pair[0], &pair[1]];
            match method {
                // Two meshes, and the polygons of the result.
                Method::Native => {
                    structure_bytes(backend, old)
                        + structure_bytes(backend, new)
                        + polygon_bytes(new)
                }
                // The polygons of both levels, the structure, and data per handle.
                Method::Gather => {
                    polygon_bytes(old) + polygon_bytes(new) + 3 * structure_bytes(backend, old)
                }
                Method::Scatter => {
                    polygon_bytes(old)
                        + polygon_bytes(new)
                        + structure_bytes(backend, old)
                        + old.edges * SUMS_BYTES
                }
            }
        });
        let steps = peaks.max().unwrap_or_else(|| polygon_bytes(&counts[0]));
        let result = &counts[counts.len() - 1];
        let limits = match limit {
            true => {
                2 * polygon_bytes(result)
                    + structure_bytes("face-vertex", result)
                    + result.vertices * LIMIT_BYTES
            }
            false => 0,
        };
        Ok(Self {
            isolated_vertices,
            peak: steps.max(limits),
            levels: counts,
        })
    }

    /// Returns the total number of faces of all new levels.
    pub(crate) fn new_faces(&self) -> usize {
        self.levels.iter().skip(1).map(|counts| counts.faces).sum()
    }

    /// Describes the expected result in one line.
    pub(crate) fn describe(&self) -> String {
        let result = &self.levels[self.levels.len() - 1];
        format!(
            "result: {}, {}; needs about {} of memory",
            counted(result.vertices, "vertex", "vertices"),
            counted(result.faces, "face", "faces"),
            bytes(self.peak)
        )
    }

    /// Returns an error if the result needs more than the free memory. `force` turns the check off.
    pub(crate) fn check(&self, force: bool) -> Result<(), Failure> {
        let result = &self.levels[self.levels.len() - 1];
        let faces = counted(result.faces, "face", "faces");
        check_memory(&format!("a result of {faces}"), self.peak, force)
    }
}

/// Returns an error if `what` needs more than the free memory. `force` turns the check off.
pub(super) fn check_memory(what: &str, peak: usize, force: bool) -> Result<(), Failure> {
    match force {
        true => Ok(()),
        false => check_free_memory(
            what,
            peak as u64,
            "take fewer levels, or continue with --force",
        ),
    }
}

fn polygon_bytes(counts: &Counts) -> usize {
    let positions = counts.vertices.saturating_mul(size_of::<Point>());
    positions.saturating_add(counts.corners.saturating_mul(size_of::<VertexId>()))
}

fn structure_bytes(backend: &str, counts: &Counts) -> usize {
    let found = Backend::find(backend);
    found.map_or(0, |found| (found.layout_bytes)(counts))
}
