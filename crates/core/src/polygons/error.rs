//! Errors of face lists, construction, moves, refinement, creases and invariants.

use crate::handles::row_id::{FaceId, VertexId};
use crate::traits::split::Split;

/// The reason why a list of faces is not a [`PolygonMesh`](crate::PolygonMesh).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum PolygonError {
    /// A face names a vertex that does not exist.
    #[error(
        "face {face} names vertex {vertex}, but there are {vertices} vertices: correct the index"
    )]
    VertexOutOfRange {
        face: FaceId,
        vertex: VertexId,
        vertices: usize,
    },
    /// A face with fewer than three corners.
    #[error("face {face} has {corners} corners, and a polygon has at least three: remove the face")]
    TooFewCorners { face: FaceId, corners: usize },
    /// A face names one vertex twice.
    #[error(
        "face {face} names vertex {vertex} twice: remove the face, or split the face at this vertex"
    )]
    RepeatedVertex { face: FaceId, vertex: VertexId },
    /// More elements of one kind than 32-bit handles can number.
    #[error("more than {limit} {elements}: split the mesh, because handles have 32 bits")]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
}

/// The reason why a structure cannot hold a polygon mesh.
///
/// Only the first fault is reported. The checks have a fixed order: faces that are not triangles,
/// number of elements, edges with three or more faces, orientation, vertices with several fans,
/// isolated vertices, coincident corners. Each check reports its first fault: faces and vertices
/// are ordered by number, and edges are ordered by their lower end, then by their higher end.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum BuildError {
    /// More elements of one kind than 32-bit handles can number.
    #[error("more than {limit} {elements}: split the mesh, because handles have 32 bits")]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
    /// A face that is not a triangle, in a structure that holds only triangles.
    #[error("face {face} has {degree} corners, and only triangles fit: triangulate the mesh")]
    NotATriangle { face: FaceId, degree: usize },
    /// Three or more faces along one edge.
    #[error("edge {0}–{1} has {count} faces ({faces}): give all but two of them vertices of their own, or choose a \
             structure that holds non-manifold edges",
        .vertices[0], .vertices[1], count = .faces.len(), faces = format_faces(.faces))]
    NonManifoldEdge {
        vertices: [VertexId; 2],
        faces: Vec<FaceId>,
    },
    /// Two faces run along one edge in the same direction.
    #[error(
        "faces {first} and {second} both run {from}→{to}: reverse one of them if its neighbours then agree, or give \
         it vertices of its own"
    )]
    RepeatedSide {
        from: VertexId,
        to: VertexId,
        first: FaceId,
        second: FaceId,
    },
    /// The faces at a vertex form more than one fan (chain of faces that share edges).
    #[error(
        "faces {first} and {second} meet at vertex {vertex}, but are not connected by edges at \
         this vertex: duplicate the vertex"
    )]
    NonManifoldVertex {
        vertex: VertexId,
        first: FaceId,
        second: FaceId,
    },
    /// A vertex without a face.
    #[error("vertex {vertex} has no face (isolated vertices: {count}): remove them")]
    IsolatedVertex { vertex: VertexId, count: usize },
    /// Two corners of a face with the same position, in a structure that identifies vertices by
    /// coordinates.
    #[error("corners {0} and {1} of face {face} have the same coordinates: remove the face, or move a vertex", .vertices[0], .vertices[1])]
    CoincidentCorners {
        face: FaceId,
        vertices: [VertexId; 2],
    },
}

impl BuildError {
    /// Returns the first face that the error names, if it names one.
    pub fn first_face(&self) -> Option<FaceId> {
        match self {
            Self::TooMany { .. } | Self::IsolatedVertex { .. } => None,
            Self::NotATriangle { face, .. } | Self::CoincidentCorners { face, .. } => Some(*face),
            Self::NonManifoldEdge { faces, .. } => faces.first().copied(),
            Self::RepeatedSide { first, .. } | Self::NonManifoldVertex { first, .. } => {
                Some(*first)
            }
        }
    }
}

/// The reason why vertices cannot be moved; every vertex keeps its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum MoveError {
    /// Two corners of a face with the same position, in a structure that identifies vertices by
    /// coordinates.
    #[error(
        "two corners of face {face} would be at one point, and this structure identifies vertices \
         by their coordinates: keep the corners apart, or choose another structure"
    )]
    CoincidentCorners { face: FaceId },
    /// The number of positions in the map differs from the number of vertices.
    #[error("{given} positions for {vertices} vertices: the map belongs to another mesh")]
    OtherMesh { given: usize, vertices: usize },
}

/// The reason why a structure cannot split its faces; the mesh is unchanged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RefineError {
    /// A split that the structure does not support.
    #[error(
        "{structure} cannot split its own tables into {split}: build the structure from the \
         refined polygons, or choose another structure"
    )]
    Unsupported {
        structure: &'static str,
        split: Split,
    },
    /// A face that is not a triangle; the split requires triangles.
    #[error(
        "face {face} has {degree} corners, and this split requires triangles: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// Two triangles that share two edges. The split would create two edges with the same ends.
    #[error(
        "faces {first} and {second} share two edges, so the refined mesh would have two edges with the same ends: cut one of the two faces first, or choose a structure that holds edges with more than two faces"
    )]
    DoubleEdge { first: FaceId, second: FaceId },
    /// More elements of one kind than 32-bit handles can number.
    #[error(
        "the refined mesh would have {number} {elements}, but 32-bit handles allow at most {limit}: refine fewer levels, or split the mesh"
    )]
    TooMany {
        elements: &'static str,
        number: usize,
        limit: usize,
    },
}

/// The reason why creases do not fit a mesh. The field `entry` is the position of the faulty entry
/// in the list of edges or of vertices, counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CreaseError {
    /// A vertex that does not exist.
    #[error("vertex {vertex} does not exist: the mesh has {vertices} vertices, counted from 0")]
    MissingVertex {
        entry: usize,
        vertex: u32,
        vertices: usize,
    },
    /// Two vertices that are not adjacent corners of a face.
    #[error("{0} and {1} are not the ends of an edge: name two vertices that follow each other in a face", .ends[0], .ends[1])]
    NotAnEdge { entry: usize, ends: [VertexId; 2] },
    /// A sharpness that is negative or NaN.
    #[error("sharpness {sharpness} is not a number from 0 to inf: write it like 2, 0.5 or inf")]
    BadSharpness { entry: usize, sharpness: f32 },
}

/// Lists `faces`, at most eight of them.
fn format_faces(faces: &[FaceId]) -> String {
    let shown: Vec<String> = faces.iter().take(8).map(ToString::to_string).collect();
    let more = if faces.len() > 8 { ", …" } else { "" };
    shown.join(", ") + more
}

/// The error of `validate()`: a numbered invariant of a structure does not hold. The cause is a bug
/// in the structure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{invariant} fails: {detail}")]
pub struct InvariantError {
    /// The number of the invariant in the structure's documentation (`"I3"`).
    pub invariant: &'static str,
    /// A description of the fault, with the element that has the fault.
    pub detail: String,
}

impl InvariantError {
    /// Builds the error from the number of the invariant and a description of the fault.
    pub fn new(invariant: &'static str, detail: impl Into<String>) -> Self {
        Self {
            invariant,
            detail: detail.into(),
        }
    }
}
