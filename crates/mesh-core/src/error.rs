//! What can be wrong with a face list, and what a structure refuses.

use crate::refine::Split;
use crate::row_id::{FaceId, VertexId};

/// Why a list of faces is no [`PolygonMesh`](crate::PolygonMesh).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum PolygonError {
    /// A face names a vertex that is not there.
    #[error("face {face} names vertex {vertex}, but there are {vertices} vertices: mend the index")]
    VertexOutOfRange {
        face: FaceId,
        vertex: VertexId,
        vertices: usize,
    },
    /// A face with fewer than three corners.
    #[error("face {face} has {corners} corners, and a polygon has at least three: leave it out")]
    TooFewCorners { face: FaceId, corners: usize },
    /// A face names one vertex twice.
    #[error("face {face} names vertex {vertex} twice: leave it out, or split it there")]
    RepeatedVertex { face: FaceId, vertex: VertexId },
    /// More elements than a handle can name.
    #[error("more than {limit} {elements}: split the mesh, handles are 32 bits")]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
}

/// Why a structure cannot hold a polygon mesh.
///
/// Which fault is reported first is fixed: size, then degree, then edges with three faces, then
/// orientation, then vertices, then isolated vertices, then coincident corners; of each the lowest
/// element.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum BuildError {
    /// More elements than a handle can name.
    #[error("more than {limit} {elements}: split the mesh, handles are 32 bits")]
    TooMany {
        elements: &'static str,
        limit: usize,
    },
    /// A polygon where only triangles fit.
    #[error("face {face} has {degree} corners, and only triangles fit: triangulate the mesh")]
    NotATriangle { face: FaceId, degree: usize },
    /// Three or more faces along one edge.
    #[error("edge {0}–{1} has {count} faces ({faces}): split it, or choose a structure that holds non-manifold edges",
        .vertices[0], .vertices[1], count = .faces.len(), faces = names(.faces))]
    NonManifoldEdge {
        vertices: [VertexId; 2],
        faces: Vec<FaceId>,
    },
    /// Two faces run along one edge in the same direction.
    #[error("faces {first} and {second} both run {from}→{to}: turn one over, or split the edge")]
    RepeatedSide {
        from: VertexId,
        to: VertexId,
        first: FaceId,
        second: FaceId,
    },
    /// The faces at a vertex form more than one fan.
    #[error(
        "faces {first} and {second} meet at vertex {vertex} but not along edges there: double the vertex"
    )]
    NonManifoldVertex {
        vertex: VertexId,
        first: FaceId,
        second: FaceId,
    },
    /// A vertex without a face.
    #[error("vertex {vertex} is in no face, one of {count}: remove isolated vertices")]
    IsolatedVertex { vertex: VertexId, count: usize },
    /// Two corners of one face at one point, where a vertex is its coordinates.
    #[error("corners {0} and {1} of face {face} share their coordinates: leave the face out, or move a vertex", .vertices[0], .vertices[1])]
    CoincidentCorners {
        face: FaceId,
        vertices: [VertexId; 2],
    },
}

/// Why vertices cannot be moved; nothing has moved then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum MoveError {
    /// Two corners of one face at one point, where a vertex is its coordinates.
    #[error(
        "two corners of face {face} would come to one point, and here a vertex is its coordinates: keep them apart, or choose a structure that shares vertices"
    )]
    CoincidentCorners { face: FaceId },
    /// Positions for another number of vertices.
    #[error("{given} positions for {vertices} vertices: the map is of another mesh")]
    OtherMesh { given: usize, vertices: usize },
}

/// Why a structure cannot refine itself; nothing has changed then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RefineError {
    /// A split that is none of the structure's.
    #[error(
        "{structure} cannot split its own tables into {split}: build it from the refined polygons, or choose another structure"
    )]
    Unsupported {
        structure: &'static str,
        split: Split,
    },
    /// A polygon where only triangles can be split.
    #[error(
        "face {face} has {degree} corners, and only triangles can be split so: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// Two triangles with two edges in common, whose midpoints or face points the split would join twice.
    #[error(
        "faces {first} and {second} share two edges, so the refined mesh would have two edges with the same ends: cut one of the two faces first, or choose a structure that holds edges with more than two faces"
    )]
    DoubleEdge { first: FaceId, second: FaceId },
    /// More elements than a handle can name.
    #[error(
        "the refined mesh would have {number} {elements}, and handles are 32 bits, for at most {limit}: refine fewer levels, or split the mesh"
    )]
    TooMany {
        elements: &'static str,
        number: usize,
        limit: usize,
    },
}

/// Why sharpness cannot be that of a mesh; `entry` counts the edges, or the vertices, as given, from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CreaseError {
    /// A vertex that is not there.
    #[error("vertex {vertex} is not there: the mesh has {vertices}, counted from 0")]
    MissingVertex {
        entry: usize,
        vertex: u32,
        vertices: usize,
    },
    /// Two vertices that no face has beside each other.
    #[error("{0} and {1} are the ends of no edge: name two vertices that follow each other in a face", .ends[0], .ends[1])]
    NotAnEdge { entry: usize, ends: [VertexId; 2] },
    /// A sharpness below 0 or NaN.
    #[error("sharpness {sharpness} is no number from 0 to inf")]
    BadSharpness { entry: usize, sharpness: f32 },
}

/// The names of `faces`, at most eight of them.
fn names(faces: &[FaceId]) -> String {
    let shown: Vec<String> = faces.iter().take(8).map(ToString::to_string).collect();
    let more = if faces.len() > 8 { ", …" } else { "" };
    shown.join(", ") + more
}

/// Which invariant of a structure fails, and where: a bug of ours, found by `validate()`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{invariant} fails: {detail}")]
pub struct InvariantError {
    /// The number of the invariant in the structure's documentation (`"I3"`).
    pub invariant: &'static str,
    /// The element and what is wrong with it.
    pub detail: String,
}

impl InvariantError {
    /// `invariant` fails as `detail` says.
    pub fn new(invariant: &'static str, detail: impl Into<String>) -> Self {
        Self {
            invariant,
            detail: detail.into(),
        }
    }
}
