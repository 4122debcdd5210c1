//! Faces split at the midpoints of their edges: any face into quads, or a triangle into four.
//!
//! Half-edge `h` runs from vertex `v` along face `f`. `p` is the half-edge before `h`, `n` the
//! half-edge after `h`, and `t` the twin of `h`. `#h` is the number of the corner of `h`. The
//! midpoint m(h) cuts `h` into two halves: e(h) starts where `h` starts, and l(h) ends where `h`
//! ends. The corner of `h` adds one edge inside the face: i(h) and its twin j(h).
//!
//! ```text
//!   Quads                                  Triangles
//!                                          m(p)
//!    m(p) ◄─ j(p) ── f                      │ ▲ ╲
//!     │              ▲ │                    │   ╲ ╲ j(h)
//!    l(p)       i(h) │ │ j(h)              l(p)   ╲ ╲
//!     ▼              │ ▼                    ▼   i(h)╲ ▼
//!     v ─── e(h) ──► m(h) ── l(h) ─►        v ─ e(h) ─► m(h) ── l(h) ─►
//! ```
//!
//! The mesh before the split (the parent) has E edges and C corners. In the column "origin" of the
//! table, f is the face point of `f`; in the column "face", f is the number of the face:
//!
//! | half-edge of the child | row | next | origin | face |
//! |---|---|---|---|---|
//! | e(h) | 2h | i(h) | v | #h |
//! | l(h) | 2t + 1 | e(n) | m(h) | #n |
//! | i(h), quads | 4E + 2#h | j(p) | m(h) | #h |
//! | j(h), quads | 4E + 2#h + 1 | l(h) | f | #n |
//! | i(h), triangles | 4E + 2#h | l(p) | m(h) | #h |
//! | j(h), triangles | 4E + 2#h + 1 | j(n) | m(p) | C + f |
//! | e(b), on the boundary | 2b | l(b) | v | none |
//! | l(b), on the boundary | 2(b ^ 1) + 1 | e(n) | m(b) | none |
//!
//! Edge e becomes the edges 2e and 2e + 1, whose four rows are adjacent. Each thread processes a
//! range of edges and writes two ranges of rows.

use std::sync::atomic::{AtomicBool, Ordering};

use sixfold_core::{FaceId, MeshQuery, Slot};

use super::{BLANK, Corners, fill, for_each_edge_chunk, half};
use crate::HalfEdgeMesh;
use crate::mesh::{Half, HalfEdgeId};

/// Maximum number of steps of [`previous`]. Without this limit, the walks from all corners of a
/// face would take O(degree²).
const MAX_STEPS: usize = 8;

/// The numbers of rows of the parent.
#[derive(Clone, Copy)]
struct Sizes {
    vertices: u32,
    faces: u32,
    edges: u32,
    /// The row of the first edge point.
    midpoints: u32,
}

impl Sizes {
    fn new(mesh: &HalfEdgeMesh, face_points: bool) -> Self {
        let [vertices, faces, edges] =
            [mesh.vertex_count(), mesh.face_count(), mesh.edge_count()].map(|n| n as u32);
        let midpoints = if face_points {
            vertices + faces
        } else {
            vertices
        };
        Self {
            vertices,
            faces,
            edges,
            midpoints,
        }
    }
}

pub(super) fn quads<const CLOSED: bool>(
    mesh: &HalfEdgeMesh,
    corners: &Corners<CLOSED>,
    child: &mut HalfEdgeMesh,
) {
    let sizes = Sizes::new(mesh, true);
    let rows = mesh.half_edge_rows();
    let inner = |h: u32| 4 * sizes.edges + 2 * corners.number(h);
    let has_large_face = AtomicBool::new(false);
    split(mesh, corners, sizes, child, |h, record, n| {
        let (sizes, corners) = (sizes, *corners);
        let p = previous(rows, h, n).unwrap_or_else(|| {
            // A placeholder: `link_large_faces` links large faces later.
            has_large_face.store(true, Ordering::Relaxed);
            h
        });
        let face = record.face.get().map_or(0, |f| f.index() as u32);
        [
            half(inner(p) + 1, sizes.midpoints + h / 2, corners.face(h)),
            half(late(h), sizes.vertices + face, corners.face(n)),
        ]
    });
    if has_large_face.into_inner() {
        link_large_faces(mesh, child, inner);
    }
    let first = mesh.first_rows();
    let points = &mut child.leaving.rows_mut()[sizes.vertices as usize..];
    fill(&mut points[..first.len()], |f| {
        Slot::some(HalfEdgeId::new(inner(first[f].index() as u32) + 1))
    });
}

pub(super) fn triangles<const CLOSED: bool>(
    mesh: &HalfEdgeMesh,
    corners: &Corners<CLOSED>,
    child: &mut HalfEdgeMesh,
) {
    let sizes = Sizes::new(mesh, false);
    let rows = mesh.half_edge_rows();
    let inner = |h: u32| 4 * sizes.edges + 2 * corners.number(h);
    split(mesh, corners, sizes, child, |h, record, n| {
        let p = rows[n as usize].next.index() as u32;
        let face = record.face.get().map_or(0, |f| f.index() as u32);
        let middle = FaceId::new(3 * sizes.faces + face);
        [
            half(late(p), sizes.midpoints + h / 2, corners.face(h)),
            half(inner(n) + 1, sizes.midpoints + p / 2, Slot::some(middle)),
        ]
    });
    let first = mesh.first_rows();
    let middles = &mut child.first.rows_mut()[3 * first.len()..];
    fill(middles, |f| {
        HalfEdgeId::new(inner(first[f].index() as u32) + 1)
    });
}

