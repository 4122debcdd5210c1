//! Merging two faces.

use sixfold_core::{
    EdgeId, EditError, EditLog, Editable, FaceId, Lookup, Probe, Refusal, ShortVec, Slot, VertexId,
};

use super::primitives::runs_of;
use crate::edge::RunId;
use crate::mesh::WingedEdgeMesh;

impl<P: Probe> WingedEdgeMesh<Editable, P> {
    /// Removes `e`, and the face of `e` with fewer sides.
    pub(super) fn dissolve(
        &mut self,
        e: EdgeId,
        log: &mut impl EditLog<Self>,
    ) -> Result<FaceId, Refusal<Self>> {
        let edge = *self.check_edge(e)?;
        let [Some(left), Some(right)] = edge.faces() else {
            return Err(EditError::NotTwoFaces { edge: e, faces: 1 });
        };
        let [out, back] = runs_of(e);
        let (corners, others) = (self.other_corners(out), self.other_corners(back));
        let (degree, other_degree) = (corners.as_slice().len(), others.as_slice().len());
        let mut sorted = corners;
        sorted.sort_for_lookup();
        if let Some(&vertex) = others.as_slice().iter().find(|&&v| sorted.has(v)) {
            return Err(EditError::RepeatedVertex { vertex });
        }
        let (kept, gone, along_gone) = if degree >= other_degree {
            (left, right, back)
        } else {
            (right, left, out)
        };
        let mut run = self.run_after(along_gone);
        while run != along_gone {
            self.set_face(run, Slot::some(kept));
            run = self.run_after(run);
        }
        let [a, b] = edge.ends;
        let [after_out, after_back] = [out, back].map(|run| self.run_after(run));
        let [before_out, before_back] = [out, back].map(|run| self.run_before(run));
        self.link(before_out, after_back);
        self.link(before_back, after_out);
        self.replace_spoke(a, e, after_back.edge);
        self.replace_spoke(b, e, after_out.edge);
        self.set_side(kept, after_out.edge);
        self.delete_edge(e, log);
        self.delete_face(gone, log);
        Ok(kept)
    }

    /// Returns the corners of the face along `run`, except the ends of `run`.
    fn other_corners(&self, run: RunId) -> ShortVec<VertexId> {
        let end = self.run(run).origin();
        let mut corners = ShortVec::new();
        let mut at = self.run_after(run);
        loop {
            let corner = self.run(at).target();
            if corner == end {
                return corners;
            }
            corners.push(corner);
            at = self.run_after(at);
        }
    }
}
