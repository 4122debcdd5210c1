//! Bilinear: the faces of Catmull–Clark, without smoothing.
//!
//! ```text
//!    d ─── m ─── c      a face point at the mean of the corners, edge points at the midpoints;
//!    │     │     │      old vertices stay
//!    m ─── f ─── m
//!    │     │     │      With a projection to a sphere, a cube becomes a quad sphere.
//!    a ─── m ─── b
//! ```

use sixfold_core::{Point, Split};

use crate::mask::{Mask, midpoint};

#[derive(Clone, Copy)]
pub(crate) struct Bilinear;

impl Mask for Bilinear {
    const SPLIT: Split = Split::Quads;
    const APPROXIMATES: bool = false;
    const EDGES_USE_FACES: bool = false;
    const VERTICES_USE_FACES: bool = false;

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
}
