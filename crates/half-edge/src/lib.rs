//! Half-edge mesh: every edge is two directed halves, each with a face on its left.
//!
//! Choose it to walk around vertices and to change connectivity; not for input with three faces
//! on an edge, which it refuses. Start at [`AnyHalfEdgeMesh`], whose numbered invariants explain the
//! rest. After Weiler (1985) and Mäntylä (1988); twin pairs after Campagna, Kobbelt & Seidel (1998).
//!
//! | holds | |
//! |---|---|
//! | polygons of any degree, boundaries, isolated vertices | yes |
//! | edges with three faces, vertices with two fans, faces that disagree about the side | no: refused by name |
//!
//! | query | cost | reads |
//! |---|---|---|
//! | VV, VE, VF | O(valence) | `leaving`, then one half a neighbour |
//! | EV, EF | O(1) | two halves, side by side |
//! | EE | O(valence) of both ends | one half a neighbour |
//! | FV, FE | O(degree) | `first`, then one half a corner |
//! | FF | O(degree) | `first`, then two halves a side, side by side |
//!
//! | refinement ([`Refine`](mesh_core::Refine)) | cost | reads |
//! |---|---|---|
//! | quads, triangles, √3: all faces split | O(halves) | along a face from each half: its next, and on to its prev |
//!
//! | edit ([`MeshEdit`](mesh_core::MeshEdit)) | cost | records that change |
//! |---|---|---|
//! | `set_position`, `add_vertex` | O(1) | the vertex |
//! | `add_face` | O(valence) of its corners | its sides, new edges, the halves before and after them |
//! | `remove_face` | O(valence) of its corners | its sides, the halves before and after those that go |
//! | `remove_vertex` | the sum of these over its faces | theirs |
//! | `remove_isolated_vertices` | O(vertices) | those |
//! | `split_edge` | O(degree) of a face | both halves, a new edge, the half before |
//! | `bisect_edge` | O(1) | both triangles, two or three new edges |
//! | `poke_face` | O(degree) | its sides, an edge for each |
//! | `split_face` | O(degree + valence) | the sides of one part, a new edge, the half before it |
//! | `dissolve_edge` | O(degree) of both faces | the sides of one face, the halves before the edge |
//! | `flip_edge` | O(valence) of a third corner | the six halves of two triangles |
//! | `collapse_edge` | O(valence) of both ends | the halves from one end, and around its triangles |
//! | `split_vertex` | O(valence) | the halves from the new vertex, up to three new edges |
//! | `compact` | O(mesh) | all |
//!
//! Degrees and valences are those of the faces and vertices named, not of the mesh. Vertices, edges
//! and faces keep their names but in `compact`, and what is deleted is a hole until then.
//!
//! Vertices, edges and faces are rows, so that counting and listing them reads nothing but the bits
//! of deleted ones, if there are any. `prev` is not stored: it is O(degree) along a face and
//! O(valence) along a boundary. Stored, it made every sweep slower (one-rings 6 to 20 %, by the wider
//! record) and nothing here faster; edits come by most of the halves that they need on their way.
//!
//! # What the sweeps are bound by
//!
//! A step around a vertex is some nine instructions and one load that the next step waits for. On
//! 82,000 triangles in a good order a one-ring sweep takes 12 ns a vertex, two a step: the records
//! come from the nearer caches and several walks run at once, so instructions are the limit. In
//! random order it takes 26 ns: each vertex touches some ten cache lines, of half-edges and of
//! positions, that lie in no nearer cache. FF asks of each side two records and whether its face
//! was met before: about 110 instructions a face in a breadth-first search, its real limit.
//!
//! # Examples
//!
//! ```
//! use half_edge::HalfEdgeMesh;
//! use mesh_core::{MeshQuery, Point, PolygonMesh, Representation, VertexId};
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

pub use circulate::{AroundFace, Leaving};
pub use mesh::{AnyHalfEdgeMesh, EditableHalfEdgeMesh, Half, HalfEdgeId, HalfEdgeMesh};
