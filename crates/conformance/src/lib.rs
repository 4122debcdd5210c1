//! Tests that every structure implements the traits correctly.
//!
//! - [`Oracle`]: the expected answers, computed by brute force from the input faces only.
//! - [`law`]: the requirements on every structure, one function per law.
//! - [`gallery`]: small meshes made by hand, one for each corner case.
//! - [`strategy`]: random meshes that shrink: manifolds of any topology, known faults, random
//!   faces.
//! - [`edit`]: the model, the random scripts and the trial that test edits.
//! - [`suite!`]: a macro that makes one `#[test]` from each law.
//!
//! A structure is tested with one line in its `tests/conformance.rs`:
//!
//! ```text
//! sixfold_conformance::suite!(half_edge::HalfEdgeMesh);
//! ```
//!
//! This crate does not use the incidence code of `sixfold-core`, because that code is tested too.

mod answers;
mod caught;
pub mod edit;
mod element;
mod gallery;
pub mod law;
mod oracle;
mod print;
mod shrink;
pub mod strategy;
mod subject;
mod suite;
mod verdict;
mod weld;

pub use answers::answers;
pub use element::Element;
pub use gallery::{Specimen, gallery};
pub use oracle::Oracle;
pub use print::compact;
pub use suite::hold;
pub use verdict::verdict;
pub use weld::welded;
