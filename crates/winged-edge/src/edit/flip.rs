//! Edge flip: turns an edge within the quad of its two triangles.

use sixfold_core::{EdgeId, EditError, Editable, Probe, Refusal, Slot, VertexId};

use super::primitives::{edge_record, runs_of};
use crate::edge::{Run, RunId};
use crate::mesh::WingedEdgeMesh;

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Flips `e` counter-clockwise.
    ///
    /// ```text
    ///          c                        c
    ///        ╱   ╲                    ╱ ▲ ╲         f  left of a→b, then a→d→c
    ///   ca ╱   f   ╲ bc          ca ╱   │   ╲ bc    g  right of it, then b→c→d
    ///    ╱           ╲            ╱  f  │  g  ╲
    ///   a ──── e ────► b   →     a      e      b
    ///    ╲           ╱            ╲     │     ╱
    ///   ad ╲   g   ╱ db          ad ╲   │   ╱ db
    ///        ╲   ╱                    ╲ │ ╱
    ///          d                        d
    /// ```
    #[inline]
    pub(super) fn flip(&mut self, e: EdgeId) -> Result<EdgeId, Refusal<Self>> {
        let edge = *self.check_edge(e)?;
        let ([a, b], [f, g]) = (edge.ends, edge.faces);
        if f == Slot::NONE || g == Slot::NONE {
            return Err(EditError::NotTwoFaces { edge: e, faces: 1 });
        }
        let ([bc, ad], [ca, db]) = (edge.next.both(), edge.prev.both());
        // These four runs start at a or at b.
        let [b_to_c, b_to_d] = [bc, db].map(|edge| Run::from(self.record(edge), b));
        let [a_to_c, a_to_d] = [ca, ad].map(|edge| Run::from(self.record(edge), a));
        if b_to_c.next() != ca || a_to_d.next() != db {
            return Err(self.not_two_triangles(e));
        }
        let (c, d) = (b_to_c.target(), a_to_d.target());
        if c == d {
            return Err(EditError::SameApex { edge: e, vertex: c });
        }
        // An end has three edges if it has only one face besides f and g.
        if a_to_c.ccw() == ad && a_to_c.face() != Slot::NONE {
            return Err(EditError::LowValence { vertex: a });
        }
        if b_to_d.ccw() == bc && b_to_d.face() != Slot::NONE {
            return Err(EditError::LowValence { vertex: b });
        }
        let walks = [
            (c, b_to_c.twin().ccw(), ca, d),
            (d, a_to_d.twin().ccw(), db, c),
        ];
        if self.are_neighbours(walks) {
            return Err(EditError::EdgeExists { ends: [c, d] });
        }
        let [bc, db] = [(bc, b_to_c.side()), (db, b_to_d.side().other())];
        let [ca, ad] = [(ca, a_to_c.side().other()), (ad, a_to_d.side())];
        let [bc, db, ca, ad] = [bc, db, ca, ad].map(|(edge, side)| RunId::new(edge, side));
        let (left, right) = ((f, ca.edge, ad.edge), (g, db.edge, bc.edge));
        *self.edges.write(e.index()) = edge_record([d, c], left, right);
        self.set_links(ca, f, ad.edge, e);
        self.set_links(ad, f, e, ca.edge);
        self.set_links(db, g, bc.edge, e);
        self.set_links(bc, g, e, db.edge);
        // If e is the spoke of an end, this end is an inner vertex and needs no boundary spoke.
        self.replace_spoke(a, e, ad.edge);
        self.replace_spoke(b, e, bc.edge);
        for face in [f, g].into_iter().filter_map(Slot::get) {
            self.set_side(face, e);
        }
        Ok(e)
    }

    /// Returns whether an edge joins two vertices. Each entry of `walks` has a vertex, the first
    /// edge of its counter-clockwise walk, the edge where the walk stops, and the other vertex.
    ///
    /// Walks around both vertices at the same time. Stops when the shorter walk ends, so a vertex
    /// with many edges costs no more than the other vertex.
    #[inline(always)]
    fn are_neighbours(&self, walks: [(VertexId, EdgeId, EdgeId, VertexId); 2]) -> bool {
        let [(c, mut at_c, end_c, to_d), (d, mut at_d, end_d, to_c)] = walks;
        while at_c != end_c && at_d != end_d {
            let from_c = Run::from(self.record(at_c), c);
            let from_d = Run::from(self.record(at_d), d);
            if from_c.target() == to_d || from_d.target() == to_c {
                return true;
            }
            (at_c, at_d) = (from_c.ccw(), from_d.ccw());
        }
        false
    }

    #[cold]
    #[inline(never)]
    fn not_two_triangles(&self, e: EdgeId) -> Refusal<Self> {
        for run in runs_of(e) {
            if let Err(degree) = self.apex(run) {
                return Self::not_a_triangle(self.run(run).face(), degree);
            }
        }
        unreachable!("one of the faces is not a triangle")
    }
}
