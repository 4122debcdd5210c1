//! The part of the interface of a structure that only measurements use.

use crate::polygons::counts::Counts;
use crate::tables::probe::Probe;
use crate::traits::query::MeshQuery;
use crate::traits::representation::Representation;

/// A structure whose memory can be predicted and whose reads can be counted.
///
/// Only the measurements of Sixfold need this trait.
pub trait Measured: Representation {
    /// The type of the same structure in which a probe records every access to a table.
    type Probed<P: Probe>: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Returns the number of bytes that all tables need for a mesh of the given sizes, computed by
    /// formula.
    fn layout_bytes(counts: &Counts) -> usize;

    /// Returns the same mesh; `probe` records every access to a table.
    fn probed<P: Probe>(self, probe: P) -> Self::Probed<P>;
}
