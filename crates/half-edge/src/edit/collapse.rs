//! Edge collapse: merges the two ends of an edge into one vertex.

use sixfold_core::{EdgeId, EditError, EditLog, Editable, FaceId, Point, Probe, Slot, VertexId};

use super::Refusal;
use super::handle_set::HandleSet;
use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

/// The data of an edge collapse, from the check.
struct Collapse {
    /// The half-edge from the removed end to the kept end.
    h: HalfEdgeId,
    into: Half,
    back: Half,
    /// The third side of the triangle on the left, and of the triangle on the right, with their
    /// records. The third side starts at the third corner.
    left: Option<(HalfEdgeId, Half)>,
    right: Option<(HalfEdgeId, Half)>,
    gone: End,
    kept: End,
}

/// One end of the collapsed edge.
struct End {
    /// Number of spokes. `end_without_walk` reports every valence except 3 as 4.
    valence: usize,
    on_boundary: bool,
    /// The last two spokes before the edge.
    last: HalfEdgeId,
    last_but_one: HalfEdgeId,
}

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Collapses `e` into `keep`. O(valence) of both ends; O(valence log valence) above 16
    /// neighbours.
    ///
    /// ```text
    ///          c                      c
    ///    last ╱ ╲ next                │
    ///        ╱ h ╲                    │
    ///    gone ───► keep       →     keep
    ///        ╲ t ╱                    │
    ///         ╲ ╱                     │
    ///          d                      d
    /// ```
    #[inline]
    pub(super) fn collapse(
        &mut self,
        e: EdgeId,
        keep: VertexId,
        to: Point,
        log: &mut impl EditLog<Self>,
    ) -> Result<VertexId, Refusal> {
        let mut collapse = self.read_collapse(e, self.check_edge(e)?, keep);
        self.check_collapse(e, keep, &mut collapse)?;
        self.collapse_checked(&collapse, log);
        *self.positions.write(keep.index()) = to;
        Ok(keep)
    }

    /// Reads the edge `e` and its two faces. `pair` has the half-edges of `e`.
    #[inline]
    fn read_collapse(&self, e: EdgeId, pair: [Half; 2], keep: VertexId) -> Collapse {
        let side = usize::from(pair[0].origin == keep);
        let (into, back) = (pair[side], pair[side ^ 1]);
        let h = self.edge_half_edges(e)[side];
        let end = |last| End {
            valence: 1,
            on_boundary: false,
            last,
            last_but_one: last,
        };
        Collapse {
            h,
            into,
            back,
            left: self.third_side(h, &into),
            right: self.third_side(h.twin(), &back),
            gone: end(h),
            kept: end(h.twin()),
        }
    }

    /// Checks the link condition (Dey et al. 1999), and that no face would contain `keep` twice.
    /// Sets both ends of `collapse`. Writing into `collapse` is faster than returning a new value.
    #[inline]
    fn check_collapse(
        &self,
        e: EdgeId,
        keep: VertexId,
        collapse: &mut Collapse,
    ) -> Result<(), Refusal> {
        let Collapse {
            h,
            into,
            back,
            right,
            ..
        } = *collapse;
        if back.origin != keep {
            return Err(EditError::NotAnEnd {
                edge: e,
                vertex: keep,
            });
        }
        // `keep` replaces a missing third corner, because only the edge itself leads to `keep`.
        let apex = |side: Option<(HalfEdgeId, Half)>| side.map_or(keep, |(_, third)| third.origin);
        let apexes = [apex(collapse.left), apex(right)];
        if apexes[0] == apexes[1] && apexes[0] != keep {
            let vertex = apexes[0];
            return Err(EditError::SameApex { edge: e, vertex });
        }

        let mut neighbours = HandleSet::new();
        let mut faces = HandleSet::new();
        collapse.gone = self.walk_end(h, &back, |arriving| {
            if !apexes.contains(&arriving.origin) {
                neighbours.push(arriving.origin);
            }
            if let Some(f) = arriving.face.get()
                && arriving.face != into.face
                && arriving.face != back.face
            {
                faces.push(f);
            }
            Ok(())
        })?;
        neighbours.sort();
        faces.sort();
        collapse.kept = match right {
            // No neighbour is left, so a walk around the kept end is not needed.
            Some((last, _)) if neighbours.is_empty() => {
                let found = |f: &FaceId| self.sides(*f).any(|(_, half)| half.origin == keep);
                if faces.iter().any(found) {
                    return Err(EditError::RepeatedVertex { vertex: keep });
                }
                self.end_without_walk(keep, into.next, last.twin())
            }
            _ => self.walk_end(h.twin(), &into, |arriving| {
                if neighbours.contains(arriving.origin) {
                    let vertex = arriving.origin;
                    return Err(EditError::CommonNeighbour { edge: e, vertex });
                }
                match arriving.face.get() {
                    Some(f) if faces.contains(f) => Err(EditError::RepeatedVertex { vertex: keep }),
                    _ => Ok(()),
                }
            })?,
        };
        if collapse.gone.on_boundary || collapse.kept.on_boundary {
            self.check_at_boundary(e, collapse)
        } else if collapse.valence_after() == 2 && self.only_triangles_remain(collapse) {
            Err(EditError::Pillow { edge: e })
        } else {
            Ok(())
        }
    }

    /// Walks clockwise around the origin of `h`. `twin` is the record of the twin of `h`. `visit`
    /// gets the record of every other half-edge that arrives at the origin.
    #[inline]
    fn walk_end(
        &self,
        h: HalfEdgeId,
        twin: &Half,
        mut visit: impl FnMut(&Half) -> Result<(), Refusal>,
    ) -> Result<End, Refusal> {
        let mut end = End {
            valence: 1,
            on_boundary: twin.face == Slot::NONE,
            last: h,
            last_but_one: h,
        };
        let mut spoke = twin.next;
        while spoke != h {
            let arriving = self.record(spoke.twin());
            visit(&arriving)?;
            end.valence += 1;
            end.on_boundary |= arriving.face == Slot::NONE;
            end.last_but_one = end.last;
            end.last = spoke;
            spoke = arriving.next;
        }
        Ok(end)
    }

    /// Returns the data of the end `v` without a walk. Reports every valence except 3 as 4.
    #[inline]
    fn end_without_walk(&self, v: VertexId, first: HalfEdgeId, last: HalfEdgeId) -> End {
        let leaving = self.leaving.read(v.index()).get().expect("I5");
        End {
            valence: if self.follow(first.twin()) == last {
                3
            } else {
                4
            },
            on_boundary: !self.has_face(leaving),
            last,
            last_but_one: last,
        }
    }

    /// Refuses in two cases: an inner edge joins two boundaries, or a third corner has no other
    /// face.
    #[cold]
    #[inline(never)]
    fn check_at_boundary(&self, e: EdgeId, checked: &Collapse) -> Result<(), Refusal> {
        let Collapse {
            into,
            back,
            left,
            right,
            ..
        } = checked;
        let inner = into.face != Slot::NONE && back.face != Slot::NONE;
        if inner && checked.gone.on_boundary && checked.kept.on_boundary {
            return Err(EditError::AcrossBoundary { edge: e });
        }
        for (second, third) in [(into.next, left), (back.next, right)] {
            if let Some((third, at_third)) = third
                && !self.has_face(second.twin())
                && !self.has_face(third.twin())
            {
                let vertex = at_third.origin;
                return Err(EditError::LastFace { vertex });
            }
        }
        Ok(())
    }

    /// Returns whether the two remaining faces at the merged vertex would both be triangles.
    #[cold]
    #[inline(never)]
    fn only_triangles_remain(&self, checked: &Collapse) -> bool {
        let ends = [checked.into.origin, checked.back.origin];
        let mut faces = ends.into_iter().flat_map(|v| self.spokes(v));
        faces.all(|(_, arriving)| {
            let along = [checked.into.face, checked.back.face].contains(&arriving.face);
            let most = if along { 4 } else { 3 };
            let face = arriving.face.get();
            face.is_none_or(|f| self.around_face(f).take(most + 1).count() <= most)
        })
    }

    fn collapse_checked(&mut self, checked: &Collapse, log: &mut impl EditLog<Self>) {
        let Collapse {
            h,
            into,
            back,
            left,
            right,
            ref gone,
            ref kept,
        } = *checked;
        let (t, next) = (h.twin(), into.next);
        let [v, keep] = [into.origin, back.origin];
        // The half-edges of the removed triangles need no new origin.
        let mut spoke = match right {
            Some(_) => self.follow(back.next.twin()),
            None => back.next,
        };
        let end = left.map_or(h, |(last, _)| last.twin());
        while spoke != end {
            self.halves.write(spoke.index()).origin = keep;
            spoke = self.follow(spoke.twin());
        }

        // On the left, the side from `keep` replaces the spoke of the removed end. The right side
        // may read rows that the left side has written.
        if let Some((last, at_last)) = left {
            self.replace(gone.last_but_one.twin(), last.twin(), next);
            self.replace_leaving(at_last.origin, last, next.twin());
        } else {
            self.link(gone.last.twin(), next);
            self.replace_first(into.face, h, next);
        }
        let after = if let Some((last, at_last)) = right {
            let outer = back.next.twin();
            let before = self.prev(outer);
            self.replace(before, outer, last);
            self.replace_leaving(at_last.origin, outer, last);
            next
        } else {
            let after = self.follow(t);
            self.link(kept.last.twin(), after);
            self.replace_first(back.face, t, after);
            after
        };

        // The boundary half-edge of one of the two ends. On the left, a side has replaced a spoke.
        let from = if gone.on_boundary && !kept.on_boundary {
            v
        } else {
            keep
        };
        let leaving = self.leaving.read(from.index()).get().expect("I5");
        let leaving = match left {
            _ if leaving == t => after,
            Some((last, _)) if leaving == last.twin() => next,
            _ => leaving,
        };
        self.set_leaving(keep, leaving);

        let mut delete_triangle = |mesh: &mut Self, triangle: Slot<FaceId>, spoke: HalfEdgeId| {
            let f = triangle.get().expect("a triangle is a face");
            mesh.delete_face(f);
            mesh.delete_edge(spoke.edge());
            log.removed_face(f);
            log.removed_edge(spoke.edge());
        };
        if let Some((last, _)) = left {
            delete_triangle(self, into.face, last);
        }
        if right.is_some() {
            delete_triangle(self, back.face, back.next);
        }
        self.delete_edge(h.edge());
        self.delete_vertex(v);
        log.removed_edge(h.edge());
        log.removed_vertex(v);
    }
}

impl Collapse {
    fn valence_after(&self) -> usize {
        let triangles = usize::from(self.left.is_some()) + usize::from(self.right.is_some());
        self.gone.valence + self.kept.valence - 2 - triangles
    }
}
