//! Edits. [`ScannedFaces`](sixfold_scanning::ScannedFaces) edits the faces; this file edits the
//! vertices.

use sixfold_core::{
    Edit, EditError, EditLog, Editable, FaceId, MAX_ROWS, MeshEdit, MeshQuery, NewRows, Pair,
    Point, Probe, QueryCost, Refusal, VertexId, check_rows, row, uses_reports,
};
use sixfold_scanning::ScannedFaces;

use crate::mesh::IndexedFaceSet;

impl<P: Probe> MeshEdit for IndexedFaceSet<Editable, P> {
    const EDITS: [Option<QueryCost>; Edit::ALL.len()] = {
        let mut costs = Edit::SCAN_COSTS;
        costs[Edit::SetPosition as usize] = Some(QueryCost::Constant);
        costs[Edit::AddVertex as usize] = Some(QueryCost::Constant);
        costs
    };

    sixfold_core::compact_conversions!(IndexedFaceSet);

    /// Takes O(1) time.
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

    /// Takes O(1) time.
    fn add_vertex_logged(
        &mut self,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let v = self.adding_vertex(at, |_, v| Ok(v))?;
        log.created_vertex(v);
        Ok(v)
    }

    /// Takes O(degree) time, and one scan if the log records edits.
    fn add_face_logged(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        corners.iter().try_for_each(|&v| self.check_vertex(v))?;
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
        e: Pair<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.adding_vertex(at, |faces, m| faces.split_edge(e, m, log))
    }

    /// Takes one scan.
    fn bisect_edge_logged(
        &mut self,
        e: Pair<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.adding_vertex(at, |faces, m| faces.bisect_edge(e, m, log))
    }

    /// Takes O(degree) time.
    fn poke_face_logged(
        &mut self,
        f: FaceId,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.adding_vertex(at, |faces, m| faces.poke_face(f, m, log))
    }

    /// Takes O(degree) time, and one scan if the log records edits.
    fn split_face_logged(
        &mut self,
        f: FaceId,
        ends: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) -> Result<Pair<VertexId>, Refusal<Self>> {
        self.faces.split_face(f, ends, log)
    }

    /// Takes one scan.
    fn dissolve_edge_logged(
        &mut self,
        e: Pair<VertexId>,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        self.faces.dissolve_edge(e, log)
    }

    /// Takes two scans.
    fn flip_edge_logged(
        &mut self,
        e: Pair<VertexId>,
        log: &mut impl EditLog<Self>,
    ) -> Result<Pair<VertexId>, Refusal<Self>> {
        self.faces.flip_edge(e, log)
    }

    /// Takes one scan, or two scans if the log records edits.
    fn remove_vertex_logged(
        &mut self,
        v: VertexId,
        log: &mut impl EditLog<Self>,
    ) -> Result<(), Refusal<Self>> {
        self.check_vertex(v)?;
        self.faces.remove_faces_at(v, log)?;
        self.vertex_holes.insert(v.index());
        log.removed_vertex(v);
        Ok(())
    }

    /// Reads all corners, with temporary memory of one byte per vertex.
    fn remove_isolated_vertices_logged(&mut self, log: &mut impl EditLog<Self>) -> usize {
        let mut used = vec![false; self.positions.len()];
        let corners = &self.faces.corners;
        for v in corners.read_range(0..corners.len()) {
            // A blank corner has no vertex.
            if let Some(used) = used.get_mut(v.index()) {
                *used = true;
            }
        }
        self.vertex_holes
            .insert_unused(used.len(), |v| !used[v], |v| log.removed_vertex(v))
    }

    /// Takes one scan, or two scans if the removed triangles may be the last faces of a vertex.
    fn collapse_edge_logged(
        &mut self,
        e: Pair<VertexId>,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.faces.collapse_edge(e, keep, keep, log)?;
        let [a, b] = e.ends();
        let gone = if a == keep { b } else { a };
        self.vertex_holes.insert(gone.index());
        *self.positions.write(keep.index()) = to;
        Ok(keep)
    }

    /// Takes one scan.
    fn split_vertex_logged(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        self.check_vertex(v)?;
        self.adding_vertex(at, |faces, n| faces.split_vertex(v, left, right, n, log))
    }

    fn compact_logged(&mut self, log: &mut impl EditLog<Self>) {
        let rows = NewRows::from_holes(&self.vertex_holes, self.positions.len());
        if uses_reports(log) {
            rows.for_each_renamed(self.vertices(), |old, new| log.renamed_vertex(old, new));
            rows.for_each_renamed_pair(self.edges(), |old, new| log.renamed_edge(old, new));
        }
        self.faces.compact(log);
        if !rows.is_unchanged() {
            for v in self.faces.corners.rows_mut() {
                *v = rows.new_handle(*v);
            }
        }
        self.vertex_holes.compact_table(&mut self.positions);
        self.vertex_holes.clear();
    }
}

impl<P: Probe> IndexedFaceSet<Editable, P> {
    fn check_vertex(&self, v: VertexId) -> Result<(), Refusal<Self>> {
        match self.contains_vertex(v) {
            true => Ok(()),
            false => Err(EditError::NoSuchVertex { vertex: v }),
        }
    }

