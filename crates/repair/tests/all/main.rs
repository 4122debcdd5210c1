//! Tests that repair whole meshes and use several structures.

mod laws;
mod real_meshes;
