//! The traits of meshes.

pub(crate) mod boundary;
pub(crate) mod convert;
pub(crate) mod described;
pub mod invariant_checks;
pub(crate) mod local_queries;
pub(crate) mod measured;
pub(crate) mod mesh_move;
pub(crate) mod oriented_walk;
pub(crate) mod query;
pub(crate) mod refine;
pub(crate) mod representation;
pub(crate) mod row_handles;
pub(crate) mod split;
