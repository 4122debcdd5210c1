//! Indexed face set: shared vertices, a vertex list for each face, and no other tables.
//!
//! Files and renderers use this form. Use it to read faces in order, or to keep a mesh in memory
//! without queries. It is the smallest structure with shared vertices. It holds every polygon mesh.
//! FV, FE and EV take O(1) per item. Every query of a neighbourhood scans all corners, because no
//! table stores neighbours. Start at [`generic::IndexedFaceSet`]; its three invariants define the
//! tables.
//!
//! Edges are not stored; an edge is the [pair](sixfold_core::Pair) of its ends.
//!
//! # What limits the speed of a scan
//!
//! A scan reads 4 bytes per corner, once and in order. A scan compares many corners at a time with
//! the given vertex, without a branch. In cache, the comparisons are the limit (0.08 ns per corner
//! on 82,000 triangles, 50 GB/s). In larger meshes, the memory bandwidth is the limit (0.16 ns per
//! corner on 1.3 million triangles, 0.6 ms per query). A scan of a polygon soup reads three times
//! as many bytes and compares three times as many words.
//!
//! The scattered writes of its counting sort limit `edges`: 3.4 ns per corner in cache, 13 ns per
//! corner in larger meshes.
//!
//! # Editing
//!
//! All edits are supported. Edits of one face need no scan. Moving or adding a vertex needs no
//! scan. Every other edit begins with a scan; an edge flip needs two scans. Use the structure to
//! edit a few places, or to add and remove faces, which takes O(1) per corner. For many edits of
//! edges, use a structure that stores neighbours. [`ScannedFaces`](sixfold_core::ScannedFaces)
//! implements the scan and the face edits of this structure and of the polygon soup.
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
mod edit;
mod mesh;
mod query;
mod validate;

/// The mesh type with its type parameters, for generic code.
///
/// Programs use the two types of the crate root instead.
pub mod generic {
    pub use crate::mesh::IndexedFaceSet;
}

/// An indexed face set that cannot delete elements: a [`generic::IndexedFaceSet`] without holes.
pub type IndexedFaceSet = generic::IndexedFaceSet;

/// An indexed face set that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::IndexedFaceSet`] with holes.
pub type EditableIndexedFaceSet = generic::IndexedFaceSet<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of its queries and edits.
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
