//! Catmull–Clark: splits every face into quads. The scheme is approximating, and the limit surface
//! is C² except at extraordinary vertices.
//!
//! The scheme is that of Catmull & Clark (1978). The input may have polygons of any degree. After
//! one step, all faces are quads. The face point of a face of degree n becomes a vertex of valence
//! n. Creases follow DeRose, Kass & Truong (1998).
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

use sixfold_core::{Point, Split};

use crate::mask::Mask;

/// The weights of Catmull & Clark (1978).
#[derive(Clone, Copy)]
pub(crate) struct CatmullClark;

impl Mask for CatmullClark {
    const APPROXIMATES: bool = true;
    const EDGES_USE_FACES: bool = true;
    const VERTICES_USE_FACES: bool = true;

    #[inline(always)]
    fn split(self) -> Split {
        Split::Quads
    }

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
    use sixfold_core::{Creases, PolygonMesh};
    use sixfold_half_edge::HalfEdgeMesh;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::assert_near;
    use crate::{BoundaryRule, Method, Scheme, Subdivision, subdivide, subdivide_native};

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
    fn a_cube_matches_the_paper() {
        let scheme = Subdivision::new(Scheme::CatmullClark);
        let none = Creases::default();
        let steps = [Method::Gather, Method::Scatter].map(|method| {
            let step = subdivide::<IndexedFaceSet>(&scheme, method, &cube(), &none, 1);
            step.expect("a cube")
        });
        let native = subdivide_native::<HalfEdgeMesh>(&scheme, &cube(), &none, 1);
        for step in steps.into_iter().chain(native) {
            let points = step.polygons.positions();
            let near = |a: Point, b: Point| a.distance(b) < 1e-6;
            for (corner, point) in cube().positions().iter().zip(points) {
                assert!(near(*point, *corner * (5.0 / 9.0)), "{point}");
            }
            assert!(points[8..14].iter().all(|p| p.length() == 1.0));
            for p in &points[14..] {
                let mut sizes = p.abs().to_array();
                sizes.sort_by(f32::total_cmp);
                assert_eq!(sizes, [0.0, 0.75, 0.75]);
            }
            assert_eq!([points.len(), step.polygons.face_count()], [26, 24]);
        }
    }

    /// ```text
    ///   6 ── 7 ── 8      vertices of a unit grid, 4 at height 64, and a crease 3–4–5
    ///   │    │    │
    ///   3 ══ 4 ══ 5
    ///   │    │    │
    ///   0 ── 1 ── 2
    /// ```
    #[test]
    fn a_grid_with_a_crease_matches_the_paper() {
        let at = |i: u32| {
            Point::new(
                (i % 3) as f32,
                (i / 3) as f32,
                [0.0, 64.0][usize::from(i == 4)],
            )
        };
        let quad = |i: u32| [i, i + 1, i + 4, i + 3];
        let points: Vec<Point> = (0..9).map(at).collect();
        let grid = PolygonMesh::new(points, [0, 1, 3, 4].map(quad)).expect("four quads");
        let crease = [([3, 4], f32::INFINITY), ([4, 5], f32::INFINITY)];
        let creases = Creases::new(&grid, crease, []).expect("inner edges");
        for (boundary, corner) in [
            (BoundaryRule::EdgeAndCorner, Point::ZERO),
            (BoundaryRule::EdgeOnly, Point::new(0.125, 0.125, 0.0)),
        ] {
            let scheme = Subdivision {
                boundary,
                ..Subdivision::new(Scheme::CatmullClark)
            };
            let steps = [Method::Gather, Method::Scatter].map(|method| {
                let step = subdivide::<IndexedFaceSet>(&scheme, method, &grid, &creases, 1);
                step.expect("quads")
            });
            let native = subdivide_native::<HalfEdgeMesh>(&scheme, &grid, &creases, 1);
            for step in steps.into_iter().chain(native) {
                let points = step.polygons.positions();
                assert_near(points[0], corner);
                // The crease ends at vertex 3, which has three sharp edges and does not move.
                assert_near(points[1], Point::new(1.0, 0.0, 0.0));
                assert_near(points[3], Point::new(0.0, 1.0, 0.0));
                assert_near(points[4], Point::new(1.0, 1.0, 48.0));
                let has = |x: f32, y: f32, z: f32| {
                    let near = |p: &Point| p.distance(Point::new(x, y, z)) < 1e-5;
                    assert!(points.iter().any(near), "{x} {y} {z}, {boundary:?}");
                };
                // A face point, then the points of edge 1–4, of the crease 3–4 and of the boundary
                // edge 0–1.
                has(0.5, 0.5, 16.0);
                has(1.0, 0.5, 24.0);
                has(0.5, 1.0, 32.0);
                has(0.5, 0.0, 0.0);
            }
        }
    }
}
