//! Catmull–Clark: every face into quads, approximating, C² but at extraordinary vertices.
//!
//! Catmull & Clark (1978). Any polygons come in; after one step all faces are quads, and a face of
//! degree n has left a vertex of valence n. Creases after DeRose, Kass & Truong (1998).
//!
//! ```text
//!     face point            edge point              vertex point, valence n
//!
//!    1/n ───── 1/n          1/16 ─── 1/16              f1 ── e1 ── f2
//!     │         │            │        │                │     │     │      (n − 2)/n  the vertex
//!     │    f    │           3/8 ──e── 3/8              e4 ── v ── e2      1/n²       each neighbour e
//!     │         │            │        │                │     │     │      1/n²       each face point f
//!    1/n ───── 1/n          1/16 ─── 1/16              f4 ── e3 ── f3
//!                         (a + b + both face points)/4
//! ```

use mesh_core::{Point, Split};

use crate::mask::Mask;

/// The weights of Catmull & Clark (1978).
#[derive(Clone, Copy)]
pub(crate) struct CatmullClark;

impl Mask for CatmullClark {
    const SPLIT: Split = Split::Quads;
    const APPROXIMATES: bool = true;
    const EDGES_SEE_FACES: bool = true;
    const VERTICES_SEE_FACES: bool = true;

    #[inline(always)]
    fn face(self, corners: Point, degree: usize) -> Point {
        corners / degree as f32
    }

    #[inline(always)]
    fn edge(self, [a, b]: [Point; 2], faces: Point) -> Point {
        (a + b + faces) * 0.25
    }

    #[inline(always)]
    fn vertex(self, at: Point, valence: usize, neighbours: Point, faces: Point) -> Point {
        let n = valence as f32;
        let share = 1.0 / n;
        at * ((n - 2.0) * share) + (neighbours + faces) * (share * share)
    }
}

#[cfg(test)]
mod tests {
    use half_edge::HalfEdgeMesh;
    use indexed_face_set::IndexedFaceSet;
    use mesh_core::{Creases, PolygonMesh};

    use super::*;
    use crate::{Method, Scheme, Subdivision, subdivide, subdivide_native};

    /// A cube from −1 to 1; corner `i` has the coordinates that its bits say.
    fn cube() -> PolygonMesh {
        let corners: [Point; 8] = std::array::from_fn(|bits| {
            let axis = |bit: usize| (bits >> bit & 1) as f32 * 2.0 - 1.0;
            Point::new(axis(0), axis(1), axis(2))
        });
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        PolygonMesh::new(corners, faces).expect("valid")
    }

    #[test]
    fn a_cube_goes_where_the_paper_says() {
        let scheme = Subdivision::new(Scheme::CatmullClark);
        let none = Creases::default();
        let steps = [Method::Gather, Method::Scatter].map(|method| {
            let step = subdivide::<IndexedFaceSet>(&scheme, method, &cube(), &none, 1, |_, _| ());
            step.expect("a cube")
        });
        let native = subdivide_native::<HalfEdgeMesh>(&scheme, &cube(), &none, 1, |_, _| ());
        for step in steps.into_iter().chain(native) {
            let points = step.polygons.positions();
            let near = |a: Point, b: Point| a.distance(b) < 1e-6;
            for (corner, point) in cube().positions().iter().zip(points) {
                assert!(near(*point, *corner * (5.0 / 9.0)), "{point}");
            }
            // Face points at the centres, edge points at (3/4, 3/4, 0) and the like.
            assert!(points[8..14].iter().all(|p| p.length() == 1.0));
            for p in &points[14..] {
                let mut sizes = p.abs().to_array();
                sizes.sort_by(f32::total_cmp);
                assert_eq!(sizes, [0.0, 0.75, 0.75]);
            }
            assert_eq!([points.len(), step.polygons.face_count()], [26, 24]);
        }
    }
}
