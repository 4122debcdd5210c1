//! Walks around a vertex and around an edge, as iterators that end after one turn.
//!
//! ```text
//!        b                 The walk around v stores n, the corner after the one at v. A step needs
//!       / \                one row of each table: vertex(n) is the neighbour a, and opposite(n) is
//!   …  / t \   a = V(n)    the corner across the edge v–b, which n faces. The corner before that
//!     /     \  n           one is the next n.
//!    b ───── v
//! ```

use sixfold_core::{Editing, IteratorExt, Probe, Slot, VertexId, row};

use crate::mesh::{CornerId, CornerTable, EdgeCorner, edge_between, named_edge, names_edge};

/// The edges of a mesh, by ascending corner.
///
/// The iterator skips about every second corner, in an unpredictable order.
#[derive(Clone, Debug)]
pub(crate) struct Edges<'a, P: Probe, E: Editing> {
    mesh: &'a CornerTable<E, P>,
    at: usize,
}

impl<'a, P: Probe, E: Editing> Edges<'a, P, E> {
    #[inline]
    pub(crate) fn new(mesh: &'a CornerTable<E, P>) -> Self {
        Self { mesh, at: 0 }
    }
}

impl<P: Probe, E: Editing> Iterator for Edges<'_, P, E> {
    type Item = EdgeCorner;

    #[inline]
    fn next(&mut self) -> Option<EdgeCorner> {
        while self.at < self.mesh.opposite.len() {
            let c = CornerId::new(self.at as u32);
            let across = *self.mesh.opposite.read(self.at);
            self.at += 1;
            if names_edge(c, across) {
                return Some(EdgeCorner::new(c.index() as u32));
            }
        }
        None
    }

    #[inline]
    fn fold<B, F: FnMut(B, EdgeCorner) -> B>(self, init: B, visit: F) -> B {
        let corners = row(self.at)..row(self.mesh.opposite.len());
        let edges = corners.map(CornerId::new).filter_map(|c| {
            let across = *self.mesh.opposite.read(c.index());
            // A corner of a deleted triangle is its own opposite.
            let is_there = !E::CAN_DELETE || across != Slot::some(c);
            named_edge(c, across).filter(|_| is_there)
        });
        edges.fold(init, visit)
    }
}

impl<P: Probe, E: Editing> CornerTable<E, P> {
    /// Yields the corners at `v`, counter-clockwise: each step is `c → swing(c)`. If `v` is on a boundary, the triangle of the
    /// first corner and the triangle of the last corner have a boundary edge at `v`.
    ///
    /// # Panics
    ///
    /// Panics if there is no vertex `v`.
    #[inline]
    pub fn corners_at(&self, v: VertexId) -> impl Iterator<Item = CornerId> + Clone {
        self.fan(v).map_inline(|(after, _)| after.prev())
    }

    #[inline]
    pub(crate) fn fan(&self, v: VertexId) -> Fan<'_, P, E> {
        let at = self.corner_at(v).map(CornerId::next);
        Fan {
            mesh: self,
            at,
            first: at,
        }
    }
}

/// The corners at a vertex, counter-clockwise. Each item has the next corner in the triangle and
/// the opposite of the corner.
#[derive(Clone, Debug)]
pub(crate) struct Fan<'a, P: Probe, E: Editing> {
    mesh: &'a CornerTable<E, P>,
    at: Option<CornerId>,
    first: Option<CornerId>,
}

impl<P: Probe, E: Editing> Iterator for Fan<'_, P, E> {
    type Item = (CornerId, Slot<CornerId>);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let n = self.at?;
        let across = *self.mesh.opposite.read(n.index());
        let turned = across.get().map(CornerId::prev);
        self.at = if turned == self.first { None } else { turned };
        Some((n, across))
    }

    #[inline]
    fn fold<B, F: FnMut(B, Self::Item) -> B>(self, init: B, mut f: F) -> B {
        let (Some(mut n), Some(first)) = (self.at, self.first) else {
            return init;
        };
        let mut folded = init;
        loop {
            let across = *self.mesh.opposite.read(n.index());
            folded = f(folded, (n, across));
            match across.get().map(CornerId::prev) {
                Some(turned) if turned != first => n = turned,
                _ => return folded,
            }
        }
    }
}

/// The neighbours of a vertex: one for each corner, and one more at the end of an open fan.
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<'a, P: Probe, E: Editing> {
    fan: Fan<'a, P, E>,
    /// The last corner of an open fan, after the end of the fan.
    last: Option<CornerId>,
}