    /// Adds a vertex at `at` after `edit`, which gets and returns the handle of this vertex. Adds
    /// nothing if all handles are in use, or if the edit is refused.
    fn adding_vertex(
        &mut self,
        at: Point,
        edit: impl FnOnce(
            &mut ScannedFaces<VertexId, P, Editable>,
            VertexId,
        ) -> Result<VertexId, Refusal<Self>>,
    ) -> Result<VertexId, Refusal<Self>> {
        check_rows("vertices", self.positions.len() + 1, MAX_ROWS)?;
        let v = edit(&mut self.faces, VertexId::new(row(self.positions.len())))?;
        self.positions.push(at);
        Ok(v)
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{EditRecord, PolygonMesh, Representation};
    use sixfold_scanning::ScannedVertex;

    use super::*;
    use crate::EditableIndexedFaceSet;

    const SQUARE: [Point; 4] = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];

    fn square() -> EditableIndexedFaceSet {
        let polygons = PolygonMesh::new(SQUARE, [[0, 1, 2], [0, 2, 3]]).expect("valid");
        EditableIndexedFaceSet::from_polygons(&polygons).expect("holds every mesh")
    }

    fn v<const N: usize>(names: [u32; N]) -> [VertexId; N] {
        names.map(VertexId::new)
    }

    #[test]
    fn a_flip_changes_one_corner_per_face() {
        let mut mesh = square();
        let [a, b, c, d] = v([0, 1, 2, 3]);
        let turned = mesh.flip_edge(Pair::new(a, c));
        assert_eq!(turned, Ok(Pair::new(b, d)));
        // Face a b c runs c→a and keeps c. Face a c d runs a→c and keeps a.
        assert_eq!(mesh.corners(), [d, b, c, a, b, d]);
    }

    #[test]
    fn a_growing_face_moves_and_leaves_blanks() {
        let mut mesh = square();
        let [a, b, c, d] = v([0, 1, 2, 3]);
        let side = Pair::new(a, c);
        assert_eq!(mesh.dissolve_edge(side), Ok(FaceId::new(0)));
        assert_eq!(mesh.face(FaceId::new(0)), [a, b, c, d]);
        let blank = VertexId::BLANK;
        let expected = [[blank; 3].as_slice(), &[blank; 3], &[a, b, c, d]].concat();
        assert_eq!(mesh.corners(), expected);
        assert_eq!(mesh.split_face(FaceId::new(0), [b, d]), Ok(Pair::new(b, d)));
        assert_eq!(mesh.face(FaceId::new(0)), [b, c, d]);
        assert_eq!(mesh.face(FaceId::new(2)), [d, a, b]);
        let full = mesh.memory().total();
        mesh.compact();
        assert_eq!(mesh.corners(), [b, c, d, d, a, b]);
        assert!(mesh.memory().total() < full);
        let sides = mesh.memory().tables.len();
        assert_eq!(sides, 2, "only positions and corners remain");
    }

    #[test]
    fn handles_of_missing_and_blank_elements_are_refused() {
        let mut mesh = square();
        let [a, c] = v([0, 2]);
        mesh.remove_face(FaceId::new(1)).expect("f1 exists");
        for vertex in [VertexId::new(4), VertexId::BLANK] {
            let refusal = Err(EditError::NoSuchVertex { vertex });
            assert_eq!(mesh.remove_vertex(vertex), refusal);
        }
        for ends in [[a, VertexId::BLANK], [VertexId::BLANK; 2], [a, a]] {
            let edge = Pair::new(ends[0], ends[1]);
            let refusal = EditError::NoSuchEdge { edge };
            let at = Point::ONE;
            assert_eq!(mesh.split_edge(edge, at), Err(refusal));
            assert_eq!(mesh.flip_edge(edge), Err(refusal));
            assert_eq!(mesh.collapse_edge(edge, ends[1], at), Err(refusal));
        }
        for face in [1, 2].map(FaceId::new) {
            let refusal = Err(EditError::NoSuchFace { face });
            assert_eq!(mesh.split_face(face, [a, c]), refusal);
        }
    }

    #[test]
    #[should_panic(expected = "no vertex v1: it was deleted")]
    fn the_position_of_a_deleted_vertex_panics() {
        let mut mesh = square();
        let [v] = v([1]);
        mesh.remove_vertex(v).expect("v1 exists");
        mesh.position(v);
    }

    #[test]
    fn a_collapse_removes_edges_that_merge_and_compaction_renames_vertices() {
        let mut mesh = square();
        let [a, b, c, d] = v([0, 1, 2, 3]);
        let mut record = EditRecord::new();
        let done = mesh.collapse_edge_logged(Pair::new(a, b), a, Point::ZERO, &mut record);
        assert_eq!(done, Ok(a));
        assert_eq!(record.vertices.removed, [b]);
        assert_eq!(record.faces.removed, [FaceId::new(0)]);
        let gone = [Pair::new(a, b), Pair::new(b, c)];
        assert_eq!(record.edges.removed, gone);
        assert!(record.edges.renamed.is_empty());
        let mut record = EditRecord::new();
        let e = mesh.split_edge_logged(Pair::new(c, d), Point::ONE, &mut record);
        let m = e.expect("an edge");
        assert_eq!(record.edges.renamed, [[Pair::new(c, d), Pair::new(c, m)]]);
        assert_eq!(record.edges.created, [Pair::new(m, d)]);
        let mut record = EditRecord::new();
        mesh.compact_logged(&mut record);
        let names = [[c, v([1])[0]], [d, v([2])[0]], [m, v([3])[0]]];
        assert_eq!(record.vertices.renamed, names);
    }
}
