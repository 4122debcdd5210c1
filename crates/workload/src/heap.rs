//! The number of allocated bytes.

use sixfold::{BuildError, MemoryFootprint, PolygonMesh, Representation};

/// The counters of an allocator. The program that installs the allocator implements it.
pub trait Heap {
    /// Returns the bytes that are allocated now, without the overhead of the allocator.
    fn live(&self) -> usize;
    /// Restarts the peak at the bytes that are allocated now.
    fn restart_peak(&self);
    /// Returns the peak of allocated bytes since the last restart, minus the bytes at the restart.
    fn peak(&self) -> usize;
}

/// The memory of a structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredMemory {
    /// Bytes of the structure, as counted by the allocator.
    pub counted: usize,
    /// Peak memory while the structure is built, in bytes. It includes the structure.
    pub peak: usize,
    /// The tables, as the structure reports them.
    pub memory: MemoryFootprint,
    /// Number of input vertices that were merged with other vertices.
    pub merged_vertices: usize,
}

pub(crate) fn measure_memory<M: Representation>(
    polygons: &PolygonMesh,
    heap: &dyn Heap,
) -> Result<MeasuredMemory, BuildError> {
    let before = heap.live();
    heap.restart_peak();
    let mesh = M::from_polygons(polygons)?;
    // Read the counters first, because the list of tables below is also on the heap.
    let (live, peak) = (heap.live(), heap.peak());
    Ok(MeasuredMemory {
        counted: live.saturating_sub(before),
        peak,
        memory: mesh.memory(),
        merged_vertices: polygons.vertex_count().saturating_sub(mesh.vertex_count()),
    })
}
