//! Collapse of an edge into one of its ends.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, Lookup, Pair, Point, Probe, ShortVec, VertexId,
    uses_reports,
};

use super::Edge;
use super::corners::third_corner;
use super::find::Refused;
use crate::mesh::{BLANK_CORNER, FaceVertexMesh};

impl<P: Probe> FaceVertexMesh<Editable, P> {
    /// Implements [`collapse_edge`](sixfold_core::MeshEdit::collapse_edge).
    pub(super) fn collapse(
        &mut self,
        e: Edge,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refused> {
        let mut both = self.faces_at_both(e);
        both.sort_for_lookup();
        if !both.iter().any(|&f| self.has_side(f, e)) {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        if !e.has(keep) {
            return Err(EditError::NotAnEnd {
                edge: e,
                vertex: keep,
            });
        }
        if !both.iter().all(|&f| self.has_side(f, e)) {
            return Err(EditError::RepeatedVertex { vertex: keep });
        }
        let [low, high] = e.ends();
        let gone = if keep == low { high } else { low };
        // An extended list would be copied in memory, so the faces are pushed one by one.
        let (mut removed, mut moving) = (ShortVec::new(), ShortVec::new());
        for &f in &*both {
            if self.known_face(f).len() == 3 {
                removed.push(f);
            }
        }
        for &f in self.fan(gone) {
            if !both.has(f) {
                moving.push(f);
            }
        }
        self.check_last_faces(e, keep, &moving, &removed)?;
        self.check_room(0, 0, moving.len() + self.corners_of_polygons(&both))?;
        let neighbours = if uses_reports(log) {
            self.other_neighbours(gone, keep)
        } else {
            Vec::new()
        };

        for &f in &*moving {
            self.replace_corner(f, gone, keep);
        }
        for &f in &*removed {
            let (_, apex) = third_corner(self.triangle(f)?, e);
            self.remove_from_fan(apex, f);
            self.delete_face(f);
        }
        if removed.len() < both.len() {
            self.remove_corner(&both, gone);
        }
        self.replace_faces(keep, &removed, &moving);
        self.delete_vertex(gone);
        *self.positions.write(keep.index()) = to;

        if uses_reports(log) {
            log.removed_vertex(gone);
            log.removed_edge(e);
            removed.iter().for_each(|&f| log.removed_face(f));
            self.report_merged_edges(&neighbours, [gone, keep], log);
        }
        Ok(keep)
    }

    /// Checks that `keep` and the third corners of the triangles `removed` keep a face.
    fn check_last_faces(
        &self,
        e: Edge,
        keep: VertexId,
        moving: &[FaceId],
        removed: &[FaceId],
    ) -> Result<(), Refused> {
        let len = |v: VertexId| self.fans.read(v.index()).len as usize;
        if moving.is_empty() && len(keep) == removed.len() {
            return Err(EditError::LastFace { vertex: keep });
        }
        let mut candidates = ShortVec::new();
        for &f in removed {
            let (_, apex) = third_corner(self.triangle(f)?, e);
            if len(apex) <= removed.len() {
                candidates.push(apex);
            }
        }
        // Triangles with the same corners have the same third corner.
        candidates.sort_unstable();
        let mut runs = candidates.chunk_by(|one, other| one == other);
        match runs.find(|run| len(run[0]) == run.len()) {
            Some(run) => Err(EditError::LastFace { vertex: run[0] }),
            None => Ok(()),
        }
    }

    fn corners_of_polygons(&self, faces: &[FaceId]) -> usize {
        let degrees = faces.iter().map(|&f| self.known_face(f).len());
        degrees.filter(|&degree| degree > 3).sum()
    }

    /// Removes the corner `gone` from all `faces` that still exist.
    fn remove_corner(&mut self, faces: &[FaceId], gone: VertexId) {
        for &f in faces {
            let face = self.known_face(f);
            if face[0] != BLANK_CORNER {
                let kept = face.iter().copied().filter(|&v| v != gone);
                let kept = ShortVec::from_iter(kept);
                self.spans
                    .rewrite(&mut self.corners, f, &kept, BLANK_CORNER);
            }
        }
    }

    /// Returns the neighbours of `gone` except `keep`. The flag of a neighbour shows whether the
    /// neighbour is adjacent to `keep`.
    fn other_neighbours(&self, gone: VertexId, keep: VertexId) -> Vec<(VertexId, bool)> {
        let others = self.ring(gone, |v| v).filter(|&v| v != keep);
        others
            .map(|v| (v, self.has_edge(Pair::new(keep, v))))
            .collect()
    }

    /// Reports the changes of the edges at `gone`, and of the edges at `keep` that merge with them.
    fn report_merged_edges(
        &self,
        neighbours: &[(VertexId, bool)],
        [gone, keep]: [VertexId; 2],
        log: &mut impl EditLog<Self>,
    ) {
        for &(v, had_edge) in neighbours {
            let (old, new) = (Pair::new(gone, v), Pair::new(keep, v));
            if !had_edge {
                log.renamed_edge(old, new);
                continue;
            }
            log.removed_edge(old);
            if !self.has_edge(new) {
                log.removed_edge(new);
            }
        }
    }
}
