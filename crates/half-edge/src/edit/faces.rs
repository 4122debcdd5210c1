//! Adding and removing faces.

use sixfold_core::{EditError, EditLog, Editable, FaceId, Probe, Slot, VertexId, check_corners};

use super::Refusal;
use super::handle_set::HandleSet;
use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Adds a face over `corners`; O(valence) of the corners.
    ///
    /// Each side of the new face uses a boundary half-edge or a new edge. A vertex has at most one
    /// boundary half-edge that leaves it: `leaving`. If another edge already leads to the next
    /// corner, the face is refused.
    pub(super) fn add(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        let new_edges = self.check_new_face(corners)?;
        self.check_room(0, new_edges, 1)?;

        let f = self.next_face();
        let last = corners.len() - 1;
        let mut side = |mesh: &mut Self, i: usize| {
            let (from, to) = (corners[i], corners[if i == last { 0 } else { i + 1 }]);
            let filled = mesh.boundary_side(from, to);
            let side = filled.unwrap_or_else(|| {
                let ends = [(from, Slot::some(f)), (to, Slot::NONE)];
                let h = mesh.next_half();
                let halves = ends.map(|(origin, face)| Half {
                    next: h,
                    origin,
                    face,
                });
                log.created_edge(h.edge());
                mesh.push_edge(halves)
            });
            (side, filled.is_none())
        };
        // The last side arrives at the first corner.
        let closing = side(self, last);
        let mut arriving = closing;
        for (i, &v) in corners.iter().enumerate() {
            let leaving = if i == last { closing } else { side(self, i) };
            self.link_corner(v, arriving, leaving);
            arriving = leaving;
        }
        self.first.push(closing.0);
        let mut h = closing.0;
        for _ in corners {
            let half = self.halves.write(h.index());
            half.face = Slot::some(f);
            h = half.next;
        }
        log.created_face(f);
        Ok(f)
    }

    /// Checks a new face over `corners`. Returns the number of new edges.
    fn check_new_face(&self, corners: &[VertexId]) -> Result<usize, Refusal> {
        check_corners(corners, |v| self.check_vertex(v))?;
        let degree = corners.len();
        let mut new_edges = 0;
        let mut filled_before = self
            .boundary_side(corners[degree - 1], corners[0])
            .is_some();
        for (i, &v) in corners.iter().enumerate() {
            let next = corners[if i + 1 == degree { 0 } else { i + 1 }];
            let filled = self.boundary_side(v, next).is_some();
            if !filled {
                self.check_no_edge(v, next)?;
                new_edges += 1;
            }
            if !filled && !filled_before && self.vertex_half_edge(v).is_some() {
                return Err(EditError::SeveralFans { vertex: v });
            }
            filled_before = filled;
        }
        Ok(new_edges)
    }

    fn boundary_side(&self, from: VertexId, to: VertexId) -> Option<HalfEdgeId> {
        let h = self.leaving.read(from.index()).get()?;
        let [half, twin] = self.record_pair(h);
        (half.face == Slot::NONE && twin.origin == to).then_some(h)
    }

    /// Refuses if an edge joins the two vertices. No boundary half-edge may run from `from` to
    /// `to`.
    fn check_no_edge(&self, from: VertexId, to: VertexId) -> Result<(), Refusal> {
        let mut spokes = self.spokes(from);
        let Some((h, arriving)) = spokes.find(|(_, arriving)| arriving.origin == to) else {
            return Ok(());
        };
        match self.record(h).face.get() {
            Some(face) if arriving.face == Slot::NONE => {
                Err(EditError::RepeatedSide { from, to, face })
            }
            _ => Err(EditError::FullEdge { edge: h.edge() }),
        }
    }

    /// Links two sides of a new face at `v`, and the boundary beside them. Each side has a flag:
    /// whether its edge is new.
    ///
    /// ```text
    /// arriving  leaving     boundary
    /// new       new         next(twin(leaving)) = twin(arriving): v was isolated
    /// filled    new         next(twin(leaving)) = the old next(arriving)
    /// new       filled      next(the half-edge before leaving) = twin(arriving)
    /// filled    filled      the gap at v is closed
    /// ```
    fn link_corner(
        &mut self,
        v: VertexId,
        (arriving, arriving_is_new): (HalfEdgeId, bool),
        (leaving, leaving_is_new): (HalfEdgeId, bool),
    ) {
        match (arriving_is_new, leaving_is_new) {
            (true, true) => {
                self.link(leaving.twin(), arriving.twin());
                self.set_leaving(v, arriving.twin());
            }
            (false, true) => {
                let beyond = self.follow(arriving);
                self.link(leaving.twin(), beyond);
            }
            (true, false) => {
                let before = self.prev_around_origin(leaving);
                self.link(before, arriving.twin());
                self.set_leaving(v, arriving.twin());
            }
            (false, false) => {}
        }
        self.link(arriving, leaving);
    }

    /// Finds the half-edge before `h` by a walk around the origin of `h`.
    fn prev_around_origin(&self, h: HalfEdgeId) -> HalfEdgeId {
        let mut spoke = h;
        loop {
            let next = self.follow(spoke.twin());
            if next == h {
                return spoke.twin();
            }
            spoke = next;
        }
    }

    /// Checks that the remaining faces at each corner of a face would form one fan. At a corner on
    /// a boundary, a side of the face must also be on the boundary.
    pub(super) fn check_removable(&self, first: HalfEdgeId) -> Result<(), Refusal> {
        let mut h = first;
        let [mut half, mut twin] = self.record_pair(h);
        loop {
            let next = half.next;
            let beside = twin.face;
            [half, twin] = self.record_pair(next);
            if beside != Slot::NONE && twin.face != Slot::NONE {
                let vertex = half.origin;
                let leaving = self.leaving.read(vertex.index()).get().expect("I5");
                if !self.has_face(leaving) {
                    return Err(EditError::SeveralFans { vertex });
                }
            }
            h = next;
            if h == first {
                return Ok(());
            }
        }
    }

    /// Checks that the remaining faces at each neighbouring corner would form one fan without the
    /// faces of `v`.
    ///
    /// O(valence) for each corner of each face of `v`.
    pub(super) fn check_fan_removable(&self, v: VertexId) -> Result<(), Refusal> {
        let mut removed = HandleSet::new();
        for (_, arriving) in self.spokes(v) {
            if let Some(f) = arriving.face.get() {
                removed.push(f);
            }
        }
        removed.sort();
        let remains = |half: &Half| half.face.get().is_some_and(|f| !removed.contains(f));
        for f in self
            .spokes(v)
            .filter_map(|(_, arriving)| arriving.face.get())
        {
            for vertex in self
                .sides(f)
                .map(|(_, half)| half.origin)
                .filter(|&u| u != v)
            {
                // Each remaining fan ends once during the walk around the vertex.
                let leaving = self.leaving.read(vertex.index()).get().expect("I5");
                let (mut fans, mut before) = (0, remains(&self.record(leaving)));
                for (_, arriving) in self.spokes(vertex) {
                    let after = remains(arriving);
                    fans += usize::from(before && !after);
                    before = after;
                }
                if fans > 1 {
                    return Err(EditError::SeveralFans { vertex });
                }
            }
        }
        Ok(())
    }

    /// Unlinks the faces of `v` counter-clockwise, starting at the boundary if there is one. Each
    /// face except the first then has a side on the boundary.
    pub(super) fn unlink_fan(&mut self, v: VertexId, log: &mut impl EditLog<Self>) {
        let Some(mut out) = self.leaving.read(v.index()).get() else {
            return;
        };
        if !self.has_face(out) {
            out = self.prev_around_origin(out).twin();
        }
        while let Some(f) = self.record(out).face.get() {
            let next = self.prev(out).twin();
            let next_has_face = self.has_face(next);
            self.unlink_face(f, out, log);
            if !next_has_face {
                return;
            }
            out = next;
        }
    }

    /// Removes `f` and the edges without another face; O(valence) of the corners. `first` is a side
    /// of `f`.
    ///
    /// At each corner, the `next` of `before` becomes `after`. `before` is the arriving side, or
    /// the half-edge before its twin if the side is removed. `after` is the leaving side, or the
    /// half-edge after its twin if the side is removed. While several faces are removed, a corner
    /// may have several fans.
    pub(super) fn unlink_face(
        &mut self,
        f: FaceId,
        first: HalfEdgeId,
        log: &mut impl EditLog<Self>,
    ) {
        let mut delete_side = |mesh: &mut Self, h: HalfEdgeId| {
            mesh.delete_edge(h.edge());
            log.removed_edge(h.edge());
        };
        let first_removed = !self.has_face(first.twin());
        let (mut arriving, mut arriving_removed) = (first, first_removed);
        let mut leaving = self.follow(first);
        loop {
            let [at_leaving, at_twin] = self.record_pair(leaving);
            let leaving_removed = at_twin.face == Slot::NONE;
            let before = if arriving_removed {
                self.prev_around_origin(arriving.twin())
            } else {
                arriving
            };
            let after = if leaving_removed {
                at_twin.next
            } else {
                leaving
            };
            let v = at_leaving.origin;
            if after == arriving.twin() {
                *self.leaving.write(v.index()) = Slot::NONE;
            } else {
                self.link(before, after);
                self.set_leaving(v, after);
            }
            // The last corner needs the first side again.
            if !arriving_removed {
                self.halves.write(arriving.index()).face = Slot::NONE;
            } else if arriving != first {
                delete_side(self, arriving);
            }
            if leaving == first {
                break;
            }
            (arriving, arriving_removed) = (leaving, leaving_removed);
            leaving = at_leaving.next;
        }
        if first_removed {
            delete_side(self, first);
        }
        self.delete_face(f);
        log.removed_face(f);
    }
}
