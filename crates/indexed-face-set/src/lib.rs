//! Indexed face set: shared vertices, a vertex list for each face, and no other tables.
//!
//! Files and renderers use the form of an indexed face set. Use an indexed face set to read faces
//! in order, or to keep a mesh in memory without queries. The indexed face set is the smallest
//! structure with shared vertices, and holds every polygon mesh. The name of a query has two
//! letters, for vertex (V), edge (E) or face (F): FV lists the vertices of a face. The queries FV,
//! FE and EV take O(1) per item. The queries VV, VE, VF, EE, EF and FF scan all corners, because no
//! table stores neighbours. [`generic::IndexedFaceSet`] documents the tables and their three
//! invariants.
//!
//! Edges are not stored; the handle of an edge is the [pair](sixfold_core::Pair) of its ends.
//!
//! # What limits the speed of a scan
//!
//! A scan reads 4 bytes per corner, once and in order. A scan compares many corners at a time with
//! the given vertex, without a branch. If the table of corners fits in the cache, a scan takes 0.08
//! ns per corner (82,000 triangles, 50 GB/s), and the comparisons limit its speed. In larger
//! meshes, a scan takes 0.16 ns per corner (1.3 million triangles, 0.6 ms per query), and the
//! memory bandwidth limits its speed. Compared with an indexed face set, a scan of a polygon soup
//! reads three times as many bytes and compares three times as many words.
//!
//! The method `edges` sorts the sides by vertex. The writes of this sort go to scattered addresses
//! and limit the speed of `edges`: 3.4 ns per corner in cache, 13 ns per corner in larger meshes.
//!
//! # Editing
//!
//! All edits are supported. All edits except `set_position`, `add_vertex` and edits of a single
//! face scan all corners. An edge flip needs two scans. Use the structure to edit a few elements,
//! or to add and remove faces, which takes O(1) per corner. For many edits of edges, use a
//! structure that stores neighbours. [`ScannedFaces`](sixfold_scanning::ScannedFaces) implements the
//! scan and the face edits of the indexed face set and of the polygon soup.
//!
//! # Examples
//!
//! ```
//! use sixfold_indexed_face_set::IndexedFaceSet;
//! use sixfold_core::{MeshQuery, Pair, Point, PolygonMesh, Representation, VertexId};
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
mod describe;
mod edit;
mod mesh;
mod query;
mod validate;

/// The mesh type with its type parameters, for generic code.
///
/// Most programs use only the types [`IndexedFaceSet`] and [`EditableIndexedFaceSet`].
pub mod generic {
    pub use crate::mesh::IndexedFaceSet;
}

/// An indexed face set that cannot delete elements: a [`generic::IndexedFaceSet`] without deleted
/// rows.
pub type IndexedFaceSet = generic::IndexedFaceSet;

/// An indexed face set that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::IndexedFaceSet`] that can contain deleted rows.
pub type EditableIndexedFaceSet = generic::IndexedFaceSet<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of mesh queries and edits.
///
/// ```
/// use sixfold_indexed_face_set::prelude::*;
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let mesh = IndexedFaceSet::from_polygons(&triangle)?;
/// assert_eq!(mesh.edge_count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod prelude {
    pub use crate::{EditableIndexedFaceSet, IndexedFaceSet};
    pub use sixfold_core::prelude::*;
}
