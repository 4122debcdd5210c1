//! Tests of what is shown.

mod edits;
mod engine;
mod kept_meshes;
mod records;
mod traces;
mod walks;
