//! Why there is no picture.

use mesh_core::VertexId;

use crate::settings::{MAX_PIXELS, MAX_SIDE, MIN_PANEL};
use crate::svg::MAX_SVG_FACES;

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum RenderError {
    /// Nothing to draw.
    #[error("there is no mesh to draw: name one")]
    NoMesh,
    /// A side that is too long, or too many pixels.
    #[error(
        "a picture of {width} × {height} pixels is too large: at most {MAX_SIDE} a side, and {MAX_PIXELS} in all"
    )]
    TooLarge { width: u32, height: u32 },
    /// A panel that is too small to show anything.
    #[error(
        "{width} × {height} pixels are too few for {panels} in a row: each needs {MIN_PANEL} × {MIN_PANEL}"
    )]
    TooSmall {
        width: u32,
        height: u32,
        panels: usize,
    },
    /// An angle that is none, or beyond the poles.
    #[error(
        "no view has azimuth {azimuth} and elevation {elevation}: these are degrees, the elevation from -90 to 90"
    )]
    View { azimuth: f64, elevation: f64 },
    /// The samples do not fit into memory.
    #[error("there is no memory for {bytes} bytes of samples: make the picture smaller")]
    Memory { bytes: usize },
    /// One of the meshes, counted from 0, cannot be drawn.
    #[error("mesh {} of the row: {fault}", .mesh + 1)]
    Mesh { mesh: usize, fault: MeshFault },
}

/// Why a mesh cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum MeshFault {
    /// Nothing but vertices.
    #[error("the mesh has no faces: there is nothing to draw")]
    NoFaces,
    /// A vertex without a place.
    #[error("vertex {vertex} is not at a finite place: mend its coordinates")]
    NotFinite { vertex: VertexId },
    /// All faces in one point.
    #[error("all faces lie in one point: there is nothing to see")]
    NoExtent,
    /// Too many polygons for vector graphics.
    #[error("{faces} faces are to be seen, and an SVG holds {MAX_SVG_FACES}: write a PNG")]
    TooManyFaces { faces: usize },
}
