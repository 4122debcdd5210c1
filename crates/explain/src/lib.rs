//! Shows how mesh data structures store a mesh.
//!
//! [`Structure`] builds a structure from a mesh. The [`BuiltMesh`] has the [`Records`] of its tables: one row
//! for each vertex, edge, half-edge, face or corner, with the names that textbooks use for the fields.
//! The values come from the tables of the structure, through [`Described`](sixfold_core::Described).
//! A [`Trace`] has the reads of a query, each with its [`Reason`], and an [`EditTrace`] has the rows
//! before and after an edit. The queries and edits are those that programs run; a probe records their
//! reads and writes. [`respond`] answers requests about all of this in JSON. The crate does no input and
//! output.
//!
//! ```
//! use sixfold::{Relation, shapes};
//! use sixfold_explain::{Step, Structure};
//!
//! let half_edge = Structure::find("half-edge").expect("one of six");
//! let cube = half_edge.build(&shapes::cube())?;
//! let records = cube.records(0..2);
//! let half_edges = records.iter().find(|records| records.element == "half-edge");
//! let half_edges = half_edges.expect("a table");
//! assert_eq!((half_edges.total, half_edges.rows.len()), (24, 2));
//! assert_eq!(half_edges.columns[0].name, "origin");
//! assert_eq!(half_edges.rows[1].name, "h1");
//!
//! let trace = cube.trace(Relation::VertexVertices, "v3".parse()?)?;
//! assert_eq!((trace.results.len(), trace.cost.reads), (3, 4));
//! let Step::Read(second) = &trace.steps[1] else { unreachable!("a walk begins with two reads") };
//! assert_eq!((second.row.as_str(), second.reason.text.as_str()), ("h0", "twin of h1"));
//!
//! let mut octahedron = half_edge.build(&shapes::octahedron())?;
//! let flip = octahedron.edit(&"flip_edge v0-v2".parse()?)?;
//! assert!(flip.rows.iter().any(|row| row.is_changed()));
//! # Ok::<(), sixfold_explain::ExplainError>(())
//! ```

mod built_mesh;
mod edit;
mod engine;
mod error;
mod memory;
mod named_mesh;
mod reason;
mod records;
mod structure;
mod sweep;
mod trace;
mod walk;
mod walk_parser;

pub use built_mesh::{BuiltMesh, Geometry};
pub use edit::{EditTrace, Elements, ReadRows, RowChange};
pub use engine::{Engine, respond};
pub use error::{ExplainError, Refused};
pub use memory::{Memory, Symbol, TableMemory};
pub use reason::Reason;
pub use records::{Record, RecordColumn, Records};
pub use sixfold_core::{EditByName, EditTextError, ElementName, NoElementName};
pub use structure::Structure;
pub use trace::{Cost, Query, Read, Step, Trace};
pub use walk::{Comparison, Walk};
