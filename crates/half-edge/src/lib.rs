//! Half-edge mesh: every edge is two directed half-edges, each with a face on its left.
//!
//! Use it to walk around vertices and to change connectivity. It does not hold edges with three
//! faces: building a mesh with such edges returns an error. Start at [`generic::HalfEdgeMesh`]; its
//! numbered invariants define the tables. The structure follows Weiler (1985) and Mäntylä (1988).
//! Its twin pairs follow Campagna, Kobbelt & Seidel (1998).
//!
//! | holds | |
//! |---|---|
//! | polygons of any degree, boundaries, isolated vertices | yes |
//! | edges with three faces, vertices with two fans, faces with inconsistent orientation | no: the error names the elements |
//!
//! | query | cost | reads |
//! |---|---|---|
//! | VV, VE, VF | O(valence) | `leaving`, then one half-edge per neighbour |
//! | EV, EF | O(1) | two half-edges, adjacent in memory |
//! | EE | O(valence) of both ends | one half-edge per neighbour |
//! | FV, FE | O(degree) | `first`, then one half-edge per corner |
//! | FF | O(degree) | `first`, then two half-edges per side, adjacent in memory |
//!
//! | refinement ([`Refine`](sixfold_core::Refine)) | cost | reads |
//! |---|---|---|
//! | quads, triangles, √3: all faces split | O(half-edges) | for each half-edge, the face from its next to its prev |
//!
//! | edit ([`MeshEdit`](sixfold_core::MeshEdit)) | cost | rows that change |
//! |---|---|---|
//! | `set_position`, `add_vertex` | O(1) | the vertex |
//! | `add_face` | O(valence) of its corners | its sides, new edges, the half-edges before and after them |
//! | `remove_face` | O(valence) of its corners | its sides, the half-edges before and after the removed ones |
//! | `remove_vertex` | the sum of `remove_face` over its faces | as for `remove_face`, for all its faces |
//! | `remove_isolated_vertices` | O(vertices) | the isolated vertices |
//! | `split_edge` | O(degree) of one face | both half-edges, a new edge, the half-edge before |
//! | `bisect_edge` | O(1) | both triangles, two or three new edges |
//! | `poke_face` | O(degree) | its sides, one new edge per side |
//! | `split_face` | O(degree + valence) | the sides of one part, a new edge, the half-edge before it |
//! | `dissolve_edge` | O(degree) of both faces | the sides of one face, the half-edges before the edge |
//! | `flip_edge` | O(smaller valence) of the third corners | the six half-edges of two triangles |
//! | `collapse_edge` | O(valence) of both ends | the half-edges that leave the removed end, and the half-edges around its triangles |
//! | `split_vertex` | O(valence) | the half-edges that leave the new vertex, up to three new edges |
//! | `compact` | O(mesh) | all |
//!
//! Here, degree and valence are the degree of a face and the valence of a vertex at the edited
//! element. Vertices, edges and faces keep their handles until `compact`. Until then, the rows of
//! deleted elements are holes.
//!
//! The handles of vertices, edges and faces are row numbers. A loop over all elements reads no
//! table, except the bits of the holes. `prev` is not stored: finding the half-edge before another
//! costs O(degree) along a face and O(valence) along a boundary. A stored `prev` makes the record
//! wider. In a test, it slowed every sweep (one-rings by 6 to 20 %) and made no function of this
//! crate faster.
//!
//! # What limits the speed of the sweeps
//!
//! A step around a vertex is about nine instructions and one load. The next step waits for this
//! load. On 82,000 triangles in a good order, a one-ring sweep takes 12 ns per vertex, 2 ns per
//! step. The records are then in the nearer caches, and the number of instructions is the limit. In
//! random order, the sweep takes 26 ns per vertex. Each vertex then touches about ten cache lines
//! that are not in the nearer caches. FF reads two records per side. In a breadth-first search, FF
//! takes about 110 instructions per face, and the number of instructions is the limit.
//!
//! # Examples
//!
//! ```
//! use sixfold_half_edge::HalfEdgeMesh;
//! use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation, VertexId};
//!
//! let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
//! let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
//! let mesh = HalfEdgeMesh::from_polygons(&polygons)?;
//!
//! let v = VertexId::new(0);
//! assert_eq!(mesh.vertex_vertices(v).count(), 3);
//! let diagonal = mesh.edges().find(|&e| mesh.edge_faces(e).count() == 2).expect("one");
//! let [h, _] = mesh.halves_of(diagonal);
//! assert_eq!(mesh.origin(mesh.next(h)), mesh.target(h));
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

pub use circulate::{AroundFace, Leaving};
pub use mesh::{Half, HalfEdgeId};

/// The mesh type with its type parameters, for generic code.
///
/// Programs use the two types of the crate root instead.
pub mod generic {
    pub use crate::mesh::HalfEdgeMesh;
}

/// A half-edge mesh that cannot delete elements: a [`generic::HalfEdgeMesh`] without holes.
pub type HalfEdgeMesh = generic::HalfEdgeMesh;

/// A half-edge mesh that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::HalfEdgeMesh`] with holes.
pub type EditableHalfEdgeMesh = generic::HalfEdgeMesh<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of its queries and edits.
///
/// ```
/// use sixfold_half_edge::prelude::*;
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let mesh = HalfEdgeMesh::from_polygons(&triangle)?;
/// assert_eq!(mesh.edge_count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod prelude {
    pub use crate::{EditableHalfEdgeMesh, HalfEdgeMesh};
    pub use sixfold_core::prelude::*;
}
