//! Spatial indices as timed backends.

mod index;
mod queries;

pub use index::{Built, IndexKind, KINDS, LIST};
pub use queries::{Input, MAX_QUERIES, Triangle, Vertex};
