//! Compaction: removal of the deleted rows.

use sixfold_core::{
    EditLog, Editable, FaceId, HoleSet, MeshQuery, Probe, RowId, Slot, VertexId, uses_reports,
};

use super::faced_by;
use crate::mesh::{CornerId, CornerTable};

impl<P: Probe> CornerTable<Editable, P> {
    /// Moves all rows down over the holes. Triangles keep their order, so the lower corner that
    /// faces an edge stays the lower corner.
    pub(super) fn compact_tables(&mut self, log: &mut impl EditLog<Self>) {
        if !self.vertex_holes.is_empty() || !self.face_holes.is_empty() {
            let new_vertices = self.vertex_holes.new_rows(self.positions.len());
            let new_faces = self.face_holes.new_rows(self.vertex.len() / 3);
            if uses_reports(log) {
                self.report_new_rows(&new_vertices, &new_faces, log);
            }
            self.move_corners(&new_vertices, &new_faces);
        }
        self.vertex_holes.compact_table(&mut self.positions);
        self.vertex_holes.compact_table(&mut self.corner);
        self.vertex.shrink_if_half_empty();
        self.opposite.shrink_if_half_empty();
        self.vertex_holes.clear();
        self.face_holes.clear();
    }

    fn report_new_rows(&self, vertices: &[u32], faces: &[u32], log: &mut impl EditLog<Self>) {
        for v in self.vertices() {
            let new = VertexId::new(vertices[v.index()]);
            if new != v {
                log.renamed_vertex(v, new);
            }
        }
        for e in self.edges() {
            let new = faced_by(new_corner(e.corner(), faces));
            if new != e {
                log.renamed_edge(e, new);
            }
        }
        for f in self.faces() {
            let new = FaceId::new(faces[f.index()]);
            if new != f {
                log.renamed_face(f, new);
            }
        }
    }

    fn move_corners(&mut self, vertices: &[u32], faces: &[u32]) {
        let vertex = self.vertex.rows_mut().as_chunks_mut::<3>().0;
        let opposite = self.opposite.rows_mut().as_chunks_mut::<3>().0;
        let mut kept = 0;
        for from in self.face_holes.rows(faces.len()) {
            let from = from as usize;
            vertex[kept] = vertex[from].map(|v| VertexId::new(vertices[v.index()]));
            opposite[kept] = opposite[from].map(|o| new_slot(o, faces));
            kept += 1;
        }
        self.vertex.truncate(3 * kept);
        self.opposite.truncate(3 * kept);
        for corner in self.corner.rows_mut() {
            *corner = new_slot(*corner, faces);
        }
    }
}

/// Returns the new handle of corner `c`.
#[inline]
fn new_corner(c: CornerId, faces: &[u32]) -> CornerId {
    let t = c.triangle();
    CornerId::new(c.row() - 3 * (t.row() - faces[t.index()]))
}

#[inline]
fn new_slot(c: Slot<CornerId>, faces: &[u32]) -> Slot<CornerId> {
    c.get()
        .map_or(Slot::NONE, |c| Slot::some(new_corner(c, faces)))
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshEdit, Point, Representation};

    use super::super::tests::table;
    use super::*;

    #[test]
    fn compaction_releases_the_memory_of_holes() {
        let mut mesh = table(4, &[[0, 1, 2], [0, 2, 3]]);
        for _ in 0..200 {
            let m = mesh.poke_face(FaceId::new(1), Point::ONE);
            m.expect("the face exists");
        }
        let grown = mesh.memory().total();
        for m in (4..204).rev().map(VertexId::new) {
            let e = mesh.vertex_edges(m).next().expect("three edges");
            let [a, b] = mesh.edge_vertices(e);
            let keep = if a == m { b } else { a };
            let undone = mesh.collapse_edge(e, keep, Point::ONE);
            undone.expect("an inner vertex of valence three");
        }
        let names = mesh.compact_with_map();
        assert_eq!(mesh.validate(), Ok(()));
        assert!(mesh.memory().total() < grown / 4);
        assert_eq!(names.vertices[VertexId::new(200)], None);
        assert_eq!(names.faces[FaceId::new(0)], Some(FaceId::new(0)));
        let again = format!("{mesh:?}");
        mesh.compact();
        assert_eq!(format!("{mesh:?}"), again);
    }
}
