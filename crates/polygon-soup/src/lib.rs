//! Polygon soup: every face stores the coordinates of its own corners, and faces share nothing.
//!
//! STL files have this form, and a renderer can use it unchanged. Use it to transfer all faces at
//! once. Every query of a neighbourhood scans all corners, because no table stores neighbours. FV,
//! FE and EV take O(1) per item; the other six relations take O(corners). Start at
//! [`generic::PolygonSoup`]; its four invariants define the tables.
//!
//! A vertex *is* its coordinates here ([`SoupVertex`]). So vertices with the same coordinates are
//! one vertex, and moving a vertex changes its handle. [`SoupVertex`] explains how to merge points
//! that are nearly equal. The structure cannot hold a face with two corners at one point, or a
//! vertex without faces.
//!
//! Adding and removing faces takes O(1) per corner. Nearly every other edit begins with a scan of
//! all corners. For many edits, use another structure. [`ScannedFaces`](sixfold_core::ScannedFaces)
//! implements the scan and the edits, also for the indexed face set.

mod construct;
mod edit;
mod mesh;
mod query;
mod validate;
mod vertex;

pub use vertex::SoupVertex;

/// The mesh type with its type parameters, for generic code.
///
/// Programs use the two types of the crate root instead.
pub mod generic {
    pub use crate::mesh::PolygonSoup;
}

/// A polygon soup that cannot delete elements: a [`generic::PolygonSoup`] without holes.
pub type PolygonSoup = generic::PolygonSoup;

/// A polygon soup that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::PolygonSoup`] with holes.
pub type EditablePolygonSoup = generic::PolygonSoup<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of its queries and edits.
///
/// ```
/// use sixfold_polygon_soup::prelude::*;
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let mesh = PolygonSoup::from_polygons(&triangle)?;
/// assert_eq!(mesh.edge_count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod prelude {
    pub use crate::{EditablePolygonSoup, PolygonSoup};
    pub use sixfold_core::prelude::*;
}
