//! Splits of every triangle in the structure's own tables; every new row has a closed formula.
//!
//! The split in four uses the middles of the edges. The children of triangle `t` are 4t + i, which
//! keeps corner i of `t`, and 4t + 3 in the middle. Corner j of each lies towards corner j of `t`.
//! For two corners a and b of `t`, the child corner 3a + b is therefore the one towards b in the
//! child of a. 12t + 9 + i is the corner of the middle triangle on the edge that corner i faces.
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
//!
//! The split in three (√3) adds a point to each triangle and flips every old inner edge. Each
//! corner c of `t` makes the child triangle c at the edge that it faces. Its vertices are the first
//! end a of that edge, the point p′ of the triangle across, and the point p of `t`. On a boundary,
//! the other end b replaces p′. If the boundary edge is cut in three, its triangles are c, x and
//! x + 1, with x = 3F + 2k for the k-th boundary edge of a mesh of F triangles.
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
//! Here o is opposite(c), o₋ is opposite(prev(c)), and x₋ is the x of the edge that prev(c) faces.
//! In the child, corner(v) is 3 prev(corner(v)), and the corner of the point of `t` is 9t + 2.

use sixfold_core::{
    CHUNK_ROWS, Counts, FaceId, MeshQuery, NoHoles, Point, Ranks, Refine, RefineError, RowId, Slot,
    Split, Table, VertexId, all_rows, check_split, for_each_chunk, map_chunks, row,
};

use crate::CornerTable;
use crate::mesh::{CornerId, EdgeCorner, edge_between};

/// Number of corners in one chunk: whole triangles.
const CHUNK_CORNERS: usize = 3 * CHUNK_ROWS;

/// Numbers of the edges: which corners name an edge, and which face another triangle.
///
/// It stores no table by corner: the number of an edge is the rank of the corner that names it.
#[derive(Clone, Debug, Default)]
pub struct EdgeNumbers {
    /// The corners that name an edge.
    names: Ranks,
    /// The corners that have an opposite: all of them if the mesh is closed.
    inner: Ranks,
}

impl EdgeNumbers {
    /// Returns the number of the edge that `c` faces, with `across` opposite to it.
    #[inline(always)]
    fn number(&self, c: CornerId, across: Slot<CornerId>) -> u32 {
        self.names.rank(edge_between(c, across).index()) as u32
    }

    /// Returns the number, among the boundary edges, of the boundary edge that `c` faces.
    #[inline]
    fn boundary_number(&self, c: CornerId) -> u32 {
        c.row() - self.inner.rank(c.index()) as u32
    }
}

impl Refine for CornerTable {
    const SPLITS: &'static [Split] = &[Split::Triangles, Split::Sqrt3 { trisect: true }];

    type EdgeNumbers = EdgeNumbers;

    fn empty() -> Self {
        Self {
            positions: Table::new("positions", "vertex", Vec::new()),
            corner: Table::new("corner", "vertex", Vec::new()),
            vertex: Table::new("vertex", "corner", Vec::new()),
            opposite: Table::new("opposite", "corner", Vec::new()),
            vertex_holes: NoHoles,
            face_holes: NoHoles,
        }
    }

    /// O(corners).
    fn number_edges(&self, numbers: &mut EdgeNumbers) {
        let opposite = self.opposite_corners();
        numbers.names.fill_by_row(opposite, |c, &across| {
            [names_edge(CornerId::new(c as u32), across)]
        });
        let inner = |across: &Slot<CornerId>| [*across != Slot::NONE];
        numbers.inner.fill(opposite, inner);
    }

    fn edge_chunks(&self, numbers: &EdgeNumbers) -> Vec<usize> {
        let starts = (0..self.corner_count()).step_by(CHUNK_CORNERS);
        let starts = starts.map(|corner| numbers.names.rank(corner));
        starts.chain([numbers.names.members()]).collect()
    }

    #[inline]
    fn edges_of_chunk(&self, _: &EdgeNumbers, chunk: usize) -> impl Iterator<Item = EdgeCorner> {
        let end = self.corner_count().min((chunk + 1) * CHUNK_CORNERS);
        let corners = (row(chunk * CHUNK_CORNERS)..row(end)).map(CornerId::new);
        corners.filter_map(|c| {
            let edge = self.edge(c);
            (edge.corner() == c).then_some(edge)
        })
    }

    /// Returns the rank of the corner that names the edge; O(1).
    #[inline]
    fn edge_number(&self, numbers: &EdgeNumbers, e: EdgeCorner) -> usize {
        numbers.names.rank(e.index())
    }

