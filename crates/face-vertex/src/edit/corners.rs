//! Faces as lists of corners.

use mesh_core::{Pair, VertexId};

use super::Edge;
use crate::circulate::beside;

/// The sides of a face.
pub(super) fn sides(face: &[VertexId]) -> impl Iterator<Item = Edge> {
    Pair::sides(face.len(), |i| face[i])
}

/// The corners of a face that has `v`, from there on.
pub(super) fn from_corner(face: &[VertexId], v: VertexId) -> impl Iterator<Item = VertexId> {
    let at = face.iter().position(|&corner| corner == v);
    let (before, after) = face.split_at(at.expect("I3: a face in the fan of a vertex names it"));
    after.iter().chain(before).copied()
}

/// Of a triangle along `e`, the end to which it runs `e`, and its third corner.
#[inline]
pub(super) fn third(face: [VertexId; 3], e: Edge) -> (VertexId, VertexId) {
    let [a, b, c] = face;
    let apex = if !e.has(a) {
        a
    } else if !e.has(b) {
        b
    } else {
        c
    };
    (beside(&face, apex)[0], apex)
}

/// A vertex that comes twice.
pub(super) fn repeated(corners: &[VertexId]) -> Option<VertexId> {
    const FEW: usize = 16;
    if corners.len() <= FEW {
        let mut earlier = corners.iter().enumerate();
        let twice = earlier.find(|&(i, v)| corners[..i].contains(v));
        return twice.map(|(_, &v)| v);
    }
    let mut sorted = corners.to_vec();
    sorted.sort_unstable();
    let twice = sorted.windows(2).find(|pair| pair[0] == pair[1]);
    twice.map(|pair| pair[0])
}
