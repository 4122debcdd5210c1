//! Corner table: triangles as two columns, the vertex of each corner and the corner opposite to it.
//!
//! Choose it for large triangle meshes that must know their neighbours: it is the smallest of the
//! structures that answer everything in place, and its column of vertices is the index list that a
//! renderer takes as it is. Not for polygons, nor for input with three faces on an edge; both are
//! refused. Start at [`AnyCornerTable`], whose numbered invariants explain the rest. After Rossignac,
//! Safonova & Szymczak, *3D compression made simple* (2001).
//!
//! | holds | |
//! |---|---|
//! | triangles, boundaries, isolated vertices | yes |
//! | polygons, edges with three faces, vertices with two fans, faces that disagree about the side | no: refused by name |
//!
//! # Complexity
//!
//! | query | cost | reads |
//! |---|---|---|
//! | VV | O(valence) | `corner`, then one row of `vertex` and one of `opposite` a neighbour |
//! | VE, VF | O(valence) | `corner`, then one row of `opposite` a triangle |
//! | EV | O(1) | two rows of `vertex`, of one triangle |
//! | EE | O(valence) of both ends | one row of `opposite` an edge |
//! | EF | O(1) | one row of `opposite` |
//! | FV | O(1) | three rows of `vertex`, side by side |
//! | FE, FF | O(1) | three rows of `opposite`, side by side |
//! | the edges, their number | O(corners) | `opposite` once through |
//! | building | O(corners + vertices) | |
//! | refining (triangles, √3) | O(corners + vertices) | each row once, in closed form |
//!
//! # Edits
//!
//! [`MeshEdit`](mesh_core::MeshEdit), in place. The rows of what is deleted stay holes until `compact`.
//!
//! | edit | cost | which records change |
//! |---|---|---|
//! | `set_position` | O(1) | one row of `positions` |
//! | `add_vertex` | O(1) | one more of `positions` and `corner` |
//! | `add_face` | O(valence) to find the place | a new triangle; `opposite` across its sides, `corner` of its vertices |
//! | `remove_face` | O(1) | its rows; `opposite` across its sides, `corner` of its vertices |
//! | `remove_vertex` | O(valence) | the same of all its triangles |
//! | `remove_isolated_vertices` | O(vertices) | a bit for each of them |
//! | `bisect_edge` | O(1) | two rows of `vertex`, two triangles more, `opposite` across four corners |
//! | `poke_face` | O(1) | one row of `vertex`, two triangles more, `opposite` across four corners |
//! | `flip_edge` | O(valence) to be legal | two rows of `vertex`, six of `opposite`; no position |
//! | `collapse_edge` | O(valence) | `vertex` around the end that goes, four rows of `opposite`, two triangles deleted |
//! | `split_vertex` | O(valence) | `vertex` around the new vertex, two triangles more, `opposite` across four corners |
//! | `split_edge`, `split_face`, `dissolve_edge` | | not offered: they make polygons |
//! | `compact` | O(corners + vertices) | every row |
//!
//! Where a corner comes to face another edge, the edge may be called by another corner from then on;
//! the [`EditLog`](mesh_core::EditLog) is told.
//!
//! Corner `c` belongs to triangle `c / 3`, and `next` and `prev` are arithmetic: what a half-edge
//! mesh stores for each half, this one computes. An edge is named by the corner that faces it, of
//! two the lower, so that data by edge is a vector with a row for each corner: no hashing, but half
//! of the rows are idle.
//!
//! # What the sweeps wait for
//!
//! Around a vertex each step needs the row that the last one read: a load, then the corner before
//! (a multiplication to find `c % 3`, a comparison, a choice), about ten cycles in all with the
//! tables in the nearest cache. That chain is the price of storing no `next`, and it bounds VV, VE,
//! VF and EE in order, not the bytes: smoothing 2,562 vertices took 18 ns each and 40,962 took 27,
//! with 76 bytes to move (icospheres, one core of a shared AMD EPYC). In random order it is the
//! latency of the cache or memory behind each step: 58 ns a vertex on 82,000 triangles, and 390 on
//! 1.3 million, one trip to memory a neighbour. FV, FE and FF read three rows in sequence and are
//! bound by what is done with the answer; so are the edges and EF, at 1.5 ns an edge.
//!
//! # Examples
//!
//! ```
//! use corner_table::CornerTable;
//! use mesh_core::{MeshQuery, Point, PolygonMesh, Representation, VertexId};
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
mod edit;
mod mesh;
mod query;
mod refine;
mod validate;

pub use circulate::CornersAt;
pub use mesh::{AnyCornerTable, CornerId, CornerTable, EdgeCorner, EditableCornerTable};
pub use refine::EdgeNumbers;
