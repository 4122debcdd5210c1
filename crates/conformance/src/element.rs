//! One vertex, edge or face, identified by the numbers of the input.

use std::fmt;

use sixfold_core::{FaceId, VertexId};

/// An element of a mesh, identified by the numbers of the input instead of a structure's handle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Element {
    /// A vertex.
    Vertex(VertexId),
    /// An edge, given by its ends. The first end has the lower number; [`Element::edge`] sorts the
    /// ends.
    Edge(VertexId, VertexId),
    /// A face.
    Face(FaceId),
}

impl Element {
    /// Returns the edge between `a` and `b`; the order of `a` and `b` does not matter.
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
