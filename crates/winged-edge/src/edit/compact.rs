//! Compaction: removes the rows of deleted elements.

use sixfold_core::{EdgeId, EditLog, Editable, FaceId, MeshQuery, NewRows, Probe, Slot, VertexId};

use crate::mesh::WingedEdgeMesh;
use crate::wings::Wings;

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Moves all rows down over the holes, and replaces the handles in the rows; O(mesh).
    pub(super) fn compact_tables<L: EditLog<Self>>(&mut self, log: &mut L) {
        let vertices = NewRows::from_holes(&self.vertex_holes, self.positions.len());
        let edges = NewRows::from_holes(&self.edge_holes, self.edges.len());
        let faces = NewRows::from_holes(&self.face_holes, self.sides.len());
        if L::USES_REPORTS {
            vertices.for_each_renamed(self.vertices(), |old, new| log.renamed_vertex(old, new));
            edges.for_each_renamed(self.edges(), |old, new| log.renamed_edge(old, new));
            faces.for_each_renamed(self.faces(), |old, new| log.renamed_face(old, new));
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
