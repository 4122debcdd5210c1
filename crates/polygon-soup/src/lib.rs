//! Polygon soup: every face keeps the coordinates of its own corners, and nothing is shared.
//!
//! It is what an STL file holds and what a renderer can be handed as it is. Choose it to pass faces
//! on in one go; every question about a neighbourhood is a sweep over all corners, for nothing else
//! in the tables could answer it. FV, FE and EV take O(1) an item, the other six O(corners).
//! Start at [`AnyPolygonSoup`], whose four invariants explain the rest.
//!
//! A vertex *is* its coordinates here ([`SoupVertex`]), so vertices that share them are one vertex
//! afterwards, and moving a vertex renames it. A face with two corners at one point, or a vertex
//! in no face, cannot be held.
//!
//! Adding and removing faces takes O(1) a corner; nearly every other edit begins with a sweep, which
//! also sees that no vertex is where a new one is to be. Choose another structure for many of them. The
//! sweep and the surgery are those of [`ScannedFaces`](mesh_core::ScannedFaces), shared with the indexed
//! face set.

mod construct;
mod edit;
mod mesh;
mod query;
mod validate;
mod vertex;

pub use mesh::{AnyPolygonSoup, EditablePolygonSoup, PolygonSoup};
pub use vertex::SoupVertex;
