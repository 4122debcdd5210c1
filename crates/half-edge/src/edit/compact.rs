//! Compaction: removes the rows of deleted elements.

use sixfold_core::{EditLog, Editable, MeshQuery, NewRows, Probe, RowId};

use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Moves all rows down over the holes, and replaces the handles in the rows; O(mesh).
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

    /// Replaces every handle in the tables, and moves the half-edges.
    fn rename_rows<L: EditLog<Self>>(&mut self, log: &mut L) {
        let vertices = NewRows::from_holes(&self.vertex_holes, self.vertex_rows());
        let edges = NewRows::from_holes(&self.edge_holes, self.edge_rows());
        let faces = NewRows::from_holes(&self.face_holes, self.face_rows());
        if L::USES_REPORTS {
            vertices.for_each_renamed(self.vertices(), |old, new| log.renamed_vertex(old, new));
            edges.for_each_renamed(self.edges(), |old, new| log.renamed_edge(old, new));
            faces.for_each_renamed(self.faces(), |old, new| log.renamed_face(old, new));
        }

        let half = |h: HalfEdgeId| {
            let edge = edges.new_handle(h.edge());
            HalfEdgeId::new(edge.row() << 1 | (h.row() & 1))
        };
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
                origin: vertices.new_handle(old.origin),
                face: old.face.get().map(|f| faces.new_handle(f)).into(),
            });
            to += 1;
        }
        self.halves.truncate(2 * to);
    }
}
