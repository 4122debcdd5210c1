//! Errors of the operators.
//!
//! An error identifies a vertex by its index in `vertices()` and a face by its index in `faces()`.
//! `to_polygons()` uses the same indices.

use sixfold_core::{BuildError, FaceId, VertexId};

/// The reason why a mesh cannot be smoothed with the given options.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum SmoothingError {
    /// A face has more than three corners, but cotangent weights need triangles.
    #[error(
        "face {face} has {degree} corners; cotangent weights need triangles: triangulate the mesh, or choose uniform weights"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// The step is not a number from 0 to 1.
    #[error(
        "step {step} is not between 0 and 1: choose a step in this range, because a larger step \
         moves a vertex past its neighbours"
    )]
    Step { step: f64 },
    /// The step back is not longer than the step, or the step back would make the mesh rougher.
    #[error(
        "step back {back} does not fit step {step}: choose a step back below −{step}, with (1 − \
         2·step)·(1 − 2·back) between −1 and 1"
    )]
    StepBack { step: f64, back: f64 },
}

/// The reason why a mesh has no dual.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum DualError {
    /// A vertex has no face.
    #[error("vertex {vertex} has no face and therefore no dual face: remove isolated vertices")]
    IsolatedVertex { vertex: VertexId },
    /// An edge has only one face.
    #[error("edge {0}–{1} has one face, so the mesh is open, and only a closed mesh has a dual: close \
             the mesh first", .ends[0], .ends[1])]
    BoundaryEdge { ends: [VertexId; 2] },
    /// A vertex would become a face of the dual with only one or two corners.
    #[error(
        "vertex {vertex} has {valence} edges, but a vertex needs at least 3 edges to become a \
         face of the dual: remove the vertex from its faces"
    )]
    LowValence { vertex: VertexId, valence: usize },
    /// The mesh is not an oriented manifold: an edge has three faces, a vertex has two fans of
    /// faces, or two faces run along one edge in the same direction.
    #[error("only an oriented manifold has a dual: {0}")]
    NotOrientedManifold(#[from] BuildError),
}

/// The reason why a mesh cannot be projected to a sphere.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum SphereError {
    /// The radius is not positive and finite, or the centre is not finite.
    #[error(
        "centre {centre:?} and radius {radius} do not define a sphere: both must be finite, and the radius above 0"
    )]
    InvalidSphere { centre: [f32; 3], radius: f32 },
    /// A vertex is at the centre, or the position of a vertex is not finite.
    #[error(
        "vertex {vertex} is at the centre or not finite, so it has no direction from the centre: \
         move the vertex, or choose another centre"
    )]
    NoDirection { vertex: VertexId },
}
