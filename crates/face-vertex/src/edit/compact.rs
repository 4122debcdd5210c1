//! Compaction: removal of the deleted rows and of the blanks.

use sixfold_core::{EditLog, FaceId, HoleSet, Holes, MeshQuery, Pair, Probe, RowId, row};

use super::listens;
use crate::mesh::{EditableFaceVertexMesh, Fan};

/// The new rows of vertices or faces after compaction; `None` if there are no holes.
struct NewNames(Option<Vec<u32>>);

impl NewNames {
    fn of<P: Probe>(holes: &Holes<P>, end: usize) -> Self {
        Self((!holes.is_empty()).then(|| holes.new_rows(end)))
    }

    #[inline]
    fn name<H: RowId>(&self, old: H) -> H {
        let new = |rows: &Vec<u32>| H::from_row(rows[old.row() as usize]);
        self.0.as_ref().map_or(old, new)
    }
}

impl<P: Probe> EditableFaceVertexMesh<P> {
    /// Implements [`compact`](sixfold_core::MeshEdit::compact).
    pub(super) fn close_up(&mut self, log: &mut impl EditLog<Self>) {
        let vertices = NewNames::of(&self.vertex_holes, self.fans.len());
        let faces = NewNames::of(&self.face_holes, self.spans.len());
        if listens(log) {
            self.tell_closed(&vertices, &faces, log);
        }
        self.spans.compact(&mut self.corners, &self.face_holes);
        if vertices.0.is_some() {
            for v in self.corners.rows_mut() {
                *v = vertices.name(*v);
            }
        }
        self.vertex_holes.close(&mut self.positions);
        self.vertex_holes.close(&mut self.fans);
        self.close_pool(&faces);
        self.vertex_holes.fill();
        self.face_holes.fill();
    }

    /// Stores the fans without gaps, in vertex order, each in the order of its faces.
    fn close_pool(&mut self, faces: &NewNames) {
        let old = self.pool.rows();
        let mut pool: Vec<FaceId> = Vec::with_capacity(self.corners.len());
        for fan in self.fans.rows_mut() {
            let start = pool.len();
            pool.extend(old[fan.range()].iter().map(|&f| faces.name(f)));
            pool[start..].sort_unstable();
            *fan = Fan {
                start: row(start),
                len: fan.len,
            };
        }
        self.pool.replace(pool);
    }

    fn tell_closed(&self, vertices: &NewNames, faces: &NewNames, log: &mut impl EditLog<Self>) {
        if vertices.0.is_some() {
            for v in self.vertices().filter(|&v| vertices.name(v) != v) {
                log.renamed_vertex(v, vertices.name(v));
            }
            for e in self.edges() {
                let [a, b] = e.ends().map(|v| vertices.name(v));
                if Pair::new(a, b) != e {
                    log.renamed_edge(e, Pair::new(a, b));
                }
            }
        }
        for f in self.faces().filter(|&f| faces.name(f) != f) {
            log.renamed_face(f, faces.name(f));
        }
    }
}
