//! Counters of the bytes that a program has allocated.

use sixfold::{BuildError, MemoryFootprint, PolygonMesh, Representation};

/// The counters of a memory allocator. The program that installs the allocator implements this
/// trait.
pub trait Heap {
    /// Returns the number of bytes that are allocated now, without the overhead of the allocator.
    fn live(&self) -> usize;
    /// Restarts the measurement of the peak of the allocated bytes. The new peak is measured from
    /// the number of bytes that are allocated now.
    fn restart_peak(&self);
    /// Returns the largest increase of the allocated bytes since the last call of
    /// [`restart_peak`](Self::restart_peak).
    fn peak(&self) -> usize;
}

/// The memory of a structure: as counted by the allocator, and as computed by the structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredMemory {
    /// Bytes of the structure, as the allocator counts them.
    pub counted: usize,
    /// Largest number of bytes that are allocated while the structure is built. The bytes of the
    /// structure are included.
    pub peak: usize,
    /// Bytes of the tables, as the structure computes them.
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
