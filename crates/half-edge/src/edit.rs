//! Edits in place: the implementation of [`MeshEdit`], and the steps that the edits share.

mod collapse;
mod compact;
mod faces;
mod flip;
mod handle_set;
mod split;
mod split_vertex;
#[cfg(test)]
mod tests;

use sixfold_core::{
    EdgeId, Edit, EditError, EditLog, Editable, FaceId, HoleSet, MAX_EDGES, MAX_ROWS, MeshEdit,
    MeshQuery, Point, Probe, QueryCost, Slot, VertexId, check_fans_without, check_rows, faces_once,
    row,
};

use crate::EditableHalfEdgeMesh;
use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh, NO_HALF};

/// The error of an edit, without the type of the probe.
type Refusal = sixfold_core::Refusal<EditableHalfEdgeMesh>;

/// Each edit relinks a few half-edges. The edits follow the operators of Mäntylä (1988), but
/// without a stored `prev`.
///
/// To find the half-edge before a given half-edge, an edit searches along the face or around the
/// vertex. Every edit keeps invariant I5: `leaving` of a boundary vertex has no face.
impl<P: Probe> MeshEdit for HalfEdgeMesh<Editable, P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = Edit::LOCAL_COSTS;

    sixfold_core::compact_conversions!(HalfEdgeMesh);

    fn set_position_logged(
        &mut self,
        v: VertexId,
        to: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.check_vertex(v)?;
        *self.positions.write(v.index()) = to;
        Ok(v)
    }

    fn add_vertex_logged(
        &mut self,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.check_room(1, 0, 0)?;
        let v = self.push_vertex(at, Slot::NONE);
        log.created_vertex(v);
        Ok(v)
    }

    fn add_face_logged(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        self.add(corners, log)
    }

    fn remove_face_logged(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        let first = self.check_face(f)?;
        self.check_removable(first)?;
        self.unlink_face(f, first, log);
        Ok(())
    }

    fn remove_faces_logged(
        &mut self,
        faces: &[FaceId],
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        let gone = faces_once(faces, |f| self.check_face(f))?;
        check_fans_without(self, &gone)?;
        for f in gone {
            self.unlink_face(f, *self.first.read(f.index()), log);
        }
        Ok(())
    }

    fn remove_vertex_logged(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal> {
        self.check_vertex(v)?;
        self.check_fan_removable(v)?;
        self.unlink_fan(v, log);
        self.delete_vertex(v);
        log.removed_vertex(v);
        Ok(())
    }

    fn remove_isolated_vertices_logged(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let is_isolated = |v| *self.leaving.read(v) == Slot::NONE;
        let end = self.leaving.len();
        self.vertex_holes
            .insert_unused(end, is_isolated, |v| log.removed_vertex(v))
    }

    fn split_edge_logged(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.split(e, at, log)
    }

    fn bisect_edge_logged(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.bisect(e, at, log)
    }

    fn poke_face_logged(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.poke(f, at, log)
    }

    fn split_face_logged(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal> {
        self.split_between(f, ends, log)
    }

    fn dissolve_edge_logged(
        &mut self,
        e: EdgeId,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal> {
        self.dissolve(e, log)
    }

    #[inline]
    fn flip_edge_logged(
        &mut self,
        e: EdgeId,
        _: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal> {
        self.flip(e)
    }

    #[inline]
    fn collapse_edge_logged(
        &mut self,
        e: EdgeId,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.collapse(e, keep, to, log)
    }

    fn split_vertex_logged(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.split_fan(v, left, right, at, log)
    }

    fn compact_logged(&mut self, log: &mut impl EditLog<Self>) {
        self.compact_tables(log);
    }
}

/// Checks that elements exist and that there is room for new elements.
impl<P: Probe> HalfEdgeMesh<Editable, P> {
    #[inline]
    fn check_vertex(&self, v: VertexId) -> Result<(), Refusal> {
        if v.index() < self.vertex_rows() && !self.vertex_holes.has(v.index()) {
            Ok(())
        } else {
            Err(EditError::NoSuchVertex { vertex: v })
        }
    }

    #[inline]
    fn check_edge(&self, e: EdgeId) -> Result<[Half; 2], Refusal> {
        if e.index() < self.edge_rows() {
            let pair = *self.halves.read_pair(e.index());
            if !pair[0].is_deleted() {
                return Ok(pair);
            }
        }
        Err(EditError::NoSuchEdge { edge: e })
    }

    #[inline]
    fn check_face(&self, f: FaceId) -> Result<HalfEdgeId, Refusal> {
        if f.index() < self.face_rows() {
            let first = *self.first.read(f.index());
            if first != NO_HALF {
                return Ok(first);
            }
        }
        Err(EditError::NoSuchFace { face: f })
    }

    /// Checks that this number of rows can be added.
    #[inline]
    fn check_room(&self, vertices: usize, edges: usize, faces: usize) -> Result<(), Refusal> {
        check_rows("vertices", self.vertex_rows() + vertices, MAX_ROWS)?;
        check_rows("edges", self.edge_rows() + edges, MAX_EDGES)?;
        check_rows("faces", self.face_rows() + faces, MAX_ROWS)
    }
}

/// Steps that several edits share.
impl<P: Probe> HalfEdgeMesh<Editable, P> {
    #[inline]
    fn record(&self, h: HalfEdgeId) -> Half {
        *self.halves.read(h.index())
    }

    #[inline]
    fn record_pair(&self, h: HalfEdgeId) -> [Half; 2] {
        let pair = self.halves.read_pair(h.edge().index());
        let side = h.index() & 1;
        [pair[side], pair[side ^ 1]]
    }

    #[inline]
    fn has_face(&self, h: HalfEdgeId) -> bool {
        self.record(h).face != Slot::NONE
    }

    #[inline]
    fn link(&mut self, h: HalfEdgeId, next: HalfEdgeId) {
        self.halves.write(h.index()).next = next;
    }

    /// Replaces `old` by `new` after `before`, in the face or on the boundary loop.
    #[inline]
    fn replace(&mut self, before: HalfEdgeId, old: HalfEdgeId, new: HalfEdgeId) {
        let Half { next, face, .. } = self.record(old);
        self.link(before, new);
        let half = self.halves.write(new.index());
        (half.next, half.face) = (next, face);
        self.replace_first(face, old, new);
    }

    /// Sets `first` of the face to `new` if `first` was `old`. Does nothing if `face` is empty.
    #[inline]
    fn replace_first(&mut self, face: Slot<FaceId>, old: HalfEdgeId, new: HalfEdgeId) {
        if let Some(f) = face.get()
            && *self.first.read(f.index()) == old
        {
            *self.first.write(f.index()) = new;
        }
    }

    #[inline]
    fn replace_leaving(&mut self, v: VertexId, old: HalfEdgeId, new: HalfEdgeId) {
        if *self.leaving.read(v.index()) == Slot::some(old) {
            self.set_leaving(v, new);
        }
    }

    #[inline]
    fn set_leaving(&mut self, v: VertexId, h: HalfEdgeId) {
        *self.leaving.write(v.index()) = Slot::some(h);
    }

    /// Sets the face of all half-edges from `first` to `last`.
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

    /// Adds an edge with these two half-edges. Returns the first half-edge.
    #[inline]
    fn push_edge(&mut self, [one, other]: [Half; 2]) -> HalfEdgeId {
        let h = self.next_half();
        self.halves.push(one);
        self.halves.push(other);
        h
    }

    /// Returns the first half-edge of the next new edge.
    #[inline]
    fn next_half(&self) -> HalfEdgeId {
        HalfEdgeId::new(row(self.halves.len()))
    }

    /// Returns the handle of the next new face.
    #[inline]
    fn next_face(&self) -> FaceId {
        FaceId::new(row(self.first.len()))
    }

    #[inline]
    fn delete_vertex(&mut self, v: VertexId) {
        *self.leaving.write(v.index()) = Slot::NONE;
        self.vertex_holes.insert(v.index());
    }

    #[inline]
    fn delete_edge(&mut self, e: EdgeId) {
        for h in self.edge_half_edges(e) {
            *self.halves.write(h.index()) = Half::DELETED;
        }
        self.edge_holes.insert(e.index());
    }

    #[inline]
    fn delete_face(&mut self, f: FaceId) {
        *self.first.write(f.index()) = NO_HALF;
        self.face_holes.insert(f.index());
    }
}
