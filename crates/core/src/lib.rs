//! Shared vocabulary of Sixfold: the traits and types that all structures, algorithms and tools
//! use.
//!
//! - [`PolygonMesh`]: the neutral input and output; positions, and faces as index lists.
//! - [`MeshQuery`]: the nine relations of Weiler (1985) and their contract.
//! - [`Representation`]: one structure; its capabilities, its construction and its memory.
//! - [`LocalQueries`]: the bound of algorithms that refuse structures whose queries scan.
//! - [`Handle`] and [`HandleMap`]: handles of elements, and data stored by handle; [`Numbers`]:
//!   numbers of elements from 0.
//! - [`BoundaryLoop`]: a chain of boundary edges.
//! - [`BuildError`]: why a structure refuses a mesh; [`Capabilities`] checks it in one place.
//! - [`Table`] and [`Probe`]: storage whose reads and writes can be observed.
//! - [`Refine`] and [`Split`]: structures that split every face in their own tables.
//! - [`MeshEdit`], [`EditRecord`] and [`EditError`]: edits in place, the record of created, removed
//!   and renamed elements, and why an edit is refused; [`Holes`]: the rows of deleted elements.
//! - [`Compact`] and [`Editable`]: type parameters of meshes without and with deletion.
//! - [`ScannedFaces`]: queries and edits of structures that find the faces at a vertex by a scan.
//! - [`Creases`]: the sharpness of edges and vertices under subdivision.
//! - [`Facts`]: the exact topology of a face list, independent of any structure.
//!
//! This crate does not depend on any of the six structures.

mod boundary;
mod capability;
mod clone_by_field;
mod creases;
mod distinct;
mod edit;
mod edit_error;
mod edit_log;
mod editing;
mod error;
mod face_list;
mod face_spans;
mod facts;
mod handle;
mod holes;
mod incidence;
mod local_queries;
mod measured;
mod memory;
mod numbering;
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

pub use boundary::BoundaryLoop;
pub use capability::Capabilities;
pub use creases::{Creases, SHARPNESS_INFINITE};
pub use distinct::{Distinct, DistinctWalk, IteratorExt};
pub use edit::{Edit, MeshEdit, Refusal};
pub use edit_error::EditError;
pub use edit_log::{Changes, EditLog, EditRecord, OldToNew};
pub use editing::{
    Compact, EDGE_HOLES, Editable, Editing, FACE_HOLES, HoleSet, NoHoles, NoScatteredFaces,
    VERTEX_HOLES,
};
pub use error::{BuildError, CreaseError, InvariantError, MoveError, PolygonError, RefineError};
pub use face_list::FaceList;
pub use face_spans::{FaceSpans, ScatteredFaces};
pub use facts::{Distribution, Facts};
pub use glam;
pub use glam::Vec3 as Point;
pub use handle::{Handle, HandleMap, HashHandleMap, Pair, RowMap};
pub use holes::Holes;
pub use incidence::EdgeUse;
#[doc(hidden)]
pub use local_queries::CostsAreLocal;
pub use local_queries::LocalQueries;
pub use measured::{Counts, Measured};
pub use memory::{MemoryFootprint, TableBytes};
pub use numbering::Numbers;
pub use pairing::{SideRows, TwinPairs, pair_triangle_sides};
pub use polygon_mesh::PolygonMesh;
pub use probe::{Access, AccessKind, Probe, Traced, Untraced};
pub use query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
pub use ranks::Ranks;
pub use refine::{
    CHUNK_ROWS, Refine, Split, all_rows, check_split, chunk_starts, for_each_chunk, map_chunks,
    rows_of_chunk,
};
pub use representation::{QueryCost, Relation, Representation};
pub use row_id::{EdgeId, FaceId, MAX_ROWS, RowId, Slot, VertexId, row};
pub use scan::hits_in;
pub use scan_edit::ScannedMesh;
pub use scanned::{Hit, ScannedFaces, ScannedVertex, SearchSet};
pub use short_vec::{Lookup, ShortVec};
pub use table::Table;

/// The imports of a program that uses meshes: the traits with queries, edits and refinement, and
/// the types in their signatures.
pub mod prelude {
    pub use crate::{
        BuildError, EdgeId, EdgeMap, EditError, EditLog, EditRecord, FaceId, FaceMap, LocalQueries,
        MeshEdit, MeshQuery, Point, PolygonMesh, Refine, Representation, VertexId, VertexMap,
    };
}
