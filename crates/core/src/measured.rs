//! What measurements need from a structure, apart from the API for programs.

use crate::probe::Probe;
use crate::query::MeshQuery;
use crate::representation::Representation;

/// The sizes of a mesh that determine the memory of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// The number of vertices, isolated ones included.
    pub vertices: usize,
    /// The number of edges.
    pub edges: usize,
    /// The number of faces.
    pub faces: usize,
    /// The number of corners of all faces.
    pub corners: usize,
    /// Whether all faces have one degree.
    pub uniform: bool,
}

impl Counts {
    /// Returns the bytes of a table of face offsets, which only mixed degrees need.
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
/// Sixfold's studies need it; programs that use a mesh do not.
pub trait Measured: Representation {
    /// The same structure with every access to its tables reported to a probe.
    type Probed<P: Probe>: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Returns the bytes of the layout for a mesh of these sizes, by formula.
    fn layout_bytes(counts: &Counts) -> usize;

    /// Returns the same mesh with `probe` observing every table.
    fn probed<P: Probe>(self, probe: P) -> Self::Probed<P>;
}
