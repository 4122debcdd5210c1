//! Compaction: closes the holes.

use sixfold_core::{
    EdgeId, EditLog, Editable, FaceId, HoleSet, Holes, Probe, RowId, Slot, VertexId,
};

use crate::mesh::WingedEdgeMesh;
use crate::wings::Wings;

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Moves all rows down over the holes, in order, and replaces the handles in them; O(mesh).
    pub(super) fn compact_tables<L: EditLog<Self>>(&mut self, log: &mut L) {
        let vertices = NewRows::from_holes(&self.vertex_holes, self.positions.len());
        let edges = NewRows::from_holes(&self.edge_holes, self.edges.len());
        let faces = NewRows::from_holes(&self.face_holes, self.sides.len());
        if L::USES_REPORTS {
            vertices.report_new_rows(&self.vertex_holes, |old, new| log.renamed_vertex(old, new));
            edges.report_new_rows(&self.edge_holes, |old, new| log.renamed_edge(old, new));
            faces.report_new_rows(&self.face_holes, |old, new| log.renamed_face(old, new));
        }
        self.vertex_holes.compact_table(&mut self.positions);
        self.vertex_holes.compact_table(&mut self.spokes);
        self.edge_holes.compact_table(&mut self.edges);
        self.face_holes.compact_table(&mut self.sides);
        let vertex = |v: VertexId| vertices.new_handle(v);
        let edge = |e: EdgeId| edges.new_handle(e);
        let face = |f: Slot<FaceId>| Slot::from(f.get().map(|f| faces.new_handle(f)));
        for record in self.edges.rows_mut() {
            record.ends = record.ends.map(vertex);
            record.faces = record.faces.map(face);
            record.next = Wings::new(record.next.both().map(edge));
            record.prev = Wings::new(record.prev.both().map(edge));
        }
        for spoke in self.spokes.rows_mut() {
            *spoke = Slot::from(spoke.get().map(edge));
        }
        for side in self.sides.rows_mut() {
            *side = edge(*side);
        }
        self.vertex_holes.clear();
        self.edge_holes.clear();
        self.face_holes.clear();
    }
}

/// The new row of each old row after the holes are closed.
struct NewRows {
    /// By old row; empty if there are no holes, because every row then stays.
    rows: Vec<u32>,
}

impl NewRows {
    fn from_holes<P: Probe>(holes: &Holes<P>, rows: usize) -> Self {
        let rows = if holes.is_empty() {
            Vec::new()
        } else {
            holes.new_rows(rows)
        };
        Self { rows }
    }

    #[inline(always)]
    fn new_handle<H: RowId>(&self, old: H) -> H {
        if self.rows.is_empty() {
            old
        } else {
            H::from_row(self.rows[old.row() as usize])
        }
    }

    /// Calls `report` with the old and the new handle of each row that moves.
    fn report_new_rows<H: RowId, P: Probe>(&self, holes: &Holes<P>, mut report: impl FnMut(H, H)) {
        for old in holes.handles(self.rows.len()) {
            let new = self.new_handle(old);
            if old != new {
                report(old, new);
            }
        }
    }
}
