//! Errors of refused edits.

use std::fmt::Debug;

use crate::edit::edit_kind::Edit;

/// The reason why an edit was refused; the mesh is unchanged. The fields contain handles of the
/// structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum EditError<V: Debug, E: Debug, F: Debug> {
    /// An edit that the structure does not support.
    #[error("{structure} does not support {edit}: choose another structure")]
    Unsupported { structure: &'static str, edit: Edit },
    /// A handle of a vertex that does not exist.
    #[error(
        "vertex {vertex:?} does not exist: use a current handle of this mesh, because edits can \
         remove or rename handles"
    )]
    NoSuchVertex { vertex: V },
    /// A handle of an edge that does not exist.
    #[error(
        "edge {edge:?} does not exist: use a current handle of this mesh, because edits can \
         remove or rename handles"
    )]
    NoSuchEdge { edge: E },
    /// A handle of a face that does not exist.
    #[error(
        "face {face:?} does not exist: use a current handle of this mesh, because edits can \
         remove or rename handles"
    )]
    NoSuchFace { face: F },
    /// A position that another vertex has, in a structure that identifies vertices by coordinates.
    #[error(
        "vertex {vertex:?} already has this position, and this structure identifies vertices by \
         their coordinates: choose another position, or collapse the edge between the two vertices"
    )]
    Occupied { vertex: V },
    /// A face with fewer than three corners.
    #[error("a face of {corners} corners is not allowed: give at least three corners")]
    TooFewCorners { corners: usize },
    /// A face that is not a triangle, in a structure that holds only triangles.
    #[error(
        "a face of {corners} corners is not allowed, because the structure holds only triangles: \
         cut the polygon first"
    )]
    OnlyTriangles { corners: usize },
    /// A face that would have a vertex twice.
    #[error(
        "a face would have vertex {vertex:?} twice: choose other corners, or cut the face first"
    )]
    RepeatedVertex { vertex: V },
    /// A face that is not a triangle; the edit requires triangles.
    #[error(
        "face {face:?} has {degree} corners, and this edit requires triangles: cut the face first"
    )]
    NotATriangle { face: F, degree: usize },
    /// A side of a new face that another face already has in the same direction.
    #[error(
        "face {face:?} already has the side {from:?}→{to:?}: reverse the corners of the new face"
    )]
    RepeatedSide { from: V, to: V, face: F },
    /// An edge that already has two faces, in a structure without non-manifold edges.
    #[error(
        "edge {edge:?} already has two faces: remove one of the faces first, or choose a \
         structure that holds non-manifold edges"
    )]
    FullEdge { edge: E },
    /// A vertex whose faces would form more than one fan (chain of faces that share edges).
    #[error(
        "the faces at vertex {vertex:?} would form more than one fan: duplicate the vertex, or choose a structure that holds non-manifold vertices"
    )]
    SeveralFans { vertex: V },
    /// An edge that exists already.
    #[error("an edge between vertices {0:?} and {1:?} exists already, and the edit would make a \
             second one: choose another edge to flip, or other corners to \
             connect", .ends[0], .ends[1])]
    EdgeExists { ends: [V; 2] },
    /// An edge that does not have exactly two faces.
    #[error("edge {edge:?} has {faces} faces; an edge with exactly two is required")]
    NotTwoFaces { edge: E, faces: usize },
    /// Two faces that run along the edge in the same direction.
    #[error(
        "both faces of edge {edge:?} run along it in the same direction: reverse one of the faces \
         first"
    )]
    SameDirection { edge: E },
    /// Two triangles along an edge that have the same third corner.
    #[error(
        "both triangles of edge {edge:?} have the same third corner {vertex:?}: choose another edge"
    )]
    SameApex { edge: E, vertex: V },
    /// A vertex that would have only two edges after the flip.
    #[error(
        "vertex {vertex:?} has only three edges and three faces, and the flip would leave the \
         vertex with only two edges: choose another edge"
    )]
    LowValence { vertex: V },
    /// A vertex that is not an end of the edge.
    #[error("vertex {vertex:?} is not an end of edge {edge:?}: choose one of the two ends")]
    NotAnEnd { edge: E, vertex: V },
    /// A vertex that is not a corner of the face.
    #[error("vertex {vertex:?} is not a corner of face {face:?}: choose one of the corners")]
    NotACorner { face: F, vertex: V },
    /// Two corners of a face that are equal or adjacent.
    #[error("corners {0:?} and {1:?} of face {face:?} are equal or adjacent: choose two different \
             corners that are not adjacent", .ends[0], .ends[1])]
    AdjacentCorners { face: F, ends: [V; 2] },
    /// A vertex that would lose its last face.
    #[error("vertex {vertex:?} would lose its last face: remove the faces instead")]
    LastFace { vertex: V },
    /// A vertex adjacent to both ends that is not the third corner of a triangle along the edge.
    #[error(
        "vertex {vertex:?} is adjacent to both ends of edge {edge:?}, but is not a corner of a \
         triangle along the edge, so the collapse would fold the mesh: choose another edge"
    )]
    CommonNeighbour { edge: E, vertex: V },
    /// An inner edge between two boundary vertices.
    #[error(
        "both ends of inner edge {edge:?} are on the boundary, so the collapse would make a \
         non-manifold vertex: choose another edge"
    )]
    AcrossBoundary { edge: E },
    /// Two triangles that would have the same corners.
    #[error(
        "two triangles at edge {edge:?} would have the same corners, because the edge is part of \
         a tetrahedron: choose another edge"
    )]
    Pillow { edge: E },
    /// A vertex whose faces do not form one oriented fan.
    #[error(
        "the faces at vertex {vertex:?} do not form one oriented fan, so the vertex cannot be \
         split: choose another vertex"
    )]
    NoFan { vertex: V },
    /// A vertex that is not adjacent to the vertex to be split.
    #[error("vertex {side:?} is not adjacent to vertex {vertex:?}: choose an adjacent vertex")]
    NotANeighbour { vertex: V, side: V },
    /// The two neighbours given for the split of a vertex are equal, or both are missing.
    #[error(
        "splitting vertex {vertex:?} requires two different neighbours; on a boundary, one \
         neighbour is enough"
    )]
    BadNeighbours { vertex: V },
    /// Only one neighbour is given for the split of a vertex that is not on a boundary.
    #[error("vertex {vertex:?} is not on a boundary: give both neighbours")]
    NotOnBoundary { vertex: V },
    /// More elements of one kind than 32-bit handles can number.
    #[error(
        "more than {limit} {elements}: compact the mesh or split it, because handles have 32 bits"
    )]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
}

