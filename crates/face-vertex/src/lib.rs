//! Face-vertex mesh: shared vertices, faces as lists of them, and each vertex knows its faces.
//!
//! Choose it where faces around a vertex are what is asked for (normals, gathering for a smoothing
//! step, handing faces to a renderer), and where the input may be anything at all: it holds every
//! polygon mesh. Edges are not stored; an edge is the [pair](mesh_core::Pair) of its ends. FV, FE,
//! EV and VF take O(1) an item; the other five look through the faces around the element. All edits
//! of [`MeshEdit`](mesh_core::MeshEdit) are legal here wherever their own rule holds, and local.
//! Start at [`AnyFaceVertexMesh`], whose four invariants explain the rest.

mod circulate;
mod construct;
mod edge_numbers;
mod edit;
mod mesh;
mod query;
mod refine;
mod splitting;
mod validate;

pub use edge_numbers::EdgeNumbers;
pub use mesh::{AnyFaceVertexMesh, EditableFaceVertexMesh, FaceVertexMesh, Fan};
