//! Six mesh data structures behind one query trait.
//!
//! This crate re-exports the core types, the structures and the algorithms. It also contains the
//! roster: the only list of all structures, which every command, test and benchmark uses.
//!
//! # Requiring local queries
//!
//! Polygon soups and indexed face sets answer most queries by a scan of all faces. An algorithm can
//! refuse them with the bound [`LocalQueries`]:
//!
//! ```
//! use sixfold::prelude::*;
//!
//! fn largest_valence<M: LocalQueries>(mesh: &M) -> usize {
//!     mesh.vertices().map(|v| mesh.valence(v)).max().unwrap_or(0)
//! }
//!
//! let mesh = HalfEdgeMesh::from_polygons(&sixfold::shapes::cube())?;
//! assert_eq!(largest_valence(&mesh), 3);
//! assert!(HalfEdgeMesh::is_local() && !PolygonSoup::is_local());
//! # Ok::<(), BuildError>(())
//! ```
//!
//! ```compile_fail,E0277
//! # use sixfold::prelude::*;
//! # fn largest_valence<M: LocalQueries>(mesh: &M) -> usize {
//! #     mesh.vertices().map(|v| mesh.valence(v)).max().unwrap_or(0)
//! # }
//! let mesh = PolygonSoup::from_polygons(&sixfold::shapes::cube())?;
//! largest_valence(&mesh); // queries of a polygon soup may scan all faces of the mesh
//! # Ok::<(), BuildError>(())
//! ```
//!
//! # Walks in order
//!
//! Most queries yield sets. [`OrientedWalk`] steps from side to side in order, on four of the
//! structures: along a face, around a vertex, or along the boundary as here.
//!
//! ```
//! use sixfold::prelude::*;
//!
//! /// Returns the boundary loops, each as its vertices in the direction of the faces.
//! fn boundary_loops<M: OrientedWalk>(mesh: &M) -> Vec<Vec<M::Vertex>> {
//!     let mut visited = mesh.side_map(false);
//!     let mut loops = Vec::new();
//!     for start in mesh.sides().filter(|&s| mesh.twin_side(s).is_none()) {
//!         let mut vertices = Vec::new();
//!         let mut at = start;
//!         while !visited[at] {
//!             visited[at] = true;
//!             vertices.push(mesh.side_origin(at));
//!             // The next side along the face, then clockwise up to the boundary.
//!             at = mesh.next_side(at);
//!             while let Some(turned) = mesh.cw_side(at) {
//!                 at = turned;
//!             }
//!         }
//!         if !vertices.is_empty() {
//!             loops.push(vertices);
//!         }
//!     }
//!     loops
//! }
//!
//! let polygons = sixfold::shapes::grid_with_hole(4, 4)?;
//! assert_eq!(boundary_loops(&HalfEdgeMesh::from_polygons(&polygons)?).len(), 2);
//! assert_eq!(boundary_loops(&FaceVertexMesh::from_polygons(&polygons)?).len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use sixfold_core::*;
pub use sixfold_corner_table::{self as corner_table, CornerTable, EditableCornerTable};
pub use sixfold_face_vertex::{self as face_vertex, EditableFaceVertexMesh, FaceVertexMesh};
pub use sixfold_half_edge::{self as half_edge, EditableHalfEdgeMesh, HalfEdgeMesh};
pub use sixfold_indexed_face_set::{
    self as indexed_face_set, EditableIndexedFaceSet, IndexedFaceSet,
};
pub use sixfold_io as io;
pub use sixfold_operators as operators;
pub use sixfold_polygon_soup::{self as polygon_soup, EditablePolygonSoup, PolygonSoup};
pub use sixfold_remeshing as remeshing;
pub use sixfold_shapes as shapes;
pub use sixfold_subdivision as subdivision;
pub use sixfold_winged_edge::{self as winged_edge, EditableWingedEdgeMesh, WingedEdgeMesh};

mod roster;
mod support;

pub use roster::{
    BackendInfo, EditVisitor, RefineVisitor, Visitor, roster, visit, visit_all, visit_editable,
    visit_refinable,
};
pub use support::{Support, support};

/// The usual imports of a program: the six structures, and the traits for queries, edits and
/// refinement.
///
/// ```
/// use sixfold::prelude::*;
///
/// let mesh = HalfEdgeMesh::from_polygons(&sixfold::shapes::cube())?;
/// assert_eq!(mesh.edge_count(), 12);
/// # Ok::<(), BuildError>(())
/// ```
pub mod prelude {
    pub use crate::{
        CornerTable, EditableCornerTable, EditableFaceVertexMesh, EditableHalfEdgeMesh,
        EditableIndexedFaceSet, EditablePolygonSoup, EditableWingedEdgeMesh, FaceVertexMesh,
        HalfEdgeMesh, IndexedFaceSet, PolygonSoup, WingedEdgeMesh,
    };
    pub use sixfold_core::prelude::*;
}

/// The examples of the README, which are compiled and run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct ReadmeExamples;
