//! The vocabulary of Sixfold: what every representation, algorithm and tool says the same way.
//!
//! - [`PolygonMesh`]: the neutral input and output, positions and faces as index lists.
//! - [`MeshQuery`]: the nine relations of Weiler (1985) and their contract.
//! - [`Representation`]: one data structure; what it can hold, how it is built, what it weighs.
//! - [`Handle`] and [`HandleMap`]: how a structure names its elements, and data kept by name.
//! - [`BuildError`]: why a structure refuses a mesh; [`Capabilities`] decides it in one place.
//! - [`Table`] and [`Probe`]: storage whose reads and writes can be watched.
//! - [`Refine`] and [`Split`]: structures that split every face in their own tables.
//! - [`MeshEdit`], [`EditRecord`] and [`EditError`]: changing a mesh in place, what became of its
//!   names, and why not; [`Holes`]: the rows that deleting leaves.
//! - [`Whole`] and [`Editable`]: meshes of which nothing can be deleted, and the others, as types.
//! - [`ScannedFaces`]: queries and edits of structures that find the faces at a vertex by a scan.
//! - [`Creases`]: how sharp edges and vertices stay under subdivision.
//! - [`Facts`]: the topology of a face list, exact and independent of any structure.
//!
//! Nothing here knows any one of the six structures.

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
mod few;
mod handle;
mod holes;
mod incidence;
mod memory;
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
mod sides;
mod table;

pub use capability::Capabilities;
pub use creases::{Creases, SHARP_FOR_EVER};
pub use distinct::{Distinct, DistinctWalk, IteratorExt};
pub use edit::{Edit, MeshEdit, Refusal};
pub use edit_error::EditError;
pub use edit_log::{Changes, EditLog, EditRecord, OldToNew};
pub use editing::{
    EDGE_HOLES, Editable, Editing, FACE_HOLES, HoleSet, NoFaces, NoHoles, VERTEX_HOLES, Whole,
};
pub use error::{BuildError, CreaseError, InvariantError, MoveError, PolygonError, RefineError};
pub use face_list::FaceList;
pub use face_spans::{FaceSpans, ScatteredFaces};
pub use facts::{Facts, Spread};
pub use few::{Few, Lookup};
pub use glam::Vec3 as Point;
pub use handle::{Handle, HandleMap, HashHandleMap, Pair, RowMap};
pub use holes::Holes;
pub use incidence::EdgeUse;
pub use memory::{MemoryFootprint, TableBytes};
pub use pairing::{SideRows, TwinPairs, pair_triangle_sides};
pub use polygon_mesh::PolygonMesh;
pub use probe::{Access, AccessKind, Probe, Traced, Untraced};
pub use query::{EdgeMap, FaceMap, MeshQuery, VertexMap};
pub use ranks::Ranks;
pub use refine::{
    PART, Refine, Split, all_rows, check_split, in_given_parts, in_parts, row_parts, rows_of_part,
};
pub use representation::{Counts, QueryCost, Relation, Representation};
pub use row_id::{EdgeId, FaceId, MAX_ROWS, RowId, Slot, VertexId, row};
pub use scan::hits_in;
pub use scan_edit::ScannedMesh;
pub use scanned::{Hit, ScannedFaces, ScannedVertex, Sought};
pub use table::Table;
