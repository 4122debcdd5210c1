//! What needs whole meshes and several structures; one binary.

mod limit;
mod local;
