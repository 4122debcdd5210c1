//! Tests that compare several spatial indices, or use a structure.

mod laws;
mod meshes;
