//! Why an operator refuses a mesh, or its options.
//!
//! A vertex is named by its place in `vertices()` and a face by its place in `faces()`, in every
//! structure: these are their names in `to_polygons()` too.

use mesh_core::{BuildError, FaceId, VertexId};

/// Why a mesh cannot be smoothed as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum SmoothingError {
    /// A polygon where angles are opposite to edges in triangles only.
    #[error(
        "face {face} has {degree} corners, and cotangent weights need triangles: triangulate the mesh, or choose uniform weights"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// A step outside 0 to 1.
    #[error("a step of {step} is not between 0 and 1: beyond 1 a vertex jumps over its neighbours")]
    Step { step: f64 },
    /// A step back that is no longer than the step, or so long that roughness would grow.
    #[error(
        "a step back of {back} against a step of {step}: it must be negative, longer than the step, and (1 − 2·step)·(1 − 2·back) between −1 and 1"
    )]
    StepBack { step: f64, back: f64 },
}

/// Why a mesh has no dual.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum DualError {
    /// A vertex without a face.
    #[error("vertex {vertex} is in no face and has none in the dual: remove isolated vertices")]
    IsolatedVertex { vertex: VertexId },
    /// An edge with one face.
    #[error("edge {0}–{1} has one face, and the dual of a mesh is closed as the mesh is: fill the hole there", .ends[0], .ends[1])]
    BoundaryEdge { ends: [VertexId; 2] },
    /// A vertex whose face in the dual would have two corners or one.
    #[error(
        "vertex {vertex} has {valence} edges, and a face of the dual needs three: leave it out of its two faces"
    )]
    LowValence { vertex: VertexId, valence: usize },
    /// What no oriented manifold has: an edge with three faces, a vertex with two fans, a side run twice.
    #[error("the dual is that of an oriented manifold: {0}")]
    NoOrientedManifold(#[from] BuildError),
}

/// Why faces cannot be turned to agree.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum OrientationError {
    /// A chain of faces comes back upside down, as on a Möbius strip.
    #[error("the faces around lead to edge {0}–{1} from both sides and cannot agree there: cut the mesh open along it, or choose a structure that holds inconsistent orientation", .ends[0], .ends[1])]
    NotOrientable { ends: [VertexId; 2] },
}

/// Why a mesh cannot be projected to a sphere.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum SphereError {
    /// A radius that is none, or a centre that is nowhere.
    #[error(
        "no sphere has the centre {centre:?} and the radius {radius}: both must be finite, and the radius above 0"
    )]
    NoSphere { centre: [f32; 3], radius: f32 },
    /// A vertex that lies in no direction.
    #[error(
        "vertex {vertex} is at the centre or nowhere finite, and lies in no direction from there: move it, or choose another centre"
    )]
    NoDirection { vertex: VertexId },
}
