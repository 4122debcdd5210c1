//! Errors: positions, rays and options that cannot be used.

use sixfold_core::VertexId;

/// The reason why an index cannot be built, or a ray cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum SpatialError {
    /// A position with an infinite coordinate or NaN. In every structure, `vertex` is the index in
    /// `vertices()`; `to_polygons()` uses the same numbers.
    #[error(
        "vertex {vertex} is at {position:?}, and only finite positions can be searched: move or remove the vertex"
    )]
    PositionNotFinite {
        vertex: VertexId,
        position: [f32; 3],
    },
    /// An item with an infinite coordinate or NaN.
    #[error(
        "item {item} has a coordinate that is not finite, and only finite items can be searched: remove the item"
    )]
    ItemNotFinite { item: usize },
    /// More items than row numbers.
    #[error("{items} items, and an index holds at most {limit}: divide the mesh into parts")]
    TooManyItems { items: usize, limit: usize },
    /// A ray without a start or a direction.
    #[error(
        "origin {origin:?} and direction {direction:?} do not define a ray: both must be finite, and the direction not zero"
    )]
    InvalidRay {
        origin: [f64; 3],
        direction: [f64; 3],
    },
}

/// The reason why the distance between two meshes cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistanceError {
    /// A mesh without faces has no surface.
    #[error(
        "the {mesh} mesh has no faces, so there is no surface to measure to or from: add faces"
    )]
    NoFaces {
        /// Which of the two meshes: `first` or `second`.
        mesh: &'static str,
    },
    /// More samples than row numbers.
    #[error("{samples} samples, and at most {limit} are allowed: choose fewer samples")]
    TooManySamples {
        /// The number of samples that was asked for.
        samples: usize,
        /// The largest number.
        limit: usize,
    },
    /// A mesh that cannot be searched.
    #[error("the {mesh} mesh: {error}")]
    Mesh {
        /// Which of the two meshes: `first` or `second`.
        mesh: &'static str,
        /// The reason.
        #[source]
        error: SpatialError,
    },
}
