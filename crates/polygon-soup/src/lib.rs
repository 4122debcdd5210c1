//! Polygon soup: every face keeps the coordinates of its own corners, and nothing is shared.
//!
//! It is what an STL file holds and what a renderer can be handed as it is. Choose it to pass faces
//! on in one go; every question about a neighbourhood is a sweep over all corners, for nothing else
//! in the tables could answer it. FV, FE and EV take O(1) an item, the other six O(corners).
//! Start at [`PolygonSoup`], whose three invariants explain the rest.
//!
//! A vertex *is* its coordinates here ([`SoupVertex`]), so vertices that share them are one vertex
//! afterwards, and moving a vertex renames it. A face with two corners at one point, or a vertex
//! in no face, cannot be held.

mod circulate;
mod construct;
mod mesh;
mod query;
mod validate;
mod vertex;

pub use mesh::PolygonSoup;
pub use vertex::SoupVertex;
