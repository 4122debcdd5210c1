//! The nine relations.

use sixfold_core::{Capabilities, Editing, FaceId, IteratorExt, MeshQuery, Pair, Point, Probe};

use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

impl<P: Probe, E: Editing> MeshQuery for PolygonSoup<E, P> {
    type Vertex = SoupVertex;
    type Edge = Pair<SoupVertex>;
    type Face = FaceId;

    const CAPABILITIES: Capabilities = Capabilities {
        isolated_vertices: false,
        coincident_vertices: false,
        ..Capabilities::ALL
    };

    sixfold_core::face_rows!(
        #[inline]
        self,
        self.faces.spans.len(),
        self.faces.holes
    );

    /// Lists the vertices in the order in which the faces first contain them.
    fn vertices(&self) -> impl Iterator<Item = SoupVertex> {
        self.faces().flat_map(|f| self.face_vertices(f)).distinct()
    }

    /// Lists the edges in the order in which the faces first contain them.
    fn edges(&self) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.faces().flat_map(|f| self.face_edges(f)).distinct()
    }

    #[inline]
    fn position(&self, v: SoupVertex) -> Point {
        v.position()
    }

    #[inline]
    fn vertex_vertices(&self, v: SoupVertex) -> impl Iterator<Item = SoupVertex> {
        self.faces.vertex_vertices(v)
    }

    #[inline]
    fn vertex_edges(&self, v: SoupVertex) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.vertex_vertices(v)
            .map_inline(move |other| Pair::new(v, other))
    }

    #[inline]
    fn vertex_faces(&self, v: SoupVertex) -> impl Iterator<Item = FaceId> {
        self.faces.vertex_faces(v)
    }

    #[inline]
    fn edge_vertices(&self, e: Pair<SoupVertex>) -> [SoupVertex; 2] {
        e.ends()
    }

    #[inline]
    fn edge_edges(&self, e: Pair<SoupVertex>) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.faces.edge_edges(e)
    }

    #[inline]
    fn edge_faces(&self, e: Pair<SoupVertex>) -> impl Iterator<Item = FaceId> {
        self.faces.edge_faces(e)
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = SoupVertex> {
        self.faces.face_vertices(f)
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.faces.face_edges(f)
    }

    #[inline]
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        self.faces.face_faces(f)
    }

    #[inline]
    fn contains_vertex(&self, v: SoupVertex) -> bool {
        self.vertex_faces(v).next().is_some()
    }

    #[inline]
    fn contains_edge(&self, e: Pair<SoupVertex>) -> bool {
        self.edge_faces(e).next().is_some()
    }

    fn vertex_rows(&self) -> usize {
        0
    }

    fn edge_rows(&self) -> usize {
        0
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{Measured, PolygonMesh, Representation, Traced, VertexId};
    use sixfold_scanning::SearchSet;

    use super::*;
    use crate::PolygonSoup;

    /// A pentagon and its mirror image, with a triangle and a quad at two sides.
    fn pillow() -> (PolygonMesh, PolygonSoup) {
        let at = [
            (0, 0),
            (2, 0),
            (3, 2),
            (1, 3),
            (-1, 2),
            (1, -1),
            (4, 0),
            (4, 1),
        ];
        let at = at.map(|(x, y)| Point::new(x as f32, y as f32, 0.0));
        let faces: [&[u32]; 4] = [
            &[0, 1, 2, 3, 4],
            &[4, 3, 2, 1, 0],
            &[1, 0, 5],
            &[2, 1, 6, 7],
        ];
        let polygons = PolygonMesh::new(at, faces).expect("valid");
        let soup = PolygonSoup::from_polygons(&polygons).expect("nothing coincides");
        (polygons, soup)
    }

    #[test]
    fn each_neighbour_is_listed_once() {
        let (polygons, soup) = pillow();
        let v = |i| PolygonSoup::vertex_handle(&polygons, VertexId::new(i));
        let faces = |faces: &mut dyn Iterator<Item = FaceId>| {
            let mut rows: Vec<usize> = faces.map(FaceId::index).collect();
            rows.sort_unstable();
            rows
        };
        assert_eq!((soup.vertex_count(), soup.edge_count()), (8, 10));
        for (f, expected) in (0..).zip([[1, 2, 3].as_slice(), &[0, 2, 3], &[0, 1], &[0, 1]]) {
            assert_eq!(
                faces(&mut soup.face_faces(FaceId::new(f))),
                expected,
                "FF(f{f})"
            );
        }
        let side = Pair::new(v(0), v(1));
        assert_eq!(faces(&mut soup.edge_faces(side)), [0, 1, 2]);
        assert_eq!(faces(&mut soup.vertex_faces(v(1))), [0, 1, 2, 3]);
        let sorted = |mut items: Vec<SoupVertex>| {
            items.sort_unstable();
            items
        };
        let ring = sorted(soup.vertex_vertices(v(1)).collect());
        assert_eq!(ring, sorted([0, 2, 5, 6].map(v).to_vec()));
        let mut around: Vec<_> = soup.edge_edges(side).collect();
        around.sort_unstable();
        let ends = [(0, 4), (0, 5), (1, 2), (1, 5), (1, 6)];
        let mut expected = ends.map(|(a, b)| Pair::new(v(a), v(b)));
        expected.sort_unstable();
        assert_eq!(around, expected);
    }

    #[test]
    fn a_diagonal_is_not_an_edge_and_a_missing_vertex_has_no_neighbours() {
        let (polygons, soup) = pillow();
        let v = |i| PolygonSoup::vertex_handle(&polygons, VertexId::new(i));
        assert_eq!(soup.edge_faces(Pair::new(v(0), v(2))).next(), None);
        let missing = SoupVertex::at(Point::splat(9.0));
        assert_eq!(soup.vertex_vertices(missing).next(), None);
        assert_eq!(soup.vertex_edges(missing).next(), None);
    }

    /// Returns a fan of `sides` - 1 triangles around the origin.
    fn fan(sides: u32) -> PolygonSoup {
        let rim = (0..sides).map(|i| Point::new(1.0, i as f32, 0.0));
        let positions: Vec<Point> = std::iter::once(Point::ZERO).chain(rim).collect();
        let faces = (1..sides).map(|i| [i, i + 1, 0]);
        PolygonSoup::from_polygons(&PolygonMesh::new(positions, faces).expect("valid"))
            .expect("a valid soup")
    }

    #[test]
    fn a_scan_finds_corners_in_full_and_partial_blocks() {
        for sides in [2, 10, 11, 12, 21, 22, 23, 24, 33, 100] {
            let soup = fan(sides);
            let hub = SoupVertex::at(Point::ZERO);
            let last = SoupVertex::at(Point::new(1.0, (sides - 1) as f32, 0.0));
            let corners: Vec<usize> = soup.faces.scan(SearchSet::One(hub)).collect();
            let expected: Vec<usize> = (2..soup.corners().len()).step_by(3).collect();
            assert_eq!(corners, expected, "{sides} sides");
            let either = soup.faces.scan(SearchSet::Two([hub, last])).count();
            let far = [1, 2, 3].map(|i| SoupVertex::at(Point::splat(i as f32)));
            let many = [hub, last, far[0], far[1], far[2]];
            let many = soup.faces.scan(SearchSet::from_vertices(&many)).count();
            assert_eq!((either, many), (expected.len() + 1, expected.len() + 1));
            let missing = SoupVertex::at(Point::NEG_ONE);
            assert_eq!(soup.faces.scan(SearchSet::One(missing)).next(), None);
        }
    }

    #[test]
    fn a_query_reads_every_corner_once_and_the_faces_of_its_hits() {
        let probe = Traced::default();
        let soup = fan(101);
        let far = SoupVertex::at(Point::new(1.0, 50.0, 0.0));
        let soup = soup.probed(probe.clone());
        assert_eq!(soup.vertex_faces(far).count(), 2);
        assert_eq!(probe.take().len(), 300);
        assert_eq!(soup.vertex_vertices(far).count(), 3);
        assert_eq!(probe.take().len(), 300 + 2 * 3);
    }

    #[test]
    #[should_panic(expected = "no face f1: every face has a row below 1")]
    fn a_missing_face_panics_with_its_handle() {
        let triangle = PolygonMesh::new([Point::X, Point::Y, Point::Z], [[0, 1, 2]]);
        let soup = PolygonSoup::from_polygons(&triangle.expect("valid")).expect("a valid soup");
        let _ = soup.face_vertices(FaceId::new(1));
    }
}
