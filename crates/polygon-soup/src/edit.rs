//! Edits. [`ScannedFaces`](sixfold_scanning::ScannedFaces) does the edits, because a soup has only
//! faces.

use sixfold_core::{
    Edit, EditError, EditLog, Editable, FaceId, MeshEdit, Pair, Point, Probe, QueryCost, Refusal,
    Representation,
};

use crate::EditablePolygonSoup;
use crate::mesh::PolygonSoup;
use crate::vertex::SoupVertex;

impl<P: Probe> MeshEdit for PolygonSoup<Editable, P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = {
        let mut costs = Edit::SCAN_COSTS;
        costs[Edit::AddVertex as usize] = None;
        // No vertex is isolated.
        costs[Edit::RemoveIsolatedVertices as usize] = Some(QueryCost::Constant);
        // A scan checks that the position of the new vertex is free.
        costs[Edit::PokeFace as usize] = Some(QueryCost::Scan);
        costs
    };

    sixfold_core::compact_conversions!(PolygonSoup);

    /// Takes one scan. The vertex and its edges get new handles.
    fn set_position_logged(
        &mut self,
        v: SoupVertex,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        let to = SoupVertex::at(to);
        self.faces.rename_vertex(v, to, log)?;
        Ok(to)
    }

    /// Always returns an error, because a vertex is the position of a corner.
    fn add_vertex_logged(
        &mut self,
        _: Point,
        _: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        Err(EditError::Unsupported {
            structure: <EditablePolygonSoup as Representation>::NAME,
            edit: Edit::AddVertex,
        })
    }

    /// Takes O(degree) time, and one scan if the log records edits. A corner may be at a new
    /// position.
    fn add_face_logged(
        &mut self,
        corners: &[SoupVertex],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        self.faces.add_face(corners, log)
    }

    /// Takes O(degree) time, and one scan if the log records edits.
    fn remove_face_logged(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.faces.remove_face(f, log)
    }

    /// Takes O(n log n) time for n faces, and one scan if the log records edits.
    fn remove_faces_logged(
        &mut self,
        faces: &[FaceId],
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.faces.remove_faces(faces, log)
    }

    /// Takes one scan.
    fn split_edge_logged(
        &mut self,
        e: Pair<SoupVertex>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        self.faces.split_edge(e, SoupVertex::at(at), log)
    }

    /// Takes one scan.
    fn bisect_edge_logged(
        &mut self,
        e: Pair<SoupVertex>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        self.faces.bisect_edge(e, SoupVertex::at(at), log)
    }

    /// Takes one scan, to check that the position is free.
    fn poke_face_logged(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        self.faces.poke_face(f, SoupVertex::at(at), log)
    }

    /// Takes O(degree) time, and one scan if the log records edits.
    fn split_face_logged(
        &mut self,
        f: FaceId,
        ends: [SoupVertex; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<Pair<SoupVertex>, Refusal<Self>> {
        self.faces.split_face(f, ends, log)
    }

    /// Takes one scan.
    fn dissolve_edge_logged(
        &mut self,
        e: Pair<SoupVertex>,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        self.faces.dissolve_edge(e, log)
    }

    /// Takes two scans.
    fn flip_edge_logged(
        &mut self,
        e: Pair<SoupVertex>,
        log: &mut impl EditLog<Self>,
    ) -> Result<Pair<SoupVertex>, Refusal<Self>> {
        self.faces.flip_edge(e, log)
    }

    /// Takes one scan, or two scans if the log records edits.
    fn remove_vertex_logged(
        &mut self,
        v: SoupVertex,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.faces.remove_faces_at(v, log)
    }

    /// Returns 0, because no vertex is isolated.
    fn remove_isolated_vertices_logged(&mut self, _: &mut impl EditLog<Self>) -> usize {
        0
    }

    /// Takes one scan, and one more scan for each vertex that may lose its last face. `to` may be
    /// the position of the removed end.
    fn collapse_edge_logged(
        &mut self,
        e: Pair<SoupVertex>,
        keep: SoupVertex,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        let to = SoupVertex::at(to);
        self.faces.collapse_edge(e, keep, to, log)?;
        Ok(to)
    }

    /// Takes one scan.
    fn split_vertex_logged(
        &mut self,
        v: SoupVertex,
        left: Option<SoupVertex>,
        right: Option<SoupVertex>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<SoupVertex, Refusal<Self>> {
        let n = SoupVertex::at(at);
        self.faces.split_vertex(v, left, right, n, log)
    }

    /// Keeps the handles of vertices and edges.
    fn compact_logged(&mut self, log: &mut impl EditLog<Self>) {
        self.faces.compact(log);
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{EditRecord, MeshQuery, PolygonMesh};

    use super::*;

    const SQUARE: [Point; 4] = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];

    fn square() -> (EditablePolygonSoup, [SoupVertex; 4]) {
        let polygons = PolygonMesh::new(SQUARE, [[0, 1, 2], [0, 2, 3]]).expect("valid");
        let soup = EditablePolygonSoup::from_polygons(&polygons).expect("nothing coincides");
        (soup, SQUARE.map(SoupVertex::at))
    }

    #[test]
    fn moving_a_vertex_changes_its_handle_and_those_of_its_edges() {
        let (mut soup, [a, b, c, d]) = square();
        let mut record = EditRecord::new();
        let to = soup.set_position_logged(a, Point::new(5.0, -0.0, 0.0), &mut record);
        let to = to.expect("the position is free");
        assert_eq!(to, SoupVertex::at(Point::new(5.0, 0.0, 0.0)));
        assert_eq!(soup.validate(), Ok(()), "−0 is stored as 0");
        assert_eq!(record.vertices.renamed, [[a, to]]);
        let mut renamed = record.edges.renamed.clone();
        renamed.sort_unstable();
        let mut expected = [b, c, d].map(|v| [Pair::new(a, v), Pair::new(to, v)]);
        expected.sort_unstable();
        assert_eq!(renamed, expected);
        let corners = [to, b, c, to, c, d].map(SoupVertex::position);
        assert_eq!(soup.corners(), corners);
        let occupied = soup.set_position(to, d.position());
        assert_eq!(occupied, Err(EditError::Occupied { vertex: d }));
        let gone = soup.set_position(a, a.position());
        assert_eq!(gone, Err(EditError::NoSuchVertex { vertex: a }));
        assert_eq!(soup.set_position(to, to.position()), Ok(to));
    }

    #[test]
    fn a_collapse_to_the_position_of_the_removed_end_uses_its_handle() {
        let (mut soup, [a, b, c, d]) = square();
        let mut record = EditRecord::new();
        let kept = soup.collapse_edge_logged(Pair::new(a, b), a, b.position(), &mut record);
        assert_eq!(kept, Ok(b));
        assert_eq!(record.vertices.removed, [b]);
        assert_eq!(record.vertices.renamed, [[a, b]]);
        let mut removed = record.edges.removed.clone();
        removed.sort_unstable();
        let mut expected = [Pair::new(a, b), Pair::new(b, c)];
        expected.sort_unstable();
        assert_eq!(removed, expected);
        let mut renamed = record.edges.renamed.clone();
        renamed.sort_unstable();
        let mut expected = [c, d].map(|v| [Pair::new(a, v), Pair::new(b, v)]);
        expected.sort_unstable();
        assert_eq!(renamed, expected);
    }

    #[test]
    fn vertices_are_created_and_removed_with_their_faces() {
        let (mut soup, [a, b, c, d]) = square();
        let mut record = EditRecord::new();
        let peak = SoupVertex::at(Point::Z);
        let f = soup
            .add_face_logged(&[b, a, peak], &mut record)
            .expect("a face");
        assert_eq!(record.vertices.created, [peak]);
        assert_eq!(record.edges.created.len(), 2);
        record.clear();
        soup.remove_face_logged(f, &mut record).expect("f exists");
        assert_eq!(record.vertices.removed, [peak]);
        assert_eq!(record.edges.removed.len(), 2);
        record.clear();
        soup.remove_vertex_logged(b, &mut record).expect("b exists");
        assert_eq!(record.vertices.removed, [b]);
        soup.remove_vertex_logged(d, &mut record).expect("d exists");
        assert_eq!(soup.vertex_count(), 0);
        let gone = soup.remove_vertex(c);
        assert_eq!(gone, Err(EditError::NoSuchVertex { vertex: c }));
    }

    #[test]
    fn nan_coordinates_find_no_deleted_corner() {
        let (mut soup, [a, b, _, _]) = square();
        soup.remove_face(FaceId::new(0)).expect("a face");
        let stored = soup.corners()[0];
        let nan_points = [
            stored,
            Point::NAN,
            Point::splat(f32::from_bits(u32::MAX)),
            Point::new(stored.x, 0.0, 0.0),
        ];
        for nan in nan_points.map(SoupVertex::at) {
            assert_eq!(soup.vertex_faces(nan).next(), None);
            assert_eq!(soup.vertex_edges(nan).next(), None);
            let refusal = Err(EditError::NoSuchVertex { vertex: nan });
            assert_eq!(soup.remove_vertex(nan), refusal);
            let edge = Pair::new(nan, a);
            assert_eq!(soup.edge_faces(edge).next(), None);
            // The position is valid, because a face may have a corner there.
            let mut soup = soup.clone();
            let f = soup.add_face(&[a, b, nan]).expect("valid");
            assert_eq!(soup.validate(), Ok(()));
            assert!(soup.vertex_faces(nan).eq([f]));
            assert!(soup.face_vertices(f).eq([a, b, nan]));
        }
    }

    #[test]
    fn compaction_keeps_only_the_corners_of_faces() {
        let (mut soup, [a, b, c, d]) = square();
        let merged = soup.dissolve_edge(Pair::new(a, c));
        assert_eq!(merged, Ok(FaceId::new(0)));
        let names = soup.compact_with_map();
        assert_eq!(names.faces.values(), [Some(FaceId::new(0)), None]);
        assert_eq!(soup.corners(), [a, b, c, d].map(SoupVertex::position));
        assert_eq!(soup.memory().total(), 4 * 12);
    }

    #[test]
    #[should_panic(expected = "no face f0: it was deleted")]
    fn the_vertices_of_a_deleted_face_panic() {
        let (mut soup, _) = square();
        soup.remove_face(FaceId::new(0)).expect("a face");
        let _ = soup.face_vertices(FaceId::new(0));
    }
}
