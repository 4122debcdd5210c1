//! Triangles split in four at the middles of their edges.
//!
//! The children of triangle `t` are 4t, 4t + 1, 4t + 2 and 4t + 3. Child 4t + i keeps corner i of
//! `t`; child 4t + 3 is in the middle. Corner j of each child lies towards corner j of `t`. For two
//! corners a and b of `t`, corner 3a + b is the corner of the child of a that lies towards b.
//! Corner 12t + 9 + i is the corner of the middle triangle on the edge that corner i of `t` faces.
//!
//! ```text
//!             b             vertex(3a + a)      vertex(a)
//!            ╱ ╲            vertex(3a + b)      the middle of the edge that c faces
//!           ╱3b+b           vertex(12t + 9 + i) the middle of the edge that corner i faces
//!          ╱     ╲
//!       3b+c──────3b+a      opposite(3a + a)    12t + 9 + i if a is corner i, and vice versa
//!        ╱ ╲     ╱ ╲        opposite(3a + b)    3a′ + b′, if b′ is opposite(b) and a′ is the
//!       ╱3c+b╲ ╱3a+b╲                           corner at the vertex of a there: prev(b′) if a
//!      ╱     ╱ ╲     ╲                          is next(b), else next(b′)
//!     c───3c+a──3a+c──a
//!                           corner(v)           4 corner(v), which is 3a + a
//!                           corner(middle)      3 prev(c) + next(c), if c faces the edge
//! ```

use sixfold_core::{CHUNK_ROWS, Refine, RowId, Slot, VertexId, for_each_chunk, map_chunks};

use super::{CHUNK_CORNERS, EdgeNumbers, names_edge};
use crate::CornerTable;
use crate::mesh::CornerId;

impl CornerTable {
    /// Splits every triangle into four. Overwrites the tables of `child`, which already have their
    /// final lengths.
    pub(super) fn split_in_four(&self, numbers: &EdgeNumbers, child: &mut Self) {
        let count = self.positions.len();
        let middle = |c, across| VertexId::new(count as u32 + numbers.number(c, across));
        let four = 12 * CHUNK_ROWS;
        for_each_chunk(child.vertex.rows_mut(), four, |first, rows| {
            let vertices = triangles(self.corner_vertices(), first / 4);
            let opposites = triangles(self.opposite_corners(), first / 4);
            let mut c = first as u32 / 4;
            for ((&v, &across), rows) in vertices.zip(opposites).zip(rows.as_chunks_mut().0) {
                let m = [0, 1, 2].map(|i| middle(CornerId::new(c + i), across[i as usize]));
                *rows = [
                    v[0], m[2], m[1], m[2], v[1], m[0], m[1], m[0], v[2], m[0], m[1], m[2],
                ];
                c += 3;
            }
        });
        for_each_chunk(child.opposite.rows_mut(), four, |first, rows| {
            let opposites = triangles(self.opposite_corners(), first / 4);
            let mut c = first as u32;
            for (&across, rows) in opposites.zip(rows.as_chunks_mut().0) {
                *rows = opposites_of_four(c, across);
                c += 12;
            }
        });
        let (old, new) = child.corner.rows_mut().split_at_mut(count);
        for_each_chunk(old, CHUNK_ROWS, |first, corners| {
            for (corner, parent) in corners.iter_mut().zip(&self.vertex_corners()[first..]) {
                let kept = |c: CornerId| CornerId::new(4 * c.row());
                *corner = Slot::from(parent.get().map(kept));
            }
        });
        map_chunks(new, &self.edge_chunks(numbers), |chunk, _, corners| {
            let mut first = (chunk * CHUNK_CORNERS) as u32;
            let mut edge = 0;
            let opposites = triangles(self.opposite_corners(), chunk * CHUNK_CORNERS);
            for across in opposites.take(CHUNK_ROWS) {
                let [a, b, c] = [first, first + 1, first + 2].map(CornerId::new);
                let at_middles = [towards(c, b), towards(a, c), towards(b, a)];
                for ((corner, &across), middle) in [a, b, c].into_iter().zip(across).zip(at_middles)
                {
                    // To avoid an unpredictable branch, every corner writes a row. If a corner
                    // names no edge, the next corner overwrites this row.
                    if let Some(row) = corners.get_mut(edge) {
                        *row = Slot::some(middle);
                    }
                    edge += usize::from(names_edge(corner, across));
                }
                first += 3;
            }
        });
    }
}

/// Iterates over the three rows of each triangle, from the triangle of corner `first`.
fn triangles<T>(rows: &[T], first: usize) -> std::slice::Iter<'_, [T; 3]> {
    rows[first..].as_chunks().0.iter()
}

/// Returns the corner 3a + b of a mesh split in four.
#[inline(always)]
fn towards(a: CornerId, b: CornerId) -> CornerId {
    CornerId::new(3 * a.row() + b.row())
}

/// Returns the opposites of the corners of the four children. `first` is the first of these
/// corners.
#[inline(always)]
fn opposites_of_four(first: u32, across: [Slot<CornerId>; 3]) -> [Slot<CornerId>; 12] {
    let own = |i: u32| Slot::some(CornerId::new(first + i));
    // For each corner b, the opposites in the triangles of next(b) and of prev(b).
    let after = across.map(|o| Slot::from(o.get().map(|o| towards(o.prev(), o))));
    let before = across.map(|o| Slot::from(o.get().map(|o| towards(o.next(), o))));
    [
        [own(9), before[1], after[2]],
        [after[0], own(10), before[2]],
        [before[0], after[1], own(11)],
        [own(0), own(4), own(8)],
    ]
    .as_flattened()
    .try_into()
    .expect("twelve")
}
