//! Errors of subdivision.

use sixfold_core::{BuildError, FaceId, Point, PolygonError, RefineError, VertexId};

use crate::scheme::{Method, Scheme};

/// The reason why a subdivision failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum SubdivisionError {
    /// A face has more than three corners, but the scheme splits only triangles.
    #[error(
        "face {face} has {degree} corners, and {scheme} splits only triangles: triangulate the mesh, or choose catmull-clark, doo-sabin or bilinear"
    )]
    NotATriangle {
        scheme: Scheme,
        face: FaceId,
        degree: usize,
    },
    /// There are creases, but the scheme has no rule for creases.
    #[error(
        "{scheme} has no rule for creases: remove the creases, or choose catmull-clark or loop"
    )]
    NoCreases { scheme: Scheme },
    /// The crate has no limit masks for this scheme.
    #[error("{scheme} has no limit masks: choose catmull-clark or loop, or use more levels")]
    NoLimit { scheme: Scheme },
    /// The scheme does not have this method.
    #[error("{scheme} has no {method} method: choose {choice}")]
    NoMethod {
        scheme: Scheme,
        method: Method,
        choice: &'static str,
    },
    /// The scheme has no rule for this edge.
    #[error("edge {0}–{1} has {faces} faces, but {scheme} needs one face, or two faces that run \
             along the edge in opposite directions: split the edge, or choose catmull-clark or \
             loop", .ends[0], .ends[1])]
    NonManifoldEdge {
        scheme: Scheme,
        ends: [VertexId; 2],
        faces: usize,
    },
    /// The scheme has no rule for this vertex.
    #[error(
        "the faces at vertex {vertex} are not one fan, but {scheme} needs one fan: duplicate the \
         vertex, or choose catmull-clark or loop"
    )]
    NonManifoldVertex { scheme: Scheme, vertex: VertexId },
    /// The structure cannot be refined.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// There are more elements than 32-bit handles can number.
    #[error(transparent)]
    Polygons(#[from] PolygonError),
    /// The structure cannot hold the refined mesh.
    #[error("{structure} cannot hold level {level}: {refusal}")]
    Build {
        structure: &'static str,
        level: u32,
        refusal: BuildError,
    },
}

/// The reason why points do not define a curve or a patch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum CurveError {
    /// A direction has too few points.
    #[error(
        "{given} points are too few, because ends of this kind need at least {least}: add points, \
         or keep the ends"
    )]
    TooFewPoints { given: usize, least: usize },
    /// There are more points than 32-bit handles can number.
    #[error(
        "{levels} levels of {given} points make too many points, because 32-bit handles allow at \
         most {limit}: refine fewer levels"
    )]
    TooManyPoints {
        given: usize,
        levels: u32,
        limit: usize,
    },
    /// The last row is incomplete.
    #[error("{given} points do not fill rows of {columns}: add or remove points")]
    RaggedGrid { given: usize, columns: usize },
}

/// The reason why a mesh cannot be refined locally.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum LocalError {
    /// A face has more than three corners, but local refinement needs triangles.
    #[error(
        "face {face} has {degree} corners, and local refinement needs triangles: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// A chosen face does not exist.
    #[error("face {face} does not exist: the mesh has {faces} faces, counted from 0")]
    MissingFace { face: FaceId, faces: usize },
    /// A box has NaN or swapped bounds.
    #[error("{min} to {max} is not a box: give the lower coordinates first")]
    BadBox { min: Point, max: Point },
    /// An angle is outside 0 to 180 degrees.
    #[error("{degrees} is not an angle between two faces: give degrees from 0 to 180")]
    BadAngle { degrees: f32 },
    /// An edge is so short that no coordinate lies between its ends.
    #[error("edge {0}–{1} is too short to be halved with 32-bit coordinates: refine fewer levels", .ends[0], .ends[1])]
    TooShort { ends: [VertexId; 2] },
    /// There are more elements than 32-bit handles can number.
    #[error(transparent)]
    Polygons(#[from] PolygonError),
    /// The structure cannot hold the mesh.
    #[error("{structure} cannot hold level {level}: {refusal}")]
    Build {
        structure: &'static str,
        level: u32,
        refusal: BuildError,
    },
}
