//! Errors of repairs.

use sixfold_core::{BuildError, PolygonError, VertexId};

/// The reason why a mesh cannot be repaired with the given options; the mesh is unchanged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RepairError {
    /// A tolerance that is negative or not finite.
    #[error("the tolerance {tolerance} is not a finite number of 0 or more: give a distance")]
    BadTolerance { tolerance: f64 },
    /// A relative tolerance above 1.
    #[error(
        "the relative tolerance {tolerance} is above 1, the whole diagonal of the bounding box: give a part of it, such as 1e-6"
    )]
    RelativeToleranceAboveOne { tolerance: f64 },
    /// Holes can be filled in oriented manifolds only.
    #[error("holes are filled only in an oriented manifold: cut the mesh first, because {0}")]
    NotOrientedManifold(#[source] BuildError),
    /// The repaired mesh has more elements than a handle can name.
    #[error("the repaired mesh would be too large: {0}")]
    TooLarge(#[from] PolygonError),
    /// A fault for which there is no step.
    #[error("no step repairs this fault: {0}")]
    NoStep(#[source] BuildError),
}

/// The reason why the faces cannot be oriented consistently.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum OrientationError {
    /// A closed chain of faces returns to its first face with the opposite orientation.
    #[error("the mesh is not orientable, because its faces cannot have the same orientation at \
             edge {0}–{1}: cut the mesh open along this edge, or choose a structure that accepts \
             inconsistent orientation", .ends[0], .ends[1])]
    NotOrientable { ends: [VertexId; 2] },
}
