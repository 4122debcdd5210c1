//! Splitting edges and faces, and merging faces.

use sixfold_core::{
    EdgeId, EditError, EditLog, Editable, FaceId, Point, Probe, Slot, VertexId, row,
};

use super::Refusal;
use super::handle_set::HandleSet;
use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Splits `e` at a new vertex; O(degree) of one face of `e`.
    pub(super) fn split(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let h = self.half_beside_a_face(e)?;
        self.check_room(1, 1, 0)?;
        let before = self.prev(h.twin());
        let n = self.cut_edge(h, before, at, log);
        Ok(self.record(n).origin)
    }

    /// Splits `e` and its triangles at a new vertex; O(1).
    pub(super) fn bisect(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let h = self.half_beside_a_face(e)?;
        let t = h.twin();
        let [half, twin] = self.record_pair(h);
        let third = |mesh: &Self, h, half: &Half| {
            let third = mesh.third_side(h, half);
            match half.face.get() {
                Some(f) if third.is_none() => Err(mesh.not_a_triangle(f)),
                _ => Ok(third),
            }
        };
        let left = third(self, h, &half)?;
        let (before, at_before) = third(self, t, &twin)?.expect("the twin has a face");
        if let Some((_, at_third)) = left
            && at_third.origin == at_before.origin
        {
            let vertex = at_third.origin;
            return Err(EditError::SameApex { edge: e, vertex });
        }
        let faces = if left.is_some() { 2 } else { 1 };
        self.check_room(1, 1 + faces, faces)?;
        let n = self.cut_edge(h, before, at, log);
        self.cut_face(n.twin(), twin.next, log);
        if left.is_some() {
            self.cut_face(h, half.next, log);
        }
        Ok(self.record(n).origin)
    }

    /// Returns a half-edge of `e` whose twin has a face.
    fn half_beside_a_face(&self, e: EdgeId) -> Result<HalfEdgeId, Refusal> {
        let [_, other] = self.check_edge(e)?;
        let [h, t] = self.edge_half_edges(e);
        Ok(if other.face == Slot::NONE { t } else { h })
    }

    /// Inserts a vertex into the edge of `h`. Returns the new half-edge after `h`. The twin of `h`
    /// has a face, and `before` is the half-edge before the twin.
    ///
    /// ```text
    ///        h                    h       n
    ///    a ─────► b       →   a ───► m ───► b
    ///      ◄─────               ◄───   ◄───
    ///         t ◄ before          t         ◄ before
    /// ```
    fn cut_edge(
        &mut self,
        h: HalfEdgeId,
        before: HalfEdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> HalfEdgeId {
        let t = h.twin();
        let [half, twin] = self.record_pair(h);
        let n = self.next_half();
        // If the edge is on a boundary, `n` is the boundary half-edge at m.
        let m = self.push_vertex(at, Slot::some(n));
        self.push_edge([Half { origin: m, ..half }, Half { next: t, ..twin }]);
        self.link(h, n);
        self.halves.write(t.index()).origin = m;
        self.link(before, n.twin());
        self.replace_leaving(twin.origin, t, n.twin());
        log.created_vertex(m);
        log.created_edge(n.edge());
        n
    }

    /// Cuts a face by an edge from the target of `q` to the target of `p`. The part after `p` up to
    /// `q` becomes a new face. Returns the half-edge along the new face.
    ///
    /// ```text
    ///    ───► u ───► ┄        p ends at u, q at w; x runs w → u in the new face
    ///      p  ▲│
    ///        x││
    ///         │▼  q
    ///    ┄ ◄─── w ◄───
    /// ```
    fn cut_face(
        &mut self,
        p: HalfEdgeId,
        q: HalfEdgeId,
        log: &mut impl EditLog<Self>,
    ) -> HalfEdgeId {
        let [at_p, from_p] = self.record_pair(p);
        let [at_q, from_q] = self.record_pair(q);
        let old = at_p.face.get().expect("p has a face");
        let new = self.next_face();
        let x = self.push_edge([
            Half {
                next: at_p.next,
                origin: from_q.origin,
                face: Slot::some(new),
            },
            Half {
                next: at_q.next,
                origin: from_p.origin,
                face: Slot::some(old),
            },
        ]);
        self.first.push(x);
        self.relabel(at_p.next, q, new);
        self.link(p, x.twin());
        self.link(q, x);
        *self.first.write(old.index()) = x.twin();
        log.created_edge(x.edge());
        log.created_face(new);
        x
    }

    /// Splits `f` into one triangle per side, around a new vertex; O(degree).
    ///
    /// ```text
    ///          c
    ///         ╱│╲          side i runs a → b, and out(i) m → a;
    ///        ╱ │ ╲         triangle i is side i,
    ///       ╱  m  ╲                     the twin of out(i + 1),
    ///      ╱ ◄┘ └╲ ╲                    out(i)
    ///     a ──────► b
    /// ```
    #[inline]
    pub(super) fn poke(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let first = self.check_face(f)?;
        let degree = self.sides(f).count();
        self.check_room(1, degree, degree - 1)?;

        let (base, new) = (self.next_half().index(), self.next_face().index());
        let out = |i: usize| HalfEdgeId::new(row(base + 2 * i));
        let part = |i: usize| {
            if i == 0 {
                f
            } else {
                FaceId::new(row(new + i - 1))
            }
        };
        let m = self.push_vertex(at, Slot::some(out(0)));
        log.created_vertex(m);
        let mut side = first;
        for i in 0..degree {
            let before = if i == 0 { degree - 1 } else { i - 1 };
            let after = if i + 1 == degree { 0 } else { i + 1 };
            let half = self.halves.write(side.index());
            let Half { next, origin, .. } = *half;
            *half = Half {
                next: out(after).twin(),
                origin,
                face: Slot::some(part(i)),
            };
            self.push_edge([
                Half {
                    next: side,
                    origin: m,
                    face: Slot::some(part(i)),
                },
                Half {
                    next: out(before),
                    origin,
                    face: Slot::some(part(before)),
                },
            ]);
            log.created_edge(out(i).edge());
            if i > 0 {
                self.first.push(side);
                log.created_face(part(i));
            }
            side = next;
        }
        Ok(m)
    }

    /// Splits `f` by an edge between two of its corners; O(degree + valence).
    pub(super) fn split_between(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal> {
        self.check_face(f)?;
        let mut arriving = [None; 2];
        for (h, _) in self.sides(f) {
            let target = self.record(h.twin()).origin;
            for (end, arriving) in ends.into_iter().zip(&mut arriving) {
                if target == end {
                    *arriving = Some(h);
                }
            }
        }
        let corner = |i: usize| {
            arriving[i].ok_or(EditError::NotACorner {
                face: f,
                vertex: ends[i],
            })
        };
        let (p, q) = (corner(0)?, corner(1)?);
        if p == q || self.follow(p) == q || self.follow(q) == p {
            return Err(EditError::AdjacentCorners { face: f, ends });
        }
        let [u, w] = ends;
        if self.spokes(u).any(|(_, arriving)| arriving.origin == w) {
            return Err(EditError::EdgeExists { ends });
        }
        self.check_room(0, 1, 1)?;
        Ok(self.cut_face(p, q, log).edge())
    }

    /// Merges the two faces of `e`; O(degree) of both faces, O(degree log degree) above 16 corners.
    pub(super) fn dissolve(
        &mut self,
        e: EdgeId,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        let [one, other] = self.check_edge(e)?;
        let (Some(f), Some(g)) = (one.face.get(), other.face.get()) else {
            return Err(EditError::NotTwoFaces { edge: e, faces: 1 });
        };
        let [h, t] = self.edge_half_edges(e);
        // The corners of one face, except the ends of `e`.
        let mut corners = HandleSet::new();
        let mut before_h = one.next;
        loop {
            let next = self.follow(before_h);
            if next == h {
                break;
            }
            corners.push(self.record(next).origin);
            before_h = next;
        }
        corners.sort();
        let mut before_t = other.next;
        loop {
            let next = self.follow(before_t);
            if next == t {
                break;
            }
            let vertex = self.record(next).origin;
            if corners.contains(vertex) {
                return Err(EditError::RepeatedVertex { vertex });
            }
            before_t = next;
        }

        self.relabel(other.next, before_t, f);
        self.link(before_h, other.next);
        self.link(before_t, one.next);
        *self.first.write(f.index()) = one.next;
        self.replace_leaving(one.origin, h, other.next);
        self.replace_leaving(other.origin, t, one.next);
        self.delete_edge(e);
        self.delete_face(g);
        log.removed_edge(e);
        log.removed_face(g);
        Ok(f)
    }
}
