//! Vertex split: makes two vertices out of one.

use sixfold_core::{EditError, EditLog, Editable, Point, Probe, Slot, VertexId};

use super::Refusal;
use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

/// A spoke of the split vertex, and the half-edge before this spoke.
#[derive(Clone, Copy)]
struct Spoke {
    h: HalfEdgeId,
    before: HalfEdgeId,
}

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Splits `v`; O(valence).
    ///
    /// The edge to `left` moves to the new vertex, and the edge to `right` stays. The walk around
    /// `v` finds the half-edge before each of the two spokes.
    ///
    /// ```text
    ///        left                    left
    ///      ╲  ▲  ╱              ╲  new ╱ ╲▲ hl ╱
    ///       ╲ │hl                ╲    ╱   ╲│  ╱
    ///     ─── v ───     →       ─── v ───► n ───        y runs v → n, its twin x back
    ///       ╱ │hr                ╱ hr╲    ╱  ╲
    ///      ╱  ▼  ╲              ╱     ▼  ╱ new ╲
    ///        right                   right
    /// ```
    pub(super) fn split_fan(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        self.check_vertex(v)?;
        let first = self
            .vertex_half_edge(v)
            .ok_or(EditError::NoFan { vertex: v })?;
        if left == right {
            return Err(EditError::BadNeighbours { vertex: v });
        }
        let ([to_left, to_right], before) = self.find_spokes(v, first, [left, right])?;
        let two = to_left.is_some() && to_right.is_some();
        if !two && self.has_face(first) {
            return Err(EditError::NotOnBoundary { vertex: v });
        }
        let sides = if two { 2 } else { 1 };
        self.check_room(1, 1 + sides, sides)?;

        let n = self.push_vertex(at, Slot::NONE);
        log.created_vertex(n);
        // Clockwise from `left` to `right`. If a side is missing, the boundary replaces the side.
        let from = to_left.map_or(first, |spoke| self.follow(spoke.h.twin()));
        let to = to_right.map_or(first, |spoke| spoke.h);
        let mut first_moves = false;
        let mut h = from;
        while h != to {
            first_moves |= h == first;
            self.halves.write(h.index()).origin = n;
            h = self.follow(h.twin());
        }

        let blank = |origin| Half {
            next: first,
            origin,
            face: Slot::NONE,
        };
        let y = self.push_edge([blank(v), blank(n)]);
        let x = y.twin();
        log.created_edge(y.edge());
        let right = to_right.map(|spoke| (spoke.h, self.double(spoke, n, x, log)));
        let left = to_left.map(|spoke| {
            self.halves.write(spoke.h.index()).origin = n;
            (spoke.h, self.double(spoke, v, y, log))
        });
        let (leaves_v, leaves_n) = match (left, right) {
            // At a boundary vertex, the first spoke is on the boundary.
            (Some((hl, new_l)), Some((hr, new_r))) => match first {
                _ if first_moves => (hr, first),
                _ if first == hr => (hr, new_r),
                _ if first == hl => (new_l, hl),
                _ => (first, hl),
            },
            // With one triangle, the other half-edge of the new edge joins the boundary loop.
            (left, _) => {
                let outer = if left.is_some() { x } else { y };
                let after = self.follow(before);
                self.link(before, outer);
                self.link(outer, after);
                match left {
                    Some(_) => (after, outer),
                    None => (outer, after),
                }
            }
        };
        self.set_leaving(v, leaves_v);
        self.set_leaving(n, leaves_n);
        Ok(n)
    }

    /// Finds the spokes of `v` to `left` and `right`, and the half-edge before `first`. `first` is
    /// the first spoke of `v`.
    #[inline]
    fn find_spokes(
        &self,
        v: VertexId,
        first: HalfEdgeId,
        [left, right]: [Option<VertexId>; 2],
    ) -> Result<([Option<Spoke>; 2], HalfEdgeId), Refusal> {
        let [mut to_left, mut to_right] = [None; 2];
        let mut h = first;
        // The walk finds the half-edge before the first spoke last.
        let mut before = first;
        loop {
            let arriving = self.record(h.twin());
            let spoke = Some(Spoke { h, before });
            if left == Some(arriving.origin) {
                to_left = spoke;
            } else if right == Some(arriving.origin) {
                to_right = spoke;
            }
            before = h.twin();
            h = arriving.next;
            if h == first {
                break;
            }
        }
        for spoke in [&mut to_left, &mut to_right].into_iter().flatten() {
            if spoke.h == first {
                spoke.before = before;
            }
        }
        for (side, spoke) in [(left, to_left), (right, to_right)] {
            if let (Some(side), None) = (side, spoke) {
                return Err(EditError::NotANeighbour { vertex: v, side });
            }
        }
        Ok(([to_left, to_right], before))
    }

    /// Doubles a spoke: a new half-edge from `origin` replaces the spoke. The sides of the new
    /// triangle are the spoke, the twin of the new half-edge, and `third`. Returns the new
    /// half-edge.
    fn double(
        &mut self,
        Spoke { h, before }: Spoke,
        origin: VertexId,
        third: HalfEdgeId,
        log: &mut impl EditLog<Self>,
    ) -> HalfEdgeId {
        let f = self.next_face();
        let [half, twin] = self.record_pair(h);
        let new = self.push_edge([
            Half { origin, ..half },
            Half {
                next: third,
                face: Slot::some(f),
                ..twin
            },
        ]);
        self.link(before, new);
        self.replace_first(half.face, h, new);
        for (side, next) in [(h, new.twin()), (third, h)] {
            let half = self.halves.write(side.index());
            (half.next, half.face) = (next, Slot::some(f));
        }
        self.first.push(h);
        log.created_edge(new.edge());
        log.created_face(f);
        new
    }
}
