//! Corner table: a triangle mesh in two arrays, the vertex and the opposite corner of each corner.
//!
//! Use it for large triangle meshes with neighbour queries. It is the smallest structure that
//! answers every query without a search of the whole mesh. A renderer accepts its `vertex` table as
//! an index list. It does not hold polygons or edges with three faces: building from such a mesh
//! returns an error. Start at [`generic::CornerTable`]; its numbered invariants define the tables.
//! The structure follows Rossignac, Safonova & Szymczak, *3D compression made simple* (2001).
//!
//! | holds | |
//! |---|---|
//! | triangles, boundaries, isolated vertices | yes |
//! | polygons, edges with three faces, vertices with two fans, faces with inconsistent orientation | no: the error names the elements |
//!
//! # Complexity
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
//! | refining (triangles, √3) | O(corners + vertices) | each row once; every new row has a closed formula |
//!
//! # Edits
//!
//! [`MeshEdit`](sixfold_core::MeshEdit) works in place. Deleted rows stay as holes until `compact`.
//!
//! | edit | cost | rows that change |
//! |---|---|---|
//! | `set_position` | O(1) | one row of `positions` |
//! | `add_vertex` | O(1) | a new row of `positions` and of `corner` |
//! | `add_face` | O(valence) to find the place | a new triangle; `opposite` across its sides, `corner` of its vertices |
//! | `remove_face` | O(1) | its rows; `opposite` across its sides, `corner` of its vertices |
//! | `remove_vertex` | O(valence) | as for `remove_face`, for all its triangles |
//! | `remove_isolated_vertices` | O(vertices) | one bit per removed vertex |
//! | `bisect_edge` | O(1) | two rows of `vertex`, two new triangles, `opposite` across four corners |
//! | `poke_face` | O(1) | one row of `vertex`, two new triangles, `opposite` across four corners |
//! | `flip_edge` | O(valence) to check, O(1) to change | two rows of `vertex`, six of `opposite`; no position |
//! | `collapse_edge` | O(valence) | `vertex` around the removed end, four rows of `opposite`, two triangles deleted |
//! | `split_vertex` | O(valence) | `vertex` around the new vertex, two new triangles, `opposite` across four corners |
//! | `split_edge`, `split_face`, `dissolve_edge` | | not supported: the results are polygons |
//! | `compact` | O(corners + vertices) | every row |
//!
//! The handle of an edge is the lower of the two corners that face the edge. If an edit changes
//! this corner, the edit reports the new handle to the [`EditLog`](sixfold_core::EditLog).
//!
//! Corner `c` belongs to triangle `c / 3`. `next` and `prev` are computed, not stored. A table by
//! edge has one row per corner; half of the rows are unused.
//!
//! # What limits the speed of the sweeps
//!
//! Around a vertex, each step waits for the row that the previous step read. A step is a load and
//! the computation of `prev`: a multiplication for `c % 3`, a comparison and a selection. A step
//! takes about ten cycles if the tables are in the nearest cache. If the vertices are visited in
//! order, these steps limit VV, VE, VF and EE. Smoothing took 18 ns per vertex on 2,562 vertices
//! and 27 ns per vertex on 40,962 vertices (icospheres, one core of a shared AMD EPYC). In random
//! order, the latency of the cache or of the memory is the limit at each step. A vertex takes 58 ns
//! on 82,000 triangles. On 1.3 million triangles, a vertex takes 390 ns, which is one memory access
//! per neighbour. FV, FE and FF read three rows in sequence, so their limit is the work with the
//! result. EF and the list of the edges have the same limit, at 1.5 ns per edge.
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
// Counter-clockwise, from one boundary edge to the other.
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
mod edit;
mod mesh;
mod query;
mod refine;
mod validate;
mod walk;

pub use circulate::CornersAt;
pub use mesh::{CornerId, EdgeCorner};
pub use refine::EdgeNumbers;

/// The mesh type with its type parameters, for generic code.
///
/// Programs use the two types of the crate root instead.
pub mod generic {
    pub use crate::mesh::CornerTable;
}

/// A corner table that cannot delete elements: a [`generic::CornerTable`] without holes.
pub type CornerTable = generic::CornerTable;

/// A corner table that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::CornerTable`] with holes.
pub type EditableCornerTable = generic::CornerTable<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of its queries and edits.
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
