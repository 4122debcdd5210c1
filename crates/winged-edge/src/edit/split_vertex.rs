//! Vertex split: makes two vertices out of one.

use sixfold_core::{
    EdgeId, EditError, EditLog, Editable, MeshQuery, Point, Probe, Refusal, ShortVec, Slot,
    VertexId,
};

use super::primitives::runs_of;
use crate::edge::{Edge, Run, RunId};
use crate::mesh::WingedEdgeMesh;

/// The part of the fan that moves to the new vertex.
struct Part {
    left: Option<EdgeId>,
    right: Option<EdgeId>,
    /// The edges between `left` and `right`. If `left` or `right` is missing, the edges extend to
    /// the boundary.
    moved: ShortVec<EdgeId>,
    /// Whether the boundary begins in this part.
    has_boundary: bool,
}

/// A run that becomes a side of a new triangle, and the run of the new edge that replaces it.
#[derive(Clone, Copy)]
struct Doubled {
    run: RunId,
    new: RunId,
    before: RunId,
    after: RunId,
}

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Splits `v`: adds an edge from `v` to a new vertex n; O(valence).
    ///
    /// ```text
    ///     left             left
    ///    ╲ │ ╱           ╲ ╱ ╲ ╱        The edges to the sides stay at v, as sides of the new
    ///    ─ v ─     →     ─v───n─        triangles. In the part of n, the new edges from n to the
    ///    ╱ │ ╲           ╱ ╲ ╱ ╲        sides replace them.
    ///    right            right
    /// ```
    pub(super) fn split_fan(
        &mut self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
        at: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal<Self>> {
        let part = self.part_between(v, left, right)?;
        self.check_room([1, 3, 2])?;
        let boundary = self.boundary_into(v);
        let boundary = boundary.map(|into| [into, self.run_after(into)]);
        let n = self.push_vertex(at, log);
        let blank = |ends| Edge {
            ends,
            ..Edge::BLANK
        };
        let e = self.push_edge(blank([v, n]), log);
        let [to_n, to_v] = runs_of(e);
        let on_left = part.left.zip(left).map(|(edge, side)| {
            let new = self.push_edge(blank([n, side]), log);
            self.doubled(self.arriving(edge, v), runs_of(new)[1])
        });
        let on_right = part.right.zip(right).map(|(edge, side)| {
            let new = self.push_edge(blank([n, side]), log);
            self.doubled(self.leaving(edge, v), runs_of(new)[0])
        });
        let doubled = [on_left, on_right];
        // A new run replaces each doubled run.
        let current = |run: RunId| {
            let mut doubled = doubled.iter().flatten();
            doubled.find(|d| d.run == run).map_or(run, |d| d.new)
        };
        for d in doubled.into_iter().flatten() {
            let face = self.run(d.run).face();
            self.link(current(d.before), d.new);
            self.link(d.new, current(d.after));
            self.set_face(d.new, face);
            if let Some(f) = face.get() {
                self.set_side(f, d.new.edge);
            }
        }
        // If a side is missing, the new edge is on the boundary there.
        for (d, run) in [(on_left, to_n), (on_right, to_v)] {
            if let (None, Some([into, out])) = (d, boundary) {
                self.link(current(into), run);
                self.link(run, current(out));
            }
        }
        if let Some(d) = on_left {
            self.add_triangle([to_n, d.new.twin(), d.run], log);
        }
        if let Some(d) = on_right {
            self.add_triangle([to_v, d.run, d.new.twin()], log);
            if self.run(d.new).face() == Slot::NONE {
                // The boundary from v to the side now starts at n.
                let side = self.run(d.new).target();
                self.set_spoke(side, d.new.edge);
            }
        }
        for &edge in part.moved.as_slice() {
            self.set_end(edge, v, n);
        }
        let begins_at_n = part.has_boundary || right.is_none();
        if begins_at_n || boundary.is_none() {
            self.set_spoke(v, e);
        }
        let first = boundary
            .filter(|_| begins_at_n)
            .map(|[into, _]| current(into).edge);
        self.set_spoke(n, first.unwrap_or(e));
        Ok(n)
    }

    /// Checks the sides, and walks from the right side to the left side.
    fn part_between(
        &self,
        v: VertexId,
        left: Option<VertexId>,
        right: Option<VertexId>,
    ) -> Result<Part, Refusal<Self>> {
        let vertex = v;
        let sides = left.into_iter().chain(right);
        [v].into_iter()
            .chain(sides)
            .try_for_each(|v| self.check_vertex(v))?;
        if left == right {
            return Err(EditError::BadNeighbours { vertex });
        }
        let Some(spoke) = self.spoke(v) else {
            return Err(EditError::NoFan { vertex });
        };
        if (left.is_none() || right.is_none()) && self.boundary_into(v).is_none() {
            return Err(EditError::NotOnBoundary { vertex });
        }
        let missing = |side| EditError::NotANeighbour { vertex, side };
        let right = match right {
            Some(side) => Some(self.edge_between(v, side).ok_or(missing(side))?),
            None => None,
        };
        let first = right.unwrap_or(spoke);
        let mut part = Part {
            left: None,
            right,
            moved: ShortVec::new(),
            has_boundary: false,
        };
        let mut at = first;
        loop {
            let run = Run::from(self.record(at), v);
            if Some(run.target()) == left {
                part.left = Some(at);
                return Ok(part);
            }
            if right != Some(at) {
                part.moved.push(at);
            }
            if run.face() == Slot::NONE {
                if left.is_none() {
                    return Ok(part);
                }
                part.has_boundary = true;
            }
            at = run.ccw();
            if let (Some(side), true) = (left, at == first) {
                return Err(missing(side));
            }
        }
    }

    fn doubled(&self, run: RunId, new: RunId) -> Doubled {
        Doubled {
            run,
            new,
            before: self.run_before(run),
            after: self.run_after(run),
        }
    }

    fn add_triangle(&mut self, runs: [RunId; 3], log: &mut impl EditLog<Self>) {
        let f = self.push_face(runs[0].edge, log);
        for i in 0..3 {
            let [next, prev] = [runs[(i + 1) % 3].edge, runs[(i + 2) % 3].edge];
            self.set_links(runs[i], Slot::some(f), next, prev);
        }
    }
}
