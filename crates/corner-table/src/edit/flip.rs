//! Edge flip: an edge turned within its quad.

use sixfold_core::{EditError, EditLog, Editable, Probe, Slot, VertexId};

use super::{Refusal, report_renamed};
use crate::mesh::{CornerId, CornerTable, EdgeCorner, edge_between};

impl<P: Probe> CornerTable<Editable, P> {
    /// Turns `e` from A–B to D–C.
    ///
    /// ```text
    ///        C                 C         T: p moves to D. c now faces A–D, n the new edge.
    ///       /c\               /c|r       R: r moves to C. o now faces B–C, q the new edge.
    ///      /n p\             /  |  \
    ///     A─────B     →     A n | q B    p still faces C–A, and r still faces D–B. The other
    ///      \r q/             \  |  /     three edges are now faced by another corner.
    ///       \o/               p|o/
    ///        D                 D
    /// ```
    #[inline]
    pub(super) fn flip(
        &mut self,
        e: EdgeCorner,
        log: &mut impl EditLog<Self>,
    ) -> Result<EdgeCorner, Refusal> {
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
        let adjacent = self.walk_around_both([vc, vd], [va, vb], [on, oq]);
        if adjacent.unwrap_or_else(|| self.are_neighbours([on, op], va, vd)) {
            // This check also covers ends of valence three, because C and D are then adjacent.
            return Err(EditError::EdgeExists { ends: [vc, vd] });
        }

        *self.vertex.write(p.index()) = vd;
        *self.vertex.write(r.index()) = vc;
        for (c, across) in [(c, oq), (o, on)] {
            *self.opposite.write(c.index()) = across;
            self.set_opposite(across, Slot::some(c));
        }
        *self.opposite.write(n.index()) = Slot::some(q);
        *self.opposite.write(q.index()) = Slot::some(n);
        // Corner n is the only remaining corner of the two at A, and q of the two at B.
        self.replace_corner(va, r, n);
        self.replace_corner(vb, p, q);

        let turned = edge_between(n, Slot::some(q));
        report_renamed(log, e, turned);
        report_renamed(log, edge_between(q, oq), edge_between(c, oq));
        report_renamed(log, edge_between(n, on), edge_between(o, on));
        Ok(turned)
    }

    /// Returns whether C and D are adjacent, or `None` if a walk reaches a boundary. Walks around C
    /// and D at the same time; the shorter walk decides.
    #[inline]
    fn walk_around_both(
        &self,
        [vc, vd]: [VertexId; 2],
        [va, vb]: [VertexId; 2],
        [on, oq]: [Slot<CornerId>; 2],
    ) -> Option<bool> {
        let (mut x, mut y) = (on, oq);
        loop {
            let (at_c, at_d) = (x.get()?, y.get()?);
            let [u, w] = [at_c, at_d].map(|c| *self.vertex.read(c.index()));
            if u == vd || w == vc {
                return Some(true);
            }
            if u == va || w == vb {
                return Some(false);
            }
            x = *self.opposite.read(at_c.prev().index());
            y = *self.opposite.read(at_d.prev().index());
        }
    }

    /// Returns whether C and D are adjacent, by a walk around C: from `on` in one direction, then
    /// from `op` in the other direction.
    #[cold]
    #[inline(never)]
    fn are_neighbours(&self, [on, op]: [Slot<CornerId>; 2], va: VertexId, vd: VertexId) -> bool {
        let (mut x, mut y) = (on, op);
        while let Some(left) = x.get() {
            let u = *self.vertex.read(left.index());
            if u == vd || u == va {
                return u == vd;
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
}

#[cfg(test)]
mod tests {
    use sixfold_core::{EditRecord, MeshEdit, MeshQuery, Representation, RowId};

    use super::super::tests::table;
    use super::*;

    #[test]
    fn a_flip_writes_the_expected_rows() {
        // C, A, B, D are v0, v1, v2, v3. A triangle lies across A–D, and a triangle across B–C.
        let mut mesh = table(6, &[[0, 1, 2], [3, 2, 1], [3, 1, 4], [0, 2, 5]]);
        let mut record = EditRecord::new();
        let e = mesh.flip_edge_logged(EdgeCorner::new(0), &mut record);
        assert_eq!(e, Ok(EdgeCorner::new(1)));
        assert_eq!(mesh.validate(), Ok(()));
        let vertices: Vec<u32> = mesh.corner_vertices().iter().map(|v| v.row()).collect();
        assert_eq!(vertices[..6], [0, 1, 3, 3, 2, 0]);
        let none = u32::MAX;
        let opposite = mesh.opposite_corners().iter();
        let opposite: Vec<u32> = opposite.map(|c| c.get().map_or(none, RowId::row)).collect();
        assert_eq!(
            opposite,
            [8, 4, none, 11, 1, none, none, none, 0, none, none, 3]
        );
        // Edge e1 was B–C, which c3 now faces. Edge e4 was A–D, which c0 now faces.
        let mut renamed = record.edges.renamed.clone();
        renamed.sort_unstable();
        assert_eq!(
            renamed,
            [[0, 1], [1, 3], [4, 0]].map(|ends| ends.map(EdgeCorner::new))
        );
        assert!(record.edges.created.is_empty() && record.edges.removed.is_empty());
    }

    #[test]
    fn a_flip_to_an_existing_edge_is_refused() {
        let mut mesh = table(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]]);
        let refused = mesh.flip_edge(EdgeCorner::new(0));
        assert!(matches!(
            refused,
            Err(EditError::NotTwoFaces { faces: 1, .. })
        ));
        let refused = mesh.flip_edge(EdgeCorner::new(1));
        let Err(EditError::EdgeExists { ends }) = refused else {
            panic!("{refused:?}");
        };
        assert!(mesh.edge_between(ends[0], ends[1]).is_some());
    }
}
