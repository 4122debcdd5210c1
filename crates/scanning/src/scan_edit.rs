//! The edits of structures that scan all corners: the check of an edit, its effect on the faces,
//! and its reports.
//!
//! An edit that adds a vertex receives the new handle as an argument. Each edit first checks all
//! conditions and then changes the faces. The structure itself updates its table of vertices.
//!
//! If the log ignores reports, an edit of one face reads only this face. If the log uses reports,
//! the edit also scans all corners, to find other faces with the same sides and corners.

mod collapse;
mod edges;
mod faces;
mod split_vertex;

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, MAX_ROWS, MeshQuery, Pair, Probe, ShortVec, check_rows,
    uses_reports,
};

use crate::scanned::{Hit, ScannedFaces, ScannedVertex, SearchSet};

type Refusal<V> = EditError<V, Pair<V>, FaceId>;

/// A mesh with the handle types of [`ScannedFaces`]: edges are pairs of vertices.
pub trait ScannedMesh<V>: MeshQuery<Vertex = V, Edge = Pair<V>, Face = FaceId> {}

impl<V, M: MeshQuery<Vertex = V, Edge = Pair<V>, Face = FaceId>> ScannedMesh<V> for M {}

/// Steps that several edits share.
impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Returns `f` if it exists.
    fn check_face(&self, f: FaceId) -> Result<FaceId, Refusal<V>> {
        if self.has(f) {
            Ok(f)
        } else {
            Err(EditError::NoSuchFace { face: f })
        }
    }

    fn degree(&self, f: FaceId) -> usize {
        self.spans.range(f).len()
    }

    /// Checks that the mesh can have this many additional faces and rows of corners. A face that
    /// gets more corners needs new rows for all its corners.
    fn check_capacity(&self, faces: usize, corners: usize) -> Result<(), Refusal<V>> {
        check_rows("faces", self.spans.len() + faces, MAX_ROWS)?;
        check_rows("corners", self.corners.len() + corners, MAX_ROWS)
    }

    /// Returns whether a face has a corner at `v`; one scan of all corners.
    pub fn has_vertex(&self, v: V) -> bool {
        self.scan(SearchSet::One(v)).next().is_some()
    }

    /// Returns the corners at `v`. If vertices are identified by coordinates, the same scan checks
    /// that the position `m` is free.
    fn hits_at(&self, v: V, m: V) -> Result<ShortVec<Hit<V>>, Refusal<V>> {
        let set = if V::IS_POSITION {
            SearchSet::Two([v, m])
        } else {
            SearchSet::One(v)
        };
        let (mut hits, mut occupied) = (ShortVec::new(), false);
        for hit in self.hits(set) {
            occupied |= hit.at == m;
            if hit.at == v {
                hits.push(hit);
            }
        }
        if V::IS_POSITION && hits.is_empty() {
            return Err(EditError::NoSuchVertex { vertex: v });
        }
        if occupied {
            return Err(EditError::Occupied { vertex: m });
        }
        Ok(hits)
    }

    /// Returns all corners of `f`, starting at `corner`.
    fn corners_from(&self, f: FaceId, corner: usize) -> impl Iterator<Item = V::Corner> {
        let range = self.spans.range(f);
        let cycle = (corner..range.end).chain(range.start..corner);
        cycle.map(|corner| *self.corners.read(corner))
    }

    fn push(&mut self, face: &[V::Corner]) -> FaceId {
        self.spans.push(&mut self.corners, face)
    }

    fn push_triangle(&mut self, triangle: [V; 3]) -> FaceId {
        self.push(&triangle.map(V::corner))
    }

    fn rewrite(&mut self, f: FaceId, face: &[V::Corner]) {
        self.spans
            .rewrite(&mut self.corners, f, face, V::BLANK.corner());
    }

    /// Moves one corner to another vertex.
    fn retarget(&mut self, corner: usize, v: V) {
        *self.corners.write(corner) = v.corner();
    }

    fn delete(&mut self, f: FaceId) {
        self.spans.blank(&mut self.corners, f, V::BLANK.corner());
        self.holes.insert(f.index());
    }

    /// Removes the rows and the corners of deleted faces, and reports the new handles of faces;
    /// O(corners). The structure itself reports new handles of vertices and edges.
    pub fn compact<M: ScannedMesh<V>>(&mut self, log: &mut impl EditLog<M>) {
        if uses_reports(log) {
            for (new, old) in (0..).map(FaceId::new).zip(self.handles()) {
                if new != old {
                    log.renamed_face(old, new);
                }
            }
        }
        self.spans.compact(&mut self.corners, &self.holes);
        self.holes.clear();
    }
}

fn sorted_once<T: Ord>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.sort_unstable();
    items.dedup();
    items
}
