//! Six mesh data structures behind one query trait: the front door.
//!
//! This crate re-exports the vocabulary and the structures, and holds the roster: the one list of
//! all representations that every command, test and benchmark goes by.

pub use face_vertex::{self, FaceVertexMesh};
pub use half_edge::{self, HalfEdgeMesh};
pub use mesh_core::{self, *};
pub use mesh_io;
pub use polygon_soup::{self, PolygonSoup};
pub use shapes;

mod roster;

pub use roster::{BackendInfo, Visitor, roster, visit, visit_all};
