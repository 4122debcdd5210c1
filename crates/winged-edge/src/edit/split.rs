//! Splitting edges and faces.

use sixfold_core::{
    EdgeId, EditError, EditLog, Editable, FaceId, MeshQuery, Point, Probe, Refusal, Slot, VertexId,
    row,
};

use super::primitives::{edge_record, runs_of};
use crate::edge::{Run, RunId};
use crate::mesh::WingedEdgeMesh;

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Inserts a vertex into `e`. Returns the vertex and the new edge, which starts there.
    ///
    /// ```text
    ///     a ──── e ────► b        a ── e ──► m ── n ──► b
    /// ```
    pub(super) fn cut_edge(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> (VertexId, EdgeId) {
        let edge = *self.record(e);
        let ([_, b], [left, right]) = (edge.ends, edge.faces);
        let m = self.push_vertex(at, log);
        let ([next, _], [_, prev]) = (edge.next.both(), edge.prev.both());
        let n = self.push_edge(edge_record([m, b], (left, next, e), (right, e, prev)), log);
        let [ahead, behind] = runs_of(e);
        let record = self.edges.write(e.index());
        record.ends[1] = m;
        record.next.set(ahead.side, n);
        record.prev.set(behind.side, n);
        let (next, prev) = (self.leaving(next, b), self.arriving(prev, b));
        self.edges.write(next.edge.index()).prev.set(next.side, n);
        self.edges.write(prev.edge.index()).next.set(prev.side, n);
        self.replace_spoke(b, e, n);
        // Seen from m, the left face is on the right of e, and the right face is on the right of n.
        self.set_spoke(m, if left == Slot::NONE { e } else { n });
        (m, n)
    }

    pub(super) fn bisect(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let faces = self.check_edge(e)?.faces;
        let mut apexes = [None; 2];
        for (run, apex) in runs_of(e).into_iter().zip(&mut apexes) {
            let face = faces[run.side.index()];
            if face != Slot::NONE {
                let third = self.apex(run);
                *apex = Some(third.map_err(|degree| Self::not_a_triangle(face, degree))?);
            }
        }
        if let ([Some(vertex), Some(other)], edge) = (apexes, e)
            && vertex == other
        {
            return Err(EditError::SameApex { edge, vertex });
        }
        self.check_room([1, 3, 2])?;
        let (m, n) = self.cut_edge(e, at, log);
        // On each side, the run that leaves m and the run that leaves the third corner.
        let [left, right] = [runs_of(n)[0], runs_of(e)[1]];
        for (run, apex) in [left, right].into_iter().zip(apexes) {
            if apex.is_some() {
                let third = self.run_after(self.run_after(run));
                self.cut_face(run, third, log);
            }
        }
        Ok(m)
    }

    /// Cuts a face by an edge from the origin of `p` to the origin of `q`. The part from `p` up to
    /// `q` becomes a new face.
    ///
    /// ```text
    ///     ◄─── q ─── y ◄──────
    ///                ▲   ·
    ///        old     n   new
    ///                │   ·
    ///     ─────────► x ── p ─►
    /// ```
    fn cut_face(&mut self, p: RunId, q: RunId, log: &mut impl EditLog<Self>) -> EdgeId {
        let (before_p, before_q) = (self.run_before(p), self.run_before(q));
        let [x, y] = [p, q].map(|run| self.run(run).origin());
        let old = self.run(q).face();
        let new = self.push_face(self.next_edge(), log);
        let mut run = p;
        while run != q {
            self.set_face(run, Slot::some(new));
            run = self.run_after(run);
        }
        let left = (old, q.edge, before_p.edge);
        let right = (Slot::some(new), p.edge, before_q.edge);
        let n = self.push_edge(edge_record([x, y], left, right), log);
        let [n_left, n_right] = runs_of(n);
        self.link(before_p, n_left);
        self.link(n_left, q);
        self.link(before_q, n_right);
        self.link(n_right, p);
        if let Some(old) = old.get() {
            self.set_side(old, n);
        }
        n
    }

    pub(super) fn split_between(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal<Self>> {
        let first = self.along(self.check_face(f)?, f);
        ends.iter().try_for_each(|&v| self.check_vertex(v))?;
        let mut found: [Option<(usize, RunId)>; 2] = [None; 2];
        let (mut degree, mut run) = (0, first);
        loop {
            let origin = self.run(run).origin();
            for (end, found) in ends.into_iter().zip(&mut found) {
                if end == origin {
                    *found = Some((degree, run));
                }
            }
            degree += 1;
            run = self.run_after(run);
            if run == first {
                break;
            }
        }
        let [Some((i, p)), Some((j, q))] = found else {
            let missing = usize::from(found[0].is_some());
            let (face, vertex) = (f, ends[missing]);
            return Err(EditError::NotACorner { face, vertex });
        };
        let between = if i <= j { j - i } else { j + degree - i };
        if between <= 1 || between + 1 == degree {
            return Err(EditError::AdjacentCorners { face: f, ends });
        }
        if self.edge_between(ends[0], ends[1]).is_some() {
            return Err(EditError::EdgeExists { ends });
        }
        self.check_room([0, 1, 1])?;
        let new_is_first = 2 * between <= degree;
        let [p, q] = if new_is_first { [p, q] } else { [q, p] };
        Ok(self.cut_face(p, q, log))
    }

    /// Splits `f` into one triangle per side, around a new vertex m; O(degree).
    ///
    /// ```text
    ///               m              Side i runs from corner i. Its triangle is f if i is 0, else a
    ///             ▲   ▲            new face. The new edge i runs from corner i to m, with the
    ///         i ╱       ╲ i + 1    triangle of side i − 1 on its left and that of side i on its
    ///         ╱           ╲        right.
    ///       ●──── side i ──►●
    /// ```
    #[inline]
    pub(super) fn poke(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let mut side = self.check_face(f)?;
        let first = Run::along(self.record(side), f);
        let mut before = first.prev();
        // The first and the last side are sufficient to detect a triangle.
        let degree = if Run::along(self.record(before), f).prev() == first.next() {
            3
        } else {
            row(self.runs_along(f).count())
        };
        self.check_room([1, degree as usize, degree as usize - 1])?;
        let m = self.push_vertex(at, log);
        let first_edge = self.next_edge();
        let spoke = |i| EdgeId::new(first_edge.index() as u32 + i);
        let last_face = FaceId::new((self.sides.len() as u32) + degree - 2);
        let mut face_before = Slot::some(last_face);
        for i in 0..degree {
            let [spoke_before, spoke_after] = [
                spoke(if i == 0 { degree - 1 } else { i - 1 }),
                spoke(if i + 1 == degree { 0 } else { i + 1 }),
            ];
            let face = if i == 0 { f } else { self.push_face(side, log) };
            let face = Slot::some(face);
            let record = self.edges.write(side.index());
            let run = Run::along(record, f);
            let (on, corner, next) = (run.side(), run.origin(), run.next());
            record.faces[on.index()] = face;
            record.next.set(on, spoke_after);
            record.prev.set(on, spoke(i));
            let left = (face_before, spoke_before, before);
            let right = (face, side, spoke_after);
            self.push_edge(edge_record([corner, m], left, right), log);
            (before, side, face_before) = (side, next, face);
        }
        self.set_spoke(m, first_edge);
        Ok(m)
    }
}
