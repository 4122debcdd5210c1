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

use super::{Corners, fill, for_each_edge_chunk, half};
use crate::HalfEdgeMesh;
use crate::mesh::HalfEdgeId;

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
    // The number j of boundary half-edges before the boundary half-edge `b`. Then, for j, the first
    // new half-edge, the first new point and the first new triangle.
    let boundary_rank = |b: u32| b - corners.number(b);
    let new_half = |j: u32| 2 * (edges + 3 * faces) + 8 * j;
    let new_point = |j: u32| vertices + faces + 2 * j;
    let new_face = |j: u32| 3 * faces + 2 * j;
    let face_slot = |f: u32| Slot::some(FaceId::new(f));
    for_each_edge_chunk(edges as usize, corners, 2, child, |chunk| {
        let pairs = &rows.as_chunks::<2>().0[chunk.edges.start as usize..chunk.edges.end as usize];
        let inner = chunk.inner.as_chunks_mut::<2>().0;
        let mut inner = inner.iter_mut().zip(chunk.first.iter_mut());
        let along = chunk.along.as_chunks_mut::<2>().0;
        for ((e, pair), along) in chunk.edges.clone().zip(pairs).zip(along) {
            *along = [0, 1].map(|side| {
                let (h, t) = (2 * e + side, 2 * e + (side ^ 1));
                let (record, twin) = (&pair[side as usize], &pair[side as usize ^ 1]);
                let n = record.next.index() as u32;
                let origin = record.origin.index() as u32;
                if !corners.has_face(h) {
                    let next = if TRISECT {
                        new_half(boundary_rank(h)) + 1
                    } else {
                        n
                    };
                    return half(next, origin, Slot::NONE);
                }
                let face = corners.face(h);
                let p = next(n);
                let arriving = match (corners.has_face(p ^ 1), TRISECT) {
                    (true, _) => half(p ^ 1, origin, corners.face(p ^ 1)),
                    (false, false) => half(spoke(p) + 1, origin, corners.face(p)),
                    (false, true) => {
                        let next = new_half(boundary_rank(p ^ 1)) + 7;
                        half(next, origin, corners.face(p))
                    }
                };
                let centre = face_point(record.face);
                let (flipped, leaving) = match (corners.has_face(t), TRISECT) {
                    (true, _) => (
                        half(spoke(h) + 1, face_point(twin.face), face),
                        half(spoke(twin.next.index() as u32), centre, face),
                    ),
                    (false, false) => (half(spoke(n), origin, face), half(h, centre, face)),
                    (false, true) => {
                        let j = boundary_rank(t);
                        (
                            half(spoke(n), new_point(j) + 1, face),
                            half(new_half(j) + 2, centre, face_slot(new_face(j))),
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
            HalfEdgeId::new(if corners.has_face(h) { spoke(h) } else { h })
        };
        leaving[v].get().map(spoke).into()
    });
    let first = mesh.first_rows();
    let (face_points, new_points) = points.split_at_mut(first.len());
    fill(face_points, |f| {
        Slot::some(HalfEdgeId::new(spoke(first[f].index() as u32) + 1))
    });
    if CLOSED || !TRISECT {
        return;
    }
    fill(new_points.as_chunks_mut().0, |j| {
        let y = new_half(j as u32);
        [y + 3, y + 1].map(|h| Slot::some(HalfEdgeId::new(h)))
    });
    let new_first = &mut child.first.rows_mut()[3 * faces as usize..];
    fill(new_first.as_chunks_mut().0, |j| {
        let y = new_half(j as u32);
        [y + 2, y].map(HalfEdgeId::new)
    });
    let new_halves = &mut child.halves.rows_mut()[new_half(0) as usize..];
    fill(new_halves.as_chunks_mut().0, |j| {
        let b = corners.0.select_missing(j) as u32;
        let h = b ^ 1;
        let j = j as u32;
        let (y, near, far) = (new_half(j), new_point(j), new_point(j) + 1);
        let centre = face_point(rows[h as usize].face);
        let a = rows[h as usize].origin.index() as u32;
        let [first, second] = [0, 1].map(|i| face_slot(new_face(j) + i));
        let third = corners.face(h);
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
