//! Tests that need several crates.

mod conformance;
mod edit_data;
mod editing;
mod equivalence;
mod face_and_edge_lists;
mod face_and_edge_walk;
mod facts;
mod opensubdiv;
mod operators;
mod real_meshes;
mod remeshing;
mod seventh_structure;
mod subdivision;
mod subdivision_laws;
