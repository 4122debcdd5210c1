//! An edge turned within the quad of its two triangles.

use mesh_core::{EdgeId, EditError, Probe, Refusal, Slot, VertexId};

use super::surgery::{both_sides, edge_of};
use crate::edge::{Run, RunId};
use crate::mesh::EditableWingedEdgeMesh;

impl<P: Probe> EditableWingedEdgeMesh<P> {
    /// Turns `e` counter-clockwise: six records change, and what the ends and the faces start from.
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
        // All four run from a or b here, along the two faces or away from them.
        let [b_to_c, b_to_d] = [bc, db].map(|edge| Run::from(self.record(edge), b));
        let [a_to_c, a_to_d] = [ca, ad].map(|edge| Run::from(self.record(edge), a));
        if b_to_c.next() != ca || a_to_d.next() != db {
            return Err(self.flips_no_polygon(e));
        }
        let (c, d) = (b_to_c.target(), a_to_d.target());
        if c == d {
            return Err(EditError::SameApex { edge: e, vertex: c });
        }
        // Beyond f and g one more face at an end, and its edges are three.
        if a_to_c.ccw() == ad && a_to_c.face() != Slot::NONE {
            return Err(EditError::LowValence { vertex: a });
        }
        if b_to_d.ccw() == bc && b_to_d.face() != Slot::NONE {
            return Err(EditError::LowValence { vertex: b });
        }
        let rings = [
            (c, b_to_c.back().ccw(), ca, d),
            (d, a_to_d.back().ccw(), db, c),
        ];
        if self.meet(rings) {
            return Err(EditError::EdgeExists { ends: [c, d] });
        }
        let [bc, db] = [(bc, b_to_c.side()), (db, b_to_d.side().other())];
        let [ca, ad] = [(ca, a_to_c.side().other()), (ad, a_to_d.side())];
        let [bc, db, ca, ad] = [bc, db, ca, ad].map(|(edge, side)| RunId::on(edge, side));
        let (left, right) = ((f, ca.edge, ad.edge), (g, db.edge, bc.edge));
        *self.edges.write(e.index()) = edge_of([d, c], left, right);
        self.set_lane(ca, f, ad.edge, e);
        self.set_lane(ad, f, e, ca.edge);
        self.set_lane(db, g, bc.edge, e);
        self.set_lane(bc, g, e, db.edge);
        // An inner vertex each, if e was its spoke: no boundary edge is lost.
        self.replace_spoke(a, e, ad.edge);
        self.replace_spoke(b, e, bc.edge);
        for face in [f, g].into_iter().filter_map(Slot::get) {
            self.set_side(face, e);
        }
        Ok(e)
    }

    /// Whether two vertices have an edge. Each comes with the edge to begin with, counter-clockwise, the
    /// one to end before, and the other vertex.
    ///
    /// Both walks at once, until the shorter one ends: neither waits for the other, and a vertex of
    /// very many edges costs no more than its partner.
    #[inline(always)]
    fn meet(&self, rings: [(VertexId, EdgeId, EdgeId, VertexId); 2]) -> bool {
        let [(c, mut at_c, end_c, to_d), (d, mut at_d, end_d, to_c)] = rings;
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

    /// The refusal where one of two faces is no triangle.
    #[cold]
    #[inline(never)]
    fn flips_no_polygon(&self, e: EdgeId) -> Refusal<Self> {
        for run in both_sides(e) {
            if let Err(degree) = self.apex(run) {
                return Self::not_a_triangle(self.run(run).face(), degree);
            }
        }
        unreachable!("one of the faces is no triangle")
    }
}