impl<'a, P: Probe, E: Editing> Neighbours<'a, P, E> {
    #[inline]
    pub(crate) fn new(mesh: &'a CornerTable<E, P>, v: VertexId) -> Self {
        Self {
            fan: mesh.fan(v),
            last: None,
        }
    }
}

impl<P: Probe, E: Editing> Iterator for Neighbours<'_, P, E> {
    type Item = VertexId;

    #[inline]
    fn next(&mut self) -> Option<VertexId> {
        let at = match self.fan.next() {
            Some((n, across)) => {
                if across.get().is_none() {
                    self.last = Some(n.next());
                }
                n
            }
            None => self.last.take()?,
        };
        Some(self.fan.mesh.vertex(at))
    }

    /// Uses its own loop: with the loop of the fan, each step would need a second test.
    #[inline]
    fn fold<B, F: FnMut(B, VertexId) -> B>(self, init: B, mut f: F) -> B {
        let Fan { mesh, at, first } = self.fan;
        let (Some(mut n), Some(first)) = (at, first) else {
            return match self.last {
                Some(last) => f(init, mesh.vertex(last)),
                None => init,
            };
        };
        let mut folded = init;
        loop {
            folded = f(folded, mesh.vertex(n));
            match mesh.opposite(n).map(CornerId::prev) {
                Some(turned) if turned == first => return folded,
                Some(turned) => n = turned,
                None => return f(folded, mesh.vertex(n.next())),
            }
        }
    }
}

/// The edges at a vertex: one for each corner, and the first edge of an open fan.
#[derive(Clone, Debug)]
pub(crate) struct Spokes<'a, P: Probe, E: Editing> {
    fan: Fan<'a, P, E>,
    open: bool,
}

impl<'a, P: Probe, E: Editing> Spokes<'a, P, E> {
    #[inline]
    pub(crate) fn new(mesh: &'a CornerTable<E, P>, v: VertexId) -> Self {
        Self {
            fan: mesh.fan(v),
            open: false,
        }
    }

    /// Returns the first boundary edge of an open fan.
    #[inline]
    fn first_edge(&self) -> Option<EdgeCorner> {
        self.fan.first.map(|n| edge_between(n.next(), Slot::NONE))
    }
}

impl<P: Probe, E: Editing> Iterator for Spokes<'_, P, E> {
    type Item = EdgeCorner;

    #[inline]
    fn next(&mut self) -> Option<EdgeCorner> {
        match self.fan.next() {
            Some((n, across)) => {
                self.open = across.get().is_none();
                Some(edge_between(n, across))
            }
            None if self.open => {
                self.open = false;
                self.first_edge()
            }
            None => None,
        }
    }

    #[inline]
    fn fold<B, F: FnMut(B, EdgeCorner) -> B>(self, init: B, mut f: F) -> B {
        let (first_edge, mut open) = (self.first_edge(), self.open);
        let folded = self.fan.fold(init, |folded, (n, across)| {
            open = across.get().is_none();
            f(folded, edge_between(n, across))
        });
        match first_edge.filter(|_| open) {
            Some(edge) => f(folded, edge),
            None => folded,
        }
    }
}

/// The edges at both ends of an edge, except the edge itself. Reads only `opposite`.
///
/// ```text
///        c              Around a, counter-clockwise from the edge: the first corner that faces
///       / \             an edge at a is prev(c); the walk ends at d. Around b likewise: from
///      /   \            prev(d), the walk ends at c.
///     a ─e─ b
///      \   /            If a walk ends at a boundary, the rest of the fan is walked clockwise:
///       \ /             from next(d) around a, from next(c) around b.
///        d
/// ```
#[derive(Clone, Debug)]
pub(crate) struct EdgeEdges<'a, P: Probe, E: Editing> {
    mesh: &'a CornerTable<E, P>,
    /// The corner that faces the next edge.
    at: Option<CornerId>,
    direction: Direction,
    /// The corner that faces the edge at the start of the walk.
    near: Slot<CornerId>,
    /// The corner that faces the edge at the end of the walk.
    far: Slot<CornerId>,
    /// Whether the walk around the other end has not started.
    other_end_pending: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Counterclockwise,
    Clockwise,
}

impl<'a, P: Probe, E: Editing> EdgeEdges<'a, P, E> {
    #[inline]
    pub(crate) fn new(mesh: &'a CornerTable<E, P>, e: EdgeCorner) -> Self {
        let c = e.corner();
        Self {
            mesh,
            far: mesh.across(e),
            near: Slot::some(c),
            at: Some(c.prev()),
            direction: Direction::Counterclockwise,
            other_end_pending: true,
        }
    }
}

