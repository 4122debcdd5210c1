//! A software renderer for meshes with their edges and creases, in parallel projection.
//!
//! [`draw`] makes pixels, and [`Picture::write_png`] writes them. [`draw_svg`] makes lines and
//! polygons. Several [`RenderMesh`]s are drawn in a row, each in its own panel and all at one
//! scale, for example to compare the levels of a subdivision.
//!
//! ```text
//!               ┌ layout: vertex positions     ┐
//! meshes ───────┤                              ├─ depth buffer ─┬─ shaded samples ─┬─ picture
//!               └ normals: for the lighting    ┘                └─ visible strokes ┴─ SVG
//! ```
//!
//! A depth buffer with several samples per pixel determines which lines and surfaces are hidden,
//! after Catmull (1974). The test of a line uses its centre, so that the faces beside a thick line
//! do not hide half of its width. The same input gives the same bytes.

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
