//! A software renderer for meshes with their edges and creases, in parallel projection.
//!
//! Start at [`draw`] for pixels, which [`Picture::write_png`] writes, or at [`draw_svg`] for lines
//! and polygons. Several [`RenderMesh`]s are drawn in a row, each in its own panel and all at one
//! scale, for example to compare the levels of a subdivision.
//!
//! ```text
//!               ┌ layout: vertex positions     ┐
//! meshes ───────┤                              ├─ depth buffer ─┬─ shaded samples ─┬─ picture
//!               └ normals: for the lighting    ┘                └─ visible strokes ┴─ SVG
//! ```
//!
//! A depth buffer with several samples per pixel determines which lines and surfaces are hidden,
//! after Catmull (1974). Lines are tested along their middle, so that the faces at a thick line do
//! not hide half of it. The same input gives the same bytes.

mod depth_order;
mod edges;
mod error;
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
pub use picture::{Picture, draw};
pub use settings::{
    MAX_PIXELS, MAX_SIDE, MIN_PANEL, RenderMesh, Settings, Shading, Size, Up, View,
};
pub use svg::{MAX_SVG_FACES, draw_svg};
