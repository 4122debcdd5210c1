//! The nine relations.

use mesh_core::{FaceId, IteratorExt, MeshQuery, Pair, Point, Probe, row};

use crate::circulate::Sought;
use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

impl<P: Probe> MeshQuery for PolygonSoup<P> {
    type Vertex = SoupVertex;
    type Edge = Pair<SoupVertex>;
    type Face = FaceId;

    /// In the order in which faces first name them.
    fn vertices(&self) -> impl Iterator<Item = SoupVertex> {
        self.faces().flat_map(|f| self.face_vertices(f)).distinct()
    }

    /// In the order in which faces first run along them.
    fn edges(&self) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.faces().flat_map(|f| self.sides_of(f)).distinct()
    }

    fn faces(&self) -> impl Iterator<Item = FaceId> {
        (0..row(self.face_count())).map(FaceId::new)
    }

    #[inline]
    fn face_count(&self) -> usize {
        self.spans.len()
    }

    #[inline]
    fn position(&self, v: SoupVertex) -> Point {
        v.position()
    }

    fn vertex_vertices(&self, v: SoupVertex) -> impl Iterator<Item = SoupVertex> {
        let corners = self.sweep(Sought::One(v));
        let beside = corners.flat_map(|corner| {
            let (_, [before, _, after]) = self.around(corner);
            [before, after]
        });
        beside.distinct()
    }

    fn vertex_edges(&self, v: SoupVertex) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.sides_at(Sought::One(v)).distinct()
    }

    /// One corner of a face at most is at `v` (I3), so no face comes twice.
    #[inline]
    fn vertex_faces(&self, v: SoupVertex) -> impl Iterator<Item = FaceId> {
        self.sweep(Sought::One(v))
            .map(|corner| self.spans.face_of(corner))
    }

    #[inline]
    fn edge_vertices(&self, e: Pair<SoupVertex>) -> [SoupVertex; 2] {
        e.ends()
    }

    /// Whether there is such an edge at all, only the end of the sweep can tell.
    fn edge_edges(&self, e: Pair<SoupVertex>) -> impl Iterator<Item = Pair<SoupVertex>> {
        let sides = self.sides_at(Sought::Two(e.ends()));
        let mut edges: Vec<_> = sides.distinct().collect();
        match edges.iter().position(|&edge| edge == e) {
            Some(itself) => drop(edges.swap_remove(itself)),
            None => edges.clear(),
        }
        edges.into_iter()
    }

    /// One corner of a face at most is at the first end (I3), so no face comes twice.
    fn edge_faces(&self, e: Pair<SoupVertex>) -> impl Iterator<Item = FaceId> {
        let [a, b] = e.ends();
        self.sweep(Sought::One(a)).filter_map(move |corner| {
            let (face, [before, _, after]) = self.around(corner);
            (before == b || after == b).then_some(face)
        })
    }

    #[inline]
    fn face_vertices(&self, f: FaceId) -> impl Iterator<Item = SoupVertex> {
        self.face_positions(f).iter().map(|&p| SoupVertex::at(p))
    }

    #[inline]
    fn face_edges(&self, f: FaceId) -> impl Iterator<Item = Pair<SoupVertex>> {
        self.sides_of(f)
    }

    /// Every second corner of `f` ends all of its sides, so a sweep need look for no more.
    fn face_faces(&self, f: FaceId) -> impl Iterator<Item = FaceId> {
        let sought = match self.face_positions(f) {
            &[a, _, c] | &[a, _, c, _] => Sought::Two([a, c].map(SoupVertex::at)),
            many => {
                let every_second = many.iter().step_by(2);
                Sought::Many(every_second.map(|&p| SoupVertex::at(p)).collect())
            }
        };
        let mut sides: Vec<Pair<SoupVertex>> = self.sides_of(f).collect();
        sides.sort_unstable();
        let is_side = move |a, b| sides.binary_search(&Pair::new(a, b)).is_ok();
        let faces = self.sweep(sought).filter_map(move |corner| {
            let (face, [before, at, after]) = self.around(corner);
            (face != f && (is_side(before, at) || is_side(at, after))).then_some(face)
        });
        faces.distinct()
    }

    fn vertex_rows(&self) -> usize {
        0
    }

    fn edge_rows(&self) -> usize {
        0
    }

    fn face_rows(&self) -> usize {
        self.face_count()
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{PolygonMesh, Representation, VertexId};

    use super::*;

    /// A pentagon and its mirror image share all sides; a triangle and a quad share one each.
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
    fn each_neighbour_comes_once() {
        let (polygons, soup) = pillow();
        let v = |i| PolygonSoup::vertex_name(&polygons, VertexId::new(i));
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
    fn a_diagonal_is_no_edge_and_a_stranger_has_no_neighbours() {
        let (polygons, soup) = pillow();
        let v = |i| PolygonSoup::vertex_name(&polygons, VertexId::new(i));
        assert_eq!(soup.edge_faces(Pair::new(v(0), v(2))).next(), None);
        let stranger = SoupVertex::at(Point::splat(9.0));
        assert_eq!(soup.vertex_vertices(stranger).next(), None);
        assert_eq!(soup.vertex_edges(stranger).next(), None);
    }

    #[test]
    #[should_panic(expected = "no face f1: there are 1")]
    fn a_missing_face_panics_by_name() {
        let triangle = PolygonMesh::new([Point::X, Point::Y, Point::Z], [[0, 1, 2]]);
        let soup = PolygonSoup::from_polygons(&triangle.expect("valid")).expect("held");
        let _ = soup.face_vertices(FaceId::new(1));
    }
}
