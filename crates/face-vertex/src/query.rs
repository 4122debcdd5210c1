//! The nine relations.

use sixfold_core::{
    Capabilities, Editing, FaceId, HoleSet, IteratorExt, MeshQuery, Pair, Point, Probe, VertexId,
};

use crate::mesh::{FaceVertexMesh, deleted_vertex};

impl<P: Probe, E: Editing> MeshQuery for FaceVertexMesh<E, P> {
    type Vertex = VertexId;
    type Edge = Pair<VertexId>;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities::ALL;

    sixfold_core::vertex_rows!(
        #[inline]
        self,
        self.fans.len(),
        self.vertex_holes
    );
    sixfold_core::face_rows!(
        #[inline]
        self,
        self.spans.len(),
        self.face_holes
    );

    /// Lists the edges, sorted by their lower ends.
    #[inline]
    fn edges(&self) -> impl Iterator<Item = Pair<VertexId>> {
        self.spans
            .edges(&self.corners, &self.face_holes, self.fans.len())
    }

    #[inline]
    fn position(&self, v: VertexId) -> Point {
        let at = self.positions.read(v.index());
        if self.vertex_holes.has(v.index()) {
            deleted_vertex(v);
        }
        *at
    }

    #[inline(always)] // As `ring`.
    fn vertex_vertices(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        self.ring(v, |other| other)
    }

    #[inline(always)] // As `ring`.
    fn vertex_edges(&self, v: VertexId) -> impl Iterator<Item = Pair<VertexId>> {
        self.spokes(v)
    }

    #[inline]
    fn vertex_faces(&self, v: VertexId) -> impl Iterator<Item = FaceId> {
        self.fan(v).iter().map_inline(|&f| f)
    }

    #[inline]
    fn edge_vertices(&self, e: Pair<VertexId>) -> [VertexId; 2] {
        e.ends()
    }

    /// Lists the other edges at both ends of `e`. If `e` is not an edge, the result is empty.
    #[inline]
    fn edge_edges(&self, e: Pair<VertexId>) -> impl Iterator<Item = Pair<VertexId>> {
        let [a, b] = e.ends();
        let (at_a, at_b) = (self.spokes(a), self.spokes(b));
        let is_edge = at_a.has(b);
        at_a.chain(at_b).filter(move |&edge| is_edge && edge != e)
    }

