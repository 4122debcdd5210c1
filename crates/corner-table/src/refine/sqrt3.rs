//! Triangles split in three at a new point each, with their inner edges flipped (√3).
//!
//! Each corner c of triangle `t` makes the child triangle c. The vertices of this child are an end
//! a of the edge that c faces, the point p′ of the triangle across, and the point p of `t`. If the
//! edge is a boundary edge, the other end b replaces p′. If the boundary edge is cut in three, the
//! three triangles at the edge are c, x and x + 1, with x = 3F + 2k for the k-th boundary edge of a
//! mesh of F triangles.
//!
//! ```text
//!     p ─────── b           inner edge                boundary edge     cut: c      x       x + 1
//!     │╲   c   ╱   vertex   a, p′, p                  a, b, p           a, m, p m, m′, p m′, b, p
//!     │ ╲     ╱    opposite of the corners 3c, 3c + 1 and 3c + 2:
//!     │  ╲   ╱            0 3 o                       3 next(c) + 1     3x + 1  3x + 4  3 next(c) + 1
//!     │ c ╲ ╱             1 across p–a, in the triangle of prev(c): 3 o₋ + 2,
//!     a ─── p′              3 prev(c) or 3x₋ + 3                                3c      3x
//!                         2 3 next(o) + 1             none              none    none    none
//! ```
//!
//! Here o is opposite(c) and o₋ is opposite(prev(c)). x₋ is the x of the edge that prev(c) faces.
//! In the child, corner(v) is 3 prev(corner(v)). The corner of the point of `t` is 9t + 2.

use sixfold_core::{CHUNK_ROWS, MeshQuery, RowId, Slot, VertexId, for_each_chunk, row};

use super::EdgeNumbers;
use crate::CornerTable;
use crate::mesh::CornerId;

/// The split of every triangle into three, with flipped inner edges.
#[derive(Clone, Copy)]
pub(super) struct Sqrt3<'a> {
    pub(super) mesh: &'a CornerTable,
    pub(super) numbers: &'a EdgeNumbers,
    pub(super) trisect: bool,
}

impl Sqrt3<'_> {
    /// Overwrites the tables of `child`, which already have their final lengths.
    pub(super) fn fill(self, child: &mut CornerTable) {
        let split = 3 * self.mesh.corner_count();
        let (vertex, cut_vertex) = child.vertex.rows_mut().split_at_mut(split);
        let (opposite, cut_opposite) = child.opposite.rows_mut().split_at_mut(split);
        for_each_chunk(vertex, 9 * CHUNK_ROWS, |first, rows| {
            for (c, rows) in (first as u32 / 3..).zip(rows.as_chunks_mut().0) {
                *rows = self.vertices(CornerId::new(c));
            }
        });
        for_each_chunk(opposite, 9 * CHUNK_ROWS, |first, rows| {
            for (c, rows) in (first as u32 / 3..).zip(rows.as_chunks_mut().0) {
                *rows = self.opposites(CornerId::new(c));
            }
        });
        for_each_chunk(cut_vertex, 6 * CHUNK_ROWS, |first, rows| {
            for (k, rows) in (first / 6..).zip(rows.as_chunks_mut().0) {
                let c = self.boundary_corner(k);
                let [m, n] = self.cuts(c);
                *rows = [
                    m,
                    n,
                    self.point(c),
                    n,
                    self.mesh.vertex(c.prev()),
                    self.point(c),
                ];
            }
        });
        for_each_chunk(cut_opposite, 6 * CHUNK_ROWS, |first, rows| {
            let pieces = rows.as_chunks_mut().0.as_chunks_mut().0;
            for (k, rows) in (first / 6..).zip(pieces) {
                let c = self.boundary_corner(k);
                let first = [self.cut(c, 4), child_corner(c, 0), Slot::NONE];
                let second = [child_corner(c.next(), 1), self.cut(c, 0), Slot::NONE];
                *rows = [first, second];
            }
        });
        self.fill_corners(child.corner.rows_mut());
    }

    fn fill_corners(self, child: &mut [Slot<CornerId>]) {
        let (old, new) = child.split_at_mut(self.mesh.positions.len());
        let (of_faces, of_cuts) = new.split_at_mut(self.mesh.face_count());
        for_each_chunk(old, CHUNK_ROWS, |first, corners| {
            for (corner, parent) in corners.iter_mut().zip(&self.mesh.vertex_corners()[first..]) {
                *corner = parent
                    .get()
                    .map_or(Slot::NONE, |c| child_corner(c.prev(), 0));
            }
        });
        for_each_chunk(of_faces, CHUNK_ROWS, |first, corners| {
            for (t, corner) in (first as u32..).zip(corners) {
                *corner = child_corner(CornerId::new(3 * t), 2);
            }
        });
        for_each_chunk(of_cuts, 2 * CHUNK_ROWS, |first, corners| {
            for (cut, corner) in (first as u32..).zip(corners) {
                *corner = self.cut_corner(3 * cut);
            }
        });
    }

    #[inline(always)]
    fn vertices(self, c: CornerId) -> [VertexId; 3] {
        let far = match self.mesh.opposite(c) {
            Some(across) => self.point(across),
            None if self.trisect => self.cuts(c)[0],
            None => self.mesh.vertex(c.prev()),
        };
        [self.mesh.vertex(c.next()), far, self.point(c)]
    }

    #[inline(always)]
    fn opposites(self, c: CornerId) -> [Slot<CornerId>; 3] {
        let [own, before] = [c, c.prev()].map(|c| self.mesh.opposite(c));
        let ahead = match own {
            Some(across) => child_corner(across, 0),
            None if self.trisect => self.cut(c, 1),
            None => child_corner(c.next(), 1),
        };
        let behind = match before {
            Some(across) => child_corner(across, 2),
            None if self.trisect => self.cut(c.prev(), 3),
            None => child_corner(c.prev(), 0),
        };
        let across = own.map_or(Slot::NONE, |across| child_corner(across.next(), 1));
        [ahead, behind, across]
    }

    /// Returns the new point of the triangle of `c`.
    #[inline(always)]
    fn point(self, c: CornerId) -> VertexId {
        VertexId::new(self.mesh.positions.len() as u32 + c.triangle().row())
    }

    /// Returns the corner that faces the `k`-th boundary edge.
    fn boundary_corner(self, k: usize) -> CornerId {
        CornerId::new(row(self.numbers.inner.select_missing(k)))
    }

    /// Returns the two points on the boundary edge that `c` faces, in the order of the side.
    fn cuts(self, c: CornerId) -> [VertexId; 2] {
        let points = self.mesh.positions.len() + self.mesh.face_count();
        let first = points as u32 + 2 * self.numbers.boundary_number(c);
        [first, first + 1].map(VertexId::new)
    }

    /// Returns corner 0 to 5 of the two new triangles at the boundary edge that `c` faces.
    fn cut(self, c: CornerId, corner: u32) -> Slot<CornerId> {
        self.cut_corner(6 * self.numbers.boundary_number(c) + corner)
    }

    /// Returns corner `corner` of all new triangles at boundary edges.
    fn cut_corner(self, corner: u32) -> Slot<CornerId> {
        Slot::some(CornerId::new(3 * self.mesh.corner_count() as u32 + corner))
    }
}

/// Returns corner `i` of the child triangle `c` of a mesh split in three.
#[inline(always)]
fn child_corner(c: CornerId, i: u32) -> Slot<CornerId> {
    Slot::some(CornerId::new(3 * c.row() + i))
}
