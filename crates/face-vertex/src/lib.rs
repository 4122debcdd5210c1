//! Face-vertex mesh: shared vertices, a vertex list for each face, a face list for each vertex.
//!
//! Use a face-vertex mesh if most queries ask for the faces around a vertex, for example to compute
//! normals. Also use a face-vertex mesh if the input can be any mesh, because the structure holds
//! every polygon mesh. Edges are not stored; the handle of an edge is the
//! [pair](sixfold_core::Pair) of its ends. The name of a query has two letters, for vertex (V),
//! edge (E) or face (F): VF lists the faces of a vertex. The queries FV, FE, EV and VF take O(1)
//! per item. The queries VV, VE, EE, EF and FF search the faces around the element. All edits of
//! [`MeshEdit`](sixfold_core::MeshEdit) are supported. An edit is refused only if the edit itself
//! is not possible (for example the flip of a boundary edge), if a handle is not valid, or if the
//! tables are full. [`generic::FaceVertexMesh`] documents the tables and their four invariants.

mod circulate;
mod construct;
mod describe;
mod edge_numbers;
mod edit;
mod mesh;
mod query;
mod refine;
mod splitting;
mod validate;
mod walk;

pub use edge_numbers::EdgeNumbers;
pub use mesh::Fan;
pub use walk::{CornerMap, FaceSide};

/// The mesh type with its type parameters, for generic code.
///
/// Most programs use only the types [`FaceVertexMesh`] and [`EditableFaceVertexMesh`].
pub mod generic {
    pub use crate::mesh::FaceVertexMesh;
}

/// A face-vertex mesh that cannot delete elements: a [`generic::FaceVertexMesh`] without deleted
/// rows.
pub type FaceVertexMesh = generic::FaceVertexMesh;

/// A face-vertex mesh that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::FaceVertexMesh`] that can contain deleted rows.
pub type EditableFaceVertexMesh = generic::FaceVertexMesh<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of mesh queries and edits.
///
/// ```
/// use sixfold_face_vertex::prelude::*;
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let mesh = FaceVertexMesh::from_polygons(&triangle)?;
/// assert_eq!(mesh.edge_count(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub mod prelude {
    pub use crate::{EditableFaceVertexMesh, FaceVertexMesh};
    pub use sixfold_core::prelude::*;
}
