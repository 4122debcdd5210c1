//! Tests that need whole meshes and several structures.

mod limit;
mod local;
