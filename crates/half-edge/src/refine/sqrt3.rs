//! Triangles split at face points, with their edges flipped.
//!
//! Half-edge `h` runs from vertex `a` to vertex `b` along face `f`. `p` is the half-edge before
//! `h`, and `n` the half-edge after `h`. The twin `t` of `h` has face `g`. In the refined mesh (the
//! child), row `h` runs from the face point g to the face point f. The corner of `h` adds one edge:
//! the spoke s(h) from `a` to f, with its twin r(h).
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
//! The mesh before the split (the parent) has E edges and C corners. `#h` is the number of the
//! corner of `h`:
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
//! Boundary half-edges do not change, unless boundary edges are cut into three edges. If boundary
//! edges are cut, the `j`-th boundary edge gets the points q and q', and eight rows from y = 2(E +
//! C) + 8j on. Two more triangles lie beside #h (q' b f): C + 2j (a q f) and C + 2j + 1 (q q' f).
//! The boundary half-edge keeps its row and runs from `b` to q'. Half-edge y + 1 runs from q' to q,
//! and y + 3 from q to `a`.

use sixfold_core::{FaceId, MeshQuery, Slot};

use super::{Corners, fill, for_each_edge_chunk, half};
use crate::HalfEdgeMesh;
use crate::mesh::{Half, HalfEdgeId};

/// Splits every triangle into three and flips the inner edges. If `TRISECT`, also cuts each
/// boundary edge in three.
pub(super) fn sqrt3<const CLOSED: bool, const TRISECT: bool>(
    mesh: &HalfEdgeMesh,
    corners: &Corners<CLOSED>,
    child: &mut HalfEdgeMesh,
) {
    let [vertices, faces, edges] =
        [mesh.vertex_count(), mesh.face_count(), mesh.edge_count()].map(|n| n as u32);
    let split = Sqrt3::<CLOSED, TRISECT> {
        rows: mesh.half_edge_rows(),
        corners,
        vertices,
        faces,
        edges,
    };
    split.fill_edges(child);
    split.fill_leaving(mesh, child);
    if !CLOSED && TRISECT {
        split.fill_cuts(child);
    }
}

/// The parent mesh and the formulas of the child.
#[derive(Clone, Copy)]
struct Sqrt3<'a, const CLOSED: bool, const TRISECT: bool> {
    rows: &'a [Half],
    corners: &'a Corners<'a, CLOSED>,
    vertices: u32,
    faces: u32,
    edges: u32,
}

/// The tables of the child.
impl<const CLOSED: bool, const TRISECT: bool> Sqrt3<'_, CLOSED, TRISECT> {
    /// Computes the rows of the old half-edges and of the spokes, and `first` of each face.
    fn fill_edges(self, child: &mut HalfEdgeMesh) {
        for_each_edge_chunk(self.edges as usize, self.corners, 2, child, |chunk| {
            // The compiler keeps a local copy in registers, because no write to the tables can
            // change the copy.
            let split = self;
            let pairs = &split.rows.as_chunks::<2>().0
                [chunk.edges.start as usize..chunk.edges.end as usize];
            let inner = chunk.inner.as_chunks_mut::<2>().0;
            let mut inner = inner.iter_mut().zip(chunk.first.iter_mut());
            let along = chunk.along.as_chunks_mut::<2>().0;
            for ((e, pair), along) in chunk.edges.clone().zip(pairs).zip(along) {
                *along = [0, 1].map(|side| {
                    let h = 2 * e + side;
                    let (record, twin) = (&pair[side as usize], &pair[side as usize ^ 1]);
                    if !split.corners.has_face(h) {
                        return split.boundary_half(h, record);
                    }
                    let (flipped, leaving) = split.flipped_and_leaving(h, record, twin);
                    let arriving = split.arriving_spoke(record);
                    if let Some((inner, first)) = inner.next() {
                        *inner = [arriving, leaving];
                        *first = HalfEdgeId::new(h);
                    }
                    flipped
                });
            }
        });
    }

    fn fill_leaving(self, mesh: &HalfEdgeMesh, child: &mut HalfEdgeMesh) {
        let (old, points) = child
            .leaving
            .rows_mut()
            .split_at_mut(self.vertices as usize);
        let leaving = mesh.leaving_rows();
        fill(old, |v| {
            let spoke = |h: HalfEdgeId| {
                let h = h.index() as u32;
                HalfEdgeId::new(if self.corners.has_face(h) {
                    self.spoke(h)
                } else {
                    h
                })
            };
            leaving[v].get().map(spoke).into()
        });
        let first = mesh.first_rows();
        fill(&mut points[..first.len()], |f| {
            Slot::some(HalfEdgeId::new(self.spoke(first[f].index() as u32) + 1))
        });
    }

    /// Computes the points, triangles and half-edges at the cut boundary edges.
    fn fill_cuts(self, child: &mut HalfEdgeMesh) {
        let new_points = &mut child.leaving.rows_mut()[self.new_point(0) as usize..];
        fill(new_points.as_chunks_mut().0, |j| {
            let y = self.new_half(j as u32);
            [y + 3, y + 1].map(|h| Slot::some(HalfEdgeId::new(h)))
        });
        let new_first = &mut child.first.rows_mut()[self.new_face(0) as usize..];
        fill(new_first.as_chunks_mut().0, |j| {
            let y = self.new_half(j as u32);
            [y + 2, y].map(HalfEdgeId::new)
        });
        let new_halves = &mut child.halves.rows_mut()[self.new_half(0) as usize..];
        fill(new_halves.as_chunks_mut().0, |j| {
            let b = self.corners.0.select_missing(j) as u32;
            self.cut_halves(b, j as u32)
        });
    }
}

