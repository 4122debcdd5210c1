//! Face-vertex mesh: shared vertices, a vertex list for each face, a face list for each vertex.
//!
//! Use it if the main query is the faces around a vertex, for example for normals. Use it also if
//! the input is unrestricted: it holds every polygon mesh. Edges are not stored; an edge is the
//! [pair](sixfold_core::Pair) of its ends. FV, FE, EV and VF take O(1) per item; the other five
//! relations search the faces around the element. All edits of [`MeshEdit`](sixfold_core::MeshEdit)
//! are supported and local. An edit is refused only if the edit breaks its own rule. Start at
//! [`generic::FaceVertexMesh`]; its four invariants define the tables.

mod circulate;
mod construct;
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
/// Programs use the two types of the crate root instead.
pub mod generic {
    pub use crate::mesh::FaceVertexMesh;
}

/// A face-vertex mesh that cannot delete elements: a [`generic::FaceVertexMesh`] without holes.
pub type FaceVertexMesh = generic::FaceVertexMesh;

/// A face-vertex mesh that can be edited ([`MeshEdit`](sixfold_core::MeshEdit)): a
/// [`generic::FaceVertexMesh`] with holes.
pub type EditableFaceVertexMesh = generic::FaceVertexMesh<sixfold_core::Editable>;

/// The traits and types that all Sixfold structures share.
pub use sixfold_core;

/// Imports for a program: the types of this structure, and the traits of its queries and edits.
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
