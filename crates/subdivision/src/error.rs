//! Why a mesh cannot be subdivided.

use mesh_core::{BuildError, FaceId, Point, PolygonError, RefineError, VertexId};

use crate::scheme::{Method, Scheme};

/// Why a step, or a whole subdivision, cannot be done; nothing has changed then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum SubdivisionError {
    /// A polygon where the scheme splits triangles alone.
    #[error(
        "face {face} has {degree} corners, and {scheme} splits triangles alone: triangulate the mesh, or choose catmull-clark, doo-sabin or bilinear"
    )]
    NotATriangle {
        scheme: Scheme,
        face: FaceId,
        degree: usize,
    },
    /// Sharpness where the scheme has no rule for it.
    #[error("{scheme} has no rule for creases: leave them out, or choose catmull-clark or loop")]
    NoCreases { scheme: Scheme },
    /// A limit surface of which no masks are known here.
    #[error("{scheme} has no limit masks: choose catmull-clark or loop, or take more levels")]
    NoLimit { scheme: Scheme },
    /// A method that the scheme does not have.
    #[error("{scheme} has no {method} method: choose {choice}")]
    NoMethod {
        scheme: Scheme,
        method: Method,
        choice: &'static str,
    },
    /// An edge that the scheme has no rule for.
    #[error("edge {0}–{1} has {faces} faces, and {scheme} needs one or two that run along it in opposite directions: split it, or choose catmull-clark or loop", .ends[0], .ends[1])]
    NonManifoldEdge {
        scheme: Scheme,
        ends: [VertexId; 2],
        faces: usize,
    },
    /// A vertex that the scheme has no rule for.
    #[error(
        "the faces at vertex {vertex} are not one fan, and {scheme} needs one: double the vertex, or choose catmull-clark or loop"
    )]
    NonManifoldVertex { scheme: Scheme, vertex: VertexId },
    /// The structure cannot be refined.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// More elements than a handle can name.
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

/// Why a polygon or a control grid is no curve or patch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum CurveError {
    /// Too few points one way.
    #[error("{given} points, and these ends need at least {least}: add points, or keep the ends")]
    TooFewPoints { given: usize, least: usize },
    /// More points than a handle can name.
    #[error(
        "{levels} levels of {given} points make more than {limit}: refine fewer levels, handles are 32 bits"
    )]
    TooManyPoints {
        given: usize,
        levels: u32,
        limit: usize,
    },
    /// A last row that is not full.
    #[error("{given} points do not fill rows of {columns}: add or take away points")]
    RaggedGrid { given: usize, columns: usize },
}

/// Why a mesh cannot be refined here and there.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum LocalError {
    /// A polygon where triangles alone can be refined.
    #[error(
        "face {face} has {degree} corners, and triangles alone are refined here and there: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// A chosen face that is not there.
    #[error("face {face} is not there: the mesh has {faces}, counted from 0")]
    MissingFace { face: FaceId, faces: usize },
    /// A box that contains nothing.
    #[error("no box runs from {min} to {max}: give numbers, the lower ones first")]
    BadBox { min: Point, max: Point },
    /// An angle that no two faces make.
    #[error("{degrees} is no angle between two faces: give degrees from 0 to 180")]
    BadAngle { degrees: f32 },
    /// An edge without a number between its ends.
    #[error("edge {0}–{1} is too short to be halved, coordinates are 32 bits: refine fewer levels", .ends[0], .ends[1])]
    TooShort { ends: [VertexId; 2] },
    /// More elements than a handle can name.
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
