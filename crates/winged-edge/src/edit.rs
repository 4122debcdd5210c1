//! Edits in place: the implementation of [`MeshEdit`], after Baumgart (1975).
//!
//! Each edge stores the next and the previous edge along both sides, so an edit links and unlinks
//! an edge without a search. Two steps of an edit can cost O(valence): the check before the edit,
//! and replacing a vertex by another vertex in all edges at the vertex.
//!
//! Every edit does all checks before the first write. In these modules, a run `a→b` is the edge
//! between `a` and `b`, along the side where the edge runs from `a` to `b`.

use sixfold_core::{
    EdgeId, Edit, EditLog, Editable, FaceId, MeshEdit, Point, Probe, QueryCost, Refusal, Slot,
    VertexId, check_fans_without, faces_once,
};

use crate::mesh::WingedEdgeMesh;

mod add;
mod collapse;
mod compact;
mod flip;
mod merge;
mod primitives;
mod remove;
mod split;
mod split_vertex;
#[cfg(test)]
mod tests;

impl<P: Probe> MeshEdit for WingedEdgeMesh<Editable, P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = Edit::LOCAL_COSTS;

    sixfold_core::compact_conversions!(WingedEdgeMesh);

    /// O(1).
    #[inline]
    fn set_position_logged(
        &mut self,
        v: VertexId,
        to: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.check_vertex(v)?;
        *self.positions.write(v.index()) = to;
        Ok(v)
    }

    /// O(1) amortised.
    #[inline]
    fn add_vertex_logged(
        &mut self,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.check_room([1, 0, 0])?;
        Ok(self.push_vertex(at, log))
    }

    /// O(degree of the new face), plus the valence of each corner where a new edge starts.
    fn add_face_logged(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        self.add(corners, log)
    }

    /// O(degree).
    fn remove_face_logged(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.remove(f, log)
    }

    fn remove_faces_logged(
        &mut self,
        faces: &[FaceId],
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        let gone = faces_once(faces, |f| self.check_face(f))?;
        check_fans_without(self, &gone)?;
        for f in gone {
            self.unlink_face(f, log);
        }
        Ok(())
    }

    /// O(n) if the faces of `v` are triangles, otherwise O(n log n), for n corners of these faces.
    fn remove_vertex_logged(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.remove_star(v, log)
    }

    /// O(vertices).
    fn remove_isolated_vertices_logged(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let is_isolated = |v| *self.spokes.read(v) == Slot::NONE;
        let end = self.spokes.len();
        self.vertex_holes
            .insert_unused(end, is_isolated, |v| log.removed_vertex(v))
    }

    /// O(1). The old edge keeps its start; the new edge has the old end.
    fn split_edge_logged(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.check_edge(e)?;
        self.check_room([1, 1, 0])?;
        Ok(self.cut_edge(e, at, log).0)
    }

    /// O(1).
    fn bisect_edge_logged(
        &mut self,
        e: EdgeId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.bisect(e, at, log)
    }

    /// O(degree).
    #[inline]
    fn poke_face_logged(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.poke(f, at, log)
    }

    /// O(degree), plus the valence of one end. The part with fewer sides becomes the new face.
    fn split_face_logged(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal<Self>> {
        self.split_between(f, ends, log)
    }

    /// O(degree) of both faces. The face with more sides stays.
    fn dissolve_edge_logged(
        &mut self,
        e: EdgeId,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        self.dissolve(e, log)
    }

    /// O(smaller valence) of the third corners.
    #[inline]
    fn flip_edge_logged(
        &mut self,
        e: EdgeId,
        _: &mut impl EditLog<Self>,
    ) -> Result<EdgeId, Refusal<Self>> {
        self.flip(e)
    }

    /// O(valence) of both ends; O(1) if the removed end has three triangles.
    #[inline]
    fn collapse_edge_logged(
        &mut self,
        e: EdgeId,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.collapse(e, keep, to, log)
    }

    /// O(valence).
    fn split_vertex_logged(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.split_fan(v, left, right, at, log)
    }

    /// O(rows).
    fn compact_logged(&mut self, log: &mut impl EditLog<Self>) {
        self.compact_tables(log);
    }
}
