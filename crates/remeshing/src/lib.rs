//! What people do with edits: coarser meshes, even ones, and better triangles.
//!
//! | operator | does | work | source |
//! |---|---|---|---|
//! | [`decimate`] | collapses edges, the least harmful first, down to a number of faces | edges · log edges | Garland & Heckbert 1997 |
//! | [`remesh`] | makes all edges about as long as asked, all valences about six | edges · log edges, each iteration | Botsch & Kobbelt 2004 |
//! | [`flip_to_delaunay`] | flips edges whose two opposite angles are obtuse together | edges · flips | Lawson 1977 |
//!
//! Each is written once, against [`MeshEdit`] and the queries, and runs on every structure; where a
//! structure scans for its neighbours, so does every step. All decisions go by numbers that vertices
//! get in the order in which the faces name them, and sums run in that order: so **every structure
//! makes the same mesh, to the bit**, from the same manifold.
//!
//! Triangles only. Boundaries keep their shape. What is removed leaves holes: see [`MeshEdit::compact`].
//!
//! ```
//! use half_edge::EditableHalfEdgeMesh;
//! use mesh_core::{MeshQuery, Representation};
//! use remeshing::{Decimation, Target, decimate};
//!
//! let sphere = shapes::geodesic(8)?;
//! let mut mesh = EditableHalfEdgeMesh::from_polygons(&sphere)?;
//! let tenth = Decimation { target: Target::Ratio(0.1), ..Decimation::default() };
//! let report = decimate(&mut mesh, &tenth)?;
//! assert_eq!(report.faces, sphere.face_count() / 10);
//! assert_eq!(mesh.face_count(), report.faces);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`MeshEdit`]: mesh_core::MeshEdit
//! [`MeshEdit::compact`]: mesh_core::MeshEdit::compact

mod decimation;
mod delaunay;
mod error;
mod isotropic;
mod numbering;
mod quadric;
mod queue;
mod rules;

pub use decimation::{Boundary, Decimated, Decimation, Target, decimate, decimate_watched};
pub use delaunay::{Flipped, flip_to_delaunay};
pub use error::RemeshError;
pub use isotropic::{Remeshed, Remeshing, remesh, remesh_watched};

/// Why an operator came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stop {
    /// It did all that was asked.
    Done,
    /// No edit was left that is legal and turns no face over.
    NothingLeft,
    /// It reached the bound of its work.
    WorkBound,
    /// Whoever watched told it to.
    Asked,
}
