//! Traits and types that all structures, algorithms and tools of Sixfold share. This crate does not
//! depend on any of the six structures.
//!
//! # For programs
//!
//! The crate `sixfold` exports the following items.
//!
//! - [`PolygonMesh`]: the input and output of every structure: vertex positions, and faces as lists
//!   of vertex numbers.
//! - [`MeshQuery`]: the nine relations between vertices, edges and faces (Weiler 1985), and their
//!   contract.
//! - [`OrientedWalk`]: steps along the sides of a face and around a vertex.
//! - [`MeshMove`]: new positions of all vertices.
//! - [`Representation`]: the trait of all structures: construction, conversion and memory.
//! - [`LocalQueries`]: the trait of structures whose queries never read all faces.
//! - [`Handle`] and [`HandleMap`]: handles of vertices, edges and faces, and maps from handles to
//!   values.
//! - [`Numbers`]: the vertices, edges or faces of a mesh, numbered from 0 without gaps.
//! - [`BoundaryLoop`]: boundary edges that form a chain.
//! - [`BuildError`]: the reason why a structure refuses a mesh; [`Capabilities`]: the kinds of
//!   meshes that a structure can hold.
//! - [`Refine`] and [`Split`]: subdivision steps that split every face in the structure's own
//!   tables.
//! - [`MeshEdit`], [`EditRecord`] and [`EditError`]: edits in place, the record of created, removed
//!   and renamed elements, and the reason why an edit is refused.
//! - [`EditCall`]: an edit with its arguments as a value, by handles or as text.
//! - [`ElementName`] and [`ElementNames`]: names such as `v3` and `f2`, which mean the same elements
//!   on every structure, also after edits.
//! - [`MeshWithData`]: a mesh together with values for its vertices, edges or faces; each edit of
//!   the mesh also updates the values.
//! - [`Creases`]: the edges and vertices that stay sharp under subdivision, and for how many
//!   levels.
//! - [`named!`]: enums whose values have names; [`UnknownName`]: the error for an unknown name.
//! - [`Facts`]: topological properties of a list of faces, such as the genus and the number of
//!   components.
//!
//! # For authors of structures
//!
//! - [`Table`], [`Slot`], [`row_id!`] and [`RowId`]: tables, and handles that are row numbers.
//! - [`Editing`]: the type parameter of a mesh that states whether elements can be deleted:
//!   [`Editable`] if they can, [`Compact`] if they cannot.
//! - [`Holes`]: the rows of deleted elements; [`NewRows`]: the new rows of all other elements after
//!   the rows of deleted elements are removed.
//! - [`check_rows`], [`check_corners`], [`check_cut`], [`faces_once`], [`check_fans_without`]: checks that an edit is allowed.
//! - [`mesh_tables!`]: the code that treats all tables of a structure alike, from a list of the
//!   tables; [`vertex_rows!`], [`edge_rows!`] and [`face_rows!`]: the lists of elements that are rows.
//! - [`invariant_checks`]: checks of invariants that several structures share.
//! - [`FaceSpans`]: the range of corners of each face in a flat table.
//! - [`TwinPairs`]: the half-edges of a list of faces in pairs, found without hashing.
//! - [`Incidence`]: the sides of any list of faces by edge; [`Fans`]: the fans of all vertices;
//!   [`FacesByLowest`]: the search for faces that have the same vertices.
//! - [`Classes`]: union–find; [`Partition`]: union–find with parities and sizes.
//! - [`ring`]: the vertices around a vertex, in order, from the faces at this vertex.
//! - [`Distinct`], [`ShortVec`], [`Lookup`]: an iterator without repeated items, short lists, and
//!   search in short lists.
//! - [`Ranks`], [`for_each_chunk`], [`map_chunks`], [`check_split`]: helpers for refinement, some
//!   of which use several threads. [`join`]: runs two computations at the same time.
//!
//! # For measurements
//!
//! - [`Measured`] and [`Counts`]: the memory of a structure, computed by formula.
//! - [`Probe`], [`Traced`] and [`Access`]: records of the reads and writes of tables.
//!
//! # Features
//!
//! No feature is on by default. `rayon`: refinement and the computation of facts use several
//! threads. `serde`: facts, capabilities, costs and memory tables can be serialised. `mint`:
//! positions can be points and vectors of the crate `mint`.

mod edit;
mod handles;
mod named;
mod polygons;
mod tables;
mod traits;

