//! Tests of edits. The tests apply the same random sequence of edits (a *script*) to a structure
//! and to a model, and compare the results.
//!
//! The model is independent of any structure: faces are lists of numbers, and every rule of
//! [`MeshEdit`](sixfold_core::MeshEdit) is implemented by brute force. A step of a script selects
//! its elements from the current mesh. So a script that makes a test fail can be shrunk by leaving
//! out steps.

mod action;
mod apply;
mod model;
mod model_test;
mod relations;
mod script;

pub use action::Action;
pub(crate) use apply::{apply_action, translated};
pub(crate) use model::sides;
pub use model::{Model, Rules};
pub use model_test::ModelTest;
pub(crate) use model_test::canonical_rotation;
pub use script::{Step, script};
