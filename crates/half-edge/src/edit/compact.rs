//! Compaction: closes the holes.

use sixfold_core::{EditLog, Editable, FaceId, HoleSet, Holes, MeshQuery, Probe, RowId, VertexId};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Moves all rows down over the holes, in order, and replaces the handles in them; O(mesh).
    pub(super) fn compact_tables<L: EditLog<Self>>(&mut self, log: &mut L) {
        if self.hole_count() > 0 {
            self.rename_rows(log);
        }
        self.vertex_holes.compact_table(&mut self.positions);
        self.vertex_holes.compact_table(&mut self.leaving);
        self.face_holes.compact_table(&mut self.first);
        self.halves.shrink_if_half_empty();
        self.vertex_holes.clear();
        self.edge_holes.clear();
        self.face_holes.clear();
    }

    /// Replaces every handle in the tables, and moves the half-edges, which have two rows per edge.
    fn rename_rows<L: EditLog<Self>>(&mut self, log: &mut L) {
        let vertices = self.vertex_holes.new_rows(self.vertex_rows());
        let edges = self.edge_holes.new_rows(self.edge_rows());
        let faces = self.face_holes.new_rows(self.face_rows());
        if L::USES_REPORTS {
            report_new_rows(&self.vertex_holes, &vertices, |old, new| {
                log.renamed_vertex(old, new);
            });
            report_new_rows(&self.edge_holes, &edges, |old, new| {
                log.renamed_edge(old, new);
            });
            report_new_rows(&self.face_holes, &faces, |old, new| {
                log.renamed_face(old, new);
            });
        }

        let half =
            |h: HalfEdgeId| HalfEdgeId::new(edges[h.edge().index()] << 1 | (h.index() as u32 & 1));
        for leaving in self.leaving.rows_mut() {
            *leaving = leaving.get().map(half).into();
        }
        let first = self.first.rows_mut();
        for f in self.face_holes.rows(first.len()) {
            first[f as usize] = half(first[f as usize]);
        }
        let rows = self.halves.rows_mut().as_chunks_mut::<2>().0;
        let mut to = 0;
        for from in self.edge_holes.rows(rows.len()) {
            rows[to] = rows[from as usize].map(|old| Half {
                next: half(old.next),
                origin: VertexId::new(vertices[old.origin.index()]),
                face: old.face.get().map(|f| FaceId::new(faces[f.index()])).into(),
            });
            to += 1;
        }
        self.halves.truncate(2 * to);
    }
}

/// Calls `report` with the old and the new handle of each row that moves.
fn report_new_rows<H: RowId, P: Probe>(
    holes: &Holes<P>,
    new_rows: &[u32],
    mut report: impl FnMut(H, H),
) {
    for old in holes.rows(new_rows.len()) {
        let new = new_rows[old as usize];
        if new != old {
            report(H::from_row(old), H::from_row(new));
        }
    }
}
