//! Changing the mesh in place: the edits of [`MeshEdit`], and the steps that they share.

mod collapse;
mod compact;
mod faces;
mod flip;
mod names;
mod split;
mod split_vertex;
#[cfg(test)]
mod tests;

use mesh_core::{
    EdgeId, Edit, EditError, EditLog, FaceId, HoleSet, MAX_ROWS, MeshEdit, MeshQuery, NoHoles,
    Point, Probe, QueryCost, Slot, VertexId, row,
};

use crate::mesh::{AnyHalfEdgeMesh, EditableHalfEdgeMesh, Half, HalfEdgeId, HalfEdgeMesh, NO_HALF};

/// Why an edit is refused; the same whatever the probe.
type Refusal = mesh_core::Refusal<EditableHalfEdgeMesh>;

/// Surgery on twin pairs: halves are relinked, and each edit is a handful of rows (the operators of
/// Mäntylä 1988, made for meshes without stored `prev`).
///
/// An edit reads each row that it decides by once; what it then writes follows from these rows. The
/// half before another is what a walk came by, or is looked for along the face or around the vertex.
///
/// Every edit that touches a vertex sees to `leaving` (I5): where the boundary half goes, that which
/// takes its place on the boundary loop takes it here.
impl<P: Probe> MeshEdit for EditableHalfEdgeMesh<P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = Edit::LOCAL_COSTS;

    type Whole = HalfEdgeMesh<P>;

    fn into_whole(mut self) -> HalfEdgeMesh<P> {
        self.compact(&mut ());
        AnyHalfEdgeMesh {
            positions: self.positions,
            leaving: self.leaving,
            halves: self.halves,
            first: self.first,
            vertex_holes: NoHoles,
            edge_holes: NoHoles,
            face_holes: NoHoles,
        }
    }

    fn set_position(
        &mut self,
        v: VertexId,
        to: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.check_vertex(v)?;
        *self.positions.write(v.index()) = to;
        Ok(v)
    }

    fn add_vertex(&mut self, at: Point, log: &mut impl EditLog<Self>) -> Result<VertexId, Refusal> {
        self.check_room(1, 0, 0)?;
        let v = self.push_vertex(at, Slot::NONE);
        log.created_vertex(v);
        Ok(v)
    }

    fn add_face(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        self.add(corners, log)
    }

    fn remove_face(&mut self, f: FaceId, log: &mut impl EditLog<Self>) -> Result<(), Refusal> {
        let first = self.existing_face(f)?;
        self.check_removable(first)?;
        self.unlink_face(f, first, log);
        Ok(())
    }

    fn remove_vertex(&mut self, v: VertexId, log: &mut impl EditLog<Self>) -> Result<(), Refusal> {
        self.check_vertex(v)?;
        self.check_star_removable(v)?;
        self.unlink_star(v, log);
        self.dig_vertex(v);
        log.removed_vertex(v);
        Ok(())
    }

    fn remove_isolated_vertices(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let before = self.vertex_holes.len();
        for v in (0..row(self.vertex_rows())).map(VertexId::new) {
            let isolated = self.leaving.read(v.index()).get().is_none();
            if isolated && !self.vertex_holes.has(v.index()) {
                self.dig_vertex(v);
                log.removed_vertex(v);
            }
        }
        self.vertex_holes.len() - before
    }

    fn split_edge(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.split(e, at, log)
    }

    fn bisect_edge(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.bisect(e, at, log)
    }

    fn poke_face(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.poke(f, at, log)
    }

    fn split_face(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal> {
        self.cut(f, ends, log)
    }

    fn dissolve_edge(
        &mut self,
        e: EdgeId,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        self.dissolve(e, log)
    }

    #[inline]
    fn flip_edge(&mut self, e: EdgeId, _: &mut impl EditLog<Self>) -> Result<EdgeId, Refusal> {
        self.flip(e)
    }

    #[inline]
    fn collapse_edge(
        &mut self,
        e: EdgeId,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.collapse(e, keep, to, log)
    }

    fn split_vertex(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.open(v, left, right, at, log)
    }

    fn compact(&mut self, log: &mut impl EditLog<Self>) {
        self.close_holes(log);
    }
}

/// What is there, and whether there is room for more.
impl<P: Probe> EditableHalfEdgeMesh<P> {
    #[inline]
    fn check_vertex(&self, v: VertexId) -> Result<(), Refusal> {
        if v.index() < self.vertex_rows() && !self.vertex_holes.has(v.index()) {
            Ok(())
        } else {
            Err(EditError::NoSuchVertex { vertex: v })
        }
    }

    /// The records of both halves of `e`.
    #[inline]
    fn existing_edge(&self, e: EdgeId) -> Result<[Half; 2], Refusal> {
        if e.index() < self.edge_rows() {
            let pair = *self.halves.read_pair(e.index());
            if !pair[0].is_deleted() {
                return Ok(pair);
            }
        }
        Err(EditError::NoSuchEdge { edge: e })
    }

