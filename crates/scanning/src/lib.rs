//! Queries and edits of structures that store no neighbours: they scan all corners.
//!
//! [`ScannedFaces`] has the corners of all faces in one table. It finds the faces at a vertex or
//! along an edge in one pass over this table, and edits the faces. The indexed face set and the
//! polygon soup store their faces in this form; their vertices are of different kinds
//! ([`ScannedVertex`]).
//!
//! - [`ScannedFaces`]: the faces, their queries and their edits.
//! - [`ScannedVertex`]: the handle of a vertex, and how a corner stores it.
//! - [`SearchSet`]: the vertices that one scan searches for; [`Hit`]: a corner that a scan finds.
//! - [`scan()`] and [`hits_in`]: the scan of any table.

mod algorithms;
mod describe;
mod scan;
mod scan_edit;
mod scanned;

pub use algorithms::algorithm_of;
pub use scan::{hits_in, scan};
pub use scan_edit::ScannedMesh;
pub use scanned::{Hit, ScannedFaces, ScannedVertex, SearchSet};
