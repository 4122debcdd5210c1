//! The tables of structures, holes in them, and helpers to fill them.

pub(crate) mod clone_by_field;
pub(crate) mod editing;
pub(crate) mod face_spans;
pub(crate) mod holes;
pub(crate) mod memory;
pub(crate) mod mesh_tables;
pub(crate) mod pairing;
pub(crate) mod probe;
pub(crate) mod ranks;
pub(crate) mod sides;
pub(crate) mod table;
pub(crate) mod threads;
