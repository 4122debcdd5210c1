//! Shows how mesh data structures store a mesh.
//!
//! [`Structure`] builds a structure from a mesh and returns the [`Records`] of its tables: one row
//! for each vertex, edge, half-edge, face or corner, with the names that textbooks use for the fields.
//! The values come from the tables of the structure, through [`Described`](sixfold_core::Described).
//! The crate does no input and output.
//!
//! ```
//! use sixfold::shapes;
//! use sixfold_explain::Structure;
//!
//! let half_edge = Structure::find("half-edge").expect("one of six");
//! let records = half_edge.records(&shapes::cube(), 0..2)?;
//! let half_edges = records.iter().find(|records| records.element == "half-edge");
//! let half_edges = half_edges.expect("a table");
//! assert_eq!((half_edges.total, half_edges.rows.len()), (24, 2));
//! assert_eq!(half_edges.columns[0].name, "origin");
//! assert_eq!(half_edges.rows[1].name, "h1");
//! # Ok::<(), sixfold_explain::ExplainError>(())
//! ```

mod records;
mod structure;

pub use records::{Record, RecordColumn, Records};
pub use structure::{ExplainError, Structure};
