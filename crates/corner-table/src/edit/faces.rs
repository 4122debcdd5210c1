//! Triangles added and removed.

use mesh_core::{EditError, EditLog, FaceId, Few, Probe, Slot, VertexId};

use super::{Refusal, faced_by, tell_renamed};
use crate::mesh::{CornerId, EditableCornerTable, edge_between};

impl<P: Probe> EditableCornerTable<P> {
    /// Adds the triangle over three vertices, beside the triangles that run its sides the other way.
    ///
    /// ```text
    ///     s           l        At a vertex v of an open fan, from the edge v–s to the edge v–l, the
    ///      \  fan at /         new triangle comes before the first or after the last triangle, or it
    ///       \   v   /          closes the gap: of its sides v–u and w–v, u is l or w is s.
    /// ```
    pub(super) fn add_triangle(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        let &[a, b, c] = corners else {
            let corners = corners.len();
            return Err(if corners < 3 {
                EditError::TooFewCorners { corners }
            } else {
                EditError::OnlyTriangles { corners }
            });
        };
        for (v, other) in [(a, b), (b, c), (c, a)] {
            self.check_vertex(v)?;
            if v == other {
                return Err(EditError::RepeatedVertex { vertex: v });
            }
        }
        self.check_room(0, 1)?;
        let places = [self.gap(a, b, c)?, self.gap(b, c, a)?, self.gap(c, a, b)?];

        // What lies across the side from each vertex on is opposite to the corner before it.
        let new = self.new_corners(0);
        let [ab, bc, ca] = places.map(|gap| gap.across);
        self.push_triangle([a, b, c], [bc, ca, ab]);
        let [at_a, at_b, at_c] = new;
        for (across, corner) in [(bc, at_a), (ca, at_b), (ab, at_c)] {
            self.answer(across, Slot::some(corner));
            if across == Slot::NONE {
                log.created_edge(faced_by(corner));
            }
        }
        for ((v, corner), gap) in [a, b, c].into_iter().zip(new).zip(places) {
            if gap.is_first {
                *self.corner.write(v.index()) = Slot::some(corner);
            }
        }
        log.created_face(at_a.triangle());
        Ok(at_a.triangle())
    }

    /// Where a triangle with the sides w–v and v–u comes into the fan of `v`.
    fn gap(&self, v: VertexId, u: VertexId, w: VertexId) -> Result<Gap, Refusal> {
        let Some(first) = self.corner.read(v.index()).get() else {
            return Ok(Gap {
                across: Slot::NONE,
                is_first: true,
            });
        };
        let (mut last, mut end) = (first.next(), Slot::NONE);
        // The triangle in which v is followed by u, and that in which it is followed by w.
        let (mut at_u, mut at_w) = (None, None);
        for (after, across) in self.fan(v) {
            let beyond = *self.vertex.read(after.index());
            if beyond == u {
                at_u = Some(after);
            } else if beyond == w {
                at_w = Some(after);
            }
            (last, end) = (after, across);
        }
        let open = end == Slot::NONE;
        let beyond_last = *self.vertex.read(last.next().index());
        let (joins_last, joins_first) =
            (open && beyond_last == u, open && at_w == Some(first.next()));
        // The boundary edges where the triangle does not fit are run already, the other edges are full.
        if let Some(at_u) = at_u {
            return Err(if open && at_u == first.next() {
                self.runs(v, u, at_u)
            } else {
                self.full(at_u)
            });
        }
        if open && beyond_last == w {
            return Err(self.runs(w, v, last));
        }
        if let Some(at_w) = at_w.filter(|_| !joins_first) {
            return Err(self.full(at_w));
        }
        if !joins_last && !joins_first {
            return Err(EditError::SeveralFans { vertex: v });
        }
        Ok(Gap {
            across: if joins_last {
                Slot::some(last)
            } else {
                Slot::NONE
            },
            is_first: joins_first && !joins_last,
        })
    }

    fn runs(&self, from: VertexId, to: VertexId, corner: CornerId) -> Refusal {
        EditError::RepeatedSide {
            from,
            to,
            face: corner.triangle(),
        }
    }

    /// The edge between the vertex that is followed by `after`, and that of `after`, has two faces.
    fn full(&self, after: CornerId) -> Refusal {
        EditError::FullEdge {
            edge: self.edge(after.next()),
        }
    }

    /// Removes `f`. The edges it shared are those of its neighbours alone.
    pub(super) fn remove_triangle(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        let [a, b, c] = self.check_face(f)?;
        let [(x, ox), (y, oy), (z, oz)] = self.opposites_of(f);
        let blocks = [(a, oz, oy), (b, ox, oz), (c, oy, ox)];
        for (v, before, after) in blocks {
            self.check_block(v, before, after)?;
        }
        for (v, before, after) in blocks {
            self.cut_block(v, before, after);
        }
        for (corner, across) in [(x, ox), (y, oy), (z, oz)] {
            self.open_side(corner, across, log);
        }
        self.delete_triangle(f);
        log.removed_face(f);
        Ok(())
    }

