//! Tests that need whole meshes and several structures; one binary.

mod limit;
mod local;
