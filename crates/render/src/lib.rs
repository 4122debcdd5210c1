//! A software renderer for meshes with their edges and creases, in parallel projection.
//!
//! [`draw`] makes a [`Picture`] of pixels, and [`Picture::write_png`] writes the picture as PNG.
//! [`draw_svg`] makes a picture of lines and polygons as SVG. Several [`RenderMesh`]es are drawn in
//! a row, all at the same scale.
//!
//! ```text
//!               ┌ layout: vertex positions     ┐
//! meshes ───────┤                              ├─ depth buffer ─┬─ shaded samples ─┬─ picture
//!               └ normals: for the lighting    ┘                └─ visible strokes ┴─ SVG
//! ```
//!
//! A depth buffer (Catmull 1974) with several samples per pixel determines which lines and surfaces
//! are hidden. The test of whether a line is visible ignores the width of the line. For the same
//! input, the renderer makes the same bytes.

mod depth_order;
mod edges;
mod error;
mod labels;
mod layout;
mod light;
mod limits;
mod normals;
mod picture;
mod rasterise;
mod samples;
mod settings;
mod strokes;
mod svg;
mod tiles;

pub use error::{MeshFault, RenderError};
pub use limits::{MAX_LABELS, MAX_PIXELS, MAX_SIDE, MAX_SVG_FACES, MIN_PANEL};
pub use picture::{Picture, draw};
pub use settings::{Faults, RenderMesh, Settings, Shading, Size, Up, View};
pub use svg::draw_svg;
