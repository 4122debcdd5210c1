//! The record of one edge, and the cursor that runs along it.

use std::hint::select_unpredictable;

use sixfold_core::{EdgeId, FaceId, Slot, VertexId};

use crate::wings::{Side, Wings};

/// One edge: a row of the table `edges`.
///
/// The edge runs from start to end along its left face, and from end to start along its right face.
/// On each side, `next` and `prev` follow the direction of the edge along that side.
///
/// The record has 32 bytes and is aligned to 32 bytes, so every step of a walk touches one cache
/// line. Without the alignment, every second record would lie across two cache lines.
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

/// The value of both ends of a deleted edge.
const NO_VERTEX: VertexId = VertexId::new(u32::MAX);

/// The value of the side of a deleted face.
pub(crate) const NO_EDGE: EdgeId = EdgeId::new(u32::MAX);

impl Edge {
    /// A record that is not linked yet.
    pub(crate) const BLANK: Self = Self {
        ends: [VertexId::new(0); 2],
        faces: [Slot::NONE; 2],
        next: Wings::BLANK,
        prev: Wings::BLANK,
    };

    pub(crate) const DELETED: Self = Self {
        ends: [NO_VERTEX; 2],
        ..Self::BLANK
    };

    #[inline(always)]
    pub(crate) fn is_deleted(&self) -> bool {
        self.ends[0] == NO_VERTEX
    }

    #[inline(always)]
    pub(crate) fn blank_side(&self) -> Option<Side> {
        let mut sides = [Side::LEFT, Side::RIGHT].into_iter();
        sides.find(|&side| self.faces[side.index()] == Slot::NONE)
    }

    /// Returns the two ends of the edge: start, then end.
    #[inline]
    pub fn ends(&self) -> [VertexId; 2] {
        self.ends
    }

    /// Returns the face on the left and the face on the right. An entry is `None` if there is no
    /// face on that side.
    #[inline]
    pub fn faces(&self) -> [Option<FaceId>; 2] {
        self.faces.map(Slot::get)
    }

    /// Returns the next edge along the left side, and the next edge along the right side.
    #[inline]
    pub fn next(&self) -> [EdgeId; 2] {
        self.next.both()
    }

    /// Returns the previous edge along the left side, and the previous edge along the right side.
    #[inline]
    pub fn prev(&self) -> [EdgeId; 2] {
        self.prev.both()
    }
}

/// An edge along one of its sides. A run is the cursor of every walk.
///
/// A left run goes from start to end, a right run from end to start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run<'a> {
    edge: &'a Edge,
    side: Side,
}

impl<'a> Run<'a> {
    #[inline(always)]
    pub(crate) fn new(edge: &'a Edge, side: Side) -> Self {
        Self { edge, side }
    }

    /// Returns the run of `edge` that leaves `v`.
    #[inline(always)]
    pub(crate) fn from(edge: &'a Edge, v: VertexId) -> Self {
        let side = Side::right_if(edge.ends[0] != v);
        Self { edge, side }
    }

    /// Returns the run of `edge` with `f` on its left.
    #[inline(always)]
    pub(crate) fn along(edge: &'a Edge, f: FaceId) -> Self {
        let side = Side::right_if(edge.faces[0] != Slot::some(f));
        Self { edge, side }
    }

    #[inline(always)]
    pub(crate) fn side(self) -> Side {
        self.side
    }

    /// Returns the run of the same edge in the opposite direction.
    #[inline(always)]
    pub(crate) fn twin(self) -> Self {
        Self::new(self.edge, self.side.other())
    }

    // No step waits for these four values. `target` and `across` select between two loaded values;
    // `origin` and `face` load one value by index.

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

    /// Returns the next edge around the origin, counter-clockwise.
    #[inline(always)]
    pub(crate) fn ccw(self) -> EdgeId {
        self.prev()
    }

    /// Returns the next edge around the origin, clockwise.
    #[inline(always)]
    pub(crate) fn cw(self) -> EdgeId {
        self.edge.next.on(self.side.other())
    }
}

/// A run, stored as an edge and a side. Records can change while a `RunId` exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RunId {
    pub(crate) edge: EdgeId,
    pub(crate) side: Side,
}

impl RunId {
    #[inline(always)]
    pub(crate) const fn new(edge: EdgeId, side: Side) -> Self {
        Self { edge, side }
    }

    /// Returns the run of the same edge in the opposite direction.
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
