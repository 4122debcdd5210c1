//! The part of the interface of a structure that only measurements use.

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
    /// True if all faces have the same degree.
    pub uniform: bool,
}

impl Counts {
    /// Returns the size of the table of face offsets in bytes; 0 if all faces have the same degree.
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
