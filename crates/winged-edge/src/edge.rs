//! The record of one edge, and the cursor that runs along it.

use std::hint::select_unpredictable;

use mesh_core::{EdgeId, FaceId, Slot, VertexId};

use crate::wings::{Side, Wings};

/// One edge: a row of the table `edges`.
///
/// Along its left face it runs from start to end, along its right face back again; `next` and `prev`
/// of a side follow the direction of the face there.
///
/// 32 bytes that start at a multiple of 32: every step of a walk touches one cache line. Left to
/// the allocator, every second record of a large table would lie across two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct Edge {
    /// Where it starts, and where it ends: where the run along each side has its origin.
    pub(crate) ends: [VertexId; 2],
    /// The face on each side; none outside a boundary.
    pub(crate) faces: [Slot<FaceId>; 2],
    /// The wings ahead: the next edge along each side.
    pub(crate) next: Wings,
    /// The wings behind: the edge before along each side.
    pub(crate) prev: Wings,
}

/// Where a deleted edge starts and ends: no row of any table has this number.
const NOWHERE: VertexId = VertexId::new(u32::MAX);

/// The side of a deleted face: no row of any table has this number.
pub(crate) const NO_EDGE: EdgeId = EdgeId::new(u32::MAX);

impl Edge {
    /// Nothing linked yet, from the first vertex to itself.
    pub(crate) const BLANK: Self = Self {
        ends: [VertexId::new(0); 2],
        faces: [Slot::NONE; 2],
        next: Wings::BLANK,
        prev: Wings::BLANK,
    };

    /// What the row of a deleted edge holds.
    pub(crate) const HOLE: Self = Self {
        ends: [NOWHERE; 2],
        ..Self::BLANK
    };

    /// Whether the edge is deleted.
    #[inline(always)]
    pub(crate) fn is_hole(&self) -> bool {
        self.ends[0] == NOWHERE
    }

    /// The side without a face, if there is one.
    #[inline(always)]
    pub(crate) fn blank_side(&self) -> Option<Side> {
        let mut sides = [Side::LEFT, Side::RIGHT].into_iter();
        sides.find(|&side| self.faces[side.index()] == Slot::NONE)
    }

    /// The vertex where it starts, and the one where it ends.
    #[inline]
    pub fn ends(&self) -> [VertexId; 2] {
        self.ends
    }

    /// The face on the left, and the one on the right; none outside a boundary.
    #[inline]
    pub fn faces(&self) -> [Option<FaceId>; 2] {
        self.faces.map(Slot::get)
    }

    /// The next edge along the left, and along the right.
    #[inline]
    pub fn next(&self) -> [EdgeId; 2] {
        self.next.both()
    }

    /// The edge before along the left, and along the right.
    #[inline]
    pub fn prev(&self) -> [EdgeId; 2] {
        self.prev.both()
    }
}

/// An edge run along one of its sides: the cursor of every walk, never stored.
///
/// Along the left it runs from start to end, along the right from end to start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run<'a> {
    edge: &'a Edge,
    side: Side,
}

impl<'a> Run<'a> {
    /// `edge` run along `side`.
    #[inline(always)]
    pub(crate) fn on(edge: &'a Edge, side: Side) -> Self {
        Self { edge, side }
    }

    /// `edge`, which has `v`, run away from it: the side test of a walk around a vertex.
    #[inline(always)]
    pub(crate) fn from(edge: &'a Edge, v: VertexId) -> Self {
        let side = Side::right_if(edge.ends[0] != v);
        Self { edge, side }
    }

    /// `edge`, which has `f`, run with it on the left: the side test of a walk along a face.
    #[inline(always)]
    pub(crate) fn along(edge: &'a Edge, f: FaceId) -> Self {
        let side = Side::right_if(edge.faces[0] != Slot::some(f));
        Self { edge, side }
    }

    /// The side that it runs along.
    #[inline(always)]
    pub(crate) fn side(self) -> Side {
        self.side
    }

    /// The same edge run back along its other side.
    #[inline(always)]
    pub(crate) fn back(self) -> Self {
        Self::on(self.edge, self.side.other())
    }

    // No step waits for these four. What the side test has read already is selected, for that is one
    // instruction more; the rest is indexed, for that loads one value and not two.

    /// Where the run starts.
    #[inline(always)]
    pub(crate) fn origin(self) -> VertexId {
        self.edge.ends[self.side.index()]
    }

    /// Where the run ends.
    #[inline(always)]
    pub(crate) fn target(self) -> VertexId {
        let [start, end] = self.edge.ends;
        select_unpredictable(self.side.is_right(), start, end)
    }

    /// The face on the left of the run.
    #[inline(always)]
    pub(crate) fn face(self) -> Slot<FaceId> {
        self.edge.faces[self.side.index()]
    }

    /// The face on the right of the run.
    #[inline(always)]
    pub(crate) fn across(self) -> Slot<FaceId> {
        let [left, right] = self.edge.faces;
        select_unpredictable(self.side.is_right(), left, right)
    }

    /// The next edge along the face.
    #[inline(always)]
    pub(crate) fn next(self) -> EdgeId {
        self.edge.next.on(self.side)
    }

    /// The edge before along the face.
    #[inline(always)]
    pub(crate) fn prev(self) -> EdgeId {
        self.edge.prev.on(self.side)
    }

    /// The next edge around the origin, counter-clockwise: the one before along the face on the left.
    #[inline(always)]
    pub(crate) fn ccw(self) -> EdgeId {
        self.prev()
    }

    /// The next edge around the origin, clockwise: the next along the face on the right.
    #[inline(always)]
    pub(crate) fn cw(self) -> EdgeId {
        self.edge.next.on(self.side.other())
    }
}

/// A run by name, which may be kept while the records are written: what a half-edge is elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RunId {
    pub(crate) edge: EdgeId,
    pub(crate) side: Side,
}

impl RunId {
    /// `edge` run along `side`.
    #[inline(always)]
    pub(crate) const fn on(edge: EdgeId, side: Side) -> Self {
        Self { edge, side }
    }

    /// The same edge run back along its other side.
    #[inline(always)]
    pub(crate) fn back(self) -> Self {
        Self::on(self.edge, self.side.other())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_fill_their_cache_lines() {
        assert_eq!((size_of::<Edge>(), align_of::<Edge>()), (32, 32));
    }
}
