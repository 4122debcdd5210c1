//! Midpoint: splits every triangle into four, without smoothing.
//!
//! ```text
//!        c            edge points at the midpoints; old vertices stay
//!       / \
//!      m───m          With a projection to a sphere, an icosahedron becomes a geodesic dome of
//!     / \ / \         frequency 2, 4, 8 …
//!    a───m───b
//! ```

use sixfold_core::{Point, Split};

use crate::mask::{Mask, midpoint};

#[derive(Clone, Copy)]
pub(crate) struct Midpoint;

impl Mask for Midpoint {
    const SPLIT: Split = Split::Triangles;
    const APPROXIMATES: bool = false;
    const EDGES_USE_FACES: bool = false;
    const VERTICES_USE_FACES: bool = false;

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

#[cfg(test)]
mod tests {
    use sixfold_core::PolygonMesh;

    use super::*;
    use crate::Scheme;
    use crate::test_support::all_methods;

    #[test]
    fn a_triangle_keeps_its_corners() {
        let corners = [Point::ZERO, Point::X, Point::Y];
        let triangle = PolygonMesh::new(corners, [[0, 1, 2]]).expect("a triangle");
        for mesh in all_methods(Scheme::Midpoint, &triangle, 0).expect("a triangle") {
            assert_eq!(mesh.positions()[..3], corners);
            for middle in [[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]] {
                let middle = Point::new(middle[0], middle[1], 0.0);
                assert!(mesh.positions()[3..].contains(&middle), "{middle}");
            }
            assert_eq!([mesh.vertex_count(), mesh.face_count()], [6, 4]);
        }
    }
}
