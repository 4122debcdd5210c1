//! The nine relations.

use sixfold_core::{
    Capabilities, DistinctWalk, EdgeId, Editing, FaceId, HoleSet, IteratorExt, MeshQuery, Point,
    Probe, Slot, VertexId,
};

use crate::circulate::EdgeEdges;
use crate::mesh::{WingedEdgeMesh, no_such_vertex};

impl<P: Probe, E: Editing> MeshQuery for WingedEdgeMesh<E, P> {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities::ORIENTED_MANIFOLDS;

    sixfold_core::vertex_rows!(self, self.positions.len(), self.vertex_holes);
    sixfold_core::edge_rows!(self, self.edges.len(), self.edge_holes);
    sixfold_core::face_rows!(self, self.sides.len(), self.face_holes);

    #[inline]
    fn position(&self, v: VertexId) -> Point {
        let position = self.positions.read(v.index());
        if self.vertex_holes.has(v.index()) {
            no_such_vertex(v);
        }
        *position
    }

    /// Counter-clockwise. At a boundary vertex, starts on the boundary.
    #[inline]
    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.runs_from(v).map_inline(|(_, run)| run.target())
    }

    #[inline]
    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = EdgeId> {
        self.runs_from(v).map_inline(|(e, _)| e)
    }

    #[inline]
    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        // Each face at v is on the left of one run that leaves v.
        self.runs_from(v).filter_map(|(_, run)| run.face().get())
    }

    #[inline]
    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        self.edge(e).ends()
    }

    #[inline]
    fn edge_edges(&self, e: EdgeId) -> impl Iterator<Item = EdgeId> {
        EdgeEdges::new(self, e)
    }

    #[inline]
    fn edge_faces(&self, e: EdgeId) -> impl Iterator<Item = FaceId> {
        self.edge(e).faces.into_iter().filter_map(Slot::get)
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.runs_along(f).map_inline(|(_, run)| run.origin())
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = EdgeId> {
        self.runs_along(f).map_inline(|(e, _)| e)
    }

    #[inline]
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        DistinctWalk::new(self.runs_along(f).map_inline(|(_, run)| run.across()))
    }

    /// Walks around `a`.
    #[inline]
    fn edge_between(&self, a: VertexId, b: VertexId) -> Option<EdgeId> {
        let mut runs = self.runs_from(a);
        runs.find_map(|(e, run)| (run.target() == b).then_some(e))
    }

    /// Returns the walk around `v`, which is counter-clockwise and starts on the boundary.
    #[inline]
    fn one_ring(&self, v: VertexId) -> Option<impl Iterator<Item = VertexId>> {
        Some(self.vertex_vertices(v))
    }
}
