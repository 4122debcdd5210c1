//! Polygon soup: every face stores the coordinates of its own corners, and faces share no data.
//!
//! STL files have the form of a polygon soup, and a renderer can use this form unchanged. Use a
//! polygon soup to transfer all faces at once. The name of a query has two letters, for vertex (V),
//! edge (E) or face (F): FV lists the vertices of a face. The queries FV, FE and EV take O(1) per
//! item. The queries VV, VE, VF, EE, EF and FF scan all corners, because no table stores
//! neighbours. [`generic::PolygonSoup`] documents the table and its four invariants.
//!
//! In a polygon soup, a vertex is identified by its coordinates ([`SoupVertex`]). So corners with
//! the same coordinates are one vertex, and moving a vertex changes its handle. [`SoupVertex`]
//! explains how to merge points that are nearly equal. A polygon soup cannot hold a face with two
//! corners at one point, or a vertex without faces.
//!
//! Adding and removing faces takes O(1) per corner. Nearly every edit of vertices and edges begins
//! with a scan of all corners. For many edits, use a structure that stores neighbours.
//! [`ScannedFaces`](sixfold_scanning::ScannedFaces) implements the scan and the edits of the polygon
//! soup and of the indexed face set.

mod construct;
mod describe;
mod edit;
mod mesh;
mod query;
mod validate;
mod vertex;

pub use vertex::SoupVertex;

/// The mesh type with its type parameters, for generic code.
///
/// Most programs use only the types [`PolygonSoup`] and [`EditablePolygonSoup`].
pub mod generic {
    pub use crate::mesh::PolygonSoup;
}

/// A polygon soup that cannot delete elements: a [`generic::PolygonSoup`] without deleted rows.
pub type PolygonSoup = generic::PolygonSoup;

/// A polygon soup that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::PolygonSoup`] that can contain deleted rows.
pub type EditablePolygonSoup = generic::PolygonSoup<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of mesh queries and edits.
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
