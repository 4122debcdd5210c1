//! What needs several crates at once.

mod equivalence;
mod facts;
mod real_meshes;
mod seventh;
