//! Indexed face set: shared vertices, faces as lists of them, and nothing else.
//!
//! It is what files hold and what a renderer is handed. Choose it where faces are read in order, or
//! where a mesh only waits in memory: no structure with shared vertices is smaller, and it holds
//! every polygon mesh. FV, FE and EV take O(1) an item. Any question about a neighbourhood is a scan
//! of all corners, for nothing else in the tables could answer it. Start at [`AnyIndexedFaceSet`],
//! whose three invariants explain the rest.
//!
//! Edges are not stored; an edge is the [pair](mesh_core::Pair) of its ends.
//!
//! # What a scan is bound by
//!
//! A scan reads 4 bytes a corner, once and in order, and compares them with the vertex that it looks
//! for, many at a time and without a branch. In cache it is bound by those comparisons (0.08 ns a
//! corner on 82,000 triangles, 50 GB/s), beyond it by the bandwidth of memory (0.16 ns on 1.3 million,
//! 0.6 ms a query). Hits are few, and only they are looked at more closely. A scan of a polygon soup
//! moves three times as many bytes and compares three times as many words.
//!
//! `edges` is bound by the scattered writes of its counting sort: 3.4 ns a corner in cache, 13 beyond.
//!
//! # Editing
//!
//! It takes every edit, and all but those of one face or one vertex begin with a scan: two of them to
//! turn one edge. Choose it to edit a few places, or to add and remove faces, which it does in O(1) a
//! corner; for many edits of edges choose a structure that knows what is where. The scan and the
//! surgery are those of [`ScannedFaces`](mesh_core::ScannedFaces), shared with the polygon soup.
//!
//! # Examples
//!
//! ```
//! use indexed_face_set::IndexedFaceSet;
//! use mesh_core::{MeshQuery, Pair, Point, PolygonMesh, Representation, VertexId};
//!
//! let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
//! let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
//! let mesh = IndexedFaceSet::from_polygons(&polygons)?;
//!
//! let [a, c] = [0, 2].map(VertexId::new);
//! assert_eq!(mesh.vertex_vertices(a).count(), 3);
//! assert_eq!(mesh.edge_faces(Pair::new(a, c)).count(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod construct;
mod edit;
mod mesh;
mod query;
mod validate;

pub use mesh::{AnyIndexedFaceSet, EditableIndexedFaceSet, IndexedFaceSet};
