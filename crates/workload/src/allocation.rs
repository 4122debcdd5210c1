//! The bytes that an operation allocates, and the bytes of its result.

use sixfold::PolygonMesh;
use sixfold::subdivision::Method;
use sixfold_core::Counts;

use crate::backend::Backend;
use crate::operation::edit_pass::counts_after;
use crate::subdivision_job::SubdivisionJob;
use sixfold_measure::{Clock, Operation, Series};
use sixfold_results::Time;

/// A counter of all bytes that a program requests from its allocator. The program that installs the
/// allocator implements this trait.
pub trait AllocationCounter: Sync {
    /// Returns the number of bytes that were requested since the program started. If a block is
    /// enlarged, only the additional bytes are counted. The bytes of freed blocks are not
    /// subtracted.
    fn allocated(&self) -> usize;
}

/// The bytes that one run of an operation allocates, and the bytes of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allocated {
    /// Bytes that the timed part of the operation requests from the allocator.
    pub bytes: usize,
    /// Bytes of the result of the operation, computed by a formula from the numbers of elements.
    pub result_bytes: usize,
}

/// The reason why the bytes of an operation were not counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotCounted {
    /// The structure or the subdivision scheme refuses the operation. The field is the error
    /// message.
    Refused(String),
    /// The operation would take too long, because the structure scans all faces for each element
    /// and the mesh is large.
    Scans,
    /// The operation would take too long, because it visits all neighbours of elements, and some
    /// elements have very many.
    Crowded,
}

/// Size limit for meshes, in faces. Operations that scan all faces for each element are not run on
/// larger meshes than this limit, or if the faces have more than four times as many corners.
pub const MAX_SCANNED_FACES: usize = 2_000;

/// Limits for [`visits`]: of a mesh with few edges, and for each edge of a larger mesh.
const MAX_VISITS: usize = 20_000_000;
const MAX_VISITS_PER_EDGE: usize = 100;

/// A clock that returns allocated bytes instead of time. Set-up is excluded.
struct ByteClock<'a>(&'a dyn AllocationCounter);

impl Clock for ByteClock<'_> {
    fn now(&self) -> Time {
        Time::from_wall_ns(self.0.allocated() as f64)
    }
}

/// Returns the number of visits if each corner visits the other corners of its face, and the other faces at
/// its vertex.
fn visits(polygons: &PolygonMesh) -> usize {
    let mut faces = vec![0_usize; polygons.vertex_count()];
    for v in polygons.faces().corners() {
        faces[v.index()] += 1;
    }
    let degrees = polygons.faces().iter().map(|(_, face)| face.len());
    let squares = faces
        .into_iter()
        .chain(degrees)
        .map(|n| n.saturating_mul(n));
    squares.fold(0, usize::saturating_add)
}

impl Backend {
    /// Runs `operation` once and counts the bytes that the timed part of the operation requests
    /// from the allocator. `edges` is the number of edges of `polygons`.
    ///
    /// The bytes of the result are also returned. The result of each operation is:
    ///
    /// - `build`: the structure
    /// - subdivision: the structure of the refined mesh
    /// - edits: the mesh after the edits
    /// - `ff_bfs`: the depth of each face
    ///
    /// For a native subdivision, the first run is counted, because later runs reuse the tables of
    /// the first run.
    ///
    /// # Errors
    ///
    /// Returns an error with the reason if the operation cannot be counted.
    pub fn allocated(
        &self,
        operation: Operation,
        polygons: &PolygonMesh,
        edges: usize,
        counter: &dyn AllocationCounter,
    ) -> Result<Allocated, NotCounted> {
        let limit = MAX_VISITS.max(MAX_VISITS_PER_EDGE.saturating_mul(edges));
        if operation != Operation::Build && visits(polygons) > limit {
            return Err(NotCounted::Crowded);
        }
        let method = SubdivisionJob::of(operation).map(|job| job.way.method());
        let is_native = method == Some(Method::Native);
        let scans = operation.scans(&self.info.costs).contains(&true);
        let is_large = polygons.face_count() > MAX_SCANNED_FACES
            || polygons.corner_count() > 4 * MAX_SCANNED_FACES;
        if scans && !is_native && is_large {
            return Err(NotCounted::Scans);
        }
        let bytes = self.allocated_by_run(operation, polygons, counter);
        let counts = polygons.counts(edges);
        Ok(Allocated {
            bytes: bytes.map_err(NotCounted::Refused)?,
            result_bytes: self.result_bytes(operation, polygons, &counts),
        })
    }

    fn allocated_by_run(
        &self,
        operation: Operation,
        polygons: &PolygonMesh,
        counter: &dyn AllocationCounter,
    ) -> Result<usize, String> {
        let prepared = self.prepare(polygons, None);
        let (mut backend, _) = prepared.map_err(|refusal| refusal.to_string())?;
        let run = backend.run(&operation.into(), &Series::once(&ByteClock(counter)));
        match run.refusal {
            Some(refusal) => Err(refusal),
            None => Ok(run.time.wall_ns as usize),
        }
    }

    fn result_bytes(&self, operation: Operation, polygons: &PolygonMesh, counts: &Counts) -> usize {
        if let Some(bytes) = operation.result_bytes(counts) {
            return bytes;
        }
        let counts = match operation {
            Operation::EditPass(pass) => counts_after(pass, self, polygons, counts),
            _ => match SubdivisionJob::of(operation).map(|job| job.subdivision.split(0)) {
                Some(Some(split)) => split.refined_counts(counts, 0),
                _ => *counts,
            },
        };
        (self.layout_bytes)(&counts)
    }
}
