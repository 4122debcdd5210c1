//! Edge collapse: merges the two ends of an edge into one vertex.

use sixfold_core::{
    EdgeId, EditError, EditLog, Editable, FaceId, Lookup, MeshQuery, Point, Probe, Refusal,
    ShortVec, Slot, VertexId,
};

use crate::edge::{Run, RunId};
use crate::mesh::WingedEdgeMesh;

/// A triangle along the collapsed edge, and its other two sides.
///
/// ```text
///           c              The edge k–c is kept, and g–c is removed. The run of k–c inside the
///         ╱   ╲            triangle (`kept`) replaces the run of g–c outside it (`outer`).
///   kept ╱     ╲ outer
///      ╱         ╲         The triangle on the other side of k–g is the mirror image.
///     k ────────► g
/// ```
#[derive(Clone, Copy)]
struct Triangle {
    face: FaceId,
    apex: VertexId,
    kept: RunId,
    outer: RunId,
}

/// The remaining edges at the removed end.
struct Spokes {
    edges: ShortVec<EdgeId>,
    on_boundary: bool,
}

impl<P: Probe> WingedEdgeMesh<Editable, P> {
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
        let (gone, before, out) = (run.target(), run.prev(), RunId::new(e, run.side()));
        let sides = [self.left_of(run, gone)?, self.right_of(run.twin(), keep)?];
        let first = match sides {
            [Some(left), Some(right)] if left.apex == right.apex => {
                let vertex = left.apex;
                return Err(EditError::SameApex { edge: e, vertex });
            }
            [Some(left), Some(right)] if self.removed_end_has_valence_three(left, right) => {
                if self.kept_end_has_valence_three(left, right) {
                    return Err(EditError::Pillow { edge: e });
                }
                self.merge_three_triangles(left, right);
                None
            }
            _ => {
                let spokes = self.check_link(out, [keep, gone], sides)?;
                self.relink(out, [keep, gone], sides, &spokes)
            }
        };
        for triangle in sides.into_iter().flatten() {
            let (removed, kept) = (triangle.outer.edge, triangle.kept.edge);
            self.replace_spoke(triangle.apex, removed, kept);
            self.delete_edge(removed, log);
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

    /// Relinks the edges around `out`, which runs from the first of `ends` to the second end.
    /// Returns the spoke of the merged vertex if its boundary begins at the second end.
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
        // Faces that lose only one side come first. After that, a kept side may replace one of
        // their runs.
        for (run, _) in { [out, out.twin()].into_iter().zip(sides) }.filter(|(_, s)| s.is_none()) {
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
        // One of these two runs may follow the other run, so both runs get the new end first.
        for triangle in sides.into_iter().flatten() {
            self.set_end(triangle.outer.edge, gone, keep);
        }
        for Triangle { kept, outer, .. } in sides.into_iter().flatten() {
            self.replace(outer, kept);
            if first == Some(outer.edge) {
                first = Some(kept.edge);
            }
        }
        first
    }

    /// Puts `new` in the place of `old`.
    fn replace(&mut self, old: RunId, new: RunId) {
        let (before, after) = (self.run_before(old), self.run_after(old));
        let face = self.run(old).face();
        self.link(before, new);
        self.link(new, after);
        self.set_face(new, face);
        if let Some(f) = face.get() {
            self.set_side(f, new.edge);
        }
    }

    /// Merges the three triangles around a vertex into one triangle. The triangle that is not along
    /// the collapsed edge gets the remaining sides of the other two triangles.
    #[inline(always)]
    fn merge_three_triangles(&mut self, left: Triangle, right: Triangle) {
        let run = self.run(left.outer);
        let (face, base) = (run.face(), run.prev());
        let (next, prev) = (left.kept.edge, right.kept.edge);
        self.set_links(left.kept, face, prev, base);
        self.set_links(right.kept, face, base, next);
        if let Some(f) = face.get() {
            let base = self.along(base, f);
            self.set_links(base, face, next, prev);
            self.set_side(f, base.edge);
        }
    }

    /// Returns the triangle on the left of `out`, if there is one. `out` runs to `gone`.
    #[inline(always)]
    fn left_of(&self, out: Run<'_>, gone: VertexId) -> Result<Option<Triangle>, Refusal<Self>> {
        let removed = Run::from(self.record(out.next()), gone);
        let (Some(face), true) = (out.face().get(), removed.next() == out.prev()) else {
            return Ok(None);
        };
        let apex = removed.target();
        let kept = Run::from(self.record(out.prev()), apex);
        let across = [removed.across(), kept.across()];
        Self::check_last_face(apex, across)?;
        Ok(Some(Triangle {
            face,
            apex,
            kept: RunId::new(out.prev(), kept.side()),
            outer: RunId::new(out.next(), removed.side()).twin(),
        }))
    }

    /// Returns the triangle on the left of `back`, if there is one. `back` runs to `keep`.
    #[inline(always)]
    fn right_of(&self, back: Run<'_>, keep: VertexId) -> Result<Option<Triangle>, Refusal<Self>> {
        let kept = Run::from(self.record(back.next()), keep);
        let (Some(face), true) = (back.face().get(), kept.next() == back.prev()) else {
            return Ok(None);
        };
        let apex = kept.target();
        let removed = Run::from(self.record(back.prev()), apex);
        let across = [removed.across(), kept.across()];
        Self::check_last_face(apex, across)?;
        Ok(Some(Triangle {
            face,
            apex,
            kept: RunId::new(back.next(), kept.side()),
            outer: RunId::new(back.prev(), removed.side()).twin(),
        }))
    }

    /// Checks that at least one of the two merged sides has a face across.
    #[inline(always)]
    fn check_last_face(vertex: VertexId, across: [Slot<FaceId>; 2]) -> Result<(), Refusal<Self>> {
        if across == [Slot::NONE; 2] {
            return Err(EditError::LastFace { vertex });
        }
        Ok(())
    }

    /// Checks the link condition (Dey et al. 1999), and that no face would contain `keep` twice.
    ///
    /// Only the third corners may be adjacent to both ends. Only the faces along the edge may be at
    /// both ends.
    fn check_link(
        &self,
        out: RunId,
        [keep, gone]: [VertexId; 2],
        sides: [Option<Triangle>; 2],
    ) -> Result<Spokes, Refusal<Self>> {
        let e = out.edge;
        let mut spokes = Spokes {
            edges: ShortVec::new(),
            on_boundary: false,
        };
        let apexes = sides.map(|side| side.map(|triangle| triangle.apex));
        let is_apex = |v| apexes.contains(&Some(v));
        let (mut ends, mut faces) = (ShortVec::new(), ShortVec::new());
        let mut valence = 0;
        let mut run = self.run(out.twin());
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
        ends.sort_for_lookup();
        faces.sort_for_lookup();
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
            let [left, right] = [out, out.twin()].map(|run| self.run(run).face());
            if left != Slot::NONE && right != Slot::NONE {
                return Err(EditError::AcrossBoundary { edge: e });
            }
        } else if !spokes.on_boundary && !keep_on_boundary {
            let merged = apexes.iter().flatten().count();
            if valence == merged + 2 && self.only_triangles_remain(out, [keep, gone]) {
                return Err(EditError::Pillow { edge: e });
            }
        }
        Ok(spokes)
    }