    #[inline]
    fn edge_faces(&self, e: Pair<VertexId>) -> impl Iterator<Item = FaceId> {
        self.faces_along(e)
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = VertexId> {
        self.face(f).iter().map_inline(|&corner| corner)
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = Pair<VertexId>> {
        self.sides(f)
    }

    #[inline]
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        self.faces_around(f)
    }

    /// Looks at the faces of the end with fewer faces.
    #[inline]
    fn edge_between(&self, a: VertexId, b: VertexId) -> Option<Pair<VertexId>> {
        let e = Pair::new(a, b);
        (a != b && self.edge_faces(e).next().is_some()).then_some(e)
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
    use sixfold_core::{Measured, PolygonMesh, Representation, Traced};

    use super::*;
    use crate::FaceVertexMesh;

    fn build(faces: impl IntoIterator<Item: AsRef<[u32]>>, vertices: usize) -> FaceVertexMesh {
        let polygons = PolygonMesh::new(vec![Point::ZERO; vertices], faces).expect("valid");
        FaceVertexMesh::from_polygons(&polygons).expect("holds every mesh")
    }

    /// Returns a closed wheel of `sides` triangles around v0.
    fn wheel(sides: u32) -> FaceVertexMesh {
        let faces = (0..sides).map(|i| [0, i + 1, (i + 1) % sides + 1]);
        build(faces, sides as usize + 1)
    }

    /// Returns two faces with the same corners, back to back.
    fn pillow(sides: u32) -> FaceVertexMesh {
        let faces = [(0..sides).collect::<Vec<_>>(), (0..sides).rev().collect()];
        build(faces, sides as usize)
    }

    #[test]
    fn neighbours_are_listed_once_in_small_and_large_fans() {
        for sides in [3, 4, 15, 16, 17, 18, 40] {
            let mesh = wheel(sides);
            let [hub, rim] = [0, 1].map(VertexId::new);
            let mut ring: Vec<VertexId> = mesh.vertex_vertices(hub).collect();
            ring.sort_unstable();
            assert!(
                ring.into_iter().eq(mesh.vertices().skip(1)),
                "{sides} sides"
            );
            assert_eq!(mesh.vertex_vertices(rim).count(), 3);
            assert_eq!(mesh.vertex_edges(hub).count(), sides as usize);
            assert_eq!(mesh.edge_count(), 2 * sides as usize);
            let spoke = Pair::new(hub, rim);
            assert_eq!(mesh.edge_edges(spoke).count(), sides as usize - 1 + 2);
            assert_eq!(mesh.edge_faces(spoke).count(), 2);
            for f in mesh.faces() {
                assert_eq!(mesh.face_faces(f).count(), 2, "FF({f}) of {sides} sides");
            }
        }
    }

    #[test]
    fn two_faces_with_the_same_sides_are_listed_once_as_neighbours() {
        for sides in [3, 4, 5, 15, 16, 17, 40] {
            let mesh = pillow(sides);
            let [front, back] = [0, 1].map(FaceId::new);
            assert!(mesh.face_faces(front).eq([back]), "{sides} sides");
            assert!(mesh.face_faces(back).eq([front]), "{sides} sides");
            assert_eq!(mesh.edge_count(), sides as usize);
        }
    }

    #[test]
    fn forty_faces_at_one_edge_are_all_adjacent() {
        let mesh = build((0..40).map(|i| [0, 1, i + 2]), 42);
        let shared = Pair::new(VertexId::new(0), VertexId::new(1));
        assert_eq!(mesh.edge_faces(shared).count(), 40);
        for f in mesh.faces() {
            let others = mesh.faces().filter(|&face| face != f);
            let mut around: Vec<FaceId> = mesh.face_faces(f).collect();
            around.sort_unstable();
            assert!(around.into_iter().eq(others), "FF({f})");
        }
    }

    #[test]
    fn a_diagonal_is_not_an_edge() {
        let mesh = build([[0, 1, 2, 3]], 4);
        let [a, b, c] = [0, 1, 2].map(VertexId::new);
        assert_eq!(mesh.edge_faces(Pair::new(a, c)).next(), None);
        assert_eq!(mesh.edge_faces(Pair::new(a, b)).count(), 1);
        assert_eq!(mesh.edge_edges(Pair::new(a, c)).next(), None);
        assert_eq!(mesh.edge_edges(Pair::new(a, b)).count(), 2);
    }

    #[test]
    fn queries_read_only_a_few_times_the_surrounding_rows() {
        let n = 5000;
        let probe = Traced::default();
        let reads = |bound: u32, asked: usize| {
            let (read, bound) = (probe.take().len(), bound as usize);
            assert!(
                asked > 0 && read <= bound,
                "{read} reads, at most {bound} allowed"
            );
        };
        let wheel = wheel(n).probed(probe.clone());
        let spoke = Pair::new(VertexId::new(0), VertexId::new(1));
        reads(4 * n + 1, wheel.vertex_vertices(VertexId::new(0)).count());
        reads(20, wheel.edge_faces(spoke).count());
        reads(60, wheel.face_faces(FaceId::new(0)).count());
        let pillow = pillow(n).probed(probe.clone());
        reads(12 * n, pillow.face_faces(FaceId::new(0)).count());
        reads(4 * n, pillow.edges().count());
    }

    #[test]
    #[should_panic(expected = "no vertex 4: table `fans` has 4 rows")]
    fn a_missing_vertex_panics_with_its_row() {
        let _ = wheel(3).vertex_faces(VertexId::new(4));
    }

    #[test]
    #[should_panic(expected = "no face f3: every face has a row below 3")]
    fn a_missing_face_panics_with_its_handle() {
        let _ = wheel(3).face_edges(FaceId::new(3));
    }
}
