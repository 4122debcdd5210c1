//! Operators on meshes. Each operator is written once and runs on every structure.
//!
//! | operator | input | output | time, O(…) | source |
//! |---|---|---|---|---|
//! | [`smoothed`] | any; triangles for cotangents | positions | corners × iterations | Field 1988, Pinkall & Polthier 1993, Taubin 1995 |
//! | [`face_normals`], [`vertex_normals`] | any | directions | corners | Newell, after Sutherland, Sproull & Schumacker 1974; Thürmer & Wüthrich 1998 |
//! | [`projected_to_sphere`] | any | positions | vertices | |
//! | [`dual`] | closed oriented manifolds | polygons | corners | |
//!
//! An operator queries each face and each edge a fixed number of times, never the neighbours of a
//! vertex, and stores sums in maps by vertex, edge or face. So no structure scans all faces for
//! each vertex, and reading the mesh takes O(corners) time for every structure. New positions are
//! returned as a [`VertexMap`] for [`set_positions`].
//!
//! Sums are computed in double precision, so a product of three coordinates neither overflows nor
//! underflows. Two structures may add the terms of a sum in different orders, so their results may
//! differ in the last bits of a coordinate.
//! ```
//! use sixfold_half_edge::HalfEdgeMesh;
//! use sixfold_core::{MeshMove, MeshQuery, Representation};
//! use sixfold_operators::{Smoothing, smoothed};
//!
//! let triangles = sixfold_shapes::cube().triangulated()?.polygons;
//! let mut mesh = HalfEdgeMesh::from_polygons(&triangles)?;
//! let moved = smoothed(&mesh, &Smoothing::default())?;
//! mesh.set_positions(&moved)?;
//! assert!(mesh.vertices().all(|v| mesh.position(v).length() < 1.7));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`VertexMap`]: sixfold_core::VertexMap
//! [`set_positions`]: sixfold_core::MeshMove::set_positions

mod dual;
mod error;
mod laplacian;
mod normals;
mod smoothing;
mod sphere;

pub use dual::dual;
pub use error::{DualError, SmoothingError, SphereError};
pub use normals::{NormalWeights, face_normals, vertex_normals};
pub use smoothing::{Smoothing, SmoothingBoundary, Weights, smoothed};
pub use sphere::projected_to_sphere;
