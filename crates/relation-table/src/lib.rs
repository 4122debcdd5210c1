//! Relation tables: relations of a mesh, stored as flat tables.
//!
//! Use relation tables if a program queries the same relations many times, and the connectivity of the mesh does
//! not change. Each row of a table is a slice, and consecutive rows are adjacent in memory. A table is built
//! in one sweep over the structure. A later edit of the mesh does not change the tables.
//!
//! [`RelationTables`] have the queries of every mesh: a program that is generic over
//! [`MeshQuery`](sixfold_core::MeshQuery) runs on them. [`Numbering`] builds single tables, whose rows are
//! slices. The row indices and the items of a table are numbers of elements.
//!
//! ```text
//!   offsets   0     3        7  …        row v of `vertex_faces` is items[offsets[v]..offsets[v + 1]];
//!             │     │        │           if all rows have one length, offsets are not stored:
//!   items     f4 f9 f2 f2 f7 f9 f1 …     row f of `face_vertices` is items[3 f..3 f + 3]
//! ```
//!
//! ```
//! use sixfold_core::Representation;
//! use sixfold_relation_table::Numbering;
//!
//! let mesh = sixfold_half_edge::HalfEdgeMesh::from_polygons(&sixfold_shapes::icosahedron())?;
//! let neighbours = Numbering::new(&mesh).vertex_vertices()?;
//! assert!(neighbours.iter().all(|(_, ring)| ring.len() == 5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod mesh;
mod numbering;
mod table;

pub use mesh::RelationTables;
pub use numbering::Numbering;
pub use table::{RelationTable, TabulationError};
