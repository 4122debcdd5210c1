//! Tests of the public functions of the crate. `memory.rs` and `mutations.rs` are programs of their own,
//! because their allocator counts the bytes of the whole program.

mod creases;
mod formats;
mod gltf;
mod properties;
mod real_meshes;
mod repeated_corners;
mod round_trips;
mod rules;
