//! Edge flip: turns an edge within the quad of its two triangles.

use sixfold_core::{EdgeId, EditError, Editable, FaceId, Probe};

use super::Refusal;
use crate::mesh::{Half, HalfEdgeId, HalfEdgeMesh};

impl<P: Probe> HalfEdgeMesh<Editable, P> {
    /// Flips `e`; O(smaller valence of `c` and `d`).
    ///
    /// ```text
    ///        c                    c
    ///   ca  ╱ ╲  bc          ca  ╱│╲  bc
    ///      ╱ h ╲                ╱ │ ╲
    ///     a ───► b       →     a h│t b
    ///      ╲ t ╱                ╲ │ ╱
    ///   ad  ╲ ╱  db          ad  ╲│╱  db
    ///        d                    d
    /// ```
    #[inline]
    pub(super) fn flip(&mut self, e: EdgeId) -> Result<EdgeId, Refusal> {
        let [one, other] = self.check_edge(e)?;
        let (Some(f), Some(g)) = (one.face.get(), other.face.get()) else {
            return Err(EditError::NotTwoFaces { edge: e, faces: 1 });
        };
        let [h, t] = self.edge_half_edges(e);
        let (bc, ad) = (one.next, other.next);
        let [at_bc, at_cb] = self.record_pair(bc);
        let [at_ad, at_da] = self.record_pair(ad);
        let (ca, db) = (at_bc.next, at_ad.next);
        let [at_ca, at_ac] = self.record_pair(ca);
        let [at_db, at_bd] = self.record_pair(db);
        if at_ca.next != h {
            return Err(self.not_a_triangle(f));
        }
        if at_db.next != t {
            return Err(self.not_a_triangle(g));
        }
        let (a, b, c, d) = (one.origin, other.origin, at_ca.origin, at_db.origin);
        if c == d {
            return Err(EditError::SameApex { edge: e, vertex: c });
        }
        // An end has three edges if the spoke after `e` directly follows the spoke before `e`.
        let inner = |half: &Half| half.face.get().is_some();
        if at_da.next == ca.twin() && inner(&at_da) {
            return Err(EditError::LowValence { vertex: a });
        }
        if at_cb.next == db.twin() && inner(&at_cb) {
            return Err(EditError::LowValence { vertex: b });
        }
        // Walks around both third corners at the same time. The shorter walk visits every edge that
        // could join the third corners.
        let (mut x, mut y) = (at_ac.next, at_bd.next);
        while x != bc.twin() && y != ad.twin() {
            let [to_c, to_d] = [x, y].map(|spoke| self.record(spoke.twin()));
            if to_c.origin == d || to_d.origin == c {
                return Err(EditError::EdgeExists { ends: [c, d] });
            }
            (x, y) = (to_c.next, to_d.next);
        }

        *self.halves.write(h.index()) = Half {
            next: ca,
            origin: d,
            ..one
        };
        *self.halves.write(t.index()) = Half {
            next: db,
            origin: c,
            ..other
        };
        *self.halves.write(ad.index()) = Half {
            next: h,
            origin: a,
            face: one.face,
        };
        *self.halves.write(bc.index()) = Half {
            next: t,
            origin: b,
            face: other.face,
        };
        self.link(ca, ad);
        self.link(db, bc);
        *self.first.write(f.index()) = h;
        *self.first.write(g.index()) = t;
        self.replace_leaving(a, h, ad);
        self.replace_leaving(b, t, bc);
        Ok(e)
    }

    #[cold]
    #[inline(never)]
    pub(super) fn not_a_triangle(&self, f: FaceId) -> Refusal {
        EditError::NotATriangle {
            face: f,
            degree: self.around_face(f).count(),
        }
    }

    /// Returns the third side of the triangle along `h`, with its record. Returns `None` if there
    /// is no triangle along `h`. `half` is the record of `h`.
    #[inline]
    pub(super) fn third_side(&self, h: HalfEdgeId, half: &Half) -> Option<(HalfEdgeId, Half)> {
        half.face.get()?;
        let third = self.follow(half.next);
        let at_third = self.record(third);
        (at_third.next == h).then_some((third, at_third))
    }
}
