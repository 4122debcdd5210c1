//! Corner table: a triangle mesh in two arrays, the vertex and the opposite corner of each corner.
//!
//! Use a corner table for queries of neighbours in large triangle meshes. Of the six structures,
//! the corner table is the smallest that answers every query about an element without a search of
//! the whole mesh. A renderer can use the `vertex` table as an index list. If a mesh has a polygon
//! with more than three sides or an edge with three faces, building returns an error.
//! [`generic::CornerTable`] documents the tables and their numbered invariants. The structure
//! follows Rossignac, Safonova & Szymczak, *3D compression made simple* (2001).
//!
//! | holds | |
//! |---|---|
//! | triangles, boundaries, isolated vertices | yes |
//! | polygons, edges with three faces, vertices with two fans, faces with inconsistent orientation | no: the error names the elements |
//!
//! # Complexity
//!
//! The name of a query has two letters, for vertex (V), edge (E) or face (F): VE lists the edges of
//! a vertex.
//!
//! | query | cost | reads |
//! |---|---|---|
//! | VV | O(valence) | `corner`, then one row of `vertex` and one of `opposite` per neighbour |
//! | VE, VF | O(valence) | `corner`, then one row of `opposite` per triangle |
//! | EV | O(1) | two rows of `vertex` |
//! | EE | O(valence) of both ends | one row of `opposite` per edge |
//! | EF | O(1) | one row of `opposite` |
//! | FV | O(1) | three rows of `vertex`, adjacent in memory |
//! | FE, FF | O(1) | three rows of `opposite`, adjacent in memory |
//! | listing or counting edges | O(corners) | `opposite`, once |
//! | building | O(corners + vertices) | |
//! | refining (triangles, √3) | O(corners + vertices) | each row once; a formula gives every new row |
//!
//! # Edits
//!
//! [`MeshEdit`](sixfold_core::MeshEdit) changes the tables in place. The rows of deleted elements
//! stay in the tables until `compact` removes the rows.
//!
//! | edit | cost | rows that change |
//! |---|---|---|
//! | `set_position` | O(1) | one row of `positions` |
//! | `add_vertex` | O(1) | a new row of `positions` and of `corner` |
//! | `add_face` | O(valence) to find the position of the face around each vertex | a new triangle; `opposite` across its sides, `corner` of its vertices |
//! | `remove_face` | O(1) | the rows of the triangle; `opposite` across its sides, `corner` of its vertices |
//! | `remove_vertex` | O(valence) | as for `remove_face`, for all triangles of the vertex |
//! | `remove_isolated_vertices` | O(vertices) | one bit per removed vertex |
//! | `bisect_edge` | O(1) | up to two rows of `vertex`, up to two new triangles, `opposite` across up to four corners |
//! | `poke_face` | O(1) | one row of `vertex`, two new triangles, `opposite` across four corners |
//! | `flip_edge` | O(valence) to check, O(1) to change | two rows of `vertex`, six rows of `opposite` |
//! | `collapse_edge` | O(valence) | `vertex` around the removed end, up to four rows of `opposite`, one or two deleted triangles |
//! | `split_vertex` | O(valence) | `vertex` around the new vertex, one or two new triangles, `opposite` across up to four corners |
//! | `split_edge`, `split_face`, `dissolve_edge` | | not supported: the results are polygons |
//! | `compact` | O(corners + vertices) | every row |
//!
//! A corner faces the edge of its triangle that does not end at the corner. The handle of an edge
//! is the lower of the two corners that face the edge. If an edit changes the handle of an edge,
//! the edit reports the new handle to the [`EditLog`](sixfold_core::EditLog).
//!
//! Corner `c` belongs to triangle `c / 3`. `next` and `prev` are computed, not stored. A map of
//! values for edges has one row per corner; in a closed mesh, half of the rows are unused.
//!
//! # What limits the speed of the sweeps
//!
//! In a walk around a vertex, each step waits for the row that the previous step read, and computes
//! `prev`: a multiplication for `c % 3`, a comparison and a selection. If the vertices are visited in
//! order, these steps limit the speed of the queries VV, VE, VF and EE. If the vertices of a large
//! mesh are visited in random order, each step waits for the memory: one access per neighbour. The
//! queries FV, FE and FF read three consecutive rows, and EF and the list of edges one row per edge,
//! so most of their time is the caller's work with the results. `reports/growth` has the times per
//! element for each size of the mesh, in both orders.
//!
//! # Examples
//!
//! ```
//! use sixfold_corner_table::CornerTable;
//! use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation, VertexId};
//!
//! let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
//! let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
//! let mesh = CornerTable::from_polygons(&polygons)?;
//!
//! // Counter-clockwise, from one boundary edge to the other.
//! let v = VertexId::new(0);
//! assert!(mesh.vertex_vertices(v).eq([1, 2, 3].map(VertexId::new)));
//!
//! let c = mesh.corner_at(v).expect("v0 is in a triangle");
//! let turned = mesh.swing(c).expect("and in another");
//! assert_eq!(mesh.unswing(turned), Some(c));
//! assert_eq!(mesh.swing(turned), None);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod circulate;
mod construct;
mod describe;
mod edit;
mod mesh;
mod query;
mod refine;
mod validate;
mod walk;

pub use mesh::{CornerId, EdgeCorner};
pub use refine::EdgeNumbers;

/// The mesh type with its type parameters, for generic code.
///
/// Most programs use only the types [`CornerTable`] and [`EditableCornerTable`].
pub mod generic {
    pub use crate::mesh::CornerTable;
}

/// A corner table that cannot delete elements: a [`generic::CornerTable`] without deleted rows.
pub type CornerTable = generic::CornerTable;

/// A corner table that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::CornerTable`] that can contain deleted rows.
pub type EditableCornerTable = generic::CornerTable<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of mesh queries and edits.
///
/// ```
/// use sixfold_corner_table::prelude::*;
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let mesh = CornerTable::from_polygons(&triangle)?;
/// assert_eq!(mesh.edge_count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod prelude {
    pub use crate::{CornerTable, EditableCornerTable};
    pub use sixfold_core::prelude::*;
}
