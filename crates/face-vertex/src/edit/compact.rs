//! Compaction: removal of the deleted rows and of the blanks.

use sixfold_core::{EditLog, Editable, FaceId, MeshQuery, NewRows, Probe, row, uses_reports};

use crate::mesh::{FaceVertexMesh, Fan};

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Implements [`compact`](sixfold_core::MeshEdit::compact).
    pub(super) fn compact_tables(&mut self, log: &mut impl EditLog<Self>) {
        let vertices = NewRows::from_holes(&self.vertex_holes, self.fans.len());
        let faces = NewRows::from_holes(&self.face_holes, self.spans.len());
        if uses_reports(log) {
            self.report_new_rows(&vertices, &faces, log);
        }
        self.spans.compact(&mut self.corners, &self.face_holes);
        if !vertices.is_unchanged() {
            for v in self.corners.rows_mut() {
                *v = vertices.new_handle(*v);
            }
        }
        self.vertex_holes.compact_table(&mut self.positions);
        self.vertex_holes.compact_table(&mut self.fans);
        self.compact_pool(&faces);
        self.vertex_holes.clear();
        self.face_holes.clear();
    }

    /// Stores the fans without gaps, in vertex order. Each fan has the order of its faces.
    fn compact_pool(&mut self, faces: &NewRows) {
        let old = self.pool.rows();
        let mut pool: Vec<FaceId> = Vec::with_capacity(self.corners.len());
        for fan in self.fans.rows_mut() {
            let start = pool.len();
            pool.extend(old[fan.range()].iter().map(|&f| faces.new_handle(f)));
            pool[start..].sort_unstable();
            *fan = Fan {
                start: row(start),
                len: fan.len,
            };
        }
        self.pool.replace(pool);
    }

    fn report_new_rows(&self, vertices: &NewRows, faces: &NewRows, log: &mut impl EditLog<Self>) {
        vertices.for_each_renamed(self.vertices(), |old, new| log.renamed_vertex(old, new));
        vertices.for_each_renamed_pair(self.edges(), |old, new| log.renamed_edge(old, new));
        faces.for_each_renamed(self.faces(), |old, new| log.renamed_face(old, new));
    }
}
