//! One vertex, edge or face, in the numbers of the input.

use std::fmt;

use mesh_core::{FaceId, VertexId};

/// An element of a mesh, named by the input's own numbers, whatever a structure calls it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Element {
    /// A vertex.
    Vertex(VertexId),
    /// An edge by its ends, the lower first; made by [`Element::edge`].
    Edge(VertexId, VertexId),
    /// A face.
    Face(FaceId),
}

impl Element {
    /// The edge between `a` and `b`, in whichever order they come.
    pub fn edge(a: VertexId, b: VertexId) -> Self {
        Self::Edge(a.min(b), a.max(b))
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => write!(f, "{v}"),
            Self::Edge(a, b) => write!(f, "{a}–{b}"),
            Self::Face(face) => write!(f, "{face}"),
        }
    }
}

impl fmt::Debug for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
