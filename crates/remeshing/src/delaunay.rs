//! Delaunay flipping by the cotangent criterion.

use glam::DVec3;
use mesh_core::{MeshEdit, Representation};
use rustc_hash::FxHashSet;

use crate::Stop;
use crate::error::RemeshError;
use crate::numbering::{Numbering, corners};
use crate::rules::at;

/// How many flips there are at most, for each edge: a plane needs far fewer, and a surface, on which
/// flips need not come to an end, does not go on for ever.
const FLIPS_PER_EDGE: usize = 16;

/// By how much the cotangents must add up below zero: rounding alone should flip nothing.
const MARGIN: f64 = 1e-7;

/// What flipping came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Flipped {
    /// How many edges were flipped.
    pub flips: usize,
    /// How many flips were refused: illegal, or folding the surface.
    pub refused: usize,
    /// Why it ended; [`Stop::Done`] where every edge is Delaunay or was refused.
    pub stop: Stop,
}

/// Flips every edge whose two opposite angles come to more than π together, until there is none.
///
/// ```text
///       c                 cot ∠c + cot ∠d < 0:  the circle around a b c holds d,
///     ╱   ╲               and the cotangent Laplacian has a negative weight there
///    a ─── b
///     ╲   ╱
///       d
/// ```
///
/// In a plane that ends at the Delaunay triangulation (Lawson 1977). On a surface a flip changes the
/// shape, so one that would turn a triangle away from the two it comes from is left out, and the
/// number of flips is bounded by sixteen for each edge.
///
/// # Errors
///
/// [`RemeshError`]: a polygon, a vertex that is nowhere.
///
/// # Complexity
///
/// O(edges log edges), and the structure's cost of VE, EF and `flip_edge` for each flip.
pub fn flip_to_delaunay<M: MeshEdit + Representation>(
    mesh: &mut M,
) -> Result<Flipped, RemeshError> {
    let numbering = Numbering::of(mesh)?;
    let mut waiting = numbering.edges(mesh);
    waiting.reverse();
    let bound = waiting.len().saturating_mul(FLIPS_PER_EDGE);
    let mut waits: FxHashSet<[u32; 2]> = waiting.iter().copied().collect();
    let mut report = Flipped {
        flips: 0,
        refused: 0,
        stop: Stop::Done,
    };
    while let Some(ends) = waiting.pop() {
        waits.remove(&ends);
        let Some(quad) = Quad::around(mesh, &numbering, ends) else {
            continue;
        };
        if quad.cotangents() >= -MARGIN {
            continue;
        }
        if report.flips == bound {
            report.stop = Stop::WorkBound;
            break;
        }
        let edge = numbering.edge(mesh, ends).filter(|_| quad.stays_flat());
        if edge.is_none_or(|e| mesh.flip_edge(e, &mut ()).is_err()) {
            report.refused += 1;
            continue;
        }
        report.flips += 1;
        for side in quad.sides() {
            if waits.insert(side) {
                waiting.push(side);
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
    /// That of the edge between two numbers; none where it is gone or has not two faces.
    fn around<M: MeshEdit + Representation>(
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
            // From the apex on, the face that runs a to b has b last.
            let side = usize::from(numbers[(i + 2) % 3] != b);
            apexes[side] = Some(numbers[i]);
        }
        let numbers = [a, b, apexes[0]?, apexes[1]?];
        (faces == 2).then(|| Self {
            numbers,
            at: numbers.map(|n| at(mesh, numbering.name(n))),
        })
    }

    fn cotangents(&self) -> f64 {
        let [a, b, c, d] = self.at;
        let cotangent = |apex: DVec3| {
            let (u, v) = (a - apex, b - apex);
            let sine = u.cross(v).length();
            // A triangle without an area: as obtuse, or as acute, as its sides say.
            if sine == 0.0 {
                u.dot(v).signum() * 1e30
            } else {
                u.dot(v) / sine
            }
        };
        cotangent(c) + cotangent(d)
    }

    /// Whether both new triangles face the way the two old ones do together.
    fn stays_flat(&self) -> bool {
        let [a, b, c, d] = self.at;
        let together = (b - a).cross(c - a) + (a - b).cross(d - b);
        let new = [(d - a).cross(c - a), (c - b).cross(d - b)];
        new.into_iter().all(|n| n.dot(together) > 0.0)
    }

    fn sides(&self) -> [[u32; 2]; 4] {
        let [a, b, c, d] = self.numbers;
        [[a, c], [b, c], [a, d], [b, d]].map(|[x, y]| [x.min(y), x.max(y)])
    }
}

#[cfg(test)]
mod tests;
