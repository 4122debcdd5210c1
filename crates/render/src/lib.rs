//! A plain software renderer: meshes, their edges and creases, seen without perspective.
//!
//! Start at [`draw`] for pixels, which [`Picture::write_png`] writes, or at [`draw_svg`] for lines and
//! polygons. Several [`Subject`]s stand in a row, each in a panel of its own, all at one scale: the
//! levels of a subdivision can be compared.
//!
//! ```text
//!               ┌ layout: where each vertex falls ┐
//! subjects ─────┤                                 ├─ depth buffer ─┬─ shaded samples ─┬─ picture
//!               └ normals: what light falls on    ┘                └─ visible strokes ┴─ SVG
//! ```
//!
//! Hidden lines and surfaces are decided in a depth buffer of several samples a pixel, after Catmull
//! (1974); lines are tested along their middle, so that a thick line is never half hidden by the faces
//! it parts. The same input gives the same bytes.

mod edges;
mod error;
mod fill;
mod layout;
mod light;
mod normals;
mod order;
mod picture;
mod samples;
mod settings;
mod strokes;
mod svg;

pub use error::{MeshFault, RenderError};
pub use picture::{Picture, draw};
pub use settings::{MAX_PIXELS, MAX_SIDE, MIN_PANEL, Settings, Shading, Size, Subject, Up, View};
pub use svg::{MAX_SVG_FACES, draw_svg};
