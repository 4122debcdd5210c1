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
//! - [`MeshWithData`]: a mesh together with values for its vertices, edges or faces; each edit of
//!   the mesh also updates the values.
//! - [`Creases`]: the edges and vertices that stay sharp under subdivision, and for how many
//!   levels.
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
//! - [`check_rows`], [`check_corners`], [`check_cut`]: checks that an edit is allowed.
//! - [`FaceSpans`]: the range of corners of each face in a flat table.
//! - [`TwinPairs`]: the half-edges of a list of faces in pairs, found without hashing.
//! - [`Incidence`]: the sides of any list of faces by edge; [`Fans`]: the fans of all vertices;
//!   [`FacesByLowest`]: the search for faces that have the same vertices.
//! - [`Classes`]: union–find; [`Partition`]: union–find with parities and sizes.
//! - [`ScannedFaces`]: queries and edits of structures that scan all corners to find the faces at a
//!   vertex.
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

mod boundary;
mod capability;
mod classes;
mod clone_by_field;
mod convert;
mod creases;
mod distinct;
mod edit;
mod edit_check;
mod edit_error;
mod edit_kind;
mod edit_log;
mod editing;
mod element_data;
mod error;
mod face_list;
mod face_spans;
mod faces_by_lowest;
mod facts;
mod fans;
mod follow_edits;
mod handle;
mod holes;
mod incidence;
mod iterator_ext;
mod local_queries;
mod measured;
mod memory;
mod mesh_move;
mod mesh_with_data;
mod new_rows;
mod numbering;
mod oriented_walk;
mod pairing;
mod partition;
mod polygon_mesh;
mod probe;
mod query;
mod ranks;
mod refine;
mod representation;
mod row_id;
mod scan;
mod scan_edit;
mod scanned;
mod short_vec;
mod sides;
mod table;
mod threads;

// For programs.
pub use boundary::BoundaryLoop;
pub use capability::Capabilities;
pub use creases::{Creases, SHARPNESS_INFINITE};
pub use edit::{MeshEdit, Refusal};
pub use edit_error::EditError;
pub use edit_kind::Edit;
pub use edit_log::{Changes, EditLog, EditRecord, OldToNew};
pub use element_data::{Created, EdgeData, ElementData, FaceData, VertexData};
#[doc(hidden)]
pub use element_data::{Edges, ElementKind, Faces, Vertices};
pub use error::{BuildError, CreaseError, InvariantError, MoveError, PolygonError, RefineError};
pub use face_list::FaceList;
pub use facts::{Distribution, Facts};
pub use follow_edits::{AcceptedEdit, FollowEdits};
pub use glam;
pub use glam::Vec3 as Point;
pub use handle::{Handle, HandleMap, HashHandleMap, Pair, RowMap};
pub use incidence::EdgeUse;
#[doc(hidden)]
pub use local_queries::CostsAreLocal;
pub use local_queries::LocalQueries;
pub use measured::Counts;
pub use memory::{MemoryFootprint, TableBytes};
pub use mesh_move::MeshMove;
pub use mesh_with_data::MeshWithData;
pub use numbering::Numbers;
pub use oriented_walk::{OrientedWalk, SideMap};
pub use polygon_mesh::PolygonMesh;
pub use query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
pub use refine::{Refine, Split};
pub use representation::{QueryCost, Relation, Representation};
pub use row_id::{EdgeId, FaceId, VertexId};

// For authors of structures.
pub use classes::Classes;
pub use distinct::{Distinct, DistinctWalk};
pub use edit_check::{check_corners, check_cut, check_rows};
pub use edit_log::uses_reports;
pub use editing::{
    Compact, EDGE_HOLES, Editable, Editing, FACE_HOLES, HoleSet, NoHoles, NoScatteredFaces,
    VERTEX_HOLES,
};
pub use face_spans::{FaceSpans, ScatteredFaces};
pub use faces_by_lowest::FacesByLowest;
pub use fans::Fans;
pub use holes::Holes;
pub use incidence::{EdgeSides, Incidence, Side};
pub use iterator_ext::{IteratorExt, MapInline};
pub use new_rows::NewRows;
pub use pairing::{LinkFaces, SideRows, TwinPairs, pair_triangle_sides};
pub use partition::Partition;
pub use ranks::Ranks;
pub use refine::{
    CHUNK_ROWS, all_rows, check_split, chunk_starts, for_each_chunk, map_chunks, rows_of_chunk,
};
pub use row_id::{MAX_ROWS, RowId, Slot, row};
pub use scan::hits_in;
pub use scan_edit::ScannedMesh;
pub use scanned::{Hit, ScannedFaces, ScannedVertex, SearchSet};
pub use short_vec::{Lookup, ShortVec};
pub use table::Table;
pub use threads::join;

// For measurements.
pub use measured::Measured;
pub use probe::{Access, AccessKind, Probe, Traced, Untraced};

/// The imports of a program that uses meshes: the traits with queries, walks, edits and refinement,
/// and the types in their signatures.
pub mod prelude {
    pub use crate::{
        BuildError, Compact, EdgeData, EdgeId, EdgeMap, EditError, EditLog, EditRecord, Editable,
        FaceData, FaceId, FaceMap, HandleMap, LocalQueries, MeshEdit, MeshMove, MeshQuery,
        MeshWithData, MoveError, Numbers, OldToNew, OrientedWalk, Point, PolygonMesh, Refine,
        Refusal, Representation, SideMap, VertexData, VertexId, VertexMap,
    };
}
