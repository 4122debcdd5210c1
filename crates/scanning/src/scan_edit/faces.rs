//! Edits of whole faces.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, Pair, Probe, ShortVec, check_corners, check_cut,
    faces_once, uses_reports,
};

use super::{Refusal, ScannedMesh, sorted_once};
use crate::scanned::{ScannedFaces, ScannedVertex, SearchSet};

impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Adds a face with the given `corners`, which are existing vertices or positions of new
    /// vertices. O(degree); if the log uses reports, a scan of all corners finds the sides that
    /// already exist.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than three corners, or if a corner occurs twice.
    pub fn add_face<M: ScannedMesh<V>>(
        &mut self,
        corners: &[V],
        log: &mut impl EditLog<M>,
    ) -> Result<FaceId, Refusal<V>> {
        check_corners(corners, |_| Ok(()))?;
        self.check_capacity(1, corners.len())?;
        if uses_reports(log) {
            let sides = Pair::sides(corners.len(), |i| corners[i]);
            let (vertices, edges) = self.unused_elsewhere(corners.iter().copied(), sides, &[]);
            if V::IS_POSITION {
                vertices.into_iter().for_each(|v| log.created_vertex(v));
            }
            edges.into_iter().for_each(|e| log.created_edge(e));
        }
        let face: ShortVec<V::Corner> = corners.iter().map(|v| v.corner()).collect();
        let f = self.push(&face);
        log.created_face(f);
        Ok(f)
    }

    /// Removes `f`; O(degree). If the log uses reports, a scan of all corners finds the sides that
    /// `f` shares with other faces. If vertices are identified by coordinates, vertices without a
    /// face are removed.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no face `f`.
    pub fn remove_face<M: ScannedMesh<V>>(
        &mut self,
        f: FaceId,
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        self.check_face(f)?;
        self.remove_sorted(&[f], log);
        Ok(())
    }

    /// Removes `faces`; O(n log n) for n faces. If the log uses reports, one scan finds the sides that the
    /// removed faces share with other faces.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh does not have one of the faces.
    pub fn remove_faces<M: ScannedMesh<V>>(
        &mut self,
        faces: &[FaceId],
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        let gone = faces_once(faces, |f| self.check_face(f))?;
        self.remove_sorted(&gone, log);
        Ok(())
    }

    /// Removes all faces at `v`; one scan of all corners. If the log uses reports, a second scan
    /// finds the sides that the removed faces share with other faces.
    ///
    /// # Errors
    ///
    /// Returns an error if vertices are identified by coordinates and no face has a corner at `v`.
    pub fn remove_faces_at<M: ScannedMesh<V>>(
        &mut self,
        v: V,
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        let mut faces: ShortVec<FaceId> = self.vertex_faces(v).collect();
        if V::IS_POSITION && faces.is_empty() {
            return Err(EditError::NoSuchVertex { vertex: v });
        }
        faces.sort_unstable();
        self.remove_sorted(&faces, log);
        Ok(())
    }

    /// Removes `faces`, which must be sorted.
    fn remove_sorted<M: ScannedMesh<V>>(&mut self, faces: &[FaceId], log: &mut impl EditLog<M>) {
        if uses_reports(log) {
            let corners = faces.iter().flat_map(|&f| self.face_vertices(f));
            let sides = faces.iter().flat_map(|&f| self.face_edges(f));
            let (vertices, edges) = self.unused_elsewhere(corners, sides, faces);
            if V::IS_POSITION {
                vertices.into_iter().for_each(|v| log.removed_vertex(v));
            }
            edges.into_iter().for_each(|e| log.removed_edge(e));
        }
        for &f in faces {
            self.delete(f);
            log.removed_face(f);
        }
    }

    /// Returns the given vertices and sides that no face has; faces in the sorted list `except` do
    /// not count. One scan.
    fn unused_elsewhere(
        &self,
        vertices: impl Iterator<Item = V>,
        sides: impl Iterator<Item = Pair<V>>,
        except: &[FaceId],
    ) -> (Vec<V>, Vec<Pair<V>>) {
        let (mut vertices, mut sides) = (sorted_once(vertices), sorted_once(sides));
        if vertices.is_empty() {
            return (vertices, sides);
        }
        let mut used = (vec![false; vertices.len()], vec![false; sides.len()]);
        let hits = self.hits(SearchSet::from_vertices(&vertices));
        for hit in hits.filter(|hit| except.binary_search(&hit.face).is_err()) {
            if let Ok(i) = vertices.binary_search(&hit.at) {
                used.0[i] = true;
            }
            for side in hit.sides() {
                if let Ok(i) = sides.binary_search(&side) {
                    used.1[i] = true;
                }
            }
        }
        let (mut vertex, mut side) = (used.0.into_iter(), used.1.into_iter());
        vertices.retain(|_| vertex.next() == Some(false));
        sides.retain(|_| side.next() == Some(false));
        (vertices, sides)
    }

    /// Cuts `f` into triangles around the new vertex `m`, and returns `m`; `f` becomes the triangle at
    /// its first side. O(degree); if vertices are identified by coordinates, a scan of all corners searches
    /// for `m`.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no face `f`, or if vertices are identified by coordinates
    /// and another vertex is at `m`.
    pub fn poke_face<M: ScannedMesh<V>>(
        &mut self,
        f: FaceId,
        m: V,
        log: &mut impl EditLog<M>,
    ) -> Result<V, Refusal<V>> {
        let corners = self.spans.range(self.check_face(f)?);
        if V::IS_POSITION && self.has_vertex(m) {
            return Err(EditError::Occupied { vertex: m });
        }
        self.check_capacity(corners.len() - 1, 3 * corners.len())?;
        log.created_vertex(m);
        // Pushing other faces does not move the corners of `f`.
        let start = corners.start;
        let [first, second] =
            [start, start + 1].map(|corner| V::from_corner(*self.corners.read(corner)));
        let mut a = second;
        for corner in corners.skip(2) {
            let b = V::from_corner(*self.corners.read(corner));
            log.created_face(self.push_triangle([a, b, m]));
            log.created_edge(Pair::new(a, m));
            a = b;
        }
        log.created_face(self.push_triangle([a, first, m]));
        log.created_edge(Pair::new(a, m));
        self.rewrite(f, &[first, second, m].map(V::corner));
        log.created_edge(Pair::new(first, m));
        Ok(m)
    }

    /// Cuts `f` into two faces by an edge between `ends`. The handle `f` stays the handle of the
    /// part from the earlier to the later of the two corners. O(degree); if the log uses reports, a
    /// scan of all corners searches the other faces for an edge between `ends`.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no face `f`, or if the `ends` are not corners of `f`, are
    /// equal, or are adjacent in `f`.
    pub fn split_face<M: ScannedMesh<V>>(
        &mut self,
        f: FaceId,
        ends: [V; 2],
        log: &mut impl EditLog<M>,
    ) -> Result<Pair<V>, Refusal<V>> {
        self.check_face(f)?;
        let face: ShortVec<V::Corner> = self.face(f).iter().copied().collect();
        let [i, j] = check_cut(f, &face, ends, |v, corner| v.is_at(corner))?;
        self.check_capacity(1, face.len() + 2)?;
        let edge = Pair::new(ends[0], ends[1]);
        if uses_reports(log) && self.edge_faces(edge).next().is_none() {
            log.created_edge(edge);
        }
        let beyond: ShortVec<V::Corner> = face[j..].iter().chain(&face[..=i]).copied().collect();
        self.rewrite(f, &face[i..=j]);
        log.created_face(self.push(&beyond));
        Ok(edge)
    }
}
