//! A software renderer for meshes with their edges and creases, in parallel projection.
//!
//! [`draw`] makes pixels, and [`Picture::write_png`] writes the pixels. [`draw_svg`] makes lines
//! and polygons. Several [`RenderMesh`]s are drawn in a row at one scale, each in its own panel.
//!
//! ```text
//!               ┌ layout: vertex positions     ┐
//! meshes ───────┤                              ├─ depth buffer ─┬─ shaded samples ─┬─ picture
//!               └ normals: for the lighting    ┘                └─ visible strokes ┴─ SVG
//! ```
//!
//! A depth buffer (Catmull 1974) with several samples per pixel determines which lines and surfaces
//! are hidden. The visibility test of a line uses the centre of the line. The same input gives the
//! same bytes.

mod depth_order;
mod edges;
mod error;
mod labels;
mod layout;
mod light;
mod normals;
mod picture;
mod rasterise;
mod samples;
mod settings;
mod strokes;
mod svg;

pub use error::{MeshFault, RenderError};
pub use labels::MAX_LABELS;
pub use picture::{Picture, draw};
pub use settings::{
    Faults, MAX_PIXELS, MAX_SIDE, MIN_PANEL, RenderMesh, Settings, Shading, Size, Up, View,
};
pub use svg::{MAX_SVG_FACES, draw_svg};
