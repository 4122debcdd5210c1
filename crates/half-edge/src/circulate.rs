//! Walks around a vertex and along a face, as iterators that end after one turn.

use sixfold_core::{EdgeId, Editing, FaceId, IteratorExt, Probe, Slot, VertexId};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh, panic_deleted};

impl<P: Probe, E: Editing> HalfEdgeMesh<E, P> {
    /// Yields the half-edges that leave `v`, clockwise: each step is `h → next(twin(h))`. At a boundary vertex, the first half-edge
    /// is on the boundary loop.
    ///
    /// # Panics
    ///
    /// Panics if `v` is not a vertex of this mesh.
    #[inline]
    pub fn leaving(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> + Clone {
        self.spokes(v).map_inline(|(h, _)| h)
    }

    /// Yields the half-edges that have `f` on their left, counter-clockwise: each step is
    /// `h → next(h)`.
    ///
    /// # Panics
    ///
    /// Panics if `f` is not a face of this mesh.
    #[inline]
    pub fn around_face(&self, f: FaceId) -> impl Iterator<Item = HalfEdgeId> + Clone {
        self.sides(f).map_inline(|(h, _)| h)
    }

    #[inline]
    pub(crate) fn spokes(&self, v: VertexId) -> Spokes<'_, P, E> {
        let at = self.vertex_half_edge(v);
        Spokes {
            mesh: self,
            at,
            first: at,
        }
    }

    #[inline]
    pub(crate) fn sides(&self, f: FaceId) -> Sides<'_, P, E> {
        let first = self.face_half_edge(f);
        Sides {
            mesh: self,
            at: Some(first),
            first,
        }
    }

    #[inline]
    pub(crate) fn across(&self, f: FaceId) -> Across<'_, P, E> {
        Across(self.sides(f))
    }
}

/// The half-edges that leave a vertex (its spokes), each with the record of its twin.
///
/// A step reads only this record: the `next` of the twin is the next spoke.
#[derive(Clone, Debug)]
pub(crate) struct Spokes<'a, P: Probe, E: Editing> {
    mesh: &'a HalfEdgeMesh<E, P>,
    at: Option<HalfEdgeId>,
    first: Option<HalfEdgeId>,
}

impl<'a, P: Probe, E: Editing> Iterator for Spokes<'a, P, E> {
    type Item = (HalfEdgeId, &'a Half);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let h = self.at?;
        let twin = self.mesh.halves.read(h.twin().index());
        let turned = Some(twin.next);
        self.at = if turned == self.first { None } else { turned };
        Some((h, twin))
    }

    #[inline]
    fn fold<B, F: FnMut(B, Self::Item) -> B>(self, init: B, mut f: F) -> B {
        let (Some(mut h), Some(first)) = (self.at, self.first) else {
            return init;
        };
        let mut folded = init;
        loop {
            let twin = self.mesh.halves.read(h.twin().index());
            folded = f(folded, (h, twin));
            h = twin.next;
            if h == first {
                return folded;
            }
        }
    }
}

/// The half-edges along a face, each with its record.
#[derive(Clone, Debug)]
pub(crate) struct Sides<'a, P: Probe, E: Editing> {
    mesh: &'a HalfEdgeMesh<E, P>,
    at: Option<HalfEdgeId>,
    first: HalfEdgeId,
}

impl<'a, P: Probe, E: Editing> Iterator for Sides<'a, P, E> {
    type Item = (HalfEdgeId, &'a Half);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let h = self.at?;
        let half = self.mesh.halves.read(h.index());
        self.at = (half.next != self.first).then_some(half.next);
        Some((h, half))
    }

    #[inline]
    fn fold<B, F: FnMut(B, Self::Item) -> B>(self, init: B, mut f: F) -> B {
        let Some(mut h) = self.at else {
            return init;
        };
        let mut folded = init;
        loop {
            let half = self.mesh.halves.read(h.index());
            folded = f(folded, (h, half));
            h = half.next;
            if h == self.first {
                return folded;
            }
        }
    }
}

/// The face across each side of a face. A step reads two half-edges, which are adjacent in memory.
#[derive(Clone, Debug)]
pub(crate) struct Across<'a, P: Probe, E: Editing>(Sides<'a, P, E>);

impl<P: Probe, E: Editing> Iterator for Across<'_, P, E> {
    type Item = Slot<FaceId>;

    #[inline]
    fn next(&mut self) -> Option<Slot<FaceId>> {
        let h = self.0.at?;
        let halves = self.0.mesh.halves.read_pair(h.edge().index());
        let side = h.index() & 1;
        let next = halves[side].next;
        self.0.at = (next != self.0.first).then_some(next);
        Some(halves[side ^ 1].face)
    }
}

/// The edges at both ends of an edge, except the edge itself. One walk around each end stops at the
/// edge itself.
#[derive(Clone, Debug)]
pub(crate) struct EdgeEdges<'a, P: Probe, E: Editing> {
    mesh: &'a HalfEdgeMesh<E, P>,
    at: HalfEdgeId,
    /// The half-edge where the walk stops.
    stop: HalfEdgeId,
    /// The half-edge where the walk around the other end stops; `None` during that walk.
    next_stop: Option<HalfEdgeId>,
}

impl<'a, P: Probe, E: Editing> EdgeEdges<'a, P, E> {
    #[inline]
    pub(crate) fn new(mesh: &'a HalfEdgeMesh<E, P>, e: EdgeId) -> Self {
        let [one, other] = mesh.edge_half_edges(e);
        let half = mesh.halves.read(other.index());
        if E::CAN_DELETE && half.is_deleted() {
            panic_deleted(e);
        }
        let at = half.next;
        Self {
            mesh,
            at,
            stop: one,
            next_stop: Some(other),
        }
    }
}

impl<P: Probe, E: Editing> Iterator for EdgeEdges<'_, P, E> {
    type Item = EdgeId;

    #[inline]
    fn next(&mut self) -> Option<EdgeId> {
        while self.at == self.stop {
            self.stop = self.next_stop.take()?;
            self.at = self.mesh.follow(self.stop.twin());
        }
        let edge = self.at.edge();
        self.at = self.mesh.follow(self.at.twin());
        Some(edge)
    }

    #[inline]
    fn fold<B, F: FnMut(B, EdgeId) -> B>(self, init: B, mut f: F) -> B {
        let Self {
            mesh,
            mut at,
            mut stop,
            mut next_stop,
        } = self;
        let mut folded = init;
        loop {
            while at != stop {
                folded = f(folded, at.edge());
                at = mesh.follow(at.twin());
            }
            match next_stop.take() {
                Some(other) => (stop, at) = (other, mesh.follow(other.twin())),
                None => return folded,
            }
        }
    }
}
