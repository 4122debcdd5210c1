//! Midpoint: every triangle into four, and no smoothing.
//!
//! ```text
//!        c            edge points at the midpoints; old vertices stay
//!       / \
//!      m───m          With a projection to a sphere, an icosahedron becomes a geodesic dome of
//!     / \ / \         frequency 2, 4, 8 …
//!    a───m───b
//! ```

use mesh_core::{Point, Split};

use crate::mask::{Mask, midpoint};

/// Every triangle into four, where it is.
#[derive(Clone, Copy)]
pub(crate) struct Midpoint;

impl Mask for Midpoint {
    const SPLIT: Split = Split::Triangles;
    const APPROXIMATES: bool = false;
    const EDGES_SEE_FACES: bool = false;
    const VERTICES_SEE_FACES: bool = false;

    fn face(self, corners: Point, _: usize) -> Point {
        corners
    }

    #[inline(always)]
    fn edge(self, ends: [Point; 2], _: Point) -> Point {
        midpoint(ends)
    }

    fn vertex(self, at: Point, _: usize, _: Point, _: Point) -> Point {
        at
    }
}
