//! The sizes of a mesh.

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
