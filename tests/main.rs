//! Tests that need several crates.

mod editing;
mod equivalence;
mod facts;
mod opensubdiv;
mod operators;
mod real_meshes;
mod remeshing;
mod seventh;
mod subdivision;
mod subdivision_laws;