// For programs.
pub use edit::edit_call::{
    EditArgument, EditArguments, EditByName, EditCall, EditOf, EditResult, EditTextError,
};
pub use edit::edit_error::EditError;
pub use edit::edit_kind::Edit;
pub use edit::edit_log::{Changes, EditLog, EditRecord, OldToNew};
pub use edit::element_data::{Created, EdgeData, ElementData, FaceData, VertexData};
#[doc(hidden)]
pub use edit::element_data::{Edges, ElementKind, Faces, Vertices};
pub use edit::element_name::{ElementName, NoElementName};
pub use edit::element_names::{ElementNames, FacesBefore, NameChanges};
pub use edit::follow_edits::{AcceptedEdit, FollowEdits};
pub use edit::mesh_edit::{MeshEdit, Refusal};
pub use edit::mesh_with_data::MeshWithData;
pub use edit::side_data::SideData;
pub use glam;
pub use glam::Vec3 as Point;
pub use handles::handle::{Handle, HandleMap, HashHandleMap, RowMap};
pub use handles::numbering::Numbers;
pub use handles::pair::Pair;
pub use handles::row_id::{EdgeId, FaceId, VertexId};
pub use named::{UnknownName, did_you_mean};
pub use polygons::capability::Capabilities;
pub use polygons::counts::Counts;
pub use polygons::creases::{Creases, SHARPNESS_INFINITE};
pub use polygons::error::{
    BuildError, CreaseError, InvariantError, MoveError, PolygonError, RefineError,
};
pub use polygons::face_list::FaceList;
pub use polygons::facts::{Distribution, Facts};
pub use polygons::incidence::EdgeUse;
pub use polygons::newell::area_vector;
pub use polygons::polygon_mesh::PolygonMesh;
pub use polygons::triangulation::{FaceParts, PolygonCutter, PolygonTriangles, Triangulated};
#[cfg(feature = "serde")]
#[doc(hidden)]
pub use serde;
pub use tables::memory::{MemoryFootprint, TableBytes};
pub use traits::boundary::BoundaryLoop;
#[doc(hidden)]
pub use traits::local_queries::CostsAreLocal;
pub use traits::local_queries::LocalQueries;
pub use traits::mesh_move::MeshMove;
pub use traits::oriented_walk::{OrientedWalk, SideMap};
pub use traits::query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
pub use traits::refine::Refine;
pub use traits::representation::{QueryCost, Relation, Representation};
pub use traits::split::Split;

// For authors of structures.
pub use edit::edit_check::{check_corners, check_cut, check_fans_without, check_rows, faces_once};
pub use edit::edit_log::uses_reports;
pub use edit::new_rows::NewRows;
pub use handles::distinct::{Distinct, DistinctWalk};
pub use handles::iterator_ext::{FilterInline, IteratorExt, MapInline};
#[cfg(feature = "lower-limits")]
pub use handles::limits::with_lower_limits;
pub use handles::limits::{MAX_CORNERS, MAX_EDGES};
pub use handles::row_id::{MAX_ROWS, RowId, Slot, row};
pub use handles::short_vec::{Lookup, ShortVec};
pub use polygons::classes::Classes;
pub use polygons::faces_by_lowest::FacesByLowest;
pub use polygons::fans::Fans;
pub use polygons::incidence::{EdgeSides, Incidence, Side};
pub use polygons::newell::Newell;
pub use polygons::partition::Partition;
pub use tables::editing::{Compact, Editable, Editing, NoScatteredFaces};
pub use tables::face_spans::{FaceSpans, ScatteredFaces};
pub use tables::holes::{EDGE_HOLES, FACE_HOLES, HoleSet, Holes, NoHoles, VERTEX_HOLES};
pub use tables::pairing::{LinkFaces, SideRows, TwinPairs, pair_triangle_sides};
pub use tables::ranks::Ranks;
pub use tables::table::Table;
pub use tables::threads::join;
pub use traits::described::{Column, Described, Element, Field, Line, RecordTable, RowName, Word};
pub use traits::invariant_checks;
pub use traits::query::ring;
pub use traits::refine::{
    CHUNK_ROWS, all_rows, check_split, chunk_starts, for_each_chunk, map_chunks, rows_of_chunk,
};

// For measurements.
#[doc(hidden)]
pub use edit::edit_at_face::edit_at_face;
pub use tables::probe::{Access, AccessKind, Probe, Traced, Untraced};
pub use traits::measured::Measured;

/// The imports of a program that uses meshes: the traits with queries, walks, edits and refinement,
/// and the types in their signatures.
pub mod prelude {
    pub use crate::{
        BuildError, Compact, EdgeData, EdgeId, EdgeMap, EditError, EditLog, EditRecord, Editable,
        FaceData, FaceId, FaceMap, HandleMap, LocalQueries, MeshEdit, MeshMove, MeshQuery,
        MeshWithData, MoveError, Numbers, OldToNew, OrientedWalk, Point, PolygonMesh, Refine,
        Refusal, Representation, SideData, SideMap, VertexData, VertexId, VertexMap,
    };
}

/// The optimisation level at which this crate was compiled: `0` to `3`, `s` or `z`.
#[doc(hidden)]
pub const OPT_LEVEL: &str = env!("CORE_OPT_LEVEL");