/// Cuts every edge in two. `inner_pair` returns the two half-edges that a corner adds.
#[inline(always)]
fn split<const CLOSED: bool>(
    mesh: &HalfEdgeMesh,
    corners: &Corners<CLOSED>,
    sizes: Sizes,
    child: &mut HalfEdgeMesh,
    inner_pair: impl Fn(u32, &Half, u32) -> [Half; 2] + Sync,
) {
    let edges = mesh.half_edge_rows().as_chunks::<2>().0;
    for_each_edge_chunk(edges.len(), corners, 4, child, |chunk| {
        // The compiler keeps local copies in registers, because no write to the tables can change
        // the copies.
        let (sizes, corners) = (sizes, *corners);
        let pairs = &edges[chunk.edges.start as usize..chunk.edges.end as usize];
        let along = chunk.along.as_chunks_mut::<4>().0;
        let children = |h: u32, record: &Half| {
            let n = record.next.index() as u32;
            let point = sizes.midpoints + h / 2;
            let to_midpoint = 4 * sizes.edges + 2 * corners.number(h);
            [
                half(to_midpoint, record.origin.index() as u32, corners.face(h)),
                half(2 * n, point, corners.face(n)),
            ]
        };
        if CLOSED {
            let inner = chunk.inner.as_chunks_mut::<2>().0.as_chunks_mut::<2>().0;
            let rows = pairs.iter().zip(along).zip(inner);
            for (e, ((pair, along), inner)) in chunk.edges.clone().zip(rows) {
                let mut cut = [[BLANK; 2]; 2];
                // With a loop, `inner_pair` is called in one place, and inlined there.
                for side in 0..2 {
                    let (h, record) = (2 * e + side as u32, &pair[side]);
                    cut[side] = children(h, record);
                    inner[side] = inner_pair(h, record, record.next.index() as u32);
                }
                let [[a, b], [c, d]] = cut;
                *along = [a, d, c, b];
            }
            for (h, first) in (2 * chunk.edges.start..).zip(chunk.first.iter_mut()) {
                *first = HalfEdgeId::new(2 * h);
            }
            return;
        }
        let inner = chunk.inner.as_chunks_mut::<2>().0;
        let mut inner = inner.iter_mut().zip(chunk.first.iter_mut());
        for ((e, pair), along) in chunk.edges.clone().zip(pairs).zip(along) {
            let [one, other] = [0, 1].map(|side| {
                let (h, record) = (2 * e + side, &pair[side as usize]);
                let (n, origin) = (record.next.index() as u32, record.origin.index() as u32);
                if !corners.has_face(h) {
                    let point = sizes.midpoints + e;
                    return [(late(h), origin), (2 * n, point)]
                        .map(|(next, origin)| half(next, origin, Slot::NONE));
                }
                if let Some((inner, first)) = inner.next() {
                    *inner = inner_pair(h, record, n);
                    *first = HalfEdgeId::new(2 * h);
                }
                children(h, record)
            });
            *along = [one[0], other[1], other[0], one[1]];
        }
    });
    fill_leaving(mesh, corners, sizes, child);
}

/// Writes a half-edge that leaves each old vertex and each midpoint.
#[inline(always)]
fn fill_leaving<const CLOSED: bool>(
    mesh: &HalfEdgeMesh,
    corners: &Corners<CLOSED>,
    sizes: Sizes,
    child: &mut HalfEdgeMesh,
) {
    let (old, points) = child
        .leaving
        .rows_mut()
        .split_at_mut(sizes.vertices as usize);
    let leaving = mesh.leaving_rows();
    fill(old, |v| {
        leaving[v]
            .get()
            .map(|h| HalfEdgeId::new(2 * h.index() as u32))
            .into()
    });
    let points = &mut points[(sizes.midpoints - sizes.vertices) as usize..];
    fill(points, |e| {
        // The boundary half-edge, if there is one.
        let h = 2 * e as u32;
        let outer = if corners.has_face(h + 1) { h } else { h + 1 };
        Slot::some(HalfEdgeId::new(late(outer)))
    });
}

/// Returns the half-edge of the child from the midpoint of `h` to its target.
#[inline(always)]
fn late(h: u32) -> u32 {
    2 * (h ^ 1) + 1
}

/// Returns the half-edge before `h` along a face, or `None` if the face is too large. `n` is the
/// half-edge after `h`.
#[inline(always)]
fn previous(rows: &[Half], h: u32, n: u32) -> Option<u32> {
    let mut at = n;
    for _ in 0..MAX_STEPS {
        let after = rows[at as usize].next.index() as u32;
        if after == h {
            return Some(at);
        }
        at = after;
    }
    None
}

/// Links the faces that are too large for [`previous`]; O(corners).
#[cold]
fn link_large_faces(mesh: &HalfEdgeMesh, child: &mut HalfEdgeMesh, inner: impl Fn(u32) -> u32) {
    let rows = child.halves.rows_mut();
    for f in mesh.faces() {
        if mesh.around_face(f).nth(MAX_STEPS + 1).is_some() {
            for h in mesh.around_face(f) {
                let [h, n] = [h, mesh.next(h)].map(|h| inner(h.index() as u32));
                rows[n as usize].next = HalfEdgeId::new(h + 1);
            }
        }
    }
}
