//! Bilinear: the faces of Catmull–Clark, and no smoothing.
//!
//! ```text
//!    d ─── m ─── c      a face point at the mean of the corners, edge points at the midpoints;
//!    │     │     │      old vertices stay
//!    m ─── f ─── m
//!    │     │     │      With a projection to a sphere, a cube becomes a quad sphere.
//!    a ─── m ─── b
//! ```

use mesh_core::{Point, Split};

use crate::mask::{Mask, midpoint};

/// Every face into quads, where it is.
#[derive(Clone, Copy)]
pub(crate) struct Bilinear;

impl Mask for Bilinear {
    const SPLIT: Split = Split::Quads;
    const APPROXIMATES: bool = false;
    const EDGES_SEE_FACES: bool = false;
    const VERTICES_SEE_FACES: bool = false;

    #[inline(always)]
    fn face(self, corners: Point, degree: usize) -> Point {
        corners / degree as f32
    }

    #[inline(always)]
    fn edge(self, ends: [Point; 2], _: Point) -> Point {
        midpoint(ends)
    }

    fn vertex(self, at: Point, _: usize, _: Point, _: Point) -> Point {
        at
    }
}
