//! Two ends of an edge made one vertex.

use mesh_core::{
    EdgeId, EditError, EditLog, FaceId, Few, Lookup, MeshQuery, Point, Probe, Refusal, Slot,
    VertexId,
};

use crate::edge::{Run, RunId};
use crate::mesh::EditableWingedEdgeMesh;

/// A triangle along the edge that goes, and what becomes of its other sides.
///
/// ```text
///           c              The edge k–c stays and g–c goes: the run of k–c inside the triangle
///         ╱   ╲            (`stays`) gets what lies beyond g–c (`beyond`, its run outside).
///  stays ╱     ╲ beyond
///      ╱         ╲         On the other side of k–g all is the mirror image.
///     k ────────► g
/// ```
#[derive(Clone, Copy)]
struct Triangle {
    face: FaceId,
    apex: VertexId,
    stays: RunId,
    beyond: RunId,
}

/// The edges at the end that goes, but for those that go with it.
struct Spokes {
    edges: Few<EdgeId>,
    on_boundary: bool,
}

impl<P: Probe> EditableWingedEdgeMesh<P> {
    #[inline]
    pub(super) fn collapse(
        &mut self,
        e: EdgeId,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let edge = self.check_edge(e)?;
        if !edge.ends.contains(&keep) {
            let vertex = keep;
            return Err(EditError::NotAnEnd { edge: e, vertex });
        }
        let run = Run::from(edge, keep);
        let (gone, before, out) = (run.target(), run.prev(), RunId::on(e, run.side()));
        let sides = [self.left_of(run, gone)?, self.right_of(run.back(), keep)?];
        let first = match sides {
            [Some(left), Some(right)] if left.apex == right.apex => {
                let vertex = left.apex;
                return Err(EditError::SameApex { edge: e, vertex });
            }
            [Some(left), Some(right)] if self.is_tip_of_three(left, right) => {
                if self.are_three(left, right) {
                    return Err(EditError::Pillow { edge: e });
                }
                self.relink_one(left, right);
                None
            }
            _ => {
                let spokes = self.check_link(out, [keep, gone], sides)?;
                self.relink(out, [keep, gone], sides, &spokes)
            }
        };
        for triangle in sides.into_iter().flatten() {
            let (goes, stays) = (triangle.beyond.edge, triangle.stays.edge);
            self.replace_spoke(triangle.apex, goes, stays);
            self.delete_edge(goes, log);
            self.delete_face(triangle.face, log);
        }
        match first {
            Some(first) => self.set_spoke(keep, first),
            None => self.replace_spoke(keep, e, before),
        }
        *self.positions.write(keep.index()) = to;
        self.delete_edge(e, log);
        self.delete_vertex(gone, log);
        Ok(keep)
    }

    /// Links around `out`, from the first of `ends` to the second; the edge with which the boundary of
    /// the vertex that they make begins, if that is the boundary of the second.
    fn relink(
        &mut self,
        out: RunId,
        ends: [VertexId; 2],
        sides: [Option<Triangle>; 2],
        spokes: &Spokes,
    ) -> Option<EdgeId> {
        let [keep, gone] = ends;
        let mut first = if spokes.on_boundary && self.run(out).face() != Slot::NONE {
            self.spokes.read(gone.index()).get()
        } else {
            None
        };
        // What only loses a side comes first: a triangle may then get what lies along it.
        for (run, _) in { [out, out.back()].into_iter().zip(sides) }.filter(|(_, s)| s.is_none()) {
            let (before, after) = (self.run_before(run), self.run_after(run));
            let face = self.run(run).face();
            self.link(before, after);
            if let Some(f) = face.get() {
                self.set_side(f, after.edge);
            }
        }
        for &spoke in spokes.edges.as_slice() {
            self.set_end(spoke, gone, keep);
        }
        // One of these two may follow the other: both have the new end before they are taken over.
        for triangle in sides.into_iter().flatten() {
            self.set_end(triangle.beyond.edge, gone, keep);
        }
        for Triangle { stays, beyond, .. } in sides.into_iter().flatten() {
            self.take_over(beyond, stays);
            if first == Some(beyond.edge) {
                first = Some(stays.edge);
            }
        }
        first
    }

    /// `new` lies where `old` did.
    fn take_over(&mut self, old: RunId, new: RunId) {
        let (before, after) = (self.run_before(old), self.run_after(old));
        let face = self.run(old).face();
        self.link(before, new);
        self.link(new, after);
        self.set_face(new, face);
        if let Some(f) = face.get() {
            self.set_side(f, new.edge);
        }
    }

    /// Makes one triangle of the three around a vertex: the one that is not along the edge that goes
    /// gets what stays of the other two.
    #[inline(always)]
    fn relink_one(&mut self, left: Triangle, right: Triangle) {
        let run = self.run(left.beyond);
        let (face, base) = (run.face(), run.prev());
        let (next, prev) = (left.stays.edge, right.stays.edge);
        self.set_lane(left.stays, face, prev, base);
        self.set_lane(right.stays, face, base, next);
        if let Some(f) = face.get() {
            let base = self.along(base, f);
            self.set_lane(base, face, next, prev);
            self.set_side(f, base.edge);
        }
    }

