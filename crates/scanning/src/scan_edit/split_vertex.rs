//! Splitting a vertex.

use sixfold_core::{EditError, EditLog, Editable, Pair, Probe, ring};

use super::{Refusal, ScannedMesh};
use crate::scanned::{ScannedFaces, ScannedVertex};

impl<V: ScannedVertex, P: Probe> ScannedFaces<V, P, Editable> {
    /// Splits `v`, and returns the new vertex `n`; one scan of all corners. The vertex `n` gets the
    /// faces that follow counter-clockwise around `v` from `right` to `left`. If `right` is `None`,
    /// the faces of `n` start at the boundary. If `left` is `None`, the faces of `n` end at the
    /// boundary.
    ///
    /// ```text
    ///              left
    ///        3    2          the ring from `right` on, 0 1 2 3 …: faces between 0 and `left` go to n
    ///          ╲ ╱
    ///      4 ── v ── 1       at a boundary, the gap takes the place of one face
    ///          ╱ ╲
    ///        5    0 right
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`MeshEdit::split_vertex`](sixfold_core::MeshEdit::split_vertex).
    pub fn split_vertex<M: ScannedMesh<V>>(
        &mut self,
        v: V,
        left: Option<V>,
        right: Option<V>,
        n: V,
        log: &mut impl EditLog<M>,
    ) -> Result<V, Refusal<V>> {
        let mut hits = self.hits_at(v, n)?;
        let spokes = hits.iter().map(|hit| [hit.after, hit.before]);
        let ring = ring(spokes.collect()).filter(|ring| !ring.is_empty());
        let ring = ring.ok_or(EditError::NoFan { vertex: v })?;
        if left == right {
            return Err(EditError::BadNeighbours { vertex: v });
        }
        let is_open = ring.len() > hits.len();
        if !is_open && (left.is_none() || right.is_none()) {
            return Err(EditError::NotOnBoundary { vertex: v });
        }
        let place_of = |side: V| {
            let place = ring.iter().position(|&u| u == side);
            place.ok_or(EditError::NotANeighbour { vertex: v, side })
        };
        let from = right.map_or(Ok(0), place_of)?;
        let to = left.map_or(Ok(ring.len() - 1), place_of)?;
        let sides = [left, right].into_iter().flatten().count();
        self.check_capacity(sides, 3 * sides)?;
        hits.sort_unstable_by_key(|hit| hit.after);
        let mut i = from;
        loop {
            // The edges to `left` and `right` stay at `v`. The other edges move to `n`.
            if Some(ring[i]) != right && Some(ring[i]) != left {
                log.renamed_edge(Pair::new(v, ring[i]), Pair::new(n, ring[i]));
            }
            if i == to {
                break;
            }
            // The last vertex of an open ring has no face after it.
            if let Ok(hit) = hits.binary_search_by_key(&ring[i], |hit| hit.after) {
                self.retarget(hits[hit].corner, n);
            }
            i = (i + 1) % ring.len();
        }
        log.created_vertex(n);
        log.created_edge(Pair::new(v, n));
        let triangles = [left.map(|l| ([v, n, l], l)), right.map(|r| ([v, r, n], r))];
        for (triangle, side) in triangles.into_iter().flatten() {
            log.created_face(self.push_triangle(triangle));
            log.created_edge(Pair::new(n, side));
        }
        Ok(n)
    }
}
