//! Neighbours in space: nearest vertices, closest points on surfaces, ray hits, and the distance
//! between two meshes.
//!
//! | question | answer |
//! |---|---|
//! | which vertex is nearest? which are within a radius? which are the k nearest? | [`PointQueries`] |
//! | which point of the surface is closest? also: facing a direction, from a start hint | [`SurfaceQueries`] |
//! | where does a ray hit the surface? | [`SurfaceQueries::first_hit`], [`SurfaceQueries::for_each_hit`] |
//! | how far are two meshes apart? | [`mesh_distance`] |
//!
//! Four indices answer the questions, and all of them give the same answer, to the last bit:
//!
//! | index | divides | source | build, O(…) |
//! |---|---|---|---|
//! | [`UniformGrid`] | space, into equal cubes | Bentley & Friedman 1979 | n |
//! | [`Octree`] | a cube into eight | Meagher 1982 | n · depth |
//! | [`KdTree`] | the items, at the median | Bentley 1975; Friedman, Bentley & Finkel 1977 | n log n |
//! | [`Bvh`] | the items, by the surfaces of their boxes | MacDonald & Booth 1990; Wald 2007 | n log n |
//!
//! [`ItemList`] is the search without an index: the reference in tests, and the fastest one for a
//! few items.
//!
//! # Which one?
//!
//! [`Bvh`], unless there are few queries: then [`KdTree`] or [`Octree`], which are built in about half
//! the time. The grid is built fastest, but its queries are fast only if the items fill their box
//! evenly, which a surface does not. `sixfold neighbours MESH` measures all of them on your mesh and
//! machine, and names the index that takes the least time for a number of queries.
//!
//! # From a mesh
//!
//! An index stores vertices ([`vertex_points`]) or the triangles of faces ([`face_triangles`]) of
//! any structure, with the handles of this structure. [`polygon_points`] and [`polygon_triangles`]
//! read a [`PolygonMesh`](sixfold_core::PolygonMesh).
//!
//! ```
//! use sixfold_core::{MeshQuery, Representation};
//! use sixfold_half_edge::HalfEdgeMesh;
//! use sixfold_spatial::{Bvh, SearchHint, SpatialIndex, SurfaceQueries, face_triangles};
//!
//! let mesh = HalfEdgeMesh::from_polygons(&sixfold_shapes::icosahedron())?;
//! let surface = Bvh::build(face_triangles(&mesh)?)?;
//! let mut hint = SearchHint::default();
//! for v in mesh.vertices() {
//!     let outside = mesh.position(v) * 1.5;
//!     let closest = surface.closest_point_from(outside, &mut hint).expect("the mesh has faces");
//!     assert!(mesh.face_vertices(closest.face).any(|w| w == v));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Exactness
//!
//! Positions are single precision; all distances are computed from them in double precision. Boxes
//! are only used to skip items, with bounds that include every rounding error, so an index finds
//! what a search of all items finds. In a tie the lower handle wins. Positions that are not finite
//! are refused when an index is built; a [`PolygonMesh`](sixfold_core::PolygonMesh) may have them.
//! Queries that are not finite find nothing.
//!
//! # Features
//!
//! `rayon`: trees are built on all threads, and batches of queries ([`PointQueries::nearest_of_each`]
//! and others) and [`mesh_distance`] use them. The results do not depend on the number of threads.

mod bounds;
mod contact;
mod distance;
mod error;
mod grid;
mod index;
mod item;
mod point_queries;
mod ray;
mod sampling;
mod surface_queries;
mod tree;
mod triangle;
mod turned_box;

pub use bounds::Bounds;
pub use contact::triangles_touch;
pub use distance::{MeshDistance, OneSidedDistance, mesh_distance, one_sided_distance};
pub use error::{DistanceError, SpatialError};
pub use grid::UniformGrid;
pub use index::{ItemList, SpatialIndex};
pub use item::{
    FaceTriangle, Item, NamedBox, VertexPoint, face_triangles, polygon_points, polygon_triangles,
    vertex_points,
};
pub use point_queries::{Neighbour, PointQueries};
pub use ray::Ray;
pub use sampling::Sampling;
pub use surface_queries::{RayHit, SearchHint, SurfacePoint, SurfaceQueries};
pub use tree::{Bvh, KdTree, Octree, SplitByArea, SplitByMedian, SplitByOctants, SplitRule, Tree};
pub use triangle::closest_point_on_triangle;
pub use turned_box::TurnedBox;