    /// O(corners + vertices).
    fn split_into(
        &self,
        split: Split,
        numbers: &EdgeNumbers,
        child: &mut Self,
    ) -> Result<(), RefineError> {
        let corners = self.corner_count();
        assert_eq!(
            numbers.names.items(),
            corners,
            "the edge numbers belong to another mesh"
        );
        let counts = Counts {
            vertices: self.positions.len(),
            edges: numbers.names.members(),
            faces: self.face_count(),
            corners: self.corner_count(),
            uniform: true,
        };
        let grown = check_split::<Self>(split, &counts, numbers.inner.missing())?;
        self.check_double_edges()?;
        child.positions.resize(grown.vertices, Point::ZERO);
        child.corner.resize(grown.vertices, Slot::NONE);
        child.vertex.resize(grown.corners, VertexId::new(0));
        child.opposite.resize(grown.corners, Slot::NONE);
        match split {
            Split::Sqrt3 { trisect } => Sqrt3 {
                mesh: self,
                numbers,
                trisect,
            }
            .fill(child),
            _ => self.split_in_four(numbers, child),
        }
        Ok(())
    }

    /// O(1); O(log corners) for the triangles that the √3 split cuts off boundary edges.
    fn parent(&self, numbers: &EdgeNumbers, split: Split, child: FaceId) -> FaceId {
        match (split, child.index().checked_sub(self.corner_count())) {
            (Split::Sqrt3 { .. }, Some(cut)) => {
                let c = numbers.inner.select_missing(cut / 2);
                FaceId::new(row(c / 3))
            }
            (Split::Sqrt3 { .. }, None) => FaceId::new(child.row() / 3),
            _ => FaceId::new(child.row() / 4),
        }
    }

    fn positions_mut(&mut self) -> &mut [Point] {
        self.positions.rows_mut()
    }

    fn position_rows(&self) -> &[Point] {
        self.positions.rows()
    }
}

impl CornerTable {
    /// Returns an error if two triangles have the same edges. Two triangles cannot share exactly
    /// two edges, because their third edges would have the same ends. It is therefore sufficient
    /// to look across two sides of each triangle.
    fn check_double_edges(&self) -> Result<(), RefineError> {
        let across = |o: Slot<CornerId>| o.get().map(CornerId::triangle);
        let has_double_edge =
            |&[a, b, _]: &[Slot<CornerId>; 3]| a != Slot::NONE && across(a) == across(b);
        let opposites = self.opposite_corners().as_chunks().0;
        if all_rows(opposites, |triangle| !has_double_edge(triangle)) {
            return Ok(());
        }
        let mut doubled = self
            .faces()
            .zip(opposites)
            .filter(|(_, t)| has_double_edge(t));
        match doubled.find_map(|(first, t)| Some((first, across(t[0])?))) {
            Some((first, second)) => Err(RefineError::DoubleEdge { first, second }),
            None => Ok(()),
        }
    }
}

