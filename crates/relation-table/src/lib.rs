//! Relation tables: what a program asks of a mesh again and again, written down once, end to end.
//!
//! Choose them for many sweeps over a mesh that does not change: a row is a slice, and the rows of
//! a sweep lie in memory one after the other, whatever structure they were asked of. Making one takes
//! one sweep over that structure. They know nothing of edits. Start at [`Numbering`], which gives the
//! elements the numbers that rows and items go by.
//!
//! ```text
//!   offsets   0     3        7  …        row v of `vertex_faces` is items[offsets[v]..offsets[v + 1]];
//!             │     │        │           where all rows are equally long there are no offsets, and
//!   items     f4 f9 f2 f2 f7 f9 f1 …     row f of `face_vertices` is items[3 f..3 f + 3]
//! ```
//!
//! ```
//! use mesh_core::Representation;
//! use relation_table::Numbering;
//!
//! let mesh = half_edge::HalfEdgeMesh::from_polygons(&shapes::icosahedron())?;
//! let neighbours = Numbering::of(&mesh).vertex_vertices()?;
//! assert!(neighbours.iter().all(|(_, ring)| ring.len() == 5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod numbering;
mod table;

pub use numbering::Numbering;
pub use table::{RelationTable, TabulationError};
