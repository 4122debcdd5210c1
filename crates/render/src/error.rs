//! Errors of drawing.

use sixfold_core::VertexId;

use crate::limits::{MAX_LABELS, MAX_PIXELS, MAX_SIDE, MAX_SVG_FACES, MIN_PANEL};

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
        "a picture of {width} × {height} pixels is too large: use at most {MAX_SIDE} \
         pixels per side and {MAX_PIXELS} pixels in total"
    )]
    TooLarge { width: u32, height: u32 },
    /// The part of the picture for one mesh would be too small.
    #[error(
        "a picture of {width} × {height} pixels is too small for {meshes} in a row: \
         give each mesh at least {MIN_PANEL} × {MIN_PANEL} pixels",
        meshes = meshes(*panels)
    )]
    TooSmall {
        width: u32,
        height: u32,
        panels: usize,
    },
    /// An angle of the view is not finite, or the elevation is outside −90° to 90°.
    #[error(
        "azimuth {azimuth} and elevation {elevation} are not valid: give both in degrees, the \
         elevation from -90 to 90"
    )]
    View { azimuth: f64, elevation: f64 },
    /// There is not enough memory for the depth buffer.
    #[error("not enough memory for a depth buffer of {bytes} bytes: make the picture smaller")]
    Memory { bytes: usize },
    /// The mesh with the number `mesh`, counted from 0, cannot be drawn.
    #[error("mesh {} of the row: {fault}", .mesh + 1)]
    Mesh { mesh: usize, fault: MeshFault },
}

/// Returns `1 mesh` or `3 meshes`, for the given number.
fn meshes(count: usize) -> String {
    match count {
        1 => "1 mesh".to_owned(),
        _ => format!("{count} meshes"),
    }
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
    /// All corners of all faces have the same position.
    #[error("all faces lie in one point: there is nothing to draw")]
    NoExtent,
    /// There are too many visible faces for an SVG.
    #[error("{faces} faces are visible, but an SVG can have at most {MAX_SVG_FACES}: write a PNG")]
    TooManyFaces { faces: usize },
    /// There are too many labels.
    #[error("{labels} labels are more than {MAX_LABELS}: draw a smaller mesh, or no labels")]
    TooManyLabels { labels: usize },
}