    /// Returns whether the removed end has three edges and three triangles. Its neighbours are then
    /// the kept end and the third corners, so no walk is needed.
    #[inline(always)]
    fn removed_end_has_valence_three(&self, left: Triangle, right: Triangle) -> bool {
        let (to_removed, from_removed) = (self.run(left.outer), self.run(right.outer));
        to_removed.next() == right.outer.edge
            && to_removed.face() != Slot::NONE
            && to_removed.prev() == from_removed.next()
    }

    /// Returns whether the kept end has three edges and three triangles. After the collapse, two
    /// triangles would have the same corners.
    #[inline(always)]
    fn kept_end_has_valence_three(&self, left: Triangle, right: Triangle) -> bool {
        let from_keep = self.run(left.kept.twin());
        let to_keep = self.run(right.kept.twin());
        to_keep.next() == left.kept.edge
            && to_keep.face() != Slot::NONE
            && to_keep.prev() == from_keep.next()
    }

    /// Returns whether all faces at the ends of `out` would be triangles after the collapse.
    #[cold]
    #[inline(never)]
    fn only_triangles_remain(&self, out: RunId, ends: [VertexId; 2]) -> bool {
        let along = [out, out.twin()].map(|run| self.run(run).face().get());
        let faces = ends.into_iter().flat_map(|v| self.vertex_faces(v));
        faces.into_iter().all(|f| {
            let degree = self.face_edges(f).count();
            degree == 3 || (degree == 4 && along.contains(&Some(f)))
        })
    }
}
