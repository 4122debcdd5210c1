//! Collapsing an edge, and moving a vertex in structures that identify vertices by coordinates.

use sixfold_core::{
    EditError, EditLog, Editable, FaceId, IteratorExt, Pair, Probe, ShortVec, uses_reports,
};

use super::{Refusal, ScannedMesh, sorted_once};
use crate::scanned::{Hit, ScannedFaces, ScannedVertex, SearchSet};

/// The corners at the two ends of an edge to be collapsed.
struct Star<V> {
    keep: V,
    removed: V,
    hits: ShortVec<Hit<V>>,
    /// The faces that have both ends, and whether each is a triangle.
    along: ShortVec<(FaceId, bool)>,
}

impl<V: ScannedVertex> Star<V> {
    /// Returns the end of the edge other than the vertex of `hit`.
    fn other(&self, hit: &Hit<V>) -> V {
        if hit.at == self.keep {
            self.removed
        } else {
            self.keep
        }
    }

    /// Returns whether `f` is a triangle; `None` if `f` does not have both ends.
    fn is_triangle_along(&self, f: FaceId) -> Option<bool> {
        let found = self.along.binary_search_by_key(&f, |&(face, _)| face);
        found.ok().map(|i| self.along[i].1)
    }

    fn remains(&self, f: FaceId) -> bool {
        self.is_triangle_along(f) != Some(true)
    }

    /// Returns the vertices adjacent to `end` in the faces that `which` selects, except the other
    /// end.
    fn ring(&self, end: V, which: impl Fn(FaceId) -> bool) -> impl Iterator<Item = V> {
        let hits = self.hits.iter();
        let hits = hits.filter(move |hit| hit.at == end && which(hit.face));
        let beside = hits.flat_map(|hit| [hit.before, hit.after]);
        beside.filter(|&v| v != self.keep && v != self.removed)
    }

    /// Returns the vertices adjacent to either end in faces that remain.
    fn remaining_ring(&self) -> impl Iterator<Item = V> {
        let ends = [self.keep, self.removed].into_iter();
        ends.flat_map(|end| self.ring(end, |f| self.remains(f)))
    }

    /// Reports the changes of the edges at both ends.
    fn report_edges<M: ScannedMesh<V>>(&self, to: V, log: &mut impl EditLog<M>) {
        let (keep, removed) = (self.keep, self.removed);
        log.removed_edge(Pair::new(keep, removed));
        let remaining = sorted_once(self.remaining_ring());
        let [at_keep, at_removed] =
            [keep, removed].map(|end| sorted_once(self.ring(end, |_| true)));
        let mut report = |end: V, v: V, remains: bool| {
            if !remains {
                log.removed_edge(Pair::new(end, v));
            } else if end != to {
                log.renamed_edge(Pair::new(end, v), Pair::new(to, v));
            }
        };
        for &v in &at_keep {
            report(keep, v, remaining.binary_search(&v).is_ok());
        }
        for &v in &at_removed {
            let only_here = at_keep.binary_search(&v).is_err();
            report(removed, v, only_here && remaining.binary_search(&v).is_ok());
        }
    }
}

impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Merges the two ends of `e` into `keep`, whose handle becomes `to`. The edit takes one scan
    /// of all corners, and one more scan for each vertex that may lose its last face.
    ///
    /// # Errors
    ///
    /// Returns an error if
    /// - the mesh has no edge `e`, or `keep` is not an end of `e`;
    /// - both ends of `e` are corners of a face, but are not adjacent in that face;
    /// - a vertex would lose its last face;
    /// - a vertex that is not an end of `e` has the position `to`, and vertices are identified by
    ///   coordinates.
    pub fn collapse_edge<M: ScannedMesh<V>>(
        &mut self,
        e: Pair<V>,
        keep: V,
        to: V,
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        let star = self.star(e, keep, to)?;
        self.check_remaining_faces(&star)?;
        let removed = star.removed;
        for hit in star.hits.iter() {
            if hit.at != to && star.is_triangle_along(hit.face).is_none() {
                self.retarget(hit.corner, to);
            }
        }
        for &(f, is_triangle) in star.along.iter() {
            if is_triangle {
                self.delete(f);
                log.removed_face(f);
                continue;
            }
            let corners = self.face_vertices(f).filter(|&v| v != removed);
            let corners = corners.map(|v| if v == keep { to } else { v });
            let face: ShortVec<V::Corner> = corners.map(V::corner).collect();
            self.rewrite(f, &face);
        }
        if uses_reports(log) {
            log.removed_vertex(removed);
            if to != keep {
                log.renamed_vertex(keep, to);
            }
            star.report_edges(to, log);
        }
        Ok(())
    }

    /// Finds the corners at the ends of `e`. Checks that `e` exists, that `to` is free, and that
    /// the ends are adjacent in every face that has both ends.
    fn star(&self, e: Pair<V>, keep: V, to: V) -> Result<Star<V>, Refusal<V>> {
        let [a, b] = e.ends();
        if !e.has(keep) {
            return Err(EditError::NotAnEnd {
                edge: e,
                vertex: keep,
            });
        }
        if e.has(V::BLANK) {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        let mut star = Star {
            keep,
            removed: if a == keep { b } else { a },
            hits: ShortVec::new(),
            along: ShortVec::new(),
        };
        let set = if V::IS_POSITION {
            SearchSet::Four([a, b, to, to])
        } else {
            SearchSet::Two([a, b])
        };
        let (mut occupied, mut apart) = (false, false);
        for hit in self.hits(set) {
            if !e.has(hit.at) {
                occupied = true;
                continue;
            }
            let other = star.other(&hit);
            if hit.is_beside(other) {
                if hit.at == keep {
                    star.along.push((hit.face, self.degree(hit.face) == 3));
                }
            } else if hit.at == keep && self.degree(hit.face) > 3 {
                apart |= self.face(hit.face).iter().any(|corner| other.is_at(corner));
            }
            star.hits.push(hit);
        }
        star.along.sort_unstable();
        if star.along.is_empty() {
            return Err(EditError::NoSuchEdge { edge: e });
        }
        if apart {
            return Err(EditError::RepeatedVertex { vertex: keep });
        }
        if occupied {
            return Err(EditError::Occupied { vertex: to });
        }
        Ok(star)
    }

    /// Checks that `keep` and the third corners of the removed triangles keep a face.
    fn check_remaining_faces(&self, star: &Star<V>) -> Result<(), Refusal<V>> {
        if star.hits.iter().all(|hit| !star.remains(hit.face)) {
            return Err(EditError::LastFace { vertex: star.keep });
        }
        for hit in star.hits.iter() {
            if hit.at != star.keep || star.remains(hit.face) {
                continue;
            }
            let apex = if hit.after == star.removed {
                hit.before
            } else {
                hit.after
            };
            if star.remaining_ring().any(|v| v == apex) {
                continue;
            }
            // Rare: no remaining face at the ends of the edge has `apex`, so this scans all faces.
            let mut faces = self.vertex_faces(apex);
            if faces.all(|f| !star.remains(f)) {
                return Err(EditError::LastFace { vertex: apex });
            }
        }
        Ok(())
    }

    /// Moves `v` to `to`; one scan of all corners. The handle of the vertex changes from `v` to
    /// `to`, because vertices are identified by coordinates.
    ///
    /// # Errors
    ///
    /// Returns an error if the mesh has no vertex `v`, or if another vertex is at `to`.
    pub fn rename_vertex<M: ScannedMesh<V>>(
        &mut self,
        v: V,
        to: V,
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        if v == to {
            let exists = self.has_vertex(v);
            return exists
                .then_some(())
                .ok_or(EditError::NoSuchVertex { vertex: v });
        }
        let hits = self.hits_at(v, to)?;
        for hit in hits.iter() {
            self.retarget(hit.corner, to);
        }
        if uses_reports(log) {
            log.renamed_vertex(v, to);
            let ring = hits.iter().flat_map(|hit| [hit.before, hit.after]);
            for other in ring.distinct() {
                log.renamed_edge(Pair::new(v, other), Pair::new(to, other));
            }
        }
        Ok(())
    }
}
