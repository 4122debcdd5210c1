//! The nine relations.

use mesh_core::{FaceId, IteratorExt, MeshQuery, Pair, Point, Probe, VertexId, row};

use crate::circulate::Sought;
use crate::mesh::IndexedFaceSet;

impl<P: Probe> MeshQuery for IndexedFaceSet<P> {
    type Vertex = VertexId;
    type Edge = Pair<VertexId>;
    type Face = FaceId;

    #[inline]
    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..row(self.positions.len())).map(VertexId::new)
    }

    /// By their lower ends.
    fn edges(&self) -> impl Iterator<Item = Pair<VertexId>> {
        self.spans.edges(&self.corners, self.positions.len())
    }

    #[inline]
    fn faces(&self) -> impl Iterator<Item = FaceId> {
        (0..row(self.spans.len())).map(FaceId::new)
    }

    #[inline]
    fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    #[inline]
    fn face_count(&self) -> usize {
        self.spans.len()
    }

    #[inline]
    fn position(&self, v: VertexId) -> Point {
        *self.positions.read(v.index())
    }

    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        let corners = self.scan(Sought::One(self.existing(v)));
        let beside = corners.flat_map(|corner| {
            let (_, [before, _, after]) = self.around(corner);
            [before, after]
        });
        beside.distinct()
    }

    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = Pair<VertexId>> {
        self.vertex_vertices(v)
            .map(move |other| Pair::new(v, other))
    }

    /// One corner of a face at most names `v` (I2), so no face comes twice.
    #[inline]
    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        let corners = self.scan(Sought::One(self.existing(v)));
        corners.map(|corner| self.spans.face_of(corner))
    }

    #[inline]
    fn edge_vertices(&self, e: Pair<VertexId>) -> [VertexId; 2] {
        e.ends()
    }

    /// Whether there is such an edge at all, only the end of the scan can tell.
    fn edge_edges(&self, e: Pair<VertexId>) -> impl Iterator<Item = Pair<VertexId>> {
        let sides = self.sides_at(Sought::Two(e.ends()));
        let mut edges: Vec<_> = sides.distinct().collect();
        match edges.iter().position(|&edge| edge == e) {
            Some(itself) => drop(edges.swap_remove(itself)),
            None => edges.clear(),
        }
        edges.into_iter()
    }

    /// One corner of a face at most names the first end (I2), so no face comes twice.
    fn edge_faces(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceId> {
        let [a, b] = e.ends();
        self.scan(Sought::One(a)).filter_map(move |corner| {
            let (face, [before, _, after]) = self.around(corner);
            (before == b || after == b).then_some(face)
        })
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.face(f).iter().copied()
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        self.sides_of(f)
    }

    /// Every second corner of `f` ends all of its sides, so the scan need look for no more.
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        let sought = Sought::every_second(self.face(f), self.positions.len());
        let mut sides: Vec<_> = self.sides_of(f).collect();
        sides.sort_unstable();
        let is_side = move |a, b| sides.binary_search(&Pair::new(a, b)).is_ok();
        let faces = self.scan(sought).filter_map(move |corner| {
            let (face, [before, at, after]) = self.around(corner);
            (face != f && (is_side(before, at) || is_side(at, after))).then_some(face)
        });
        faces.distinct()
    }

    #[inline]
    fn vertex_rows(&self) -> usize {
        self.positions.len()
    }

    #[inline]
    fn edge_rows(&self) -> usize {
        0
    }

    #[inline]
    fn face_rows(&self) -> usize {
        self.spans.len()
    }
}
