//! Collapse of an edge: its two ends become one vertex.

use sixfold_core::{EditError, EditLog, Editable, Lookup, Point, Probe, ShortVec, Slot, VertexId};

use super::{Refusal, faced_by, report_renamed};
use crate::mesh::{CornerId, CornerTable, EdgeCorner, NO_VERTEX, edge_between};

/// The fan of one end of the edge, without the triangles at the edge.
#[derive(Clone, Copy)]
struct RemainingFan {
    /// The corner across the last triangle at the edge, counter-clockwise around this end.
    after: Slot<CornerId>,
    /// The corner across the first triangle at the edge.
    before: Slot<CornerId>,
    /// If the fan is closed, a walk from `after` stops at this corner.
    stop: Slot<CornerId>,
}

impl RemainingFan {
    #[inline]
    fn is_one_triangle(self) -> bool {
        let [after, before] = [self.after, self.before].map(|c| c.get().map(CornerId::triangle));
        after.is_some() && after == before
    }
}

impl<P: Probe> CornerTable<Editable, P> {
    /// Merges the ends of `e`, if these conditions hold (Dey, Edelsbrunner, Guha & Nekhayev 1999):
    ///
    /// - Only C and D are adjacent to both ends.
    /// - No triangle of one end would coincide with a triangle of the other end.
    /// - The collapse does not join two boundaries.
    ///
    /// ```text
    ///         C                 C          T and R are deleted. on and op become opposite, as do
    ///       / | \               |          or and oq. The corners at the removed end are moved.
    ///   op / T T \ on      op   |   on
    ///     A───────B     →     A          Around the end that stays, counter-clockwise: the fan of B
    ///   oq \ R R / or      oq   |   or     up to C, the fan of A from C to D, the fan of B from D.
    ///       \ | /               |
    ///         D                 D
    /// ```
    #[inline]
    pub(super) fn collapse(
        &mut self,
        e: EdgeCorner,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let across = self.check_edge(e)?.get();
        let c = e.corner();
        let [n, p] = [c.next(), c.prev()];
        let [vc, va, vb] = [c, n, p].map(|c| *self.vertex.read(c.index()));
        if keep != va && keep != vb {
            return Err(EditError::NotAnEnd {
                edge: e,
                vertex: keep,
            });
        }
        let [on, op] = [n, p].map(|c| *self.opposite.read(c.index()));
        // For a boundary edge, the values of the missing triangle stay empty.
        let (mut q, mut r, mut vd) = (c, c, NO_VERTEX);
        let (mut oq, mut or) = (Slot::NONE, Slot::NONE);
        if let Some(o) = across {
            [q, r] = [o.next(), o.prev()];
            [oq, or] = [q, r].map(|c| *self.opposite.read(c.index()));
            vd = *self.vertex.read(o.index());
            if vc == vd {
                return Err(EditError::LastFace { vertex: keep });
            }
            if oq == Slot::NONE && or == Slot::NONE {
                return Err(EditError::LastFace { vertex: vd });
            }
        }
        if on == Slot::NONE && op == Slot::NONE {
            return Err(EditError::LastFace { vertex: vc });
        }
        let fan_a = RemainingFan {
            after: op,
            before: oq,
            stop: across.map_or(Slot::NONE, |_| Slot::some(q)),
        };
        let fan_b = RemainingFan {
            after: or,
            before: on,
            stop: Slot::some(n),
        };
        let keeps_a = keep == va;
        let (gone, gone_fan, kept_fan) = if keeps_a {
            (vb, fan_b, fan_a)
        } else {
            (va, fan_a, fan_b)
        };
        let mut moved = ShortVec::new();
        let closed = self.check_fans(e, [vc, vd], [gone_fan, kept_fan], &mut moved)?;
        if !closed && across.is_some() && self.is_on_boundary(keep) {
            return Err(EditError::AcrossBoundary { edge: e });
        }

        // The merged fan begins at the boundary, if there is one.
        let start_vertex = match across {
            None => vb,
            Some(_) if !closed => gone,
            Some(_) => keep,
        };
        let across_side = if start_vertex == vb { op } else { or };
        let first = self.start_without(start_vertex, [n, p, q, r], across_side);
        for &corner in moved.as_slice() {
            *self.vertex.write(corner.index()) = keep;
        }
        *self.positions.write(keep.index()) = to;
        *self.corner.write(keep.index()) = Slot::some(first);
        self.delete_vertex(gone);
        log.removed_vertex(gone);
        log.removed_edge(e);
        let kept_first = |[a, b]: [_; 2]| if keeps_a { [a, b] } else { [b, a] };
        self.collapse_triangle(c, vc, kept_first([(p, op), (n, on)]), log);
        if let Some(o) = across {
            self.collapse_triangle(o, vd, kept_first([(q, oq), (r, or)]), log);
        }
        Ok(keep)
    }

