//! Errors of repairs.

use sixfold_core::{BuildError, PolygonError};

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
