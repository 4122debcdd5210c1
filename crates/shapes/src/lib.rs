//! Meshes that are built by formula. The table shows the numbers V of vertices, E of edges and F of
//! faces, and χ = V − E + F. The letters m, n, f, g and h are parameters of the shape.
//!
//! | shape | V | E | F | χ |
//! |---|---|---|---|---|
//! | [`tetrahedron`] | 4 | 6 | 4 | 2 |
//! | [`cube`] | 8 | 12 | 6 | 2 |
//! | [`octahedron`] | 6 | 12 | 8 | 2 |
//! | [`dodecahedron`] | 20 | 30 | 12 | 2 |
//! | [`icosahedron`] | 12 | 30 | 20 | 2 |
//! | [`prism`] | 2n | 3n | n + 2 | 2 |
//! | [`antiprism`] | 2n | 4n | 2n + 2 | 2 |
//! | [`uv_sphere`] | m(n − 1) + 2 | m(2n − 1) | mn | 2 |
//! | [`geodesic`] | 10f² + 2 | 30f² | 20f² | 2 |
//! | [`torus`] | mn | 2mn | mn | 0 |
//! | [`triangle_torus`] | mn | 3mn | 2mn | 0 |
//! | [`genus`] | 16(g + 1) | 36g + 28 | 18g + 14 | 2 − 2g |
//! | [`moebius`] | 2n | 3n | n | 0 |
//! | [`grid`], [`bezier_patch`], [`b_spline_patch`] | (m + 1)(n + 1) | 2mn + m + n | mn | 1 |
//! | [`triangle_grid`], [`triangle_tiling`] | (m + 1)(n + 1) | 3mn + m + n | 2mn | 1 |
//! | [`mixed_grid`], c = ⌊mn/2⌋ | (m + 1)(n + 1) | 2mn + m + n + c | mn + c | 1 |
//! | [`hexagon_tiling`] | 2(m + 1)(n + 1) − 2 | 3mn + 2m + 2n − 1 | mn | 1 |
//! | [`grid_with_hole`], a = ⌊m/3⌋, b = ⌊n/3⌋ | (m + 1)(n + 1) − (a − 1)(b − 1) | 2mn + m + n − 2ab + a + b | mn − ab | 0 |
//! | [`grid_with_holes`], h holes | (m + 1)(n + 1) | 2mn + m + n | mn − h | 1 − h |
//! | [`implicit`] surfaces, [`built_in_mesh`] | F/2 + χ | 3F/2 | F | by topology |
//!
//! Faces of closed shapes are oriented outward. Faces of flat shapes run counter-clockwise as seen
//! from above. No two vertices have the same position, except in some patches. A shape is the same
//! on every machine, because the code calls no trigonometric function of the platform. If a
//! parameter is outside its documented range, the function of the shape returns a [`ShapeError`]
//! without allocating memory. [`Order`] changes the order of the elements of any mesh.
//! [`GENERATORS`] lists all shapes by name.
//!
//! ```
//! use sixfold_core::Facts;
//!
//! let torus = sixfold_shapes::generator("torus").expect("a shape of that name");
//! let mesh = torus.build(&[("m", 40.0), ("n", 20.0)])?;
//! assert_eq!(mesh, sixfold_shapes::torus(40, 20)?);
//! assert_eq!(Facts::from_polygons(&sixfold_shapes::morton(&mesh)).genus, Some(1));
//! # Ok::<(), sixfold_shapes::ShapeError>(())
//! ```

mod arithmetic;
mod bounds;
mod builder;
mod built_in_mesh;
mod error;
mod fitting;
mod generator;
mod genus;
mod geodesic;
pub mod implicit;
mod marching;
mod node;
mod order;
mod patch;
mod planar;
mod platonic;
mod solids;
mod surfaces;

pub use built_in_mesh::built_in_mesh;
pub use error::ShapeError;
pub use generator::{GENERATORS, Generator, Parameter, generator};
pub use genus::genus;
pub use geodesic::geodesic;
pub use order::{Order, Reordered, breadth_first, morton, shuffled};
pub use patch::{ControlNet, b_spline_patch, bezier_patch};
pub use planar::{
    grid, grid_with_hole, grid_with_holes, hexagon_tiling, mixed_grid, triangle_grid,
    triangle_tiling,
};
pub use platonic::{cube, dodecahedron, icosahedron, octahedron, tetrahedron};
pub use solids::{antiprism, prism, uv_sphere};
pub use surfaces::{moebius, torus, triangle_torus};
