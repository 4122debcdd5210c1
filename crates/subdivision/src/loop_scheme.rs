//! Loop: splits every triangle into four. The scheme is approximating, and the limit surface is C²
//! except at extraordinary vertices.
//!
//! The scheme is that of Loop (1987), with the weights of Loop or of Warren (1995). Warren's
//! weights are 3/16 for valence 3 and 3/(8n) for any other valence n.
//!
//! ```text
//!     edge point                  vertex point, valence n
//!
//!         1/8                       β ─── β
//!        /   \                     / \   / \        1 − nβ  the vertex
//!      3/8 ─e─ 3/8                β ── v ── β       β       each neighbour
//!        \   /                     \ / \ /
//!         1/8                       β ─── β         β = (5/8 − (3/8 + cos(2π/n)/4)²)/n
//! ```

use std::f64::consts::TAU;

use sixfold_core::{Point, Split};

use crate::mask::Mask;
use crate::options::LoopWeights;

/// Number of valences with precomputed β.
const PRECOMPUTED: usize = 16;

/// The weights of Loop (1987), or of Warren.
#[derive(Clone, Copy)]
pub(crate) struct Loop {
    weights: LoopWeights,
    betas: [f32; PRECOMPUTED],
}

impl Loop {
    pub(crate) fn new(weights: LoopWeights) -> Self {
        let betas = std::array::from_fn(|n| beta(weights, n.max(1)) as f32);
        Self { weights, betas }
    }

    fn beta(&self, valence: usize) -> f32 {
        match self.betas.get(valence) {
            Some(&beta) => beta,
            None => beta(self.weights, valence) as f32,
        }
    }
}

/// Returns β, the weight of each of `valence` neighbours.
pub(crate) fn beta(weights: LoopWeights, valence: usize) -> f64 {
    let n = valence as f64;
    match weights {
        LoopWeights::Loop => {
            let centre = 0.375 + 0.25 * (TAU / n).cos();
            (0.625 - centre * centre) / n
        }
        LoopWeights::Warren if valence == 3 => 3.0 / 16.0,
        LoopWeights::Warren => 3.0 / (8.0 * n),
    }
}

impl Mask for Loop {
    const APPROXIMATES: bool = true;
    const EDGES_USE_FACES: bool = true;
    const VERTICES_USE_FACES: bool = false;

    /// Returns the sum of the corners. The sums of the two faces at an edge contain each end twice
    /// and each far corner once.
    #[inline(always)]
    fn split(self) -> Split {
        Split::Triangles
    }

    #[inline(always)]
    fn face(self, corners: Point, _: usize) -> Point {
        corners
    }

    #[inline(always)]
    fn edge(self, [a, b]: [Point; 2], faces: Point) -> Point {
        (a + b + faces) * 0.125
    }

    #[inline(always)]
    fn vertex(self, at: Point, valence: usize, neighbours: Point, _: Point) -> Point {
        let beta = self.beta(valence);
        at * (1.0 - valence as f32 * beta) + neighbours * beta
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{Creases, PolygonMesh};
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;
    use crate::test_support::assert_near;
    use crate::{Method, Scheme, Subdivision, subdivide};

    #[test]
    fn the_weights_match_the_papers() {
        let loops = |n| beta(LoopWeights::Loop, n);
        assert!((loops(6) - 1.0 / 16.0).abs() < 1e-15);
        assert!((loops(3) - 3.0 / 16.0).abs() < 1e-15);
        assert!((loops(4) - 31.0 / 256.0).abs() < 1e-15);
        let warren = |n| beta(LoopWeights::Warren, n);
        assert_eq!(
            [warren(3), warren(4), warren(6)],
            [3.0 / 16.0, 3.0 / 32.0, 1.0 / 16.0]
        );
        let scheme = Loop::new(LoopWeights::Warren);
        assert_eq!(scheme.beta(40), (3.0_f64 / 320.0) as f32);
    }

    fn steps(weights: LoopWeights, polygons: &PolygonMesh) -> [Vec<Point>; 2] {
        let scheme = Subdivision {
            loop_weights: weights,
            ..Subdivision::new(Scheme::Loop)
        };
        let none = Creases::default();
        [Method::Gather, Method::Scatter].map(|method| {
            let step = subdivide::<IndexedFaceSet>(&scheme, method, polygons, &none, 1);
            step.expect("triangles").polygons.positions().to_vec()
        })
    }

    #[test]
    fn an_octahedron_matches_the_paper() {
        let octahedron = octahedron();
        let of_loop = steps(LoopWeights::Loop, &octahedron).map(|points| (points, 33.0 / 64.0));
        let of_warren = steps(LoopWeights::Warren, &octahedron).map(|points| (points, 5.0 / 8.0));
        for (points, shrunk) in of_loop.into_iter().chain(of_warren) {
            assert_eq!(points.len(), 6 + 12);
            for (old, new) in octahedron.positions().iter().zip(&points) {
                assert_near(*new, *old * shrunk);
            }
            for p in &points[6..] {
                let mut sizes = p.abs().to_array();
                sizes.sort_by(f32::total_cmp);
                assert_near(Point::from(sizes), Point::new(0.0, 0.375, 0.375));
            }
        }
    }

    fn octahedron() -> PolygonMesh {
        let axes = [Point::X, Point::Y, Point::Z];
        let corners = axes.map(|axis| [axis, -axis]).concat();
        let faces = (0..8_u32).map(|signs| {
            let [x, y, z] = [0, 1, 2].map(|axis| 2 * axis + (signs >> axis & 1));
            if signs.count_ones() % 2 == 0 {
                [x, y, z]
            } else {
                [x, z, y]
            }
        });
        PolygonMesh::new(corners, faces.collect::<Vec<_>>()).expect("eight triangles")
    }

    #[test]
    fn a_tetrahedron_matches_the_paper() {
        let corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]];
        let corners = corners.map(|at: [i8; 3]| Point::from(at.map(f32::from)));
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        let tetrahedron = PolygonMesh::new(corners, faces).expect("four triangles");
        let all = LoopWeights::ALL.map(|weights| steps(weights, &tetrahedron));
        for points in all.as_flattened() {
            assert_eq!(points.len(), 4 + 6);
            for (old, new) in corners.iter().zip(points) {
                assert_near(*new, *old * 0.25);
            }
            for p in &points[4..] {
                let mut sizes = p.abs().to_array();
                sizes.sort_by(f32::total_cmp);
                assert_near(Point::from(sizes), Point::new(0.0, 0.0, 0.5));
            }
        }
    }
}