/// The rows of half-edges, by the table above.
impl<const CLOSED: bool, const TRISECT: bool> Sqrt3<'_, CLOSED, TRISECT> {
    /// Returns the row of the boundary half-edge `h`. `record` is its row in the parent.
    #[inline(always)]
    fn boundary_half(self, h: u32, record: &Half) -> Half {
        let next = if TRISECT {
            self.new_half(self.boundary_rank(h)) + 1
        } else {
            record.next.index() as u32
        };
        half(next, record.origin.index() as u32, Slot::NONE)
    }

    /// Returns the row of s(h). `record` is the row of `h` in the parent.
    #[inline(always)]
    fn arriving_spoke(self, record: &Half) -> Half {
        let origin = record.origin.index() as u32;
        let p = self.next(record.next.index() as u32);
        let corners = self.corners;
        match (corners.has_face(p ^ 1), TRISECT) {
            (true, _) => half(p ^ 1, origin, corners.face(p ^ 1)),
            (false, false) => half(self.spoke(p) + 1, origin, corners.face(p)),
            (false, true) => {
                let next = self.new_half(self.boundary_rank(p ^ 1)) + 7;
                half(next, origin, corners.face(p))
            }
        }
    }

    /// Returns the rows of `h` and of r(h). `record` is the row of `h` in the parent, and `twin`
    /// the row of its twin.
    #[inline(always)]
    fn flipped_and_leaving(self, h: u32, record: &Half, twin: &Half) -> (Half, Half) {
        let n = record.next.index() as u32;
        let origin = record.origin.index() as u32;
        let (face, centre) = (self.corners.face(h), self.face_point(record.face));
        match (self.corners.has_face(h ^ 1), TRISECT) {
            (true, _) => (
                half(self.spoke(h) + 1, self.face_point(twin.face), face),
                half(self.spoke(twin.next.index() as u32), centre, face),
            ),
            (false, false) => (half(self.spoke(n), origin, face), half(h, centre, face)),
            (false, true) => {
                let j = self.boundary_rank(h ^ 1);
                (
                    half(self.spoke(n), self.new_point(j) + 1, face),
                    half(self.new_half(j) + 2, centre, face_slot(self.new_face(j))),
                )
            }
        }
    }

    /// Returns the rows from y to y + 7 at the `j`-th boundary edge. `b` is the boundary half-edge.
    #[inline(always)]
    fn cut_halves(self, b: u32, j: u32) -> [Half; 8] {
        let h = b ^ 1;
        let (y, near, far) = (self.new_half(j), self.new_point(j), self.new_point(j) + 1);
        let centre = self.face_point(self.rows[h as usize].face);
        let a = self.rows[h as usize].origin.index() as u32;
        let [first, second] = [0, 1].map(|i| face_slot(self.new_face(j) + i));
        let third = self.corners.face(h);
        [
            half(y + 6, near, second),
            half(y + 3, far, Slot::NONE),
            half(y + 4, a, first),
            half(self.next(b), near, Slot::NONE),
            half(self.spoke(h) + 1, near, first),
            half(y, centre, second),
            half(y + 5, far, second),
            half(h, centre, third),
        ]
    }
}

/// The numbers of elements.
impl<const CLOSED: bool, const TRISECT: bool> Sqrt3<'_, CLOSED, TRISECT> {
    #[inline(always)]
    fn next(self, h: u32) -> u32 {
        self.rows[h as usize].next.index() as u32
    }

    /// Returns the number of s(h).
    #[inline(always)]
    fn spoke(self, h: u32) -> u32 {
        2 * (self.edges + self.corners.number(h))
    }

    /// Returns the point of face `f`; any number if `f` is empty.
    #[inline(always)]
    fn face_point(self, f: Slot<FaceId>) -> u32 {
        self.vertices + f.get().map_or(0, |f| f.index() as u32)
    }

    /// Returns the number of boundary half-edges before `b`.
    #[inline(always)]
    fn boundary_rank(self, b: u32) -> u32 {
        b - self.corners.number(b)
    }

    /// Returns y at the `j`-th boundary edge.
    #[inline(always)]
    fn new_half(self, j: u32) -> u32 {
        2 * (self.edges + 3 * self.faces) + 8 * j
    }

    /// Returns q at the `j`-th boundary edge.
    #[inline(always)]
    fn new_point(self, j: u32) -> u32 {
        self.vertices + self.faces + 2 * j
    }

    /// Returns the first new triangle at the `j`-th boundary edge.
    #[inline(always)]
    fn new_face(self, j: u32) -> u32 {
        3 * self.faces + 2 * j
    }
}

#[inline(always)]
fn face_slot(f: u32) -> Slot<FaceId> {
    Slot::some(FaceId::new(f))
}
