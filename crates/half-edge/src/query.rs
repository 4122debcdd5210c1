//! The nine relations.

use sixfold_core::{
    Capabilities, DistinctWalk, EdgeId, Editing, FaceId, HoleSet, IteratorExt, MeshQuery, Point,
    Probe, VertexId,
};

use crate::circulate::EdgeEdges;
use crate::mesh::{Half, HalfEdgeMesh, panic_deleted};

impl<P: Probe, E: Editing> MeshQuery for HalfEdgeMesh<E, P> {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities::ORIENTED_MANIFOLDS;

    sixfold_core::vertex_rows!(self, self.positions.len(), self.vertex_holes);
    sixfold_core::edge_rows!(self, self.halves.len() / 2, self.edge_holes);
    sixfold_core::face_rows!(self, self.first.len(), self.face_holes);

    #[inline]
    fn position(&self, v: VertexId) -> Point {
        let at = self.positions.read(v.index());
        if self.vertex_holes.has(v.index()) {
            panic_deleted(v);
        }
        *at
    }

    #[inline]
    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.spokes(v).map_inline(|(_, twin)| twin.origin)
    }

    #[inline]
    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = EdgeId> {
        self.spokes(v).map_inline(|(h, _)| h.edge())
    }

    #[inline]
    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        // Each face at v has one half-edge that arrives at v.
        self.spokes(v).filter_map(|(_, twin)| twin.face.get())
    }

    #[inline]
    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let [one, other] = self.pair(e);
        [one.origin, other.origin]
    }

    #[inline]
    fn edge_edges(&self, e: EdgeId) -> impl Iterator<Item = EdgeId> {
        EdgeEdges::new(self, e)
    }

    #[inline]
    fn edge_faces(&self, e: EdgeId) -> impl Iterator<Item = FaceId> {
        let [one, other] = self.pair(e);
        [one.face, other.face]
            .into_iter()
            .filter_map(|face| face.get())
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.sides(f).map_inline(|(_, half)| half.origin)
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = EdgeId> {
        self.sides(f).map_inline(|(h, _)| h.edge())
    }

    #[inline]
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        DistinctWalk::new(self.across(f))
    }

    /// Collects the walk around `v`, which is clockwise, and reverses its order.
    fn one_ring(&self, v: VertexId) -> Option<impl Iterator<Item = VertexId>> {
        let mut ring: Vec<VertexId> = self.vertex_vertices(v).collect();
        ring.reverse();
        Some(ring.into_iter())
    }
}

impl<P: Probe, E: Editing> HalfEdgeMesh<E, P> {
    #[inline]
    pub(crate) fn pair(&self, e: EdgeId) -> &[Half; 2] {
        let pair = self.halves.read_pair(e.index());
        if E::CAN_DELETE && pair[0].is_deleted() {
            panic_deleted(e);
        }
        pair
    }
}
