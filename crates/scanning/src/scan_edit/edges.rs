//! Edits of an edge and its faces.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, IteratorExt, Pair, Probe, ShortVec, check_corners,
    uses_reports,
};

use super::{Refusal, ScannedMesh};
use crate::scanned::{Hit, ScannedFaces, ScannedVertex, SearchSet};

/// A side: an edge together with one face that runs along it.
#[derive(Clone, Copy)]
struct FaceSide<V> {
    face: FaceId,
    /// The corners where the side starts and ends.
    corners: [usize; 2],
    /// The vertices at these corners.
    ends: [V; 2],
    /// The third corner, if the face is a triangle.
    apex: V,
}

impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Returns the side of the hit's face between the hit corner and `b`, if there is one.
    fn side_to(&self, hit: &Hit<V>, b: V) -> Option<FaceSide<V>> {
        let leaves = hit.after == b;
        if !leaves && hit.before != b {
            return None;
        }
        let (face, [before, at, after]) = self.spans.around(hit.corner);
        Some(if leaves {
            FaceSide {
                face,
                corners: [at, after],
                ends: [hit.at, b],
                apex: hit.before,
            }
        } else {
            FaceSide {
                face,
                corners: [before, at],
                ends: [b, hit.at],
                apex: hit.after,
            }
        })
    }

    /// Returns the side along `e` of each face of `e`; one scan. If vertices are identified by
    /// coordinates, the same scan checks that the position `m` is free.
    fn along(&self, e: Pair<V>, m: Option<V>) -> Result<ShortVec<FaceSide<V>>, Refusal<V>> {
        let (mut along, mut occupied) = (ShortVec::new(), false);
        let [a, b] = e.ends();
        if e.has(V::BLANK) {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        let m = m.filter(|_| V::IS_POSITION);
        let set = m.map_or(SearchSet::One(a), |m| SearchSet::Two([a, m]));
        for hit in self.hits(set) {
            occupied |= Some(hit.at) == m;
            if hit.at == a
                && let Some(side) = self.side_to(&hit, b)
            {
                along.push(side);
            }
        }
        if along.is_empty() {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        match m.filter(|_| occupied) {
            Some(vertex) => Err(EditError::Occupied { vertex }),
            None => Ok(along),
        }
    }

    /// Returns the sides of the two faces of `e`, which must run in opposite directions.
    fn opposed(e: Pair<V>, along: &[FaceSide<V>]) -> Result<[FaceSide<V>; 2], Refusal<V>> {
        match *along {
            [] => Err(EditError::NoSuchEdge { edge: e }),
            [f, g] if f.ends == g.ends => Err(EditError::SameDirection { edge: e }),
            [f, g] => Ok([f, g]),
            _ => Err(EditError::NotTwoFaces {
                edge: e,
                faces: along.len(),
            }),
        }
    }

    fn check_triangle(&self, face: FaceId) -> Result<(), Refusal<V>> {
        match self.degree(face) {
            3 => Ok(()),
            degree => Err(EditError::NotATriangle { face, degree }),
        }
    }

    /// Inserts the new vertex `m` into `e` and into each face of `e`, and returns `m`; one scan of all
    /// corners.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no edge `e`, or if vertices are identified by coordinates
    /// and another vertex is at `m`.
    pub fn split_edge<M: ScannedMesh<V>>(
        &mut self,
        e: Pair<V>,
        m: V,
        log: &mut impl EditLog<M>,
    ) -> Result<V, Refusal<V>> {
        let along = self.along(e, Some(m))?;
        let grown = along.iter().map(|side| self.degree(side.face) + 1);
        self.check_capacity(0, grown.sum())?;
        for side in along.iter() {
            // The corners from the end of the side to its start, then `m`.
            let mut face: ShortVec<V::Corner> =
                self.corners_from(side.face, side.corners[1]).collect();
            face.push(m.corner());
            self.rewrite(side.face, &face);
        }
        log.created_vertex(m);
        let [a, b] = e.ends();
        log.renamed_edge(e, Pair::new(a, m));
        log.created_edge(Pair::new(m, b));
        Ok(m)
    }

    /// Inserts the new vertex `m` into `e`, cuts each triangle of `e` in two at `m`, and returns `m`;
    /// one scan of all corners.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no edge `e`, if a face of `e` is not a triangle, or if
    /// vertices are identified by coordinates and another vertex is at `m`.
    pub fn bisect_edge<M: ScannedMesh<V>>(
        &mut self,
        e: Pair<V>,
        m: V,
        log: &mut impl EditLog<M>,
    ) -> Result<V, Refusal<V>> {
        let along = self.along(e, Some(m))?;
        for side in along.iter() {
            self.check_triangle(side.face)?;
        }
        self.check_capacity(along.len(), 3 * along.len())?;
        for side in along.iter() {
            self.retarget(side.corners[1], m);
            log.created_face(self.push_triangle([m, side.ends[1], side.apex]));
        }
        if uses_reports(log) {
            log.created_vertex(m);
            let [a, b] = e.ends();
            log.renamed_edge(e, Pair::new(a, m));
            let ends = along.iter().map(|side| side.apex).distinct();
            for end in ends.chain([b]) {
                log.created_edge(Pair::new(m, end));
            }
        }
        Ok(m)
    }

    /// Removes `e` and merges its two faces into the face that comes first in the table; one scan
    /// of all corners.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`MeshEdit::dissolve_edge`](sixfold_core::MeshEdit::dissolve_edge).
    pub fn dissolve_edge<M: ScannedMesh<V>>(
        &mut self,
        e: Pair<V>,
        log: &mut impl EditLog<M>,
    ) -> Result<FaceId, Refusal<V>> {
        let [first, second] = Self::opposed(e, &self.along(e, None)?)?;
        // The corners of the first face from the end of its side to its start, then the corners of
        // the second face except the two ends.
        let mut merged: ShortVec<V> = self
            .corners_from(first.face, first.corners[1])
            .map(V::from_corner)
            .collect();
        let beyond = self.corners_from(second.face, second.corners[1]);
        let between = self.degree(second.face) - 2;
        merged.extend(beyond.map(V::from_corner).skip(1).take(between));
        check_corners(&merged, |_| Ok(()))?;
        self.check_capacity(0, merged.len())?;
        let merged: ShortVec<V::Corner> = merged.iter().map(|v| v.corner()).collect();
        self.rewrite(first.face, &merged);
        self.delete(second.face);
        log.removed_edge(e);
        log.removed_face(second.face);
        Ok(first.face)
    }

    /// Replaces `e` by the other diagonal of the quad that its two triangles form; two scans of all
    /// corners.
    ///
    /// ```text
    ///      c            c
    ///     ╱f╲          ╱│╲
    ///    a───b   →    a f│g b      one corner of each face changes: b of f, a of g
    ///     ╲g╱          ╲│╱
    ///      d            d
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`MeshEdit::flip_edge`](sixfold_core::MeshEdit::flip_edge).
    pub fn flip_edge<M: ScannedMesh<V>>(
        &mut self,
        e: Pair<V>,
        log: &mut impl EditLog<M>,
    ) -> Result<Pair<V>, Refusal<V>> {
        let [a, b] = e.ends();
        if e.has(V::BLANK) {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        let at_a: ShortVec<Hit<V>> = self.hits(SearchSet::One(a)).collect();
        let along: ShortVec<FaceSide<V>> =
            at_a.iter().filter_map(|hit| self.side_to(hit, b)).collect();
        let [f, g] = Self::opposed(e, &along)?;
        self.check_triangle(f.face)?;
        self.check_triangle(g.face)?;
        let (c, d) = (f.apex, g.apex);
        if c == d {
            return Err(EditError::SameApex { edge: e, vertex: c });
        }
        // The second scan finds the corners at `b`, and the edge `c`–`d` if it exists.
        let mut at_b = ShortVec::new();
        for hit in self.hits(SearchSet::Two([b, c])) {
            if hit.at == b {
                at_b.push(hit);
            } else if hit.is_beside(d) {
                return Err(EditError::EdgeExists { ends: [c, d] });
            }
        }
        for (vertex, hits) in [(a, &at_a), (b, &at_b)] {
            if let [_, _, _] = hits[..] {
                let ring = hits.iter().flat_map(|hit| [hit.before, hit.after]);
                if ring.distinct().count() == 3 {
                    return Err(EditError::LowValence { vertex });
                }
            }
        }
        self.retarget(f.corners[1], d);
        self.retarget(g.corners[1], c);
        let turned = Pair::new(c, d);
        log.renamed_edge(e, turned);
        Ok(turned)
    }
}
