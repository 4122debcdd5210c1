//! Edits on trial: a model that does them on plain lists, random scripts, and a structure beside it.
//!
//! The model knows no structure: faces are lists of numbers, and every rule of
//! [`MeshEdit`](mesh_core::MeshEdit) is written out by brute force. A script is a list of steps that
//! find their elements in whatever mesh they meet, so that a script with steps left out is a script
//! still, and a failing one shrinks.

mod action;
mod model;
mod relations;
mod script;
mod trial;

pub use action::Action;
pub use model::{Model, Rules};
pub use script::{Step, script};
pub use trial::Trial;
