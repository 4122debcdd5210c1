//! Bisecting an edge, poking a face, splitting a vertex.

use sixfold_core::{EditError, EditLog, Editable, FaceId, Point, Probe, Slot, VertexId};

use super::{Refusal, faced_by, report_renamed};
use crate::mesh::{CornerId, CornerTable, EdgeCorner, edge_between};

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
        let star = star.as_slice();
        let count = star.len();
        if closed && (left.is_none() || right.is_none()) {
            return Err(EditError::NotOnBoundary { vertex: v });
        }
        // Each neighbour has the index of the corner after it. An open fan has one more neighbour.
        let place = |side: VertexId| {
            let mut before = star.iter().map(|c| *self.vertex.read(c.next().index()));
            let place = before.position(|u| u == side);
            let is_end = || !closed && *self.vertex.read(star[count - 1].prev().index()) == side;
            let place = place.or_else(|| is_end().then_some(count));
            place.ok_or(EditError::NotANeighbour { vertex: v, side })
        };
        let from = right.map_or(Ok(0), place)?;
        let to = left.map_or(Ok(count), place)?;
        self.check_room(1, 2)?;

        // n gets the corners from `from` to `to`, or around the end of the list.
        let wraps = from > to;
        let moves = |i: usize| {
            if wraps {
                i >= from || i < to
            } else {
                i >= from && i < to
            }
        };
        let both = left.is_some() && right.is_some();
        let [lower, upper] = [
            self.new_corners(0),
            self.new_corners(u32::from(right.is_some())),
        ];
        let n = self.push_vertex(at, Slot::NONE);
        for (_, &c) in star.iter().enumerate().filter(|&(i, _)| moves(i)) {
            *self.vertex.write(c.index()) = n;
        }
        // The corners that face the edge to neighbour `i`, in the previous and in the next
        // triangle.
        let in_previous = |i: usize| match i {
            0 if closed => Slot::some(star[count - 1].next()),
            0 => Slot::NONE,
            _ => Slot::some(star[i - 1].next()),
        };
        let in_next = |i: usize| Slot::from(star.get(i).map(|c| c.prev()));
        if let Some(right) = right {
            let [u, w, z] = lower;
            let across_new_edge = if both {
                Slot::some(upper[2])
            } else {
                Slot::NONE
            };
            self.push_triangle(
                [v, right, n],
                [in_next(from), across_new_edge, in_previous(from)],
            );
            self.link_new_triangle(in_next(from), in_previous(from), u, z, log);
            if in_next(from) == Slot::NONE {
                *self.corner.write(right.index()) = Slot::some(w);
            }
            log.created_face(u.triangle());
        }
        if let Some(left) = left {
            let [x, x1, y] = upper;
            let across_new_edge = if both {
                Slot::some(lower[1])
            } else {
                Slot::NONE
            };
            self.push_triangle(
                [v, n, left],
                [in_previous(to), in_next(to), across_new_edge],
            );
            self.link_new_triangle(in_next(to), in_previous(to), x1, x, log);
            if in_next(to) == Slot::NONE {
                *self.corner.write(left.index()) = Slot::some(y);
            }
            log.created_face(x.triangle());
        }
        let (first_of_v, first_of_n) = match (left, right) {
            // One of the two vertices keeps the gap of an open fan, and the start of the fan.
            (Some(_), Some(_)) if closed => (upper[0], lower[2]),
            (Some(_), Some(_)) if wraps => (upper[0], if to > 0 { star[0] } else { upper[1] }),
            (_, Some(_)) => (if from > 0 { star[0] } else { lower[0] }, lower[2]),
            _ => (upper[0], if to > 0 { star[0] } else { upper[1] }),
        };
        *self.corner.write(v.index()) = Slot::some(first_of_v);
        *self.corner.write(n.index()) = Slot::some(first_of_n);
        log.created_vertex(n);
        log.created_edge(faced_by(if right.is_some() { lower[1] } else { upper[2] }));
        Ok(n)
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
