//! Adding faces.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, MeshQuery, Probe, Refusal, Slot, VertexId, check_corners,
};

use super::primitives::runs_of;
use crate::edge::{Edge, RunId};
use crate::mesh::WingedEdgeMesh;

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// ```text
    ///          w                      At each corner v the face has a run in, u→v, and a run out,
    ///         ╱│                      v→w. Each is an existing run without a face, or belongs to a
    ///    out ╱ │                      new edge. Both exist: the fan at v closes. One exists: it
    ///       ╱  │  new face            grows at that end. None exists: v had no face.
    ///      v───u
    ///        in
    /// ```
    pub(super) fn add(
        &mut self,
        corners: &[VertexId],
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        let new_edges = self.check_new_face(corners)?;
        self.check_room([0, new_edges, 1])?;
        let last = corners.len() - 1;
        let face = self.push_face(self.next_edge(), log);
        let closing = self.side_or_new([corners[last], corners[0]], log);
        let mut before = closing;
        for (i, &v) in corners.iter().enumerate() {
            let after = if i == last {
                closing
            } else {
                self.side_or_new([v, corners[i + 1]], log)
            };
            self.link_corner(v, before, after);
            // Until now, a run without a face shows that the side already existed.
            self.set_face(before.run, Slot::some(face));
            before = after;
        }
        self.set_side(face, closing.run.edge);
        Ok(face)
    }

    /// Checks a new face over `corners`. Returns the number of new edges.
    fn check_new_face(&self, corners: &[VertexId]) -> Result<usize, Refusal<Self>> {
        check_corners(corners, |v| self.check_vertex(v))?;
        let mut new_edges = 0;
        let mut before_is_new = self.is_new([corners[corners.len() - 1], corners[0]])?;
        for (i, &v) in corners.iter().enumerate() {
            let next = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
            let is_new = self.is_new([v, next])?;
            if is_new && before_is_new && self.spoke(v).is_some() {
                return Err(EditError::SeveralFans { vertex: v });
            }
            // At a vertex without a boundary, every side has a face, so both edges are new.
            new_edges += usize::from(is_new);
            before_is_new = is_new;
        }
        Ok(new_edges)
    }

    /// Returns whether no edge joins the two vertices. Refuses if the side between them already has
    /// a face.
    fn is_new(&self, [from, to]: [VertexId; 2]) -> Result<bool, Refusal<Self>> {
        if self.boundary_side([from, to]).is_some() {
            return Ok(false);
        }
        let Some(edge) = self.edge_between(from, to) else {
            return Ok(true);
        };
        // Only one side without a face leaves `from`, and this side leads to another vertex.
        let run = self.run(self.leaving(edge, from));
        match (run.face().get(), run.across().get()) {
            (Some(face), None) => Err(EditError::RepeatedSide { from, to, face }),
            _ => Err(EditError::FullEdge { edge }),
        }
    }

    fn boundary_side(&self, [from, to]: [VertexId; 2]) -> Option<RunId> {
        let side = self.run_after(self.boundary_into(from)?);
        (self.run(side).target() == to).then_some(side)
    }

    /// Returns the run without a face from one vertex to the other. Adds the edge if the edge is
    /// missing.
    fn side_or_new(&mut self, ends: [VertexId; 2], log: &mut impl EditLog<Self>) -> NewSide {
        if let Some(run) = self.boundary_side(ends) {
            return NewSide { run, is_new: false };
        }
        let edge = self.push_edge(
            Edge {
                ends,
                ..Edge::BLANK
            },
            log,
        );
        let [run, _] = runs_of(edge);
        NewSide { run, is_new: true }
    }

    fn link_corner(&mut self, v: VertexId, before: NewSide, after: NewSide) {
        let (into, out) = (before.run, after.run);
        match [before.is_new, after.is_new] {
            [true, true] => {
                self.link(out.twin(), into.twin());
                self.set_spoke(v, out.edge);
            }
            [false, true] => {
                let beyond = self.run_after(into);
                self.link(out.twin(), beyond);
                self.set_spoke(v, out.edge);
            }
            [true, false] => {
                let beyond = self.run_before(out);
                self.link(beyond, into.twin());
            }
            [false, false] => {}
        }
        self.link(into, out);
    }
}

/// A side of a face that is being added.
#[derive(Clone, Copy)]
struct NewSide {
    run: RunId,
    is_new: bool,
}
