//! Why a mesh cannot be remeshed, or not as asked.
//!
//! A vertex is named by its place in `vertices()` and a face by its place in `faces()`.

use mesh_core::{FaceId, VertexId};

/// Why an operator refuses a mesh, or its options; nothing has changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RemeshError {
    /// A polygon where only triangles will do.
    #[error(
        "face {face} has {degree} corners, and remeshing needs triangles: triangulate the mesh"
    )]
    NotATriangle { face: FaceId, degree: usize },
    /// A coordinate that is no number.
    #[error("vertex {vertex} is at {at:?}, which is nowhere: mend the coordinates")]
    NotFinite { vertex: VertexId, at: [f32; 3] },
    /// A ratio that is none.
    #[error("a ratio of {ratio} is not between 0 and 1: it is the part of the faces to keep")]
    BadRatio { ratio: f64 },
    /// A length that is none.
    #[error("an edge length of {length} cannot be reached: it must be finite and above 0")]
    BadLength { length: f64 },
    /// A length that is lost in the rounding of positions.
    #[error(
        "edges of {length} are too short so far from the origin: beside a coordinate of {far} positions are {step} apart, so move the mesh to the origin, or choose a length of {least} or more"
    )]
    TooFar {
        length: f64,
        far: f64,
        step: f64,
        least: f64,
    },
    /// A length that would take more faces than allowed.
    #[error(
        "edges of {length} would take about {faces:.0} triangles, and {limit} are allowed: choose a greater length, or allow more"
    )]
    TooFine {
        length: f64,
        faces: f64,
        limit: usize,
    },
}
