//! Tests that every structure implements the traits correctly.
//!
//! - [`Oracle`]: the expected answers, computed by brute force from the input faces only.
//! - [`law`]: the requirements on every structure. Each requirement is a function, which is called
//!   a law.
//! - [`gallery`]: small meshes made by hand, one for each corner case.
//! - [`strategy`]: random manifolds of any topology, meshes with known faults, and meshes of random
//!   faces. The meshes are shrunk when a law fails.
//! - [`edit`]: a model of edits, random scripts of edits, and a test that compares a structure with
//!   the model.
//! - [`suite!`]: a macro that makes one `#[test]` for each law.
//!
//! A structure is tested with one line in a test of its crate:
//!
//! ```text
//! sixfold_conformance::suite!(your_mesh::YourMesh);
//! ```
//!
//! The six structures of Sixfold are tested in `tests/conformance.rs` of the workspace.
//!
//! This crate does not use the incidence code of `sixfold-core`, because the laws test that code.

mod answers;
mod boundary;
mod catch_panic;
pub mod edit;
mod element;
mod expected_check;
mod folds;
mod gallery;
pub mod law;
mod oracle;
mod print;
mod shrink;
pub mod strategy;
mod subject;
mod suite;
mod weld;

pub use answers::answers;
pub use element::Element;
pub use expected_check::expected_check;
pub use folds::check_fold;
pub use gallery::{GalleryMesh, gallery};
pub use oracle::Oracle;
pub use print::one_line;
pub use suite::check_law;
pub use weld::welded;