/// The split of every triangle into four.
impl CornerTable {
    fn split_in_four(&self, numbers: &EdgeNumbers, child: &mut Self) {
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
                    // Not every corner names an edge, in an unpredictable order. To avoid a branch,
                    // every corner writes; the next one overwrites the row of a corner that names
                    // no edge.
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

/// Returns whether `c`, with `across` opposite to it, is the corner that names the edge.
#[inline(always)]
fn names_edge(c: CornerId, across: Slot<CornerId>) -> bool {
    // An empty slot is greater than every corner.
    Slot::some(c) < across
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

/// Returns the opposites of the corners of the four children; `first` is the first of the corners.
#[inline(always)]
fn opposites_of_four(first: u32, across: [Slot<CornerId>; 3]) -> [Slot<CornerId>; 12] {
    let own = |i: u32| Slot::some(CornerId::new(first + i));
    // By corner b: the opposite in the triangle of next(b), and in the triangle of prev(b).
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

/// The split of every triangle into three, with every old inner edge flipped.
#[derive(Clone, Copy)]
struct Sqrt3<'a> {
    mesh: &'a CornerTable,
    numbers: &'a EdgeNumbers,
    trisect: bool,
}

impl Sqrt3<'_> {
    /// Overwrites the tables of `child`, which already have their final lengths.
    fn fill(self, child: &mut CornerTable) {
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

    /// Returns the vertices of the child triangle `c`.
    #[inline(always)]
    fn vertices(self, c: CornerId) -> [VertexId; 3] {
        let far = match self.mesh.opposite(c) {
            Some(across) => self.point(across),
            None if self.trisect => self.cuts(c)[0],
            None => self.mesh.vertex(c.prev()),
        };
        [self.mesh.vertex(c.next()), far, self.point(c)]
    }

    /// Returns the opposites of the corners of the child triangle `c`.
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

    /// Returns the two points that cut the boundary edge that `c` faces, in the order of the side.
    fn cuts(self, c: CornerId) -> [VertexId; 2] {
        let points = self.mesh.positions.len() + self.mesh.face_count();
        let first = points as u32 + 2 * self.numbers.boundary_number(c);
        [first, first + 1].map(VertexId::new)
    }

    /// Returns one of the six corners in the two pieces at the boundary edge that `c` faces.
    fn cut(self, c: CornerId, corner: u32) -> Slot<CornerId> {
        self.cut_corner(6 * self.numbers.boundary_number(c) + corner)
    }

    /// Returns one of the corners in all pieces.
    fn cut_corner(self, corner: u32) -> Slot<CornerId> {
        Slot::some(CornerId::new(3 * self.mesh.corner_count() as u32 + corner))
    }
}

/// Returns corner `i` of the child triangle `c` of a mesh split in three.
#[inline(always)]
fn child_corner(c: CornerId, i: u32) -> Slot<CornerId> {
    Slot::some(CornerId::new(3 * c.row() + i))
}

#[cfg(test)]
mod tests {
    use sixfold_core::{PolygonMesh, Representation};

    use super::*;

    /// Splits two triangles that share an edge: c1 and c5 are opposite. The five edges are those
    /// that c0, c1, c2, c3 and c4 face; all except the second are boundary edges.
    fn split(split: Split) -> CornerTable {
        let positions = [0.0, 1.0, 2.0, 3.0].map(Point::splat);
        let polygons = PolygonMesh::new(positions, [[0, 1, 2], [0, 2, 3]]).expect("valid");
        let mesh = CornerTable::from_polygons(&polygons).expect("manifold");
        let mut numbers = EdgeNumbers::default();
        mesh.number_edges(&mut numbers);
        let mut child = CornerTable::empty();
        let done = mesh.split_into(split, &numbers, &mut child);
        done.expect("triangles");
        child
    }

    const NONE: u32 = u32::MAX;

    fn rows(slots: &[Slot<CornerId>]) -> Vec<u32> {
        let rows = slots.iter().map(|c| c.get().map_or(NONE, RowId::row));
        rows.collect()
    }

    #[test]
    fn splitting_two_triangles_in_four_gives_the_expected_tables() {
        let child = split(Split::Triangles);
        let vertices = [
            [0, 6, 5, 6, 1, 4, 5, 4, 2, 4, 5, 6],
            [0, 5, 8, 5, 2, 7, 8, 7, 3, 7, 8, 5],
        ];
        let got = child.corner_vertices().iter().map(|v| v.row());
        assert!(got.eq(vertices.into_iter().flatten()));
        let opposites = [
            [9, 14, NONE, NONE, 10, NONE, NONE, 17, 11, 0, 4, 8],
            [21, NONE, 1, NONE, 22, 7, NONE, NONE, 23, 12, 16, 20],
        ];
        assert_eq!(rows(child.opposite_corners()), opposites.as_flattened());
        assert_eq!(
            rows(child.vertex_corners()),
            [0, 4, 16, 20, 7, 2, 3, 19, 14]
        );
    }

    #[test]
    fn splitting_two_triangles_in_three_gives_the_expected_tables() {
        // v4 and v5 are the points of the triangles, v6 to v13 those of the boundary edges.
        let child = split(Split::Sqrt3 { trisect: true });
        let vertices = [
            [1, 6, 4],
            [2, 5, 4],
            [0, 8, 4],
            [2, 10, 5],
            [3, 12, 5],
            [0, 4, 5],
            [6, 7, 4],
            [7, 2, 4],
            [8, 9, 4],
            [9, 1, 4],
            [10, 11, 5],
            [11, 3, 5],
            [12, 13, 5],
            [13, 0, 5],
        ];
        let got = child.corner_vertices().iter().map(|v| v.row());
        assert!(got.eq(vertices.into_iter().flatten()));
        let opposites = [
            [19, 27, NONE],
            [15, 21, 10],
            [25, 17, NONE],
            [31, 5, NONE],
            [37, 33, NONE],
            [3, 39, 7],
            [22, 0, NONE],
            [4, 18, NONE],
            [28, 6, NONE],
            [1, 24, NONE],
            [34, 9, NONE],
            [13, 30, NONE],
            [40, 12, NONE],
            [16, 36, NONE],
        ];
        assert_eq!(rows(child.opposite_corners()), opposites.as_flattened());
        // v0 keeps the triangle of c2, v1 that of c0, v2 that of c3, and v3 that of c4.
        let corners = [6, 0, 9, 12, 2, 11, 18, 21, 24, 27, 30, 33, 36, 39];
        assert_eq!(rows(child.vertex_corners()), corners);
        let whole = split(Split::Sqrt3 { trisect: false });
        let opposites = [
            [4, 6, NONE],
            [15, 0, 10],
            [1, 17, NONE],
            [13, 5, NONE],
            [16, 9, NONE],
            [3, 12, 7],
        ];
        assert_eq!(rows(whole.opposite_corners()), opposites.as_flattened());
        assert_eq!(rows(whole.vertex_corners()), [6, 0, 9, 12, 2, 11]);
    }
}
