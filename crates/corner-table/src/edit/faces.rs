//! Adding and removing triangles.

use sixfold_core::{EditError, EditLog, Editable, FaceId, Probe, ShortVec, Slot, VertexId};

use super::{Refusal, faced_by, report_renamed};
use crate::mesh::{CornerId, CornerTable, edge_between};

impl<P: Probe> CornerTable<Editable, P> {
    /// Adds a triangle, and links it to the triangles across its sides.
    ///
    /// ```text
    ///     s           l        The fan of v is open, from the edge v–s to the edge v–l. The new
    ///      \  fan at /         triangle has the sides v–u and w–v. It comes before the first
    ///       \   v   /          triangle (w = s), after the last (u = l), or closes the gap (both).
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
        let gaps = [
            self.find_gap(a, b, c)?,
            self.find_gap(b, c, a)?,
            self.find_gap(c, a, b)?,
        ];

        // The corner across a side is opposite to the corner of the third vertex.
        let new = self.new_corners(0);
        let [ab, bc, ca] = gaps.map(|gap| gap.across);
        self.push_triangle([a, b, c], [bc, ca, ab]);
        let [at_a, at_b, at_c] = new;
        for (across, corner) in [(bc, at_a), (ca, at_b), (ab, at_c)] {
            self.set_opposite(across, Slot::some(corner));
            if across == Slot::NONE {
                log.created_edge(faced_by(corner));
            }
        }
        for ((v, corner), gap) in [a, b, c].into_iter().zip(new).zip(gaps) {
            if gap.is_first {
                *self.corner.write(v.index()) = Slot::some(corner);
            }
        }
        log.created_face(at_a.triangle());
        Ok(at_a.triangle())
    }

    /// Finds the place of a triangle with the sides w–v and v–u in the fan of `v`.
    fn find_gap(&self, v: VertexId, u: VertexId, w: VertexId) -> Result<Gap, Refusal> {
        let Some(first) = self.corner.read(v.index()).get() else {
            return Ok(Gap {
                across: Slot::NONE,
                is_first: true,
            });
        };
        let (mut last, mut end) = (first.next(), Slot::NONE);
        // `at_u` is the corner after v in the triangle where u follows v. `at_w` is the corner
        // after v in the triangle where w follows v.
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
        // The triangle does not fit in two cases: a face already runs along one of the edges in
        // this direction, or the edge has two faces.
        if let Some(at_u) = at_u {
            return Err(if open && at_u == first.next() {
                self.repeated_side_error(v, u, at_u)
            } else {
                self.full_edge_error(at_u)
            });
        }
        if open && beyond_last == w {
            return Err(self.repeated_side_error(w, v, last));
        }
        if let Some(at_w) = at_w.filter(|_| !joins_first) {
            return Err(self.full_edge_error(at_w));
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

    fn repeated_side_error(&self, from: VertexId, to: VertexId, corner: CornerId) -> Refusal {
        EditError::RepeatedSide {
            from,
            to,
            face: corner.triangle(),
        }
    }

    /// Returns the error for an edge with two faces. The edge ends at the vertex of `after`.
    fn full_edge_error(&self, after: CornerId) -> Refusal {
        EditError::FullEdge {
            edge: self.edge(after.next()),
        }
    }

    /// Removes `f`. Each edge with another face becomes a boundary edge.
    pub(super) fn remove_triangle(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        let [a, b, c] = self.check_face(f)?;
        let [(x, ox), (y, oy), (z, oz)] = self.opposites_of(f);
        let removals = [(a, oz, oy), (b, ox, oz), (c, oy, ox)];
        for (v, before, after) in removals {
            self.check_removal(v, before, after)?;
        }
        for (v, before, after) in removals {
            self.remove_from_fan(v, before, after);
        }
        for (corner, across) in [(x, ox), (y, oy), (z, oz)] {
            self.unlink_side(corner, across, log);
        }
        self.delete_triangle(f);
        log.removed_face(f);
        Ok(())
    }

    /// Removes the triangles `gone`, which are sorted, without a check. The triangles that remain at a vertex
    /// form one fan.
    pub(super) fn remove_triangles(&mut self, gone: &[FaceId], log: &mut impl EditLog<Self>) {
        let is_gone = |c: CornerId| gone.binary_search(&c.triangle()).is_ok();
        let mut starts = Vec::new();
        for &f in gone {
            for (c, _) in self.opposites_of(f) {
                let v = self.vertex(c);
                // The first remaining corner follows a corner that goes.
                let (mut start, mut remains_before) = (Slot::NONE, false);
                for (after, _) in self.fan(v) {
                    let remains = !is_gone(after);
                    if remains && !remains_before {
                        start = Slot::some(after.prev());
                    }
                    remains_before = remains;
                }
                starts.push((v, start));
            }
        }
        for (v, start) in starts {
            *self.corner.write(v.index()) = start;
        }
        for &f in gone {
            for (c, across) in self.opposites_of(f) {
                match across.get() {
                    // The first of the two triangles reports the edge.
                    Some(o) if is_gone(o) => {
                        if c < o {
                            log.removed_edge(faced_by(c));
                        }
                    }
                    _ => self.unlink_side(c, across, log),
                }
            }
            log.removed_face(f);
        }
        for &f in gone {
            self.delete_triangle(f);
        }
    }

    /// Removes `v` and all triangles at `v`. Each neighbour of `v` loses one triangle or two
    /// adjacent triangles.
    pub(super) fn remove_star(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        if self.check_vertex(v)?.get().is_some() {
            let (star, closed) = self.star(v);
            let star = star.as_slice();
            // A gap lies between two consecutive corners of the star, counter-clockwise. At an end
            // of an open star, one of the two corners is `None`.
            let gaps = (0..star.len() + usize::from(!closed)).map(|i| {
                let before = match i {
                    0 if closed => star.last(),
                    _ => i.checked_sub(1).and_then(|i| star.get(i)),
                };
                [before, star.get(i)].map(|c| c.copied())
            });
            for [before, next] in gaps.clone() {
                let (u, outer) = self.rim(v, before, next);
                self.check_removal(u, outer[0], outer[1])?;
            }
            for [before, next] in gaps {
                let (u, outer) = self.rim(v, before, next);
                self.remove_from_fan(u, outer[0], outer[1]);
            }
            self.delete_star(star, closed, log);
        }
        self.delete_vertex(v);
        log.removed_vertex(v);
        Ok(())
    }

    /// Returns the corners at `v`, counter-clockwise, and whether the fan is closed.
    pub(super) fn star(&self, v: VertexId) -> (ShortVec<CornerId>, bool) {
        let mut star = ShortVec::new();
        let mut closed = false;
        for (after, across) in self.fan(v) {
            star.push(after.prev());
            closed = across != Slot::NONE;
        }
        (star, closed)
    }

    /// Returns the other end of the edge at `v` between the triangles of two consecutive corners.
    /// Also returns the corners across the outer sides of these triangles. An outer side has this
    /// end, but not `v`.
    fn rim(
        &self,
        v: VertexId,
        before: Option<CornerId>,
        next: Option<CornerId>,
    ) -> (VertexId, [Slot<CornerId>; 2]) {
        let at = next.map_or_else(|| before.map(CornerId::prev), |c| Some(c.next()));
        let at = at.expect("there is a triangle on at least one side");
        // Two triangles with the same corners are adjacent along all sides.
        let outer = |c: Option<CornerId>| {
            let across = c.and_then(|c| self.opposite(c));
            Slot::from(across.filter(|&o| self.vertex(o) != v))
        };
        (self.vertex(at), [outer(next), outer(before)])
    }

    fn delete_star(&mut self, star: &[CornerId], closed: bool, log: &mut impl EditLog<Self>) {
        for &c in star {
            let [next, prev] = [c.next(), c.prev()];
            // The first triangle of an inner spoke reports the edge.
            log.removed_edge(self.edge(next));
            let across = *self.opposite.read(c.index());
            match across.get() {
                // If two triangles have the same corners, only one of them reports the edge.
                Some(o) if closed && star.len() == 2 && star.contains(&o) => {
                    if c < o {
                        log.removed_edge(faced_by(c));
                    }
                }
                _ => self.unlink_side(c, across, log),
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

/// The place of a new triangle in a fan.
#[derive(Clone, Copy)]
struct Gap {
    /// The corner across the side that leaves the vertex.
    across: Slot<CornerId>,
    is_first: bool,
}

/// Removal of adjacent triangles from the fan of a vertex. Counter-clockwise, `before` is the
/// corner across the first triangle and `after` the corner across the last triangle.
impl<P: Probe> CornerTable<Editable, P> {
    fn check_removal(
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

    /// Updates `corner(v)` if the start of the fan changes.
    fn remove_from_fan(&mut self, v: VertexId, before: Slot<CornerId>, after: Slot<CornerId>) {
        match after.get() {
            Some(after) => *self.corner.write(v.index()) = Slot::some(after.next()),
            None if before == Slot::NONE => *self.corner.write(v.index()) = Slot::NONE,
            None => {}
        }
    }

    /// Removes the triangle of `c` from the edge that `c` faces. An edge without another triangle
    /// is removed.
    fn unlink_side(&mut self, c: CornerId, across: Slot<CornerId>, log: &mut impl EditLog<Self>) {
        match across.get() {
            Some(o) => {
                *self.opposite.write(o.index()) = Slot::NONE;
                report_renamed(log, edge_between(c, across), faced_by(o));
            }
            None => log.removed_edge(faced_by(c)),
        }
    }
}
