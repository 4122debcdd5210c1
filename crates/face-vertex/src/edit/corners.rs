//! Functions on the corner list of a face.

use sixfold_core::{Pair, VertexId};

use super::Edge;
use crate::circulate::neighbours_in;

/// Returns the sides of a face.
pub(super) fn sides(face: &[VertexId]) -> impl Iterator<Item = Edge> {
    Pair::sides(face.len(), |i| face[i])
}

/// Returns the corners of a face that contains `v`, starting at `v`.
pub(super) fn corners_from(face: &[VertexId], v: VertexId) -> impl Iterator<Item = VertexId> {
    let at = face.iter().position(|&corner| corner == v);
    let (before, after) = face.split_at(at.expect("I3: a face in the fan of a vertex contains it"));
    after.iter().chain(before).copied()
}

/// Returns the end of the side `e` in the direction of a triangle at `e`, and the third corner.
#[inline]
pub(super) fn third_corner(face: [VertexId; 3], e: Edge) -> (VertexId, VertexId) {
    let [a, b, c] = face;
    let apex = if !e.has(a) {
        a
    } else if !e.has(b) {
        b
    } else {
        c
    };
    (neighbours_in(&face, apex)[0], apex)
}
