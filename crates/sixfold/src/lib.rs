//! Six mesh data structures behind one query trait: the front door.
//!
//! This crate re-exports the vocabulary and the structures, and holds the roster: the one list of
//! all representations that every command, test and benchmark goes by.

pub use corner_table::{self, CornerTable, EditableCornerTable};
pub use face_vertex::{self, EditableFaceVertexMesh, FaceVertexMesh};
pub use half_edge::{self, EditableHalfEdgeMesh, HalfEdgeMesh};
pub use indexed_face_set::{self, EditableIndexedFaceSet, IndexedFaceSet};
pub use mesh_core::{self, *};
pub use mesh_io;
pub use operators;
pub use polygon_soup::{self, EditablePolygonSoup, PolygonSoup};
pub use remeshing;
pub use shapes;
pub use subdivision;
pub use winged_edge::{self, EditableWingedEdgeMesh, WingedEdgeMesh};

mod roster;
mod support;

pub use roster::{
    BackendInfo, EditVisitor, RefineVisitor, Visitor, roster, visit, visit_all, visit_editable,
    visit_refinable,
};
pub use support::{Support, support};

/// The examples of the README, compiled and run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct ReadmeExamples;