    /// The triangle on the left of `out`, a run to `gone`.
    #[inline(always)]
    fn left_of(&self, out: Run<'_>, gone: VertexId) -> Result<Option<Triangle>, Refusal<Self>> {
        let goes = Run::from(self.record(out.next()), gone);
        let (Some(face), true) = (out.face().get(), goes.next() == out.prev()) else {
            return Ok(None);
        };
        let apex = goes.target();
        let stays = Run::from(self.record(out.prev()), apex);
        let across = [goes.across(), stays.across()];
        Self::check_last_face(apex, across)?;
        Ok(Some(Triangle {
            face,
            apex,
            stays: RunId::on(out.prev(), stays.side()),
            beyond: RunId::on(out.next(), goes.side()).back(),
        }))
    }

    /// The triangle on the left of `back`, a run to `keep`.
    #[inline(always)]
    fn right_of(&self, back: Run<'_>, keep: VertexId) -> Result<Option<Triangle>, Refusal<Self>> {
        let stays = Run::from(self.record(back.next()), keep);
        let (Some(face), true) = (back.face().get(), stays.next() == back.prev()) else {
            return Ok(None);
        };
        let apex = stays.target();
        let goes = Run::from(self.record(back.prev()), apex);
        let across = [goes.across(), stays.across()];
        Self::check_last_face(apex, across)?;
        Ok(Some(Triangle {
            face,
            apex,
            stays: RunId::on(back.next(), stays.side()),
            beyond: RunId::on(back.prev(), goes.side()).back(),
        }))
    }

    /// Beyond the two sides that become one there must be a face.
    #[inline(always)]
    fn check_last_face(vertex: VertexId, across: [Slot<FaceId>; 2]) -> Result<(), Refusal<Self>> {
        if across == [Slot::NONE; 2] {
            return Err(EditError::LastFace { vertex });
        }
        Ok(())
    }

    /// The link condition of Dey et al. (1999), and that no face would have a corner twice.
    ///
    /// A walk around the end that goes, and then one around the other: no two spokes may lead to one
    /// vertex but the third corners, and no face may lie between spokes of both.
    fn check_link(
        &self,
        out: RunId,
        [keep, gone]: [VertexId; 2],
        sides: [Option<Triangle>; 2],
    ) -> Result<Spokes, Refusal<Self>> {
        let e = out.edge;
        let mut spokes = Spokes {
            edges: Few::new(),
            on_boundary: false,
        };
        let apexes = sides.map(|side| side.map(|triangle| triangle.apex));
        let is_apex = |v| apexes.contains(&Some(v));
        let (mut ends, mut faces) = (Few::new(), Few::new());
        let mut valence = 0;
        let mut run = self.run(out.back());
        spokes.on_boundary = run.face() == Slot::NONE;
        while run.ccw() != e {
            let at = run.ccw();
            run = Run::from(self.record(at), gone);
            valence += 1;
            let end = run.target();
            if !is_apex(end) {
                ends.push(end);
                spokes.edges.push(at);
            }
            match run.face() {
                Slot::NONE => spokes.on_boundary = true,
                face => faces.push(face),
            }
        }
        ends.order();
        faces.order();
        run = self.run(out);
        let mut keep_on_boundary = run.face() == Slot::NONE;
        while run.ccw() != e {
            run = Run::from(self.record(run.ccw()), keep);
            valence += 1;
            let vertex = run.target();
            if ends.has(vertex) {
                return Err(EditError::CommonNeighbour { edge: e, vertex });
            }
            if faces.has(run.face()) {
                return Err(EditError::RepeatedVertex { vertex: keep });
            }
            keep_on_boundary |= run.face() == Slot::NONE;
        }
        if spokes.on_boundary && keep_on_boundary {
            let [left, right] = [out, out.back()].map(|run| self.run(run).face());
            if left != Slot::NONE && right != Slot::NONE {
                return Err(EditError::AcrossBoundary { edge: e });
            }
        } else if !spokes.on_boundary && !keep_on_boundary {
            let merged = apexes.iter().flatten().count();
            if valence == merged + 2 && self.only_triangles_stay(out, [keep, gone]) {
                return Err(EditError::Pillow { edge: e });
            }
        }
        Ok(spokes)
    }

    /// Whether the end that goes has three edges and around them three triangles: then its neighbours
    /// are the other end and the third corners, and nobody has to walk.
    #[inline(always)]
    fn is_tip_of_three(&self, left: Triangle, right: Triangle) -> bool {
        let (to_tip, from_tip) = (self.run(left.beyond), self.run(right.beyond));
        to_tip.next() == right.beyond.edge
            && to_tip.face() != Slot::NONE
            && to_tip.prev() == from_tip.next()
    }

    /// Whether the same is true of the other end: then the two last triangles would be one.
    #[inline(always)]
    fn are_three(&self, left: Triangle, right: Triangle) -> bool {
        let from_keep = self.run(left.stays.back());
        let to_keep = self.run(right.stays.back());
        to_keep.next() == left.stays.edge
            && to_keep.face() != Slot::NONE
            && to_keep.prev() == from_keep.next()
    }

    /// Whether all faces at the ends of `out` are triangles once it is collapsed.
    #[cold]
    #[inline(never)]
    fn only_triangles_stay(&self, out: RunId, ends: [VertexId; 2]) -> bool {
        let along = [out, out.back()].map(|run| self.run(run).face().get());
        let faces = ends.into_iter().flat_map(|v| self.vertex_faces(v));
        faces.into_iter().all(|f| {
            let degree = self.face_edges(f).count();
            degree == 3 || (degree == 4 && along.contains(&Some(f)))
        })
    }
}
