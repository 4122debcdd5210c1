//! Spatial indices as timed backends.

mod index;
mod queries;
mod tasks;

pub use index::{Built, IndexKind, KINDS, LIST};
pub use queries::{Input, MAX_QUERIES, QueryPoints, Triangle, Vertex};
pub use tasks::{EIGHT, SpatialTask};
