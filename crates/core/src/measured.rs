//! The part of a structure's API that only measurements use.

use crate::probe::Probe;
use crate::query::MeshQuery;
use crate::representation::Representation;

/// The sizes of a mesh that determine the memory of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// The number of vertices, including isolated vertices.
    pub vertices: usize,
    /// The number of edges.
    pub edges: usize,
    /// The number of faces.
    pub faces: usize,
    /// The number of corners of all faces.
    pub corners: usize,
    /// Whether all faces have the same degree.
    pub uniform: bool,
}

impl Counts {
    /// Returns the bytes of the table of face offsets; 0 if all faces have the same degree.
    pub const fn offset_bytes(&self) -> usize {
        if self.uniform {
            0
        } else {
            4 * (self.faces + 1)
        }
    }
}

/// A structure whose memory can be predicted and whose reads can be counted.
///
/// Sixfold's studies need this trait; programs that use a mesh do not.
pub trait Measured: Representation {
    /// The same structure, in which every access to a table is reported to a probe.
    type Probed<P: Probe>: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Returns the bytes of the layout for a mesh of these sizes, computed by formula.
    fn layout_bytes(counts: &Counts) -> usize;

    /// Returns the same mesh; `probe` records every access to a table.
    fn probed<P: Probe>(self, probe: P) -> Self::Probed<P>;
}
