//! Tests that need several crates.

mod edit_data;
mod editing;
mod equivalence;
mod facts;
mod opensubdiv;
mod operators;
mod real_meshes;
mod remeshing;
mod seventh_structure;
mod subdivision;
mod subdivision_laws;