impl<V: Debug, E: Debug, F: Debug> EditError<V, E, F> {
    /// Returns the refusal with other handles, such as names of the elements.
    pub fn map_handles<V2: Debug, E2: Debug, F2: Debug>(
        self,
        of_vertex: impl Fn(V) -> V2,
        of_edge: impl Fn(E) -> E2,
        of_face: impl Fn(F) -> F2,
    ) -> EditError<V2, E2, F2> {
        use EditError::*;
        match self {
            Unsupported { structure, edit } => Unsupported { structure, edit },
            NoSuchVertex { vertex } => NoSuchVertex {
                vertex: of_vertex(vertex),
            },
            NoSuchEdge { edge } => NoSuchEdge {
                edge: of_edge(edge),
            },
            NoSuchFace { face } => NoSuchFace {
                face: of_face(face),
            },
            Occupied { vertex } => Occupied {
                vertex: of_vertex(vertex),
            },
            TooFewCorners { corners } => TooFewCorners { corners },
            OnlyTriangles { corners } => OnlyTriangles { corners },
            RepeatedVertex { vertex } => RepeatedVertex {
                vertex: of_vertex(vertex),
            },
            NotATriangle { face, degree } => NotATriangle {
                face: of_face(face),
                degree,
            },
            RepeatedSide { from, to, face } => RepeatedSide {
                from: of_vertex(from),
                to: of_vertex(to),
                face: of_face(face),
            },
            FullEdge { edge } => FullEdge {
                edge: of_edge(edge),
            },
            SeveralFans { vertex } => SeveralFans {
                vertex: of_vertex(vertex),
            },
            EdgeExists { ends } => EdgeExists {
                ends: ends.map(&of_vertex),
            },
            NotTwoFaces { edge, faces } => NotTwoFaces {
                edge: of_edge(edge),
                faces,
            },
            SameDirection { edge } => SameDirection {
                edge: of_edge(edge),
            },
            SameApex { edge, vertex } => SameApex {
                edge: of_edge(edge),
                vertex: of_vertex(vertex),
            },
            LowValence { vertex } => LowValence {
                vertex: of_vertex(vertex),
            },
            NotAnEnd { edge, vertex } => NotAnEnd {
                edge: of_edge(edge),
                vertex: of_vertex(vertex),
            },
            NotACorner { face, vertex } => NotACorner {
                face: of_face(face),
                vertex: of_vertex(vertex),
            },
            AdjacentCorners { face, ends } => AdjacentCorners {
                face: of_face(face),
                ends: ends.map(&of_vertex),
            },
            LastFace { vertex } => LastFace {
                vertex: of_vertex(vertex),
            },
            CommonNeighbour { edge, vertex } => CommonNeighbour {
                edge: of_edge(edge),
                vertex: of_vertex(vertex),
            },
            AcrossBoundary { edge } => AcrossBoundary {
                edge: of_edge(edge),
            },
            Pillow { edge } => Pillow {
                edge: of_edge(edge),
            },
            NoFan { vertex } => NoFan {
                vertex: of_vertex(vertex),
            },
            NotANeighbour { vertex, side } => NotANeighbour {
                vertex: of_vertex(vertex),
                side: of_vertex(side),
            },
            BadNeighbours { vertex } => BadNeighbours {
                vertex: of_vertex(vertex),
            },
            NotOnBoundary { vertex } => NotOnBoundary {
                vertex: of_vertex(vertex),
            },
            TooMany { elements, limit } => TooMany { elements, limit },
        }
    }
}
