//! Compaction: removal of the deleted rows and of the blanks.

use sixfold_core::{EditLog, Editable, FaceId, HoleSet, Holes, MeshQuery, Pair, Probe, RowId, row};

use super::uses_reports;
use crate::mesh::{FaceVertexMesh, Fan};

/// The new rows of vertices or faces after compaction; `None` if there are no holes.
struct NewRows(Option<Vec<u32>>);

impl NewRows {
    fn from_holes<P: Probe>(holes: &Holes<P>, end: usize) -> Self {
        Self((!holes.is_empty()).then(|| holes.new_rows(end)))
    }

    #[inline]
    fn new_handle<H: RowId>(&self, old: H) -> H {
        let new = |rows: &Vec<u32>| H::from_row(rows[old.row() as usize]);
        self.0.as_ref().map_or(old, new)
    }
}

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Implements [`compact`](sixfold_core::MeshEdit::compact).
    pub(super) fn compact_tables(&mut self, log: &mut impl EditLog<Self>) {
        let vertices = NewRows::from_holes(&self.vertex_holes, self.fans.len());
        let faces = NewRows::from_holes(&self.face_holes, self.spans.len());
        if uses_reports(log) {
            self.report_new_rows(&vertices, &faces, log);
        }
        self.spans.compact(&mut self.corners, &self.face_holes);
        if vertices.0.is_some() {
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

    /// Stores the fans without gaps, in vertex order, each in the order of its faces.
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
        if vertices.0.is_some() {
            for v in self.vertices().filter(|&v| vertices.new_handle(v) != v) {
                log.renamed_vertex(v, vertices.new_handle(v));
            }
            for e in self.edges() {
                let [a, b] = e.ends().map(|v| vertices.new_handle(v));
                if Pair::new(a, b) != e {
                    log.renamed_edge(e, Pair::new(a, b));
                }
            }
        }
        for f in self.faces().filter(|&f| faces.new_handle(f) != f) {
            log.renamed_face(f, faces.new_handle(f));
        }
    }
}
