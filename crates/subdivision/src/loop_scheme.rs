//! Loop: every triangle into four, approximating, C² but at extraordinary vertices.
//!
//! Loop (1987), with his weights or Warren's (Warren 1995; 3/16 at valence 3, 3/(8n) beyond). The
//! file is not called after the scheme alone, for `loop` is a word of the language.
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

use mesh_core::{Point, Split};

use crate::mask::Mask;
use crate::options::LoopWeights;

/// Valences whose β is looked up; few vertices have more.
const LOOKED_UP: usize = 16;

/// The weights of Loop (1987), or of Warren.
#[derive(Clone, Copy)]
pub(crate) struct Loop {
    weights: LoopWeights,
    betas: [f32; LOOKED_UP],
}

impl Loop {
    /// The scheme with these weights.
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

/// The weight of each of `valence` neighbours.
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
    const SPLIT: Split = Split::Triangles;
    const APPROXIMATES: bool = true;
    const EDGES_SEE_FACES: bool = true;
    const VERTICES_SEE_FACES: bool = false;

    /// The sum of the corners. Both faces' together hold the ends twice and the two far corners
    /// once, so that no corner has to be told from another.
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
    use super::*;

    #[test]
    fn the_weights_are_those_of_the_papers() {
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
}
