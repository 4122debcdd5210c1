//! Bisecting an edge, poking a face, splitting a vertex.

use sixfold_core::{EditError, EditLog, Editable, FaceId, Point, Probe, ShortVec, Slot, VertexId};

use super::{Refusal, faced_by, report_renamed};
use crate::mesh::{CornerId, CornerTable, EdgeCorner, edge_between};

/// The corners at a vertex that is split, and the range of corners that the new vertex gets: from
/// `from` to `to`, or around the end of the list if `from` is larger.
struct FanCut {
    star: ShortVec<CornerId>,
    closed: bool,
    from: usize,
    to: usize,
}

impl FanCut {
    #[inline]
    fn wraps(&self) -> bool {
        self.from > self.to
    }

    /// Returns whether the new vertex gets corner `i`.
    #[inline]
    fn moves(&self, i: usize) -> bool {
        match self.wraps() {
            true => i >= self.from || i < self.to,
            false => i >= self.from && i < self.to,
        }
    }

    /// Returns the corner of the previous triangle that faces the edge to neighbour `i`.
    #[inline]
    fn in_previous(&self, i: usize) -> Slot<CornerId> {
        let star = self.star.as_slice();
        match i {
            0 if self.closed => Slot::some(star[star.len() - 1].next()),
            0 => Slot::NONE,
            _ => Slot::some(star[i - 1].next()),
        }
    }

    /// Returns the corner of the next triangle that faces the edge to neighbour `i`.
    #[inline]
    fn in_next(&self, i: usize) -> Slot<CornerId> {
        Slot::from(self.star.as_slice().get(i).map(|c| c.prev()))
    }
}

impl<P: Probe> CornerTable<Editable, P> {
    /// Puts m into `e`. T and R keep A; the two new triangles have B.
    ///
    /// ```text
    ///         C              T  p moves to m        new (C, m, B) has the corners t, u, w
    ///        /|\             R  q moves to m        new (D, B, m) has the corners x, y, z
    ///       / |t\
    ///      /n p|u\w          n faces C–m with w     u faces B–C with on
    ///     A────m────B        r faces m–D with y     z faces D–B with or
    ///      \r q|z/y          t faces m–B with x
    ///       \ |x/
    ///        \|/
    ///         D
    /// ```
    #[inline]
    pub(super) fn bisect(
        &mut self,
        e: EdgeCorner,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let across = self.check_edge(e)?.get();
        let c = e.corner();
        let [n, p] = [c.next(), c.prev()];
        let [vc, vb] = [c, p].map(|c| *self.vertex.read(c.index()));
        let vd = across.map(|o| *self.vertex.read(o.index()));
        if vd == Some(vc) {
            return Err(EditError::SameApex {
                edge: e,
                vertex: vc,
            });
        }
        self.check_room(1, 2)?;

        let [[t, u, w], [x, y, z]] = [self.new_corners(0), self.new_corners(1)];
        let m = self.push_vertex(at, Slot::some(u));
        let on = *self.opposite.read(n.index());
        let below = across.map_or(Slot::NONE, |_| Slot::some(x));
        self.push_triangle([vc, m, vb], [below, on, Slot::some(n)]);
        *self.vertex.write(p.index()) = m;
        *self.opposite.write(n.index()) = Slot::some(w);
        self.set_opposite(on, Slot::some(u));
        self.replace_corner(vb, p, w);
        log.created_vertex(m);
        log.created_face(t.triangle());
        log.created_edge(faced_by(t));
        report_cut(log, n, on, u);

        if let (Some(o), Some(vd)) = (across, vd) {
            let [q, r] = [o.next(), o.prev()];
            let or = *self.opposite.read(r.index());
            self.push_triangle([vd, vb, m], [Slot::some(t), Slot::some(r), or]);
            *self.vertex.write(q.index()) = m;
            *self.opposite.write(r.index()) = Slot::some(y);
            self.set_opposite(or, Slot::some(z));
            self.replace_corner(vb, q, y);
            self.replace_corner(vd, o, x);
            log.created_face(x.triangle());
            report_cut(log, r, or, z);
        }
        Ok(m)
    }