    /// `first(f)`.
    #[inline]
    fn existing_face(&self, f: FaceId) -> Result<HalfEdgeId, Refusal> {
        if f.index() < self.face_rows() {
            let first = *self.first.read(f.index());
            if first != NO_HALF {
                return Ok(first);
            }
        }
        Err(EditError::NoSuchFace { face: f })
    }

    /// Whether there may be so many more rows.
    #[inline]
    fn check_room(&self, vertices: usize, edges: usize, faces: usize) -> Result<(), Refusal> {
        let too_many = |elements, limit| Err(EditError::TooMany { elements, limit });
        if self.vertex_rows() + vertices > MAX_ROWS {
            return too_many("vertices", MAX_ROWS);
        }
        if self.edge_rows() + edges > MAX_ROWS / 2 {
            return too_many("edges", MAX_ROWS / 2);
        }
        if self.face_rows() + faces > MAX_ROWS {
            return too_many("faces", MAX_ROWS);
        }
        Ok(())
    }
}

/// The steps that edits share.
impl<P: Probe> EditableHalfEdgeMesh<P> {
    /// The record of `h`.
    #[inline]
    fn row_of(&self, h: HalfEdgeId) -> Half {
        *self.halves.read(h.index())
    }

    /// The record of `h`, and that of its twin beside it.
    #[inline]
    fn both(&self, h: HalfEdgeId) -> [Half; 2] {
        let pair = self.halves.read_pair(h.edge().index());
        let side = h.index() & 1;
        [pair[side], pair[side ^ 1]]
    }

    /// Whether `h` has a face on its left.
    #[inline]
    fn has_face(&self, h: HalfEdgeId) -> bool {
        self.row_of(h).face != Slot::NONE
    }

    #[inline]
    fn link(&mut self, h: HalfEdgeId, next: HalfEdgeId) {
        self.halves.write(h.index()).next = next;
    }

    /// `new` takes the place of `old`, after `before`: in its face, or on its boundary loop.
    #[inline]
    fn replace(&mut self, before: HalfEdgeId, old: HalfEdgeId, new: HalfEdgeId) {
        let Half { next, face, .. } = self.row_of(old);
        self.link(before, new);
        let half = self.halves.write(new.index());
        (half.next, half.face) = (next, face);
        self.pass_on_first(face, old, new);
    }

    /// `first` of the face, if there is one, is `new` where it was `old`.
    #[inline]
    fn pass_on_first(&mut self, face: Slot<FaceId>, old: HalfEdgeId, new: HalfEdgeId) {
        if let Some(f) = face.get()
            && *self.first.read(f.index()) == old
        {
            *self.first.write(f.index()) = new;
        }
    }

    /// `leaving(v)` is `new` where it was `old`.
    #[inline]
    fn pass_on_leaving(&mut self, v: VertexId, old: HalfEdgeId, new: HalfEdgeId) {
        if *self.leaving.read(v.index()) == Slot::some(old) {
            self.set_leaving(v, new);
        }
    }

    #[inline]
    fn set_leaving(&mut self, v: VertexId, h: HalfEdgeId) {
        *self.leaving.write(v.index()) = Slot::some(h);
    }

    /// The halves from `first` to `last` get the face `f`.
    fn relabel(&mut self, first: HalfEdgeId, last: HalfEdgeId, f: FaceId) {
        let mut h = first;
        loop {
            let half = self.halves.write(h.index());
            half.face = Slot::some(f);
            if h == last {
                return;
            }
            h = half.next;
        }
    }

    #[inline]
    fn push_vertex(&mut self, at: Point, leaving: Slot<HalfEdgeId>) -> VertexId {
        let v = VertexId::new(row(self.positions.len()));
        self.positions.push(at);
        self.leaving.push(leaving);
        v
    }

    /// A new edge of these two halves; the first of them.
    #[inline]
    fn push_edge(&mut self, [one, other]: [Half; 2]) -> HalfEdgeId {
        let h = self.next_half();
        self.halves.push(one);
        self.halves.push(other);
        h
    }

    /// The first half of the edge that is pushed next.
    #[inline]
    fn next_half(&self) -> HalfEdgeId {
        HalfEdgeId::new(row(self.halves.len()))
    }

    /// The face that is pushed next.
    #[inline]
    fn next_face(&self) -> FaceId {
        FaceId::new(row(self.first.len()))
    }

    /// Nothing is left of `v` but its row.
    #[inline]
    fn dig_vertex(&mut self, v: VertexId) {
        *self.leaving.write(v.index()) = Slot::NONE;
        self.vertex_holes.dig(v.index());
    }

    /// Nothing is left of `e` but its rows.
    #[inline]
    fn dig_edge(&mut self, e: EdgeId) {
        for h in self.halves_of(e) {
            *self.halves.write(h.index()) = Half::DELETED;
        }
        self.edge_holes.dig(e.index());
    }

    /// Nothing is left of `f` but its row.
    #[inline]
    fn dig_face(&mut self, f: FaceId) {
        *self.first.write(f.index()) = NO_HALF;
        self.face_holes.dig(f.index());
    }
}
