//! Bilinear and midpoint: the faces of Catmull–Clark and of Loop, without smoothing. Old vertices stay, and
//! edge points are midpoints.
//!
//! ```text
//!    bilinear                  midpoint
//!    d ─── m ─── c                   c
//!    │     │     │                  / \
//!    m ─── f ─── m                 m───m
//!    │     │     │                / \ / \
//!    a ─── m ─── b               a───m───b
//!    f: the mean of the corners
//! ```
//!
//! With a projection to a sphere, a cube becomes a quad sphere by the bilinear scheme, and an icosahedron
//! becomes a geodesic dome of frequency 2, 4, 8 … by the midpoint scheme.

use sixfold_core::{Point, Split};

use crate::mask::{Mask, midpoint};

/// The split of the faces.
#[derive(Clone, Copy)]
pub(crate) struct Linear(pub(crate) Split);

impl Mask for Linear {
    const APPROXIMATES: bool = false;
    const EDGES_USE_FACES: bool = false;
    const VERTICES_USE_FACES: bool = false;

    #[inline(always)]
    fn split(self) -> Split {
        self.0
    }

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

#[cfg(test)]
mod tests {
    use sixfold_core::{Creases, PolygonMesh};
    use sixfold_half_edge::HalfEdgeMesh;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::all_methods;
    use crate::{Method, Scheme, Subdivision, subdivide, subdivide_native};

    #[test]
    fn a_square_keeps_its_corners() {
        let corners = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 1.0), Point::Y];
        let square = PolygonMesh::new(corners, [[0, 1, 2, 3]]).expect("a quad");
        let (scheme, none) = (Subdivision::new(Scheme::Bilinear), Creases::default());
        let steps = [Method::Gather, Method::Scatter]
            .map(|method| subdivide::<IndexedFaceSet>(&scheme, method, &square, &none, 1));
        let native = subdivide_native::<HalfEdgeMesh>(&scheme, &square, &none, 1);
        for step in steps.into_iter().chain([native]) {
            let mesh = step.expect("a quad").polygons;
            let points = mesh.positions();
            assert_eq!(points[..4], corners);
            assert_eq!(points[4], Point::new(0.5, 0.5, 0.25));
            for middle in [
                [0.5, 0.0, 0.0],
                [1.0, 0.5, 0.5],
                [0.5, 1.0, 0.5],
                [0.0, 0.5, 0.0],
            ] {
                let middle = Point::from(middle);
                assert!(points[5..].contains(&middle), "{middle}");
            }
            assert_eq!([mesh.vertex_count(), mesh.face_count()], [9, 4]);
        }
    }

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
