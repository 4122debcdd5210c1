//! Why an edit is refused.

use std::fmt::Debug;

use crate::edit::Edit;

/// Why an edit was refused; nothing has changed then. Elements go by the names of the structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum EditError<V: Debug, E: Debug, F: Debug> {
    /// An edit that the structure never does.
    #[error("{structure} has no {edit}: its table of edits says so, choose another structure")]
    Unsupported { structure: &'static str, edit: Edit },
    /// A handle that names no vertex.
    #[error("there is no vertex {vertex:?}: it was removed, renamed, or never there")]
    NoSuchVertex { vertex: V },
    /// A handle that names no edge.
    #[error("there is no edge {edge:?}: it was removed, renamed, or never there")]
    NoSuchEdge { edge: E },
    /// A handle that names no face.
    #[error("there is no face {face:?}: it was removed, renamed, or never there")]
    NoSuchFace { face: F },
    /// A place that is another vertex, where a vertex is its coordinates.
    #[error(
        "vertex {vertex:?} is at that very place, and here a vertex is its coordinates: go elsewhere, or collapse the edge between the two"
    )]
    Occupied { vertex: V },
    /// A face with fewer than three corners.
    #[error("{corners} corners are no face: it takes three")]
    TooFewCorners { corners: usize },
    /// A face with other than three corners, where only triangles fit.
    #[error("{corners} corners are no triangle, and only triangles fit: cut the polygon first")]
    OnlyTriangles { corners: usize },
    /// A face that would name a vertex twice.
    #[error(
        "a face would have vertex {vertex:?} twice: choose other corners, or cut the face first"
    )]
    RepeatedVertex { vertex: V },
    /// A polygon where the edit is for triangles.
    #[error("face {face:?} has {degree} corners, and the edit is for triangles: cut it first")]
    NotATriangle { face: F, degree: usize },
    /// A side that a face runs already.
    #[error("face {face:?} runs {from:?}→{to:?} already: turn the new face over")]
    RepeatedSide { from: V, to: V, face: F },
    /// An edge whose two faces leave no room for a third.
    #[error(
        "edge {edge:?} has two faces already: remove one first, or choose a structure that holds non-manifold edges"
    )]
    FullEdge { edge: E },
    /// A vertex whose faces would be more than one fan.
    #[error(
        "the faces at vertex {vertex:?} would be several fans: double the vertex, or choose a structure that holds non-manifold vertices"
    )]
    SeveralFans { vertex: V },
    /// An edge that the edit would make a second time.
    #[error("there is an edge between {0:?} and {1:?} already", .ends[0], .ends[1])]
    EdgeExists { ends: [V; 2] },
    /// An edge that has not two faces: a boundary edge, or one with three or more.
    #[error("edge {edge:?} has not two faces, but {faces}")]
    NotTwoFaces { edge: E, faces: usize },
    /// Two faces that run the edge in the same direction.
    #[error("both faces of edge {edge:?} run it in the same direction: turn one over first")]
    SameDirection { edge: E },
    /// Two triangles along an edge with the same third corner.
    #[error("both triangles of edge {edge:?} have the third corner {vertex:?}")]
    SameApex { edge: E, vertex: V },
    /// An end that would keep too few edges.
    #[error("vertex {vertex:?} has three edges and three faces, and needs them")]
    LowValence { vertex: V },
    /// A vertex that is no end of the edge.
    #[error("vertex {vertex:?} is no end of edge {edge:?}")]
    NotAnEnd { edge: E, vertex: V },
    /// A vertex that is no corner of the face.
    #[error("vertex {vertex:?} is no corner of face {face:?}")]
    NotACorner { face: F, vertex: V },
    /// Two corners with no face to cut between them.
    #[error("{0:?} and {1:?} are one corner of face {face:?}, or beside each other there: nothing to cut off", .ends[0], .ends[1])]
    NothingBetween { face: F, ends: [V; 2] },
    /// A vertex that would lose its last face.
    #[error("vertex {vertex:?} would lose its last face: remove the faces themselves")]
    LastFace { vertex: V },
    /// A neighbour of both ends that is no third corner of a triangle along the edge.
    #[error(
        "vertex {vertex:?} is a neighbour of both ends of {edge:?}, but no triangle lies between: the collapse would fold the mesh"
    )]
    CommonNeighbour { edge: E, vertex: V },
    /// An inner edge between two boundary vertices.
    #[error(
        "both ends of inner edge {edge:?} are on the boundary: the collapse would pinch the mesh there"
    )]
    AcrossBoundary { edge: E },
    /// Two triangles that would have the same corners.
    #[error(
        "two triangles beside edge {edge:?} would have the same corners: it is part of a tetrahedron"
    )]
    Pillow { edge: E },
    /// A vertex whose faces are not one oriented fan.
    #[error(
        "the faces at vertex {vertex:?} are not one oriented fan, so they have no order to split"
    )]
    NoFan { vertex: V },
    /// A vertex that is no neighbour.
    #[error("vertex {side:?} is no neighbour of vertex {vertex:?}")]
    NotANeighbour { vertex: V, side: V },
    /// Sides that do not tell two parts apart.
    #[error("vertex {vertex:?} is split between two of its neighbours, or, on a boundary, at one")]
    NoSides { vertex: V },
    /// One side only, away from any boundary.
    #[error("vertex {vertex:?} is on no boundary: name both sides")]
    NotOnBoundary { vertex: V },
    /// More elements than a handle can name.
    #[error("more than {limit} {elements}: compact the mesh, or split it, handles are 32 bits")]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
}
