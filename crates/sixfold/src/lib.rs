//! Six mesh data structures behind one query trait.
//!
//! This crate re-exports the core types, the structures and the algorithms. It also contains the
//! only list of all structures, which every command, test and benchmark uses:
//! [`structures!`].

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

mod structure_list;
mod support;

pub use structure_list::{
    EditVisitor, RefineVisitor, StructureInfo, Visitor, structure_infos, visit, visit_all,
    visit_editable, visit_refinable,
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
