//! Half-edge mesh: every edge is two directed halves, each with a face on its left.
//!
//! Choose it to walk around vertices and to change connectivity; not for input with three faces
//! on an edge, which it refuses. Start at [`HalfEdgeMesh`], whose numbered invariants explain the
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
//! Vertices, edges and faces are rows, so that counting and listing them reads nothing. `prev` is
//! not stored: it is O(degree) along a face and O(valence) along a boundary. Stored, it made every
//! sweep slower (one-rings 6 to 20 %, by the wider record) and nothing here faster.
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
mod mesh;
mod query;
mod refine;
mod validate;

pub use circulate::{AroundFace, Leaving};
pub use mesh::{Half, HalfEdgeId, HalfEdgeMesh};
