//! Errors of refused edits.

use std::fmt::Debug;

use crate::edit_kind::Edit;

/// The reason why an edit was refused; the mesh is unchanged. Elements are given by the handles of
/// the structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum EditError<V: Debug, E: Debug, F: Debug> {
    /// An edit that the structure does not support.
    #[error("{structure} does not support {edit}: choose another structure")]
    Unsupported { structure: &'static str, edit: Edit },
    /// A handle of a vertex that does not exist.
    #[error("vertex {vertex:?} does not exist: it was removed, renamed, or never part of the mesh")]
    NoSuchVertex { vertex: V },
    /// A handle of an edge that does not exist.
    #[error("edge {edge:?} does not exist: it was removed, renamed, or never part of the mesh")]
    NoSuchEdge { edge: E },
    /// A handle of a face that does not exist.
    #[error("face {face:?} does not exist: it was removed, renamed, or never part of the mesh")]
    NoSuchFace { face: F },
    /// A position that another vertex has, in a structure that identifies vertices by coordinates.
    #[error(
        "vertex {vertex:?} has the same position, and in this structure a vertex is its coordinates: choose another position, or collapse the edge between the two"
    )]
    Occupied { vertex: V },
    /// A face with fewer than three corners.
    #[error("a face of {corners} corners: at least three are required")]
    TooFewCorners { corners: usize },
    /// A face that is not a triangle, in a structure that holds only triangles.
    #[error("a face of {corners} corners: only triangles are allowed, cut the polygon first")]
    OnlyTriangles { corners: usize },
    /// A face that would have a vertex twice.
    #[error(
        "a face would have vertex {vertex:?} twice: choose other corners, or cut the face first"
    )]
    RepeatedVertex { vertex: V },
    /// A polygon, for an edit of triangles.
    #[error("face {face:?} has {degree} corners, and this edit requires triangles: cut it first")]
    NotATriangle { face: F, degree: usize },
    /// A side that a face already runs along in the same direction.
    #[error("face {face:?} already runs {from:?}→{to:?}: flip the new face")]
    RepeatedSide { from: V, to: V, face: F },
    /// An edge with two faces, in a structure that allows no third.
    #[error(
        "edge {edge:?} already has two faces: remove one first, or choose a structure that holds non-manifold edges"
    )]
    FullEdge { edge: E },
    /// A vertex whose faces would form more than one fan.
    #[error(
        "the faces at vertex {vertex:?} would form more than one fan: duplicate the vertex, or choose a structure that holds non-manifold vertices"
    )]
    SeveralFans { vertex: V },
    /// An edge that exists already.
    #[error("vertices {0:?} and {1:?} already have an edge", .ends[0], .ends[1])]
    EdgeExists { ends: [V; 2] },
    /// An edge that does not have exactly two faces.
    #[error("edge {edge:?} has {faces} faces; an edge with exactly two is required")]
    NotTwoFaces { edge: E, faces: usize },
    /// Two faces that run along the edge in the same direction.
    #[error("both faces of edge {edge:?} run along it in the same direction: flip one first")]
    SameDirection { edge: E },
    /// Two triangles along an edge with the same third corner.
    #[error(
        "both triangles of edge {edge:?} have the same third corner {vertex:?}: choose another edge"
    )]
    SameApex { edge: E, vertex: V },
    /// An end of a flipped edge that would keep too few edges.
    #[error(
        "vertex {vertex:?} has only three edges and three faces: the flip would leave it only two edges"
    )]
    LowValence { vertex: V },
    /// A vertex that is not an end of the edge.
    #[error("vertex {vertex:?} is not an end of edge {edge:?}")]
    NotAnEnd { edge: E, vertex: V },
    /// A vertex that is not a corner of the face.
    #[error("vertex {vertex:?} is not a corner of face {face:?}")]
    NotACorner { face: F, vertex: V },
    /// Two corners of a face that are equal or adjacent.
    #[error("{0:?} and {1:?} are equal or adjacent corners of face {face:?}: choose two that are neither", .ends[0], .ends[1])]
    AdjacentCorners { face: F, ends: [V; 2] },
    /// A vertex that would lose its last face.
    #[error("vertex {vertex:?} would lose its last face: remove the faces instead")]
    LastFace { vertex: V },
    /// A vertex adjacent to both ends that is not the third corner of a triangle along the edge.
    #[error(
        "vertex {vertex:?} is adjacent to both ends of {edge:?}, but not in a triangle along it: the collapse would fold the mesh"
    )]
    CommonNeighbour { edge: E, vertex: V },
    /// An inner edge between two boundary vertices.
    #[error(
        "both ends of inner edge {edge:?} are on the boundary: the collapse would make a non-manifold vertex"
    )]
    AcrossBoundary { edge: E },
    /// Two triangles that would have the same corners.
    #[error(
        "two triangles at edge {edge:?} would have the same corners: the edge is part of a tetrahedron"
    )]
    Pillow { edge: E },
    /// A vertex whose faces do not form one oriented fan.
    #[error(
        "the faces at vertex {vertex:?} are not one oriented fan, so they have no order for a split"
    )]
    NoFan { vertex: V },
    /// A vertex that is not adjacent to the vertex to be split.
    #[error("vertex {side:?} is not adjacent to vertex {vertex:?}")]
    NotANeighbour { vertex: V, side: V },
    /// Neighbours that are equal or both missing, for the split of a vertex.
    #[error("splitting vertex {vertex:?} requires two different neighbours, or one on a boundary")]
    BadNeighbours { vertex: V },
    /// Only one neighbour, for a vertex that is not on a boundary.
    #[error("vertex {vertex:?} is not on a boundary: give both neighbours")]
    NotOnBoundary { vertex: V },
    /// More elements than a handle can name.
    #[error(
        "more than {limit} {elements}: compact the mesh or split it, because handles have 32 bits"
    )]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
}
