//! Subdivision schemes. The code of each scheme runs on any mesh structure, by up to three methods
//! (gather, scatter, native).
//!
//! - [`Scheme`]: the list of schemes. [`SchemeProperties`]: the properties of a scheme.
//! - [`Subdivision`]: a scheme with its options. [`gather`](Subdivision::gather),
//!   [`scatter`](Subdivision::scatter) and [`refine_into`](Subdivision::refine_into) run one step.
//! - [`subdivide`] and [`subdivide_native`] run several steps. The input and the result are polygon
//!   meshes.
//! - [`Extent`]: the size of the result, computed in advance.
//! - [`limit`](Subdivision::limit): the limit positions and normals of the vertices, as
//!   [`LimitPoint`]s.
//! - [`cubic_b_spline`] and [`chaikin`]: subdivision of curves. [`ControlGrid`]: subdivision of
//!   tensor-product patches.
//! - [`refine_locally`]: splits the triangles of a [`Selection`] and keeps the mesh conforming,
//!   which means that no vertex lies inside an edge.
//!
//! The weights of each scheme are in the file of the scheme. The file `crease.rs` computes the
//! points at sharp edges and vertices for every scheme with creases.

mod butterfly;
mod catmull_clark;
mod connectivity;
mod control;
mod crease;
mod curve;
mod doo_sabin;
mod error;
mod extent;
mod gather;
mod levels;
mod limit;
mod linear;
mod local;
mod loop_scheme;
mod manifold;
mod mask;
mod native;
mod options;
mod patch;
mod scatter;
mod scheme;
mod select;
mod sqrt3;
mod step;
mod subdivision;
mod tangent;
#[cfg(test)]
mod test_support;

pub use control::renumbered;
pub use curve::{Ends, chaikin, cubic_b_spline, cubic_b_spline_at};
pub use error::{CurveError, LocalError, SubdivisionError};
pub use extent::Extent;
pub use levels::{
    build_level, subdivide, subdivide_by, subdivide_native, subdivide_native_watched,
    subdivide_watched,
};
pub use limit::{LimitNormal, LimitPoint, NoLimit};
pub use local::{LocalMesh, refine_locally};
pub use options::{BoundaryRule, Creasing, LoopWeights};
pub use patch::ControlGrid;
pub use scheme::{FaceKind, Method, Primitive, Scheme, SchemeProperties};
pub use select::Selection;
pub use step::Step;
pub use subdivision::Subdivision;
