//! Operators that edit a mesh to get fewer faces, even edge lengths or better triangles.
//!
//! | operator | does | cost | source |
//! |---|---|---|---|
//! | [`decimate`] | collapses edges, lowest error first, down to the target number of faces | O(edges log edges) | Garland & Heckbert 1997 |
//! | [`remesh`] | makes all edges about as long as requested, all valences about six | O(edges log edges) per iteration | Botsch & Kobbelt 2004 |
//! | [`flip_to_delaunay`] | flips edges whose two opposite angles add up to more than π | O(edges log edges + flips) | Lawson 1977 |
//!
//! Each operator is written once, with [`MeshEdit`] and the queries, and runs on every structure.
//! If a structure scans all faces to find neighbours, every step of an operator scans all faces.
//! All decisions depend on vertex numbers. The vertices are numbered in the order in which the
//! faces list them, and sums are computed in the order of the numbers. Therefore **every structure
//! makes the same mesh, to the bit**, from the same manifold. Only the order of the faces in the
//! result depends on the structure. The result of a second operator can depend on the order of the
//! faces. To get the same result on all structures again, first build all structures from one
//! [`PolygonMesh`].
//!
//! [`PolygonMesh`]: sixfold_core::PolygonMesh
//!
//! An operator accepts only meshes of triangles. The operators approximately preserve the shape of
//! boundaries. Removed elements leave unused rows in the tables; [`MeshEdit::compact`] removes
//! these rows.
//!
//! ```
//! use sixfold_half_edge::EditableHalfEdgeMesh;
//! use sixfold_core::{MeshQuery, Representation};
//! use sixfold_remeshing::{Decimation, Target, decimate};
//!
//! let sphere = sixfold_shapes::geodesic(8)?;
//! let mut mesh = EditableHalfEdgeMesh::from_polygons(&sphere)?;
//! let tenth = Decimation { target: Target::Ratio(0.1), ..Decimation::default() };
//! let report = decimate(&mut mesh, &tenth)?;
//! assert_eq!(report.faces, sphere.face_count() / 10);
//! assert_eq!(mesh.face_count(), report.faces);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! If the mesh is a [`MeshWithData`], the data of vertices, edges and faces is updated by each
//! edit:
//!
//! ```
//! use sixfold_core::{FaceData, MeshQuery, MeshWithData, Representation, VertexData};
//! use sixfold_half_edge::EditableHalfEdgeMesh;
//! use sixfold_remeshing::{Remeshing, remesh};
//!
//! let mesh = EditableHalfEdgeMesh::from_polygons(&sixfold_shapes::icosahedron())?;
//! // The number of the original face; a part of a face keeps it.
//! let mut origin = FaceData::new(&mesh, 0)
//!     .with_rule(|origin, new| new.parents.first().map_or(0, |&f| origin[f]));
//! for (number, f) in (1..).zip(mesh.faces()) {
//!     origin[f] = number;
//! }
//! // A colour that is interpolated at new vertices.
//! let mut red = VertexData::new(&mesh, 0.0).with_rule(|red, new| {
//!     let sum: f32 = new.parents.iter().map(|&v| red[v]).sum();
//!     sum / new.parents.len() as f32
//! });
//! red[mesh.vertices().next().expect("twelve")] = 1.0;
//!
//! let mut mesh = MeshWithData::new(mesh, (origin, red));
//! remesh(&mut mesh, &Remeshing::with_edge_length(0.3))?;
//! let (origin, red) = mesh.data();
//! assert!(mesh.face_count() > 100);
//! assert!(mesh.faces().all(|f| (1..=20).contains(&origin[f])));
//! assert!(mesh.vertices().all(|v| (0.0..=1.0).contains(&red[v])));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`MeshEdit`]: sixfold_core::MeshEdit
//! [`MeshWithData`]: sixfold_core::MeshWithData
//! [`MeshEdit::compact`]: sixfold_core::MeshEdit::compact

mod decimation;
mod delaunay;
mod deviation;
mod error;
mod isotropic;
mod numbering;
mod quadric;
mod queue;
mod rules;

pub use decimation::{
    Decimated, Decimation, DecimationBoundary, Target, decimate, decimate_watched,
};
pub use delaunay::{Flipped, flip_to_delaunay};
pub use error::RemeshError;
pub use isotropic::{Remeshed, Remeshing, remesh, remesh_watched};
pub use rules::meets_link_condition;

/// The reason why an operator ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stop {
    /// The operator did everything that was requested.
    Done,
    /// Every remaining edit is illegal or would turn a face over.
    NoLegalEdit,
    /// The operator reached its maximum number of faces or flips.
    LimitReached,
    /// The function `watch` ended the operator.
    Requested,
}
