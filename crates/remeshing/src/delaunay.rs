//! Delaunay flips by the cotangent criterion.

use glam::DVec3;
use rustc_hash::FxHashSet;
use sixfold_core::MeshEdit;

use crate::Stop;
use crate::error::RemeshError;
use crate::numbering::{Numbering, corners};
use crate::rules::at;

/// Maximum number of flips, divided by the number of edges. Without this limit, flipping on a
/// surface might never end.
const FLIPS_PER_EDGE: usize = 16;

/// An edge is flipped if its sum of cotangents is below `-TOLERANCE`. The tolerance prevents flips
/// that are caused by rounding errors.
const TOLERANCE: f64 = 1e-7;

/// The result of [`flip_to_delaunay`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Flipped {
    /// The number of flips.
    pub flips: usize,
    /// The number of refused flips. A flip is refused if the flip is illegal or would fold the
    /// surface.
    pub refused: usize,
    /// The reason why flipping ended. [`Stop::Done`] means that every edge meets the Delaunay
    /// criterion or its flip was refused.
    pub stop: Stop,
}

/// Flips edges whose two opposite angles add up to more than π, until none of these edges can be
/// flipped.
///
/// ```text
///       c                 cot ∠c + cot ∠d < 0:  the circle around a b c contains d,
///     ╱   ╲               and the cotangent Laplacian has a negative weight there
///    a ─── b
///     ╲   ╱
///       d
/// ```
///
/// In a plane, the result is the Delaunay triangulation (Lawson 1977). On a curved surface, a flip
/// changes the shape. A flip is refused if a new triangle would face away from the two old
/// triangles. The number of flips is at most 16 times the number of edges.
///
/// # Errors
///
/// Returns [`RemeshError`] if a face is not a triangle or a position is not finite.
///
/// # Complexity
///
/// O(edges log edges) time, plus the structure's cost of the queries VE and EF and of `flip_edge`
/// for each flip.
pub fn flip_to_delaunay<M: MeshEdit>(mesh: &mut M) -> Result<Flipped, RemeshError> {
    let numbering = Numbering::new(mesh)?;
    let mut stack = numbering.edges(mesh);
    stack.reverse();
    let limit = stack.len().saturating_mul(FLIPS_PER_EDGE);
    let mut on_stack: FxHashSet<[u32; 2]> = stack.iter().copied().collect();
    let mut report = Flipped {
        flips: 0,
        refused: 0,
        stop: Stop::Done,
    };
    while let Some(ends) = stack.pop() {
        on_stack.remove(&ends);
        let Some(quad) = Quad::from_edge(mesh, &numbering, ends) else {
            continue;
        };
        if quad.cotangent_sum() >= -TOLERANCE {
            continue;
        }
        if report.flips == limit {
            report.stop = Stop::LimitReached;
            break;
        }
        let edge = numbering
            .edge(mesh, ends)
            .filter(|_| quad.flip_keeps_orientation());
        if edge.is_none_or(|e| mesh.flip_edge(e).is_err()) {
            report.refused += 1;
            continue;
        }
        report.flips += 1;
        for side in quad.sides() {
            if on_stack.insert(side) {
                stack.push(side);
            }
        }
    }
    Ok(report)
}

/// The two triangles along an edge: a, b, c and b, a, d.
struct Quad {
    numbers: [u32; 4],
    at: [DVec3; 4],
}

impl Quad {
    /// Returns the quad of the edge between two vertices, or `None` if the edge is missing or does
    /// not have two faces.
    fn from_edge<M: MeshEdit>(
        mesh: &M,
        numbering: &Numbering<M>,
        [a, b]: [u32; 2],
    ) -> Option<Self> {
        let e = numbering.edge(mesh, [a, b])?;
        let mut apexes = [None, None];
        let mut faces = 0;
        for f in mesh.edge_faces(e) {
            faces += 1;
            let numbers = corners(mesh, f).map(|v| numbering.number(v));
            let i = numbers.iter().position(|&n| n != a && n != b)?;
            // If the face runs from a to b, the corner order is apex, a, b.
            let side = usize::from(numbers[(i + 2) % 3] != b);
            apexes[side] = Some(numbers[i]);
        }
        let numbers = [a, b, apexes[0]?, apexes[1]?];
        (faces == 2).then(|| Self {
            numbers,
            at: numbers.map(|n| at(mesh, numbering.handle(n))),
        })
    }

    fn cotangent_sum(&self) -> f64 {
        let [a, b, c, d] = self.at;
        let cotangent = |apex: DVec3| {
            let (u, v) = (a - apex, b - apex);
            let sine = u.cross(v).length();
            // The triangle has no area. The sign shows whether the angle is acute or obtuse.
            if sine == 0.0 {
                u.dot(v).signum() * 1e30
            } else {
                u.dot(v) / sine
            }
        };
        cotangent(c) + cotangent(d)
    }

    /// Returns whether both new triangles face in the direction of the old normals.
    fn flip_keeps_orientation(&self) -> bool {
        let [a, b, c, d] = self.at;
        let normal_sum = (b - a).cross(c - a) + (a - b).cross(d - b);
        let new = [(d - a).cross(c - a), (c - b).cross(d - b)];
        new.into_iter().all(|n| n.dot(normal_sum) > 0.0)
    }

    fn sides(&self) -> [[u32; 2]; 4] {
        let [a, b, c, d] = self.numbers;
        [[a, c], [b, c], [a, d], [b, d]].map(|[x, y]| [x.min(y), x.max(y)])
    }
}

#[cfg(test)]
mod tests;
