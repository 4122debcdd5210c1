//! Half-edge mesh: every edge is stored as two directed half-edges, each with a face or a boundary
//! loop on its left.
//!
//! Use a half-edge mesh to walk around vertices and to change connectivity. A half-edge mesh cannot
//! hold edges with three faces: if the input has an edge with three faces, building returns an
//! error. [`generic::HalfEdgeMesh`] documents the tables and their numbered invariants. The
//! structure follows Weiler (1985) and Mäntylä (1988). The pairs of twins are those of
//! OpenMesh (Botsch et al. 2002).
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
//! | quads, triangles, √3: all faces split | O(half-edges) | for each half-edge, the other half-edges of its face |
//!
//! | edit ([`MeshEdit`](sixfold_core::MeshEdit)) | cost | rows that change |
//! |---|---|---|
//! | `set_position`, `add_vertex` | O(1) | the vertex |
//! | `add_face` | O(valence) of its corners | sides of the face, new edges, adjacent half-edges |
//! | `remove_face` | O(valence) of its corners | sides of the face, adjacent half-edges |
//! | `remove_vertex` | the sum of `remove_face` over its faces | as for `remove_face`, for all its faces |
//! | `remove_isolated_vertices` | O(vertices) | the isolated vertices |
//! | `split_edge` | O(degree) of one face | the edge, a new edge, the half-edge before the edge |
//! | `bisect_edge` | O(1) | both triangles, two or three new edges |
//! | `poke_face` | O(degree) | the sides of the face, one new edge per side |
//! | `split_face` | O(degree + valence) | the sides of one part, a new edge, the half-edge before the new edge |
//! | `dissolve_edge` | O(degree) of both faces | the sides of one face, the half-edges before the edge |
//! | `flip_edge` | O(smaller valence) of the third corners | the six half-edges of two triangles |
//! | `collapse_edge` | O(valence) of both ends | the half-edges that leave the removed end, and the half-edges around its triangles |
//! | `split_vertex` | O(valence) | the half-edges that leave the new vertex, up to three new edges |
//! | `compact` | O(mesh) | all |
//!
//! In the table of edits, degree means the degree of a face at the edited element, and valence
//! means the valence of a vertex at the edited element. Vertices, edges and faces keep their
//! handles until the mesh is compacted. Until the mesh is compacted, the rows of deleted elements
//! stay in the tables as holes.
//!
//! The handles of vertices, edges and faces are row numbers. A loop over all handles reads no
//! table; in an editable mesh, the loop reads the bits that mark deleted elements. `prev` is not
//! stored: finding the half-edge before a given half-edge costs O(degree) along a face and
//! O(valence) along a boundary. A stored `prev` would make the record of a half-edge larger. In a
//! measurement, a stored `prev` made every sweep slower (a sweep over one-rings by 6 to 20 %) and
//! no function of this crate faster.
//!
//! # What limits the speed of the sweeps
//!
//! A step around a vertex takes about nine instructions and one load, and the next step waits for
//! the load. On 82,000 triangles whose neighbours are close in memory (a good order), a one-ring
//! sweep takes 12 ns per vertex, or 2 ns per step. In a good order, the records are in the caches
//! close to the processor core, so the number of instructions limits the speed. On 82,000 triangles
//! in random order, a one-ring sweep takes 26 ns per vertex. In random order, the sweep reads about
//! ten cache lines per vertex that are not in the caches close to the core. An FF query reads two
//! records per side. In a breadth-first search, an FF query takes about 110 instructions, and the
//! number of instructions limits the speed.
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
//! let [h, _] = mesh.edge_half_edges(diagonal);
//! assert_eq!(mesh.origin(mesh.next(h)), mesh.target(h));
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

pub use mesh::{Half, HalfEdgeId};

/// The mesh type with its type parameters, for generic code.
///
/// Most programs use only the types [`HalfEdgeMesh`] and [`EditableHalfEdgeMesh`].
pub mod generic {
    pub use crate::mesh::HalfEdgeMesh;
}

/// A half-edge mesh whose elements cannot be deleted: a [`generic::HalfEdgeMesh`] with its default
/// parameters.
pub type HalfEdgeMesh = generic::HalfEdgeMesh;

/// A half-edge mesh that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::HalfEdgeMesh`] with the parameter [`Editable`](sixfold_core::Editable).
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