    /// Puts m into the triangle (A, B, C). The old row keeps the side A–B.
    ///
    /// ```text
    ///           C
    ///          /|\           (A, B, m) has the corners i, j, k as before
    ///         /u|y\          (B, C, m) has x, y, z:  x faces C–m with v, y faces m–B with i, z faces B–C
    ///        /  |  \         (C, A, m) has u, v, w:  u faces A–m with j, and w faces C–A
    ///       /  wmz  \
    ///      / v/ k \x \
    ///     / /i     j\ \
    ///    A─────────────B
    /// ```
    #[inline]
    pub(super) fn poke(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let [a, b, c] = self.check_face(f)?;
        self.check_room(1, 2)?;
        let [(i, bc), (j, ca), (k, _)] = self.opposites_of(f);
        let [[x, y, z], [u, v, w]] = [self.new_corners(0), self.new_corners(1)];
        let m = self.push_vertex(at, Slot::some(k));
        self.push_triangle([b, c, m], [Slot::some(v), Slot::some(i), bc]);
        self.push_triangle([c, a, m], [Slot::some(j), Slot::some(x), ca]);
        *self.vertex.write(k.index()) = m;
        *self.opposite.write(i.index()) = Slot::some(y);
        *self.opposite.write(j.index()) = Slot::some(u);
        self.set_opposite(bc, Slot::some(z));
        self.set_opposite(ca, Slot::some(w));
        // At B, the triangle (B, C, m) comes first. C has only the two new triangles.
        self.replace_corner(b, j, x);
        self.replace_corner(c, k, u);

        log.created_vertex(m);
        log.created_face(x.triangle());
        log.created_face(u.triangle());
        log.created_edge(faced_by(x));
        report_cut(log, i, bc, z);
        report_cut(log, j, ca, w);
        Ok(m)
    }

    /// Splits `v`. The new vertex n gets the corners from `right` to `left`.
    ///
    /// ```text
    ///         left
    ///       \  /y\  /        (v, n, left) has the corners x0 = x, x1, y:   y faces v–n
    ///        \/x x1\/        (v, right, n) has the corners u, w, z:        w faces n–v with y
    ///     ─── v───── n ───
    ///        /\u z/\         x1 faces left–v, x faces n–left, z faces v–right, u faces right–n
    ///       /  \w/  \
    ///         right
    /// ```
    ///
    /// If `left` or `right` is `None`, there is no triangle on that side.
    pub(super) fn split_fan(
        &mut self,
        v: VertexId,
        [left, right]: [Option<VertexId>; 2],
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let cut = self.find_cut(v, [left, right])?;
        self.check_room(1, 2)?;

        let both = left.is_some() && right.is_some();
        let [lower, upper] = [
            self.new_corners(0),
            self.new_corners(u32::from(right.is_some())),
        ];
        let n = self.push_vertex(at, Slot::NONE);
        let star = cut.star.as_slice();
        for (_, &c) in star.iter().enumerate().filter(|&(i, _)| cut.moves(i)) {
            *self.vertex.write(c.index()) = n;
        }
        let across_new_edge = |corner| match both {
            true => Slot::some(corner),
            false => Slot::NONE,
        };
        if let Some(right) = right {
            let [u, w, z] = lower;
            let [before, after] = [cut.in_previous(cut.from), cut.in_next(cut.from)];
            self.push_triangle([v, right, n], [after, across_new_edge(upper[2]), before]);
            self.link_new_triangle(after, before, u, z, log);
            if after == Slot::NONE {
                *self.corner.write(right.index()) = Slot::some(w);
            }
            log.created_face(u.triangle());
        }
        if let Some(left) = left {
            let [x, x1, y] = upper;
            let [before, after] = [cut.in_previous(cut.to), cut.in_next(cut.to)];
            self.push_triangle([v, n, left], [before, after, across_new_edge(lower[1])]);
            self.link_new_triangle(after, before, x1, x, log);
            if after == Slot::NONE {
                *self.corner.write(left.index()) = Slot::some(y);
            }
            log.created_face(x.triangle());
        }
        let start_of_open = if cut.to > 0 { star[0] } else { upper[1] };
        let (first_of_v, first_of_n) = match (left, right) {
            // One of the two vertices keeps the gap of an open fan, and the start of the fan.
            (Some(_), Some(_)) if cut.closed => (upper[0], lower[2]),
            (Some(_), Some(_)) if cut.wraps() => (upper[0], start_of_open),
            (_, Some(_)) => (if cut.from > 0 { star[0] } else { lower[0] }, lower[2]),
            _ => (upper[0], start_of_open),
        };
        *self.corner.write(v.index()) = Slot::some(first_of_v);
        *self.corner.write(n.index()) = Slot::some(first_of_n);
        log.created_vertex(n);
        log.created_edge(faced_by(if right.is_some() { lower[1] } else { upper[2] }));
        Ok(n)
    }

