//! Errors of the operators.
//!
//! An error identifies a vertex by its index in `vertices()` and a face by its index in `faces()`.

use sixfold_core::{FaceId, VertexId};

/// The reason why an operator refuses a mesh or its options. The operator then leaves the mesh
/// unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RemeshError {
    /// A face is not a triangle.
    #[error(
        "face {face} has {degree} corners, but a mesh of triangles is needed: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// A coordinate is not a finite number.
    #[error("vertex {vertex} is at {at:?}, which is not finite: correct the coordinates")]
    NotFinite { vertex: VertexId, at: [f32; 3] },
    /// The ratio is not a number from 0 to 1.
    #[error("the ratio {ratio} is not from 0 to 1: give the fraction of the faces to keep")]
    BadRatio { ratio: f64 },
    /// The largest distance is not a number, or below 0.
    #[error(
        "the largest distance {distance} is not a number from 0: choose one in units of the coordinates"
    )]
    BadDistance { distance: f64 },
    /// The edge length is not a finite positive number.
    #[error("the edge length {length} is not a finite positive number: choose a length above 0")]
    BadLength { length: f64 },
    /// The edge length is too short for the precision of the positions.
    #[error(
        "the edge length {length} is too short, because positions near the coordinate \
         {coordinate} are at least {step} apart: move the mesh to the origin, or choose a length \
         of {minimum} or more"
    )]
    BelowPrecision {
        length: f64,
        coordinate: f64,
        step: f64,
        minimum: f64,
    },
    /// The mesh would need more faces with this edge length than the options allow.
    #[error(
        "the edge length {length} would need about {faces:.0} triangles, but only {limit} are \
         allowed: choose a greater length, or allow more triangles"
    )]
    TooFine {
        length: f64,
        faces: f64,
        limit: usize,
    },
}
