//! Collapsing an edge, and moving a vertex that is its coordinates.

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

/// The corners at the two ends of an edge that is to be collapsed.
struct Star<V> {
    keep: V,
    gone: V,
    hits: Few<Hit<V>>,
    /// The faces that have both ends, and whether each is a triangle.
    along: Few<(FaceId, bool)>,
}

impl<V: ScannedVertex> Star<V> {
    /// The other end, seen from a corner at one of the two.
    fn other(&self, hit: &Hit<V>) -> V {
        if hit.at == self.keep {
            self.gone
        } else {
            self.keep
        }
    }

    /// Whether a face has both ends, and is a triangle then.
    fn runs_along(&self, f: FaceId) -> Option<bool> {
        let found = self.along.binary_search_by_key(&f, |&(face, _)| face);
        found.ok().map(|i| self.along[i].1)
    }

    /// Whether a face outlives the edge.
    fn stays(&self, f: FaceId) -> bool {
        self.runs_along(f) != Some(true)
    }

    /// The vertices beside `end` in faces that pass `which`, but for the other end.
    fn ring(&self, end: V, which: impl Fn(FaceId) -> bool) -> impl Iterator<Item = V> {
        let hits = self.hits.iter();
        let hits = hits.filter(move |hit| hit.at == end && which(hit.face));
        let beside = hits.flat_map(|hit| [hit.before, hit.after]);
        beside.filter(|&v| v != self.keep && v != self.gone)
    }

    /// The vertices beside either end in faces that outlive the edge.
    fn ring_left(&self) -> impl Iterator<Item = V> {
        let ends = [self.keep, self.gone].into_iter();
        ends.flat_map(|end| self.ring(end, |f| self.stays(f)))
    }

    /// What becomes of the edges at both ends, one of which is `to` from now on.
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
    /// Makes one vertex of the two ends of `e`: `keep`, called `to` from now on. One scan, and one more
    /// for a third corner that may have no other face.
    ///
    /// # Errors
    ///
    /// There is no such edge; `keep` is no end of it; a face has both ends, but not side by side; a
    /// vertex would lose its last face; the place is taken.
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

    /// What is at the ends of `e`, if it is an edge, and its ends side by side wherever both are.
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

    /// Whether `keep` and the third corners of the triangles that go have faces afterwards.
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
            // Seldom: no face left at the ends has it as a neighbour, but perhaps another face has it.
            let mut faces = self.vertex_faces(apex);
            if faces.all(|f| !star.stays(f)) {
                return Err(EditError::LastFace { vertex: apex });
            }
        }
        Ok(())
    }

    /// Calls `v` by another name, where a vertex is its coordinates: it moves to `to`. One scan.
    ///
    /// # Errors
    ///
    /// There is no such vertex; the place is another's.
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
