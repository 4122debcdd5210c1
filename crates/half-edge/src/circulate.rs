//! Walks around a vertex and along a face: ordinary iterators that end after one turn.

use std::collections::HashSet;

use mesh_core::{EdgeId, FaceId, Probe, Slot, VertexId};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

/// The half-edges that leave a vertex, clockwise: each step is `h → next(twin(h))`.
#[derive(Clone, Debug)]
pub struct Leaving<'a, P: Probe>(Spokes<'a, P>);

impl<P: Probe> Iterator for Leaving<'_, P> {
    type Item = HalfEdgeId;

    #[inline]
    fn next(&mut self) -> Option<HalfEdgeId> {
        self.0.next().map(|(h, _)| h)
    }
}

/// The half-edges along a face, counter-clockwise: each step is `h → next(h)`.
#[derive(Clone, Debug)]
pub struct AroundFace<'a, P: Probe>(Sides<'a, P>);

impl<P: Probe> Iterator for AroundFace<'_, P> {
    type Item = HalfEdgeId;

    #[inline]
    fn next(&mut self) -> Option<HalfEdgeId> {
        self.0.next().map(|(h, _)| h)
    }
}

impl<P: Probe> HalfEdgeMesh<P> {
    /// The half-edges that leave `v`, clockwise; from the boundary loop, if `v` is on one.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[inline]
    pub fn leaving(&self, v: VertexId) -> Leaving<'_, P> {
        Leaving(self.spokes(v))
    }

    /// The half-edges that have `f` on their left, counter-clockwise.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn around_face(&self, f: FaceId) -> AroundFace<'_, P> {
        AroundFace(self.sides(f))
    }

    /// The next half along the face, and the face across: one pair of rows.
    #[inline]
    fn next_and_across(&self, h: HalfEdgeId) -> (HalfEdgeId, Slot<FaceId>) {
        let pair = self.halves.read_pair(h.edge().index());
        let side = h.index() & 1;
        (pair[side].next, pair[side ^ 1].face)
    }

    #[inline]
    pub(crate) fn spokes(&self, v: VertexId) -> Spokes<'_, P> {
        let at = self.half_leaving(v);
        Spokes {
            mesh: self,
            at,
            first: at,
        }
    }

    #[inline]
    pub(crate) fn sides(&self, f: FaceId) -> Sides<'_, P> {
        let first = self.half_along(f);
        Sides {
            mesh: self,
            at: Some(first),
            first,
        }
    }
}

/// Each half that leaves a vertex, with the record of its twin: the one row a step has to read.
///
/// The twin starts at the neighbour, has the next face on its left, and leads on to the next spoke.
#[derive(Clone, Debug)]
pub(crate) struct Spokes<'a, P: Probe> {
    mesh: &'a HalfEdgeMesh<P>,
    at: Option<HalfEdgeId>,
    first: Option<HalfEdgeId>,
}

impl<'a, P: Probe> Iterator for Spokes<'a, P> {
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

/// Each half along a face, with its record.
#[derive(Clone, Debug)]
pub(crate) struct Sides<'a, P: Probe> {
    mesh: &'a HalfEdgeMesh<P>,
    at: Option<HalfEdgeId>,
    first: HalfEdgeId,
}

impl<'a, P: Probe> Iterator for Sides<'a, P> {
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

/// The edges at both ends of an edge, but for itself: two walks that start and end at its halves.
#[derive(Clone, Debug)]
pub(crate) struct EdgeEdges<'a, P: Probe> {
    mesh: &'a HalfEdgeMesh<P>,
    at: HalfEdgeId,
    stop: HalfEdgeId,
    then: Option<HalfEdgeId>,
}

impl<'a, P: Probe> EdgeEdges<'a, P> {
    #[inline]
    pub(crate) fn new(mesh: &'a HalfEdgeMesh<P>, e: EdgeId) -> Self {
        let [one, other] = mesh.halves_of(e);
        let at = mesh.next(other);
        Self {
            mesh,
            at,
            stop: one,
            then: Some(other),
        }
    }
}

