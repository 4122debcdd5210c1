//! Triangles split at face points, with their edges flipped.
//!
//! Half-edge `h` runs from vertex `a` to `b` along face `f`; `p` and `n` are the half-edges before
//! and after it, and its twin `t` has face `g`. In the child it has the same row, but runs from the
//! face point g to f. Its corner adds one edge, the spoke s(h) from `a` to f, and r(h) back.
//!
//! ```text
//!             g            x = next(t)            f           ▲ y + 4  ▲ y + 6   to f;
//!     s(x) ↗  │                            r(h) ↙   ↖ s(n)    │        │         each has its twin
//!         a   │ h                              ╱     ╲        │        │
//!     r(h) ↖  ▼                               a ──h──► b      a ─────► q ─────► q' ─────► b
//!             f                                                 y + 2      y         h
//!       an inner edge               a boundary edge           the same edge cut in three
//! ```
//!
//! With E edges and C corners in the parent, and `#h` the number of the corner of `h`:
//!
//! | half-edge of the child | row | next | origin | face |
//! |---|---|---|---|---|
//! | h, inner | h | r(h) | g | #h |
//! | s(h), p inner | 2(E + #h) | p ^ 1 | a | #(p ^ 1) |
//! | r(h), h inner | s(h) + 1 | s(next(t)) | f | #h |
//! | h, t without a face | h | s(n) | a | #h |
//! | s(h), p ^ 1 without a face | 2(E + #h) | r(p) | a | #p |
//! | r(h), t without a face | s(h) + 1 | h | f | #h |
//!
//! Boundary half-edges stay as they are. If boundary edges are cut in three, the `j`-th of them
//! gets the points q and q', the triangles C + 2j (a q f) and C + 2j + 1 (q q' f) beside #h (q' b
//! f), and eight rows from y = 2(E + C) + 8j on. Its boundary half-edge keeps its row and runs from
//! `b` to q'; y + 1 then runs to q, and y + 3 to `a`.

use sixfold_core::{FaceId, MeshQuery, Slot};

use super::{Corners, fill, for_parts, half};
use crate::mesh::{HalfEdgeId, HalfEdgeMesh};

/// Splits every triangle into three and flips the inner edges; cuts boundary edges in three if
/// `TRISECT`.
pub(super) fn sqrt3<const CLOSED: bool, const TRISECT: bool>(
    mesh: &HalfEdgeMesh,
    corners: &Corners<CLOSED>,
    child: &mut HalfEdgeMesh,
) {
    let [vertices, faces, edges] =
        [mesh.vertex_count(), mesh.face_count(), mesh.edge_count()].map(|n| n as u32);
    let rows = mesh.half_rows();
    let next = |h: u32| rows[h as usize].next.index() as u32;
    let spoke = |h: u32| 2 * (edges + corners.number(h));
    let face_point = |f: Slot<FaceId>| vertices + f.get().map_or(0, |f| f.index() as u32);
    // For the boundary half-edge `b`: the number j of boundary half-edges before it; for j, the
    // first new half-edge, the first new point and the first new triangle.
    let gap = |b: u32| b - corners.number(b);
    let cut = |j: u32| 2 * (edges + 3 * faces) + 8 * j;
    let point = |j: u32| vertices + faces + 2 * j;
    let more = |j: u32| 3 * faces + 2 * j;
    let name = |f: u32| Slot::some(FaceId::new(f));
    for_parts(edges as usize, corners, 2, child, |part| {
        let pairs = &rows.as_chunks::<2>().0[part.edges.start as usize..part.edges.end as usize];
        let inner = part.inner.as_chunks_mut::<2>().0;
        let mut inner = inner.iter_mut().zip(part.first.iter_mut());
        let along = part.along.as_chunks_mut::<2>().0;
        for ((e, pair), along) in part.edges.clone().zip(pairs).zip(along) {
            *along = [0, 1].map(|side| {
                let (h, t) = (2 * e + side, 2 * e + (side ^ 1));
                let (record, twin) = (&pair[side as usize], &pair[side as usize ^ 1]);
                let n = record.next.index() as u32;
                let origin = record.origin.index() as u32;
                if !corners.is_one(h) {
                    let next = if TRISECT { cut(gap(h)) + 1 } else { n };
                    return half(next, origin, Slot::NONE);
                }
                let face = corners.face(h);
                let p = next(n);
                let arriving = match (corners.is_one(p ^ 1), TRISECT) {
                    (true, _) => half(p ^ 1, origin, corners.face(p ^ 1)),
                    (false, false) => half(spoke(p) + 1, origin, corners.face(p)),
                    (false, true) => half(cut(gap(p ^ 1)) + 7, origin, corners.face(p)),
                };
                let centre = face_point(record.face);
                let (flipped, leaving) = match (corners.is_one(t), TRISECT) {
                    (true, _) => (
                        half(spoke(h) + 1, face_point(twin.face), face),
                        half(spoke(twin.next.index() as u32), centre, face),
                    ),
                    (false, false) => (half(spoke(n), origin, face), half(h, centre, face)),
                    (false, true) => {
                        let j = gap(t);
                        (
                            half(spoke(n), point(j) + 1, face),
                            half(cut(j) + 2, centre, name(more(j))),
                        )
                    }
                };
                if let Some((inner, first)) = inner.next() {
                    *inner = [arriving, leaving];
                    *first = HalfEdgeId::new(h);
                }
                flipped
            });
        }
    });
    let (old, points) = child.leaving.rows_mut().split_at_mut(vertices as usize);
    let leaving = mesh.leaving_rows();
    fill(old, |v| {
        let spoke = |h: HalfEdgeId| {
            let h = h.index() as u32;
            HalfEdgeId::new(if corners.is_one(h) { spoke(h) } else { h })
        };
        leaving[v].get().map(spoke).into()
    });
    let first = mesh.first_rows();
    let (face_points, cuts) = points.split_at_mut(first.len());
    fill(face_points, |f| {
        Slot::some(HalfEdgeId::new(spoke(first[f].index() as u32) + 1))
    });
    if CLOSED || !TRISECT {
        return;
    }
    fill(cuts.as_chunks_mut().0, |j| {
        let y = cut(j as u32);
        [y + 3, y + 1].map(|h| Slot::some(HalfEdgeId::new(h)))
    });
    let more_first = &mut child.first.rows_mut()[3 * faces as usize..];
    fill(more_first.as_chunks_mut().0, |j| {
        let y = cut(j as u32);
        [y + 2, y].map(HalfEdgeId::new)
    });
    let more_halves = &mut child.halves.rows_mut()[cut(0) as usize..];
    fill(more_halves.as_chunks_mut().0, |j| {
        let b = corners.0.select_missing(j) as u32;
        let h = b ^ 1;
        let j = j as u32;
        let (y, near, far) = (cut(j), point(j), point(j) + 1);
        let centre = face_point(rows[h as usize].face);
        let a = rows[h as usize].origin.index() as u32;
        let [first, second, third] = [name(more(j)), name(more(j) + 1), corners.face(h)];
        [
            half(y + 6, near, second),
            half(y + 3, far, Slot::NONE),
            half(y + 4, a, first),
            half(next(b), near, Slot::NONE),
            half(spoke(h) + 1, near, first),
            half(y, centre, second),
            half(y + 5, far, second),
            half(h, centre, third),
        ]
    });
}
