//! The number of allocated bytes, as the program's allocator counts them.

use sixfold::{BuildError, MemoryFootprint, PolygonMesh, Representation};

/// The counters of an allocator. The program that installs such an allocator implements it.
pub trait Heap {
    /// Returns the bytes that are allocated now, as requested, without the allocator's overhead.
    fn live(&self) -> usize;
    /// Restarts the peak at the bytes that are allocated now.
    fn restart_peak(&self);
    /// Returns the maximum number of allocated bytes since the last restart, minus the bytes
    /// allocated at that restart.
    fn peak(&self) -> usize;
}

/// The memory of a structure: as counted by the allocator and as reported by the structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredMemory {
    /// Bytes of the structure: the allocator's count after building minus its count before.
    pub counted: usize,
    /// The maximum of this difference during building, including the structure.
    pub peak: usize,
    /// The tables, as the structure reports them.
    pub memory: MemoryFootprint,
    /// The number of input vertices that were merged with others.
    pub merged_vertices: usize,
}

/// Builds `M` once and measures its memory.
pub(crate) fn measure_memory<M: Representation>(
    polygons: &PolygonMesh,
    heap: &dyn Heap,
) -> Result<MeasuredMemory, BuildError> {
    let before = heap.live();
    heap.restart_peak();
    let mesh = M::from_polygons(polygons)?;
    // The counters are read first, because the list of tables below is also on the heap.
    let (live, peak) = (heap.live(), heap.peak());
    Ok(MeasuredMemory {
        counted: live.saturating_sub(before),
        peak,
        memory: mesh.memory(),
        merged_vertices: polygons.vertex_count().saturating_sub(mesh.vertex_count()),
    })
}
