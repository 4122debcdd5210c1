//! Operators on meshes: each is written once, against the queries, and runs on every structure.
//!
//! | operator | takes | yields | time | source |
//! |---|---|---|---|---|
//! | [`smoothed`] | any; triangles for cotangents | positions | corners × iterations | Field 1988, Pinkall & Polthier 1993, Taubin 1995 |
//! | [`face_normals`], [`vertex_normals`] | any | directions | corners | Newell, after Sutherland, Sproull & Schumacker 1974; Thürmer & Wüthrich 1998 |
//! | [`projected_to_sphere`] | any | positions | vertices | |
//! | [`dual`] | closed oriented manifolds | polygons | corners | |
//! | [`triangulated`] | polygons | polygons | degree² a face at most | Meisters 1975 |
//! | [`oriented`] | polygons | polygons | corners · log corners | |
//!
//! What works on a structure asks it for each face once (FV and FE), or for each edge, and adds up
//! what it finds in maps by handle. So no structure has to scan the mesh for each vertex, and all
//! take time in proportion to the corners. New positions come as a [`VertexMap`], which
//! [`set_positions`] takes; two operators mend polygons that most structures refuse, and so they
//! work on a [`PolygonMesh`] before there is a structure.
//!
//! Sums are kept in doubles: no product of three coordinates overflows or vanishes, and structures
//! that add in different orders agree to the last bits of a coordinate.
//!
//! ```
//! use half_edge::HalfEdgeMesh;
//! use mesh_core::{MeshQuery, Representation};
//! use operators::{Smoothing, Triangulation, oriented, smoothed, triangulated};
//!
//! let mended = oriented(&shapes::cube(), Default::default())?;
//! assert!(mended.turned.is_empty());
//! let triangles = triangulated(&mended.polygons, Triangulation::EarClipping)?;
//! let mut mesh = HalfEdgeMesh::from_polygons(&triangles)?;
//! let moved = smoothed(&mesh, &Smoothing::default())?;
//! mesh.set_positions(&moved)?;
//! assert!(mesh.vertices().all(|v| mesh.position(v).length() < 1.7));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`VertexMap`]: mesh_core::VertexMap
//! [`PolygonMesh`]: mesh_core::PolygonMesh
//! [`set_positions`]: mesh_core::Representation::set_positions

mod dual;
mod ear_clipping;
mod error;
mod laplacian;
mod normals;
mod orientation;
mod smoothing;
mod sphere;
mod triangulation;

pub use dual::dual;
pub use error::{DualError, OrientationError, SmoothingError, SphereError};
pub use normals::{NormalWeights, face_normals, vertex_normals};
pub use orientation::{Facing, Oriented, oriented};
pub use smoothing::{Boundary, Smoothing, Weights, smoothed};
pub use sphere::projected_to_sphere;
pub use triangulation::{Triangulation, triangulated};
