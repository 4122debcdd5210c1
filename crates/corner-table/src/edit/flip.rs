//! An edge turned within its quad.

use mesh_core::{EditError, EditLog, Probe, Slot, VertexId};

use super::{Refused, tell_renamed};
use crate::mesh::{CornerId, CornerTable, EdgeCorner, edge_between};

impl<P: Probe> CornerTable<P> {
    /// Turns `e` from A–B to D–C.
    ///
    /// ```text
    ///        C                 C         T: p moves to D. c comes to face A–D, and n the edge.
    ///       /c\               /c|r       R: r moves to C. o comes to face B–C, and q the edge.
    ///      /n p\             /  |  \
    ///     A─────B     →     A n | q B    p faces C–A as before, and r faces D–B: three edges are
    ///      \r q/             \  |  /     faced by another corner than before, two are not.
    ///       \o/               p|o/
    ///        D                 D
    /// ```
    #[inline]
    pub(super) fn flip(
        &mut self,
        e: EdgeCorner,
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeCorner, Refused> {
        let Some(o) = self.check_edge(e)?.get() else {
            return Err(EditError::NotTwoFaces { edge: e, faces: 1 });
        };
        let c = e.corner();
        let [n, p, q, r] = [c.next(), c.prev(), o.next(), o.prev()];
        let [vc, va, vb, vd] = [c, n, p, o].map(|c| *self.vertex.read(c.index()));
        let [on, op, oq] = [n, p, q].map(|c| *self.opposite.read(c.index()));
        if vc == vd {
            return Err(EditError::SameApex {
                edge: e,
                vertex: vc,
            });
        }
        if self.are_neighbours([on, op], va, vd) {
            return Err(self.no_flip(e, [vc, vd]));
        }

        *self.vertex.write(p.index()) = vd;
        *self.vertex.write(r.index()) = vc;
        for (c, across) in [(c, oq), (o, on)] {
            *self.opposite.write(c.index()) = across;
            self.answer(across, Slot::some(c));
        }
        *self.opposite.write(n.index()) = Slot::some(q);
        *self.opposite.write(q.index()) = Slot::some(n);
        // A keeps n and B keeps q, each in the place of two corners.
        self.reenter(va, r, n);
        self.reenter(vb, p, q);

        let turned = edge_between(n, Slot::some(q));
        tell_renamed(log, e, turned);
        tell_renamed(log, edge_between(q, oq), edge_between(c, oq));
        tell_renamed(log, edge_between(n, on), edge_between(o, on));
        Ok(turned)
    }

    /// Whether D is a neighbour of C, whose fan goes on across `on` and across `op` on its other side.
    ///
    /// From both sides at once, for each step waits for the one before on its own side alone: the
    /// walk around C takes half the time.
    #[inline]
    fn are_neighbours(&self, [on, op]: [Slot<CornerId>; 2], va: VertexId, vd: VertexId) -> bool {
        let (mut x, mut y) = (on, op);
        // What the clockwise walk has come to: where the other meets it, all have been seen.
        let mut last = va;
        while let (Some(left), Some(right)) = (x.get(), y.get()) {
            let [u, w] = [left, right].map(|c| *self.vertex.read(c.index()));
            if u == vd || w == vd {
                return true;
            }
            if u == last || u == w {
                return false;
            }
            last = w;
            x = *self.opposite.read(left.prev().index());
            y = *self.opposite.read(right.next().index());
        }
        // One side has ended at the boundary, so the other will.
        while let Some(left) = x.get() {
            if *self.vertex.read(left.index()) == vd {
                return true;
            }
            x = *self.opposite.read(left.prev().index());
        }
        while let Some(right) = y.get() {
            if *self.vertex.read(right.index()) == vd {
                return true;
            }
            y = *self.opposite.read(right.next().index());
        }
        false
    }

    /// Why the edge between `ends` cannot be made: an end of `e` has just three edges, the third to
    /// either of them; or they have an edge somewhere else.
    #[cold]
    #[inline(never)]
    fn no_flip(&self, e: EdgeCorner, ends: [VertexId; 2]) -> Refused {
        let [a, b] = self.ends_of(e);
        let low = [a, b].into_iter().find(|&v| {
            let mut fan = self.fan(v);
            let [.., last] = [fan.next(), fan.next(), fan.next()];
            last.is_some_and(|(_, across)| across != Slot::NONE) && fan.next().is_none()
        });
        match low {
            Some(vertex) => EditError::LowValence { vertex },
            None => EditError::EdgeExists { ends },
        }
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{EditRecord, MeshEdit, Representation, RowId};

    use super::super::tests::table;
    use super::*;

    #[test]
    fn a_flip_keeps_the_rows_of_four_corners() {
        // C, A, B, D are v0, v1, v2, v3; a triangle lies across A–D, and one across B–C.
        let mut mesh = table(6, &[[0, 1, 2], [3, 2, 1], [3, 1, 4], [0, 2, 5]]);
        let mut record = EditRecord::new();
        let e = mesh.flip_edge(EdgeCorner::new(0), &mut record);
        assert_eq!(e, Ok(EdgeCorner::new(1)));
        assert_eq!(mesh.validate(), Ok(()));
        let vertices: Vec<u32> = mesh.vertex_rows().iter().map(|v| v.row()).collect();
        assert_eq!(vertices[..6], [0, 1, 3, 3, 2, 0]);
        let none = u32::MAX;
        let opposite = mesh.opposite_rows().iter();
        let opposite: Vec<u32> = opposite.map(|c| c.get().map_or(none, RowId::row)).collect();
        assert_eq!(
            opposite,
            [8, 4, none, 11, 1, none, none, none, 0, none, none, 3]
        );
        // All three at once: e1 was B–C, which c3 faces now, and e4 was A–D, which c0 faces now.
        let mut renamed = record.edges.renamed.clone();
        renamed.sort_unstable();
        assert_eq!(
            renamed,
            [[0, 1], [1, 3], [4, 0]].map(|ends| ends.map(EdgeCorner::new))
        );
        assert!(record.edges.created.is_empty() && record.edges.removed.is_empty());
    }

    #[test]
    fn an_end_with_three_edges_is_named() {
        let mut mesh = table(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]]);
        let refused = mesh.flip_edge(EdgeCorner::new(0), &mut ());
        assert!(matches!(
            refused,
            Err(EditError::NotTwoFaces { faces: 1, .. })
        ));
        let refused = mesh.flip_edge(EdgeCorner::new(1), &mut ());
        let vertex = VertexId::new(0);
        assert_eq!(refused, Err(EditError::LowValence { vertex }));
    }
}
