//! Subdivision: schemes written once, run on any structure, in three ways.
//!
//! - [`Scheme`]: what schemes there are, and [`Kind`] the classification of each.
//! - [`Subdivision`]: a scheme with its options; one step by [`gather`](Subdivision::gather),
//!   [`scatter`](Subdivision::scatter) or [`refine_into`](Subdivision::refine_into).
//! - [`subdivide`], [`subdivide_native`]: several steps from polygons to polygons.
//! - [`Extent`]: how large the result will be, before it is made.
//! - [`limit`](Subdivision::limit): where vertices go in endless levels, as [`LimitPoint`]s.
//! - [`cubic_b_spline`], [`chaikin`]: the same for curves; [`ControlGrid`]: for curves of curves.
//! - [`refine_locally`]: triangles split where a [`Selection`] says, and conforming all the same.
//!
//! The weights of each scheme stand in a file of its own; what is sharp is placed afterwards, for all
//! schemes and methods in one place (`crease.rs`).

#[cfg(test)]
mod alike;
mod bilinear;
mod butterfly;
mod catmull_clark;
mod control;
mod crease;
mod curve;
mod doo_sabin;
mod error;
mod extent;
mod gather;
mod levels;
mod limit;
mod local;
mod loop_scheme;
mod manifold;
mod mask;
mod midpoint;
mod native;
mod options;
mod patch;
mod scatter;
mod scheme;
mod select;
mod sheet;
mod sqrt3;
mod step;
mod subdivision;
mod tangent;

pub use control::renumbered;
pub use curve::{Ends, chaikin, cubic_b_spline, cubic_b_spline_at};
pub use error::{CurveError, LocalError, SubdivisionError};
pub use extent::Extent;
pub use levels::{built, subdivide, subdivide_native};
pub use limit::{LimitNormal, LimitPoint, NoLimit};
pub use local::{LocalMesh, refine_locally};
pub use options::{Boundary, Creasing, LoopWeights};
pub use patch::ControlGrid;
pub use scheme::{Kind, Method, Primitive, Scheme};
pub use select::Selection;
pub use step::Step;
pub use subdivision::Subdivision;