impl<P: Probe, E: Editing> EdgeEdges<'_, P, E> {
    /// Starts the next walk. Returns false if all walks are finished.
    #[inline]
    fn begin_next_walk(&mut self) -> bool {
        // A walk that ended at a boundary has not visited the whole fan.
        if self.at.is_none() && self.direction == Direction::Counterclockwise {
            self.direction = Direction::Clockwise;
            self.at = self.far.get().map(CornerId::next);
            return true;
        }
        let starts_other_end = std::mem::take(&mut self.other_end_pending);
        if starts_other_end {
            self.direction = Direction::Counterclockwise;
            (self.near, self.far) = (self.far, self.near);
            self.at = self.near.get().map(CornerId::prev);
        }
        starts_other_end
    }
}

impl<P: Probe, E: Editing> Iterator for EdgeEdges<'_, P, E> {
    type Item = EdgeCorner;

    #[inline]
    fn next(&mut self) -> Option<EdgeCorner> {
        loop {
            if let Some(at) = before(self.at, self.far) {
                let across = *self.mesh.opposite.read(at.index());
                self.at = across.get().map(|across| match self.direction {
                    Direction::Counterclockwise => across.prev(),
                    Direction::Clockwise => across.next(),
                });
                return Some(edge_between(at, across));
            }
            if !self.begin_next_walk() {
                return None;
            }
        }
    }

    // Always inlined: not inlined, `edge_edges` takes 1.24 times the time.
    #[inline(always)]
    fn fold<B, F: FnMut(B, EdgeCorner) -> B>(mut self, init: B, mut f: F) -> B {
        let opposite = &self.mesh.opposite;
        let mut folded = init;
        loop {
            // Two loops without a test of the direction. The variables stay in registers; fields
            // would be read from memory at every step.
            let (mut at, far) = (self.at, self.far);
            match self.direction {
                Direction::Counterclockwise => {
                    while let Some(c) = before(at, far) {
                        let across = *opposite.read(c.index());
                        folded = f(folded, edge_between(c, across));
                        at = across.get().map(CornerId::prev);
                    }
                }
                Direction::Clockwise => {
                    while let Some(c) = before(at, far) {
                        let across = *opposite.read(c.index());
                        folded = f(folded, edge_between(c, across));
                        at = across.get().map(CornerId::next);
                    }
                }
            }
            self.at = at;
            if !self.begin_next_walk() {
                return folded;
            }
        }
    }
}

/// Returns `at`, or `None` if the walk ends there.
#[inline(always)]
fn before(at: Option<CornerId>, far: Slot<CornerId>) -> Option<CornerId> {
    at.filter(|&at| Slot::some(at) != far)
}

#[cfg(test)]
mod tests {
    use std::fmt::Debug;
    use std::iter::from_fn;

    use sixfold_core::{MeshQuery, Representation};

    use super::*;
    use crate::CornerTable;

    /// Checks that `fold` and `next` visit the same items, after any number of steps.
    fn check_fold_equals_next<I>(items: I, of: impl Debug)
    where
        I: Iterator<Item: Debug + PartialEq> + Clone,
    {
        let mut rest = items;
        loop {
            let (mut stepped, mut folded) = (Vec::new(), Vec::new());
            let mut steps = rest.clone();
            stepped.extend(from_fn(|| steps.next()));
            rest.clone().for_each(|item| folded.push(item));
            assert_eq!(folded, stepped, "at {of:?}");
            assert!(steps.next().is_none(), "at {of:?}: next() after the end");
            if rest.next().is_none() {
                return;
            }
        }
    }

    #[test]
    fn fold_visits_the_items_of_next() {
        let open = sixfold_shapes::grid_with_hole(4, 4).expect("a valid size");
        for polygons in [
            sixfold_shapes::octahedron(),
            open.triangulated().expect("small").polygons,
        ] {
            let mesh = CornerTable::from_polygons(&polygons).expect("manifold");
            for v in mesh.vertices() {
                check_fold_equals_next(mesh.corners_at(v), v);
                check_fold_equals_next(mesh.fan(v), v);
                check_fold_equals_next(Neighbours::new(&mesh, v), v);
                check_fold_equals_next(Spokes::new(&mesh, v), v);
            }
            check_fold_equals_next(Edges::new(&mesh), "edges");
            for e in mesh.edges() {
                check_fold_equals_next(EdgeEdges::new(&mesh, e), e);
            }
        }
    }
}