    /// Removes `v` and all triangles at it. Each vertex around loses one of its triangles, or two that
    /// are beside each other.
    pub(super) fn remove_star(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        if self.check_vertex(v)?.get().is_some() {
            let (star, closed) = self.star(v);
            let star = star.as_slice();
            // Between the corners of the star, counter-clockwise; outside of an open one there is none.
            let gaps = (0..star.len() + usize::from(!closed)).map(|i| {
                let before = match i {
                    0 if closed => star.last(),
                    _ => i.checked_sub(1).and_then(|i| star.get(i)),
                };
                [before, star.get(i)].map(|c| c.copied())
            });
            for [before, next] in gaps.clone() {
                let (u, outer) = self.rim(v, before, next);
                self.check_block(u, outer[0], outer[1])?;
            }
            for [before, next] in gaps {
                let (u, outer) = self.rim(v, before, next);
                self.cut_block(u, outer[0], outer[1]);
            }
            self.delete_star(star, closed, log);
        }
        self.delete_vertex(v);
        log.removed_vertex(v);
        Ok(())
    }

    /// The corners at `v`, counter-clockwise, and whether its fan is closed.
    pub(super) fn star(&self, v: VertexId) -> (Few<CornerId>, bool) {
        let mut star = Few::new();
        let mut closed = false;
        for (after, across) in self.fan(v) {
            star.push(after.prev());
            closed = across != Slot::NONE;
        }
        (star, closed)
    }

    /// The vertex between two corners at `v` that follow each other, and what lies across the outer
    /// sides of their triangles: before both, around that vertex, and after both.
    fn rim(
        &self,
        v: VertexId,
        before: Option<CornerId>,
        next: Option<CornerId>,
    ) -> (VertexId, [Slot<CornerId>; 2]) {
        let at = next.map_or_else(|| before.map(CornerId::prev), |c| Some(c.next()));
        let at = at.expect("a triangle on one side at least");
        // Of two triangles with the same corners each lies across all sides of the other.
        let outer = |c: Option<CornerId>| {
            let across = c.and_then(|c| self.opposite(c));
            Slot::from(across.filter(|&o| self.vertex(o) != v))
        };
        (self.vertex(at), [outer(next), outer(before)])
    }

    fn delete_star(&mut self, star: &[CornerId], closed: bool, log: &mut impl EditLog<Self>) {
        for &c in star {
            let [next, prev] = [c.next(), c.prev()];
            // Each inner spoke is told by the first of its triangles.
            log.removed_edge(self.edge(next));
            let across = *self.opposite.read(c.index());
            match across.get() {
                // Two triangles with the same corners: the edge is told by one of them.
                Some(o) if closed && star.len() == 2 && star.contains(&o) => {
                    if c < o {
                        log.removed_edge(faced_by(c));
                    }
                }
                _ => self.open_side(c, across, log),
            }
            if !closed && c == star[0] {
                log.removed_edge(faced_by(prev));
            }
            log.removed_face(c.triangle());
        }
        for &c in star {
            self.delete_triangle(c.triangle());
        }
    }
}

/// Where a new triangle comes into a fan.
#[derive(Clone, Copy)]
struct Gap {
    /// What lies across the side that leaves the vertex.
    across: Slot<CornerId>,
    /// Whether the fan begins with the new triangle.
    is_first: bool,
}

/// Triangles beside each other are taken out of the fan of a vertex: `before` lies across the first
/// of them, `after` across the last, counter-clockwise.
impl<P: Probe> EditableCornerTable<P> {
    fn check_block(
        &self,
        v: VertexId,
        before: Slot<CornerId>,
        after: Slot<CornerId>,
    ) -> Result<(), Refusal> {
        if before != Slot::NONE && after != Slot::NONE && self.is_on_boundary(v) {
            return Err(EditError::SeveralFans { vertex: v });
        }
        Ok(())
    }

    /// The fan begins after what is taken out, or, if nothing comes after, where it did.
    fn cut_block(&mut self, v: VertexId, before: Slot<CornerId>, after: Slot<CornerId>) {
        match after.get() {
            Some(after) => *self.corner.write(v.index()) = Slot::some(after.next()),
            None if before == Slot::NONE => *self.corner.write(v.index()) = Slot::NONE,
            None => {}
        }
    }

    /// Leaves the edge that `c` faces to the triangle across, or removes it.
    fn open_side(&mut self, c: CornerId, across: Slot<CornerId>, log: &mut impl EditLog<Self>) {
        match across.get() {
            Some(o) => {
                *self.opposite.write(o.index()) = Slot::NONE;
                tell_renamed(log, edge_between(c, across), faced_by(o));
            }
            None => log.removed_edge(faced_by(c)),
        }
    }
}
