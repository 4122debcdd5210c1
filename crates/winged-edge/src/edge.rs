//! The record of one edge, and the cursor that runs along it.

use std::hint::select_unpredictable;

use sixfold_core::{EdgeId, FaceId, Slot, VertexId};

use crate::wings::{Side, Wings};

/// One edge: a row of the table `edges`.
///
/// It runs from start to end along its left face, and from end to start along its right face.
/// `next` and `prev` of a side follow the direction of the face there.
///
/// The record has 32 bytes and is aligned to 32 bytes, so every step of a walk touches one cache
/// line. Without the alignment, every second record of a large table would lie across two lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct Edge {
    /// The start and the end: the origin of the left run and of the right run.
    pub(crate) ends: [VertexId; 2],
    /// The face on each side; empty on the outer side of a boundary edge.
    pub(crate) faces: [Slot<FaceId>; 2],
    /// The next edge along each side.
    pub(crate) next: Wings,
    /// The previous edge along each side.
    pub(crate) prev: Wings,
}

/// The value of both ends of a deleted edge; no vertex has this row.
const NO_VERTEX: VertexId = VertexId::new(u32::MAX);

/// The value of the side of a deleted face; no edge has this row.
pub(crate) const NO_EDGE: EdgeId = EdgeId::new(u32::MAX);

impl Edge {
    /// A record that is not linked yet, from the first vertex to itself.
    pub(crate) const BLANK: Self = Self {
        ends: [VertexId::new(0); 2],
        faces: [Slot::NONE; 2],
        next: Wings::BLANK,
        prev: Wings::BLANK,
    };

    /// The row of a deleted edge.
    pub(crate) const DELETED: Self = Self {
        ends: [NO_VERTEX; 2],
        ..Self::BLANK
    };

    /// Returns whether the edge is deleted.
    #[inline(always)]
    pub(crate) fn is_deleted(&self) -> bool {
        self.ends[0] == NO_VERTEX
    }

    /// Returns the side without a face, if there is one.
    #[inline(always)]
    pub(crate) fn blank_side(&self) -> Option<Side> {
        let mut sides = [Side::LEFT, Side::RIGHT].into_iter();
        sides.find(|&side| self.faces[side.index()] == Slot::NONE)
    }

    /// Returns the start and the end.
    #[inline]
    pub fn ends(&self) -> [VertexId; 2] {
        self.ends
    }

    /// Returns the faces on the left and on the right; `None` on the outer side of a boundary edge.
    #[inline]
    pub fn faces(&self) -> [Option<FaceId>; 2] {
        self.faces.map(Slot::get)
    }

    /// Returns the next edges along the left and along the right.
    #[inline]
    pub fn next(&self) -> [EdgeId; 2] {
        self.next.both()
    }

    /// Returns the previous edges along the left and along the right.
    #[inline]
    pub fn prev(&self) -> [EdgeId; 2] {
        self.prev.both()
    }
}

/// An edge as it runs along one of its sides: the cursor of every walk, never stored.
///
/// Along the left side it runs from start to end, along the right side from end to start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run<'a> {
    edge: &'a Edge,
    side: Side,
}

impl<'a> Run<'a> {
    /// Returns the run of `edge` along `side`.
    #[inline(always)]
    pub(crate) fn new(edge: &'a Edge, side: Side) -> Self {
        Self { edge, side }
    }

    /// Returns the run of `edge` that leaves its end `v`: the side test of a walk around a vertex.
    #[inline(always)]
    pub(crate) fn from(edge: &'a Edge, v: VertexId) -> Self {
        let side = Side::right_if(edge.ends[0] != v);
        Self { edge, side }
    }

    /// Returns the run of `edge` with its face `f` on the left: the side test of a walk along a
    /// face.
    #[inline(always)]
    pub(crate) fn along(edge: &'a Edge, f: FaceId) -> Self {
        let side = Side::right_if(edge.faces[0] != Slot::some(f));
        Self { edge, side }
    }

    /// Returns the side.
    #[inline(always)]
    pub(crate) fn side(self) -> Side {
        self.side
    }

    /// Returns the run of the same edge along its other side.
    #[inline(always)]
    pub(crate) fn twin(self) -> Self {
        Self::new(self.edge, self.side.other())
    }

    // No step waits for the values of these four functions. If the side test has already read a
    // value, the function selects that value; this costs one more instruction. The other values are
    // read by index; this loads one value instead of two.

    /// Returns the vertex where the run starts.
    #[inline(always)]
    pub(crate) fn origin(self) -> VertexId {
        self.edge.ends[self.side.index()]
    }

    /// Returns the vertex where the run ends.
    #[inline(always)]
    pub(crate) fn target(self) -> VertexId {
        let [start, end] = self.edge.ends;
        select_unpredictable(self.side.is_right(), start, end)
    }

    /// Returns the face on the left of the run.
    #[inline(always)]
    pub(crate) fn face(self) -> Slot<FaceId> {
        self.edge.faces[self.side.index()]
    }

    /// Returns the face on the right of the run.
    #[inline(always)]
    pub(crate) fn across(self) -> Slot<FaceId> {
        let [left, right] = self.edge.faces;
        select_unpredictable(self.side.is_right(), left, right)
    }

    /// Returns the next edge along the face.
    #[inline(always)]
    pub(crate) fn next(self) -> EdgeId {
        self.edge.next.on(self.side)
    }

    /// Returns the previous edge along the face.
    #[inline(always)]
    pub(crate) fn prev(self) -> EdgeId {
        self.edge.prev.on(self.side)
    }

    /// Returns the next edge around the origin, counter-clockwise: the previous edge along the face
    /// on the left.
    #[inline(always)]
    pub(crate) fn ccw(self) -> EdgeId {
        self.prev()
    }

    /// Returns the next edge around the origin, clockwise: the next edge along the face on the
    /// right.
    #[inline(always)]
    pub(crate) fn cw(self) -> EdgeId {
        self.edge.next.on(self.side.other())
    }
}

/// A run, stored as an edge and a side. It can be kept while the records are written, and
/// corresponds to a half-edge of a half-edge mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RunId {
    pub(crate) edge: EdgeId,
    pub(crate) side: Side,
}

impl RunId {
    /// Returns the run of `edge` along `side`.
    #[inline(always)]
    pub(crate) const fn new(edge: EdgeId, side: Side) -> Self {
        Self { edge, side }
    }

    /// Returns the run of the same edge along its other side.
    #[inline(always)]
    pub(crate) fn twin(self) -> Self {
        Self::new(self.edge, self.side.other())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_have_32_bytes_and_are_aligned() {
        assert_eq!((size_of::<Edge>(), align_of::<Edge>()), (32, 32));
    }
}