    /// Checks the vertices of a split, and finds the corners that the new vertex gets.
    #[inline]
    fn find_cut(
        &self,
        v: VertexId,
        [left, right]: [Option<VertexId>; 2],
    ) -> Result<FanCut, Refusal> {
        let Some(_) = self.check_vertex(v)?.get() else {
            return Err(EditError::NoFan { vertex: v });
        };
        for side in [left, right].into_iter().flatten() {
            self.check_vertex(side)?;
        }
        if left == right {
            return Err(EditError::BadNeighbours { vertex: v });
        }
        let (star, closed) = self.star(v);
        let corners = star.as_slice();
        let count = corners.len();
        if closed && (left.is_none() || right.is_none()) {
            return Err(EditError::NotOnBoundary { vertex: v });
        }
        // Each neighbour has the index of the corner after it. An open fan has one more neighbour.
        let place = |side: VertexId| {
            let mut before = corners.iter().map(|c| *self.vertex.read(c.next().index()));
            let place = before.position(|u| u == side);
            let is_end = || !closed && *self.vertex.read(corners[count - 1].prev().index()) == side;
            let place = place.or_else(|| is_end().then_some(count));
            place.ok_or(EditError::NotANeighbour { vertex: v, side })
        };
        let from = right.map_or(Ok(0), place)?;
        let to = left.map_or(Ok(count), place)?;
        Ok(FanCut {
            star,
            closed,
            from,
            to,
        })
    }

    /// Links a new triangle between the two corners that faced an edge. After this, `in_next` faces
    /// one side of the new triangle, and `in_previous` another side. The corners `across_next` and
    /// `across_previous` of the new triangle face the same two sides.
    fn link_new_triangle(
        &mut self,
        in_next: Slot<CornerId>,
        in_previous: Slot<CornerId>,
        across_next: CornerId,
        across_previous: CornerId,
        log: &mut impl EditLog<Self>,
    ) {
        self.set_opposite(in_next, Slot::some(across_next));
        self.set_opposite(in_previous, Slot::some(across_previous));
        // The lower corner keeps its handle; the other edge is new.
        let pairs = [(in_next, across_next), (in_previous, across_previous)];
        let [one, other] = pairs.map(|(old, new)| old.get().unwrap_or(new));
        log.created_edge(faced_by(one.max(other)));
    }
}

/// Reports that `old` now faces a new edge, and that `new` faces the old edge.
#[inline]
fn report_cut<P: Probe>(
    log: &mut impl EditLog<CornerTable<Editable, P>>,
    old: CornerId,
    across: Slot<CornerId>,
    new: CornerId,
) {
    report_renamed(log, edge_between(old, across), edge_between(new, across));
    log.created_edge(faced_by(old));
}
