//! How much is allocated, as the program's allocator counts it.

use sixfold::{BuildError, MemoryFootprint, PolygonMesh, Representation};

/// The counters of an allocator; who installs one for the whole program implements it.
pub trait Heap {
    /// Bytes that are allocated now, as they were asked for: without what the allocator adds.
    fn live(&self) -> usize;
    /// Begins a new peak here.
    fn restart_peak(&self);
    /// By how much the bytes allocated at once have exceeded, at most, those at the last restart.
    fn peak(&self) -> usize;
}

/// What building a structure left on the heap, and what the structure says of that.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Weighed {
    /// Bytes that the allocator counts after building beyond those before: those of the structure.
    pub counted: usize,
    /// The most bytes beyond those before at any moment of building, the structure included.
    pub peak: usize,
    /// The tables of the structure, in its own words.
    pub memory: MemoryFootprint,
    /// How many vertices of the polygons are no vertices of their own here.
    pub merged_vertices: usize,
}

/// Builds `M` once, and weighs it.
pub(crate) fn weigh<M: Representation>(
    polygons: &PolygonMesh,
    heap: &dyn Heap,
) -> Result<Weighed, BuildError> {
    let before = heap.live();
    heap.restart_peak();
    let mesh = M::from_polygons(polygons)?;
    // Before anything else: a list of tables is on the heap as well.
    let (live, peak) = (heap.live(), heap.peak());
    Ok(Weighed {
        counted: live.saturating_sub(before),
        peak,
        memory: mesh.memory(),
        merged_vertices: polygons.vertex_count().saturating_sub(mesh.vertex_count()),
    })
}
