//! Functions on the corner list of a face. These functions do not change the fans.

use sixfold_core::{Editable, FaceId, Pair, Probe, VertexId};

use super::Edge;
use crate::circulate::neighbours_in;
use crate::mesh::{BLANK_CORNER, FaceVertexMesh};

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

/// Returns the end of `e` that `face` reaches when it runs along `e`, and the third corner.
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

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Marks `f` as deleted. `f` must be in no fan.
    pub(super) fn delete_face(&mut self, f: FaceId) {
        self.spans.blank(&mut self.corners, f, BLANK_CORNER);
        self.face_holes.insert(f.index());
    }

    /// Replaces the corner `old` of `f` by `new`. The caller updates the fans.
    #[inline]
    pub(super) fn replace_corner(&mut self, f: FaceId, old: VertexId, new: VertexId) {
        let range = self.spans.range(f);
        let at = match self.corners.read_range(range.clone()) {
            // No branch, because the place of `old` is unpredictable.
            &[_, b, c] => usize::from(b == old) + 2 * usize::from(c == old),
            face => {
                let at = face.iter().position(|&v| v == old);
                at.expect("I3: a face in the fan of a vertex contains it")
            }
        };
        *self.corners.write(range.start + at) = new;
    }
}
