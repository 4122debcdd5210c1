//! Compaction: closes the holes.

use sixfold_core::{EdgeId, EditLog, FaceId, HoleSet, Holes, Probe, RowId, Slot, VertexId};

use crate::mesh::EditableWingedEdgeMesh;
use crate::wings::Wings;

impl<P: Probe> EditableWingedEdgeMesh<P> {
    /// Moves all rows down over the holes, in order, and replaces the handles in them; O(mesh).
    pub(super) fn close_holes<L: EditLog<Self>>(&mut self, log: &mut L) {
        let vertices = NewNames::of(&self.vertex_holes, self.positions.len());
        let edges = NewNames::of(&self.edge_holes, self.edges.len());
        let faces = NewNames::of(&self.face_holes, self.sides.len());
        if L::LISTENS {
            vertices.tell(&self.vertex_holes, |old, new| log.renamed_vertex(old, new));
            edges.tell(&self.edge_holes, |old, new| log.renamed_edge(old, new));
            faces.tell(&self.face_holes, |old, new| log.renamed_face(old, new));
        }
        self.vertex_holes.close(&mut self.positions);
        self.vertex_holes.close(&mut self.spokes);
        self.edge_holes.close(&mut self.edges);
        self.face_holes.close(&mut self.sides);
        let vertex = |v: VertexId| vertices.of_old(v);
        let edge = |e: EdgeId| edges.of_old(e);
        let face = |f: Slot<FaceId>| Slot::from(f.get().map(|f| faces.of_old(f)));
        for record in self.edges.rows_mut() {
            record.ends = record.ends.map(vertex);
            record.faces = record.faces.map(face);
            record.next = Wings::of(record.next.both().map(edge));
            record.prev = Wings::of(record.prev.both().map(edge));
        }
        for spoke in self.spokes.rows_mut() {
            *spoke = Slot::from(spoke.get().map(edge));
        }
        for side in self.sides.rows_mut() {
            *side = edge(*side);
        }
        self.vertex_holes.fill();
        self.edge_holes.fill();
        self.face_holes.fill();
    }
}

/// The new row of each old row after the holes are closed.
struct NewNames {
    /// By old row; empty if there are no holes, because every row then stays.
    rows: Vec<u32>,
}

impl NewNames {
    fn of<P: Probe>(holes: &Holes<P>, rows: usize) -> Self {
        let rows = if holes.is_empty() {
            Vec::new()
        } else {
            holes.new_rows(rows)
        };
        Self { rows }
    }

    #[inline(always)]
    fn of_old<H: RowId>(&self, old: H) -> H {
        if self.rows.is_empty() {
            old
        } else {
            H::from_row(self.rows[old.row() as usize])
        }
    }

    fn tell<H: RowId, P: Probe>(&self, holes: &Holes<P>, mut renamed: impl FnMut(H, H)) {
        for old in holes.handles(self.rows.len()) {
            let new = self.of_old(old);
            if old != new {
                renamed(old, new);
            }
        }
    }
}
