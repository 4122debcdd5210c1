//! Errors of drawing.

use sixfold_core::VertexId;

use crate::labels::MAX_LABELS;
use crate::settings::{MAX_PIXELS, MAX_SIDE, MIN_PANEL};
use crate::svg::MAX_SVG_FACES;

/// The reason why a picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum RenderError {
    /// There is no mesh.
    #[error("no mesh to draw: give at least one mesh")]
    NoMesh,
    /// The picture is too wide or too high, or has too many pixels.
    #[error(
        "a picture of {width} × {height} pixels is too large: at most {MAX_SIDE} per side and {MAX_PIXELS} in total"
    )]
    TooLarge { width: u32, height: u32 },
    /// A panel would be too small.
    #[error(
        "a picture of {width} × {height} pixels is too small for a row of {panels}: give each \
         mesh at least {MIN_PANEL} × {MIN_PANEL} pixels"
    )]
    TooSmall {
        width: u32,
        height: u32,
        panels: usize,
    },
    /// An angle is not finite, or the elevation is out of range.
    #[error(
        "azimuth {azimuth} and elevation {elevation} are not valid: give both in degrees, the \
         elevation from -90 to 90"
    )]
    View { azimuth: f64, elevation: f64 },
    /// The samples do not fit into memory.
    #[error("not enough memory for {bytes} bytes of samples: make the picture smaller")]
    Memory { bytes: usize },
    /// One of the meshes, counted from 0, cannot be drawn.
    #[error("mesh {} of the row: {fault}", .mesh + 1)]
    Mesh { mesh: usize, fault: MeshFault },
}

/// The reason why a mesh cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum MeshFault {
    /// The mesh has no faces.
    #[error("the mesh has no faces: there is nothing to draw")]
    NoFaces,
    /// A vertex of a face has a coordinate that is infinite or NaN.
    #[error("vertex {vertex} has a coordinate that is not finite: correct the coordinate")]
    NotFinite { vertex: VertexId },
    /// All faces are in one point.
    #[error("all faces lie in one point: there is nothing to draw")]
    NoExtent,
    /// There are too many visible faces for an SVG.
    #[error("{faces} faces are visible, but an SVG can have at most {MAX_SVG_FACES}: write a PNG")]
    TooManyFaces { faces: usize },
    /// There are too many labels.
    #[error("{labels} labels are more than {MAX_LABELS}: draw a smaller mesh, or no labels")]
    TooManyLabels { labels: usize },
}
