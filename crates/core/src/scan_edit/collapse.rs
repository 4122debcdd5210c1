//! Collapsing an edge, and moving a vertex in structures where a vertex is its coordinates.

use super::{Refusal, ScannedMesh, listens, sorted_once};
use crate::distinct::IteratorExt;
use crate::edit_error::EditError;
use crate::edit_log::EditLog;
use crate::editing::Editable;
use crate::few::Few;
use crate::handle::Pair;
use crate::probe::Probe;
use crate::row_id::FaceId;
use crate::scanned::{Hit, ScannedFaces, ScannedVertex, Sought};

/// The corners at the two ends of an edge to be collapsed.
struct Star<V> {
    keep: V,
    gone: V,
    hits: Few<Hit<V>>,
    /// The faces that have both ends, and whether each is a triangle.
    along: Few<(FaceId, bool)>,
}

impl<V: ScannedVertex> Star<V> {
    /// Returns the end of the edge that the corner is not at.
    fn other(&self, hit: &Hit<V>) -> V {
        if hit.at == self.keep {
            self.gone
        } else {
            self.keep
        }
    }

    /// Returns whether `f` is a triangle, if it has both ends; otherwise `None`.
    fn runs_along(&self, f: FaceId) -> Option<bool> {
        let found = self.along.binary_search_by_key(&f, |&(face, _)| face);
        found.ok().map(|i| self.along[i].1)
    }

    /// Returns whether a face remains after the collapse.
    fn stays(&self, f: FaceId) -> bool {
        self.runs_along(f) != Some(true)
    }

    /// Returns the vertices adjacent to `end` in the faces that `which` selects, except the other
    /// end.
    fn ring(&self, end: V, which: impl Fn(FaceId) -> bool) -> impl Iterator<Item = V> {
        let hits = self.hits.iter();
        let hits = hits.filter(move |hit| hit.at == end && which(hit.face));
        let beside = hits.flat_map(|hit| [hit.before, hit.after]);
        beside.filter(|&v| v != self.keep && v != self.gone)
    }

    /// Returns the vertices adjacent to either end in faces that remain.
    fn ring_left(&self) -> impl Iterator<Item = V> {
        let ends = [self.keep, self.gone].into_iter();
        ends.flat_map(|end| self.ring(end, |f| self.stays(f)))
    }

    /// Reports the changes of the edges at both ends, one of which is `to` from now on.
    fn tell<M: ScannedMesh<V>>(&self, to: V, log: &mut impl EditLog<M>) {
        let (keep, gone) = (self.keep, self.gone);
        log.removed_edge(Pair::new(keep, gone));
        let left = sorted_once(self.ring_left());
        let [at_keep, at_gone] = [keep, gone].map(|end| sorted_once(self.ring(end, |_| true)));
        let mut tell = |end: V, v: V, stays: bool| {
            if !stays {
                log.removed_edge(Pair::new(end, v));
            } else if end != to {
                log.renamed_edge(Pair::new(end, v), Pair::new(to, v));
            }
        };
        for &v in &at_keep {
            tell(keep, v, left.binary_search(&v).is_ok());
        }
        for &v in &at_gone {
            let alone = at_keep.binary_search(&v).is_err();
            tell(gone, v, alone && left.binary_search(&v).is_ok());
        }
    }
}

impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Merges the two ends of `e` into `keep`, which becomes `to`. One scan, and another for a
    /// third corner that may have no other face.
    ///
    /// # Errors
    ///
    /// Refuses a missing edge, a `keep` that is not an end of it, a face that has both ends but not
    /// as adjacent corners, a vertex that would lose its last face, and an occupied position.
    pub fn collapse_edge<M: ScannedMesh<V>>(
        &mut self,
        e: Pair<V>,
        keep: V,
        to: V,
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        let star = self.star(e, keep, to)?;
        self.check_faces_left(&star)?;
        let gone = star.gone;
        for hit in star.hits.iter() {
            if hit.at != to && star.runs_along(hit.face).is_none() {
                self.retarget(hit.corner, to);
            }
        }
        for &(f, is_triangle) in star.along.iter() {
            if is_triangle {
                self.delete(f);
                log.removed_face(f);
                continue;
            }
            let corners = self.face_vertices(f).filter(|&v| v != gone);
            let corners = corners.map(|v| if v == keep { to } else { v });
            let face: Few<V::Corner> = corners.map(V::corner).collect();
            self.rewrite(f, &face);
        }
        if listens(log) {
            log.removed_vertex(gone);
            if to != keep {
                log.renamed_vertex(keep, to);
            }
            star.tell(to, log);
        }
        Ok(())
    }

    /// Returns the corners at the ends of `e`, after checking that `e` exists and that its ends are
    /// adjacent in every face that has both.
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
            gone: if a == keep { b } else { a },
            hits: Few::new(),
            along: Few::new(),
        };
        let sought = if V::IS_PLACE {
            Sought::Four([a, b, to, to])
        } else {
            Sought::Two([a, b])
        };
        let (mut occupied, mut apart) = (false, false);
        for hit in self.hits(sought) {
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

    /// Checks that `keep` and the third corners of the removed triangles still have faces
    /// afterwards.
    fn check_faces_left(&self, star: &Star<V>) -> Result<(), Refusal<V>> {
        if star.hits.iter().all(|hit| !star.stays(hit.face)) {
            return Err(EditError::LastFace { vertex: star.keep });
        }
        for hit in star.hits.iter() {
            if hit.at != star.keep || star.stays(hit.face) {
                continue;
            }
            let apex = if hit.after == star.gone {
                hit.before
            } else {
                hit.after
            };
            if star.ring_left().any(|v| v == apex) {
                continue;
            }
            // Rare: `apex` has no remaining face at the ends of the edge, but may have one
            // elsewhere.
            let mut faces = self.vertex_faces(apex);
            if faces.all(|f| !star.stays(f)) {
                return Err(EditError::LastFace { vertex: apex });
            }
        }
        Ok(())
    }

    /// Moves `v` to `to`, which changes its handle, as a vertex is its coordinates; one scan.
    ///
    /// # Errors
    ///
    /// Refuses a missing vertex, and a position that another vertex has.
    pub fn rename_vertex<M: ScannedMesh<V>>(
        &mut self,
        v: V,
        to: V,
        log: &mut impl EditLog<M>,
    ) -> Result<(), Refusal<V>> {
        if v == to {
            let there = self.has_vertex(v);
            return there
                .then_some(())
                .ok_or(EditError::NoSuchVertex { vertex: v });
        }
        let hits = self.around(v, to)?;
        for hit in hits.iter() {
            self.retarget(hit.corner, to);
        }
        if listens(log) {
            log.renamed_vertex(v, to);
            let ring = hits.iter().flat_map(|hit| [hit.before, hit.after]);
            for other in ring.distinct() {
                log.renamed_edge(Pair::new(v, other), Pair::new(to, other));
            }
        }
        Ok(())
    }
}
