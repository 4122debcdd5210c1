//! Tests of what is shown.

mod edits;
mod engine;
mod kept_meshes;
mod memory_and_welding;
mod records;
mod traces;
mod walks;
