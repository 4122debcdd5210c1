//! The nine relations.

use sixfold_core::{
    Capabilities, Editing, FaceId, IteratorExt, MeshQuery, Pair, Point, Probe, VertexId,
};

use crate::mesh::IndexedFaceSet;

impl<P: Probe, E: Editing> MeshQuery for IndexedFaceSet<E, P> {
    type Vertex = VertexId;
    type Edge = Pair<VertexId>;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities::ALL;

    sixfold_core::vertex_rows!(
        #[inline]
        self,
        self.positions.len(),
        self.vertex_holes
    );
    sixfold_core::face_rows!(
        #[inline]
        self,
        self.faces.spans.len(),
        self.faces.holes
    );

    /// Lists the edges, sorted by their lower ends.
    fn edges(&self) -> impl Iterator<Item = Pair<VertexId>> {
        let faces = &self.faces;
        let vertices = self.positions.len();
        faces.spans.edges(&faces.corners, &faces.holes, vertices)
    }

    #[inline]
    fn position(&self, v: VertexId) -> Point {
        let at = *self.positions.read(v.index());
        self.check_not_deleted(v);
        at
    }

    #[inline]
    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.faces.vertex_vertices(self.expect_vertex(v))
    }

    #[inline]
    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = Pair<VertexId>> {
        self.vertex_vertices(v)
            .map_inline(move |other| Pair::new(v, other))
    }

    #[inline]
    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        self.faces.vertex_faces(self.expect_vertex(v))
    }

    #[inline]
    fn edge_vertices(&self, e: Pair<VertexId>) -> [VertexId; 2] {
        e.ends()
    }

    #[inline]
    fn edge_edges(&self, e: Pair<VertexId>) -> impl Iterator<Item = Pair<VertexId>> {
        self.faces.edge_edges(e)
    }

    #[inline]
    fn edge_faces(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceId> {
        self.faces.edge_faces(e)
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.face(f).iter().map_inline(|&corner| corner)
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        self.faces.face_edges(f)
    }

    #[inline]
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        self.faces.face_faces(f)
    }

    #[inline]
    fn contains_edge(&self, e: Pair<VertexId>) -> bool {
        let [a, b] = e.ends();
        self.contains_vertex(a) && self.contains_vertex(b) && self.edge_faces(e).next().is_some()
    }

    #[inline]
    fn edge_rows(&self) -> usize {
        0
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{PolygonMesh, Representation};

    use super::*;
    use crate::IndexedFaceSet;

    #[test]
    fn edges_of_a_vertex_with_many_faces_are_listed_once() {
        let faces = 1_000;
        let corners = vec![Point::ZERO; faces as usize + 2];
        // All faces are around v0. Two faces share each inner spoke.
        let fan = (1..=faces).map(|f| [0, f, f + 1]);
        let mesh = PolygonMesh::new(corners, fan).expect("valid");
        let mesh = IndexedFaceSet::from_polygons(&mesh).expect("holds every mesh");
        assert_eq!(mesh.edge_count(), 2 * faces as usize + 1);
        assert_eq!(
            mesh.vertex_edges(VertexId::new(0)).count(),
            faces as usize + 1
        );
    }
}