    /// Checks that only the apexes of `e` are adjacent to both ends, and that no triangle of one end
    /// would coincide with a triangle of the other end. Adds to `moved` the corners at the removed
    /// end, without those of the triangles at `e`. Returns whether the fan of this end is closed.
    #[inline(always)]
    fn check_fans(
        &self,
        e: EdgeCorner,
        apexes: [VertexId; 2],
        [gone_fan, kept_fan]: [RemainingFan; 2],
        moved: &mut ShortVec<CornerId>,
    ) -> Result<bool, Refusal> {
        let mut others = ShortVec::new();
        let closed = self.visit(gone_fan, |corner, v| {
            moved.push(corner);
            if v != apexes[0] && v != apexes[1] {
                others.push(v);
            }
            true
        });
        if others.as_slice().is_empty() {
            // The fan is open, or closed with one remaining triangle.
            if closed && kept_fan.is_one_triangle() {
                return Err(EditError::Pillow { edge: e });
            }
        } else if let Some(vertex) = self.common_vertex(kept_fan, others) {
            return Err(EditError::CommonNeighbour { edge: e, vertex });
        }
        Ok(closed)
    }

    /// Returns the corner at which the fan of `v` starts without the triangles of the corners
    /// `deleted`. If the fan starts in one of these triangles, it then starts after the corner
    /// `across`.
    #[inline(always)]
    fn start_without(
        &self,
        v: VertexId,
        deleted: [CornerId; 4],
        across: Slot<CornerId>,
    ) -> CornerId {
        let first = self.corner.read(v.index()).get().expect("I4");
        if !deleted.contains(&first) {
            return first;
        }
        let across = across.get();
        across
            .expect("a fan with no further triangle was refused")
            .next()
    }

    /// Calls `visitor` with each corner of `fan` and a neighbour in its triangle. In a
    /// counter-clockwise walk, the neighbour is the vertex before the corner; in a clockwise walk,
    /// the vertex after the corner. Returns true if the fan is closed or `visitor` returned false.
    #[inline]
    fn visit(
        &self,
        fan: RemainingFan,
        mut visitor: impl FnMut(CornerId, VertexId) -> bool,
    ) -> bool {
        let mut at = fan.after;
        while let Some(x) = at.get() {
            if at == fan.stop || !visitor(x.next(), *self.vertex.read(x.index())) {
                return true;
            }
            at = *self.opposite.read(x.prev().index());
        }
        at = fan.before;
        while let Some(y) = at.get() {
            if !visitor(y.prev(), *self.vertex.read(y.index())) {
                return true;
            }
            at = *self.opposite.read(y.next().index());
        }
        false
    }

    /// Returns a vertex of `fan` that is in `others`.
    #[inline]
    fn common_vertex(&self, fan: RemainingFan, mut others: ShortVec<VertexId>) -> Option<VertexId> {
        others.sort_for_lookup();
        let mut common = None;
        self.visit(fan, |_, v| {
            if others.has(v) {
                common = Some(v);
            }
            common.is_none()
        });
        common
    }

    /// Deletes the triangle of `apex`, which is at `v`, and links the corners across its two other
    /// sides.
    #[inline]
    fn collapse_triangle(
        &mut self,
        apex: CornerId,
        v: VertexId,
        [(kept, over_kept), (gone, over_gone)]: [(CornerId, Slot<CornerId>); 2],
        log: &mut impl EditLog<Self>,
    ) {
        let swung = if kept == apex.next() {
            over_kept
        } else {
            over_gone
        };
        if let Some(swung) = swung.get() {
            self.replace_corner(v, apex, swung.next());
        }
        self.set_opposite(over_kept, over_gone);
        self.set_opposite(over_gone, over_kept);
        self.delete_triangle(apex.triangle());
        log.removed_face(apex.triangle());
        log.removed_edge(edge_between(gone, over_gone));
        if let Some(lower) = over_kept.min(over_gone).get() {
            report_renamed(log, edge_between(kept, over_kept), faced_by(lower));
        }
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshEdit, MeshQuery, Representation};

    use super::super::tests::table;
    use super::*;
    use crate::EditableCornerTable;

    /// Returns two wheels of `n` triangles with the same rim, around v0 and around v(n + 1).
    fn double_wheel(n: u32) -> EditableCornerTable {
        let rim = |i: u32| 1 + i % n;
        let triangles = (0..n).flat_map(|i| [[0, rim(i), rim(i + 1)], [n + 1, rim(i + 1), rim(i)]]);
        table(n as u16 + 2, &triangles.collect::<Vec<_>>())
    }

    #[test]
    fn collapse_works_for_ends_of_any_valence() {
        for n in [4, 15, 16, 17, 18, 19, 20, 40] {
            let [hub, rim] = [0, 1].map(VertexId::new);
            for keep in [hub, rim] {
                let mut mesh = double_wheel(n);
                let e = mesh.edge_between(hub, rim).expect("a spoke");
                let done = mesh.collapse_edge(e, keep, Point::ONE);
                assert_eq!(done, Ok(keep), "{n}");
                assert_eq!(mesh.validate(), Ok(()), "{n}");
                assert_eq!(mesh.face_count(), 2 * n as usize - 2);
                // The two hubs are now adjacent, and have the whole rim in common.
                let far = VertexId::new(n + 1);
                let e = mesh.edge_between(keep, far).expect("adjacent hubs");
                let before = format!("{mesh:?}");
                let refused = mesh.collapse_edge(e, keep, Point::ONE);
                let refused = refused.expect_err("a rim vertex is adjacent to both");
                let named = matches!(refused, EditError::CommonNeighbour { .. });
                assert!(named || n == 4, "{n}: {refused}");
                assert_eq!(format!("{mesh:?}"), before);
            }
        }
    }
}
