//! Winged-edge mesh: one record for every edge, with two ends, two faces and four neighbouring
//! edges (wings).
//!
//! Use a winged-edge mesh if most queries are about edges, or if an edge must be one object with
//! one record. A winged-edge mesh cannot hold edges with three faces: if the input has an edge with
//! three faces, building returns an error. Of the six structures, the winged-edge mesh is the
//! oldest that finds a neighbour in constant time. [`generic::WingedEdgeMesh`] documents the tables
//! and their numbered invariants. The structure follows Baumgart (1972, 1975).
//!
//! | holds | |
//! |---|---|
//! | polygons of any degree, boundaries, isolated vertices | yes |
//! | edges with three faces, vertices with two fans, faces with inconsistent orientation | no: the error names the elements |
//!
//! | query | cost | reads |
//! |---|---|---|
//! | VV, VE, VF | O(valence) | `spokes`, then one edge per neighbour |
//! | EV, EF | O(1) | one edge |
//! | EE | O(valence) of both ends | the edge, then one edge per neighbour |
//! | FV, FE, FF | O(degree) | `sides`, then one edge per side |
//! | refining (quads, triangles) | O(edges + vertices) | each edge and its four wings |
//!
//! The handles of vertices, edges and faces are row numbers. A loop over all handles reads no
//! table; in an editable mesh, the loop reads the bits that mark deleted elements.
//!
//! | edit ([`MeshEdit`](sixfold_core::MeshEdit)) | cost | rows that change |
//! |---|---|---|
//! | `set_position`, `add_vertex` | O(1) | one vertex |
//! | `add_face` | O(degree), plus the valence of each corner where a new edge starts | the sides of the face, and at each corner the boundary edges |
//! | `remove_face` | O(degree) | the sides of the face, and at each corner the boundary edges |
//! | `remove_vertex` | O(corners of its faces) | its faces and edges, the outline of these faces, the boundary edges at the outline |
//! | `split_edge` | O(1) | the edge, a new edge, the two wings at the end of the edge |
//! | `bisect_edge` | O(1) | as for `split_edge`, and all sides of the triangles of the edge |
//! | `poke_face` | O(degree) | the sides of the face, one new edge per side |
//! | `split_face` | O(degree + valence) | the sides of the smaller part, a new edge, two wings |
//! | `dissolve_edge` | O(degree) of both faces | the edge, its four wings, the sides of the smaller face |
//! | `flip_edge` | O(smaller valence) of the third corners | the edge and its four wings |
//! | `collapse_edge` | O(valence) of both ends; O(1) if the removed end has three triangles | the edges at the removed end, the sides of its triangles |
//! | `split_vertex` | O(valence) | the edges that get the new vertex, the edges to `left` and `right`, up to three new edges |
//! | `remove_isolated_vertices`, `compact` | O(rows) | all |
//!
//! Each edge stores the next and the previous edge along both sides, so an edit links and unlinks
//! an edge without a search. Only two steps of an edit can need a walk: the check before the edit,
//! and replacing a vertex by another vertex in all edges at the vertex.
//!
//! # The side test
//!
//! The walks around both ends of an edge and along both faces of the edge visit the same record.
//! Therefore every step must test on which side of the edge the walk is. A walk around a vertex
//! tests whether the edge starts at this vertex. A walk along a face tests whether the face is on
//! the left of the edge. The side test is one comparison with the record that the step has just
//! read. On a mesh in random order, the processor would mispredict a branch on the result of the
//! test every second time. Therefore the code has no branch: the result of the test selects between
//! two loaded values.
//!
//! The half-edge mesh of Sixfold needs no side test. The table shows the time of the winged-edge
//! mesh divided by the time of the half-edge mesh, for 82,000 triangles in a good order and in
//! random order. A mesh is in a good order if neighbours are close in memory:
//!
//! | operation | good order | random order |
//! |---|---|---|
//! | count incident faces and corners | 1.6× | 1.5× |
//! | smoothing over VV | 1.5× | 1.3× |
//! | vertex normals | 1.4× | 1.2× |
//! | all nine relations | 1.3× | 1.2× |
//! | breadth-first search over FF | 1.1× | 1.0× |
//!
//! The side test costs least if a walk waits for memory. A step of a walk reads only one record,
//! which is in one cache line.
//!
//! # What limits the speed of the sweeps
//!
//! If the mesh is in the cache, latency limits the speed of VV, VE, VF, FV, FE and FF. Each step
//! waits for the record of the previous step, for the comparison and for the selection. A step
//! takes about 8 cycles, compared with 6 cycles in the half-edge mesh. If the mesh is not in the
//! cache, each step waits for one cache line. Memory bandwidth limits the speed of sweeps with EV
//! and EF: both queries read the records in order, and use 8 of the 32 bytes of each record.
//! Building has two expensive parts: the counting sort that pairs the sides, which takes half of
//! the time, and writing one record per side.
//!
//! # Examples
//!
//! ```
//! use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation, VertexId};
//! use sixfold_winged_edge::WingedEdgeMesh;
//!
//! let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
//! let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
//! let mesh = WingedEdgeMesh::from_polygons(&polygons)?;
//!
//! let v = VertexId::new(0);
//! assert_eq!(mesh.vertex_vertices(v).count(), 3);
//! let diagonal = mesh.edges().find(|&e| mesh.edge_faces(e).count() == 2).expect("one");
//! assert_eq!(mesh.other_end(mesh.left_next(diagonal), mesh.end(diagonal)), VertexId::new(3));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod circulate;
mod construct;
mod describe;
mod edge;
mod edit;
mod mesh;
mod query;
mod refine;
mod validate;
mod walk;
mod wings;

pub use edge::Edge;
pub use walk::EdgeSide;

/// The mesh type with its type parameters, for generic code.
///
/// Most programs use only the types [`WingedEdgeMesh`] and [`EditableWingedEdgeMesh`].
pub mod generic {
    pub use crate::mesh::WingedEdgeMesh;
}

/// A winged-edge mesh whose elements cannot be deleted: a [`generic::WingedEdgeMesh`] with its
/// default parameters.
pub type WingedEdgeMesh = generic::WingedEdgeMesh;

/// A winged-edge mesh that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::WingedEdgeMesh`] with the parameter [`Editable`](sixfold_core::Editable).
pub type EditableWingedEdgeMesh = generic::WingedEdgeMesh<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of its queries and edits.
///
/// ```
/// use sixfold_winged_edge::prelude::*;
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let mesh = WingedEdgeMesh::from_polygons(&triangle)?;
/// assert_eq!(mesh.edge_count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod prelude {
    pub use crate::{EditableWingedEdgeMesh, WingedEdgeMesh};
    pub use sixfold_core::prelude::*;
}