impl<P: Probe> Iterator for EdgeEdges<'_, P> {
    type Item = EdgeId;

    #[inline]
    fn next(&mut self) -> Option<EdgeId> {
        while self.at == self.stop {
            self.stop = self.then.take()?;
            self.at = self.mesh.next(self.stop.twin());
        }
        let edge = self.at.edge();
        self.at = self.mesh.next(self.at.twin());
        Some(edge)
    }

    #[inline]
    fn fold<B, F: FnMut(B, EdgeId) -> B>(self, init: B, mut f: F) -> B {
        let Self {
            mesh,
            mut at,
            mut stop,
            then,
        } = self;
        let mut folded = init;
        let mut then = then;
        loop {
            while at != stop {
                folded = f(folded, at.edge());
                at = mesh.next(at.twin());
            }
            match then.take() {
                Some(other) => (stop, at) = (other, mesh.next(other.twin())),
                None => return folded,
            }
        }
    }
}

/// How many faces are told apart by walking the face once more before a set takes over.
const FEW: usize = 32;

/// The faces across the sides of a face, each once.
///
/// Two faces may share several sides, so every answer has to be compared with those before it. The
/// last three are at hand, which is all that triangles and quads need; for larger faces the walk is
/// repeated, and beyond 32 neighbours a set keeps the whole linear.
#[derive(Clone, Debug)]
pub(crate) struct FaceFaces<'a, P: Probe> {
    sides: Sides<'a, P>,
    last: [Slot<FaceId>; 3],
    found: usize,
    many: Option<HashSet<FaceId>>,
}

impl<'a, P: Probe> FaceFaces<'a, P> {
    #[inline]
    pub(crate) fn new(mesh: &'a HalfEdgeMesh<P>, f: FaceId) -> Self {
        Self {
            sides: mesh.sides(f),
            last: [Slot::NONE; 3],
            found: 0,
            many: None,
        }
    }

    /// The faces across the three sides, if the walk has not begun and there are three.
    #[inline]
    fn across_triangle(&self) -> Option<[Slot<FaceId>; 3]> {
        let Sides { mesh, at, first } = self.sides;
        let (second, a) = mesh.next_and_across(first);
        let (third, b) = mesh.next_and_across(second);
        let (fourth, c) = mesh.next_and_across(third);
        (at == Some(first) && fourth == first).then_some([a, b, c])
    }

    /// Whether the face across `h` differs from all that were found before.
    #[inline]
    fn is_new(&mut self, h: HalfEdgeId, face: Slot<FaceId>) -> bool {
        let [a, b, c] = self.last;
        if face == a || face == b || face == c {
            return false;
        }
        if self.found >= self.last.len() {
            // By value, but for the set: the walk itself is to stay in registers.
            let Sides { mesh, first, .. } = self.sides;
            if !is_new_among_many(mesh, first, h, self.found, &mut self.many) {
                return false;
            }
        }
        self.last = [face, a, b];
        self.found += 1;
        true
    }
}

/// Whether the face across `h` differs from those across the sides from `first` to `h`.
#[cold]
#[inline(never)]
fn is_new_among_many<P: Probe>(
    mesh: &HalfEdgeMesh<P>,
    first: HalfEdgeId,
    h: HalfEdgeId,
    found: usize,
    many: &mut Option<HashSet<FaceId>>,
) -> bool {
    let sides = Sides {
        mesh,
        at: Some(first),
        first,
    }
    .map(|(k, _)| k);
    let mut before = sides.take_while(|&k| k != h).map(|k| mesh.face(k.twin()));
    let face = mesh.face(h.twin());
    if found < FEW {
        return before.all(|other| other != face);
    }
    let many = many.get_or_insert_with(|| before.flatten().collect());
    face.is_some_and(|face| many.insert(face))
}

impl<P: Probe> Iterator for FaceFaces<'_, P> {
    type Item = FaceId;

    #[inline]
    fn next(&mut self) -> Option<FaceId> {
        loop {
            let (h, _) = self.sides.next()?;
            let across = self.sides.mesh.halves.read(h.twin().index()).face;
            if let Some(face) = across.get()
                && self.is_new(h, across)
            {
                return Some(face);
            }
        }
    }

    /// The whole answer at once, which for triangles needs three comparisons and no state.
    #[inline]
    fn fold<B, F: FnMut(B, FaceId) -> B>(mut self, init: B, mut f: F) -> B {
        if let Some([a, b, c]) = self.across_triangle() {
            let mut folded = init;
            if let Some(a) = a.get() {
                folded = f(folded, a);
            }
            if let Some(face) = b.get().filter(|_| b != a) {
                folded = f(folded, face);
            }
            if let Some(face) = c.get().filter(|_| c != a && c != b) {
                folded = f(folded, face);
            }
            return folded;
        }
        let mut folded = init;
        for face in self.by_ref() {
            folded = f(folded, face);
        }
        folded
    }
}
