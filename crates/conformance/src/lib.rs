//! The proof that every representation holds the same mesh.
//!
//! - [`Oracle`]: every answer, worked out from the input faces alone by brute force.
//! - [`law`]: what each representation must keep, one plain function a law.
//! - [`gallery`]: small meshes made by hand, one for each corner case.
//! - [`strategy`]: random meshes that shrink: manifolds of any topology, known faults, chaos.
//! - [`edit`]: the model, the random scripts and the trial that hold edits to account.
//! - [`suite!`]: one line that makes one `#[test]` of each law.
//!
//! A representation takes part with one line in its `tests/conformance.rs`:
//!
//! ```text
//! conformance::suite!(half_edge::HalfEdgeMesh);
//! ```
//!
//! Nothing here uses the incidence code of `mesh-core`, which is on trial as well.

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
