//! The tables, their invariants, and the corner operators.

use sixfold_core::{
    Compact, Editing, FaceId, HoleSet, Point, Probe, Slot, Table, Untraced, VertexId, row_id,
};

row_id! {
    /// The handle of one corner, printed as `c7`. Triangle `t` has the corners `3t`, `3t + 1` and
    /// `3t + 2`.
    pub struct CornerId, "c"
}

row_id! {
    /// The handle of one edge, printed as `e7`: the lower of the two corners that face the edge.
    ///
    /// A map of values for edges has one row per corner; in a closed mesh, half of the rows are
    /// unused.
    pub struct EdgeCorner, "e"
}

impl CornerId {
    /// Returns the next corner in its triangle, counter-clockwise.
    ///
    /// Every step around a vertex waits for the result of `next`. So `next` uses a comparison and
    /// one multiplication instead of the two divisions in `3 * (c / 3) + (c + 1) % 3`.
    #[inline]
    pub const fn next(self) -> Self {
        let c = self.index() as u32;
        Self::new(if c % 3 == 2 { c - 2 } else { c + 1 })
    }

    /// Returns the previous corner in its triangle, counter-clockwise.
    #[inline]
    pub const fn prev(self) -> Self {
        let c = self.index() as u32;
        Self::new(if c.is_multiple_of(3) { c + 2 } else { c - 1 })
    }

    /// Returns the triangle of this corner.
    #[inline]
    pub const fn triangle(self) -> FaceId {
        FaceId::new(self.index() as u32 / 3)
    }
}

impl EdgeCorner {
    /// Returns the lower of the two corners that face the edge.
    #[inline]
    pub const fn corner(self) -> CornerId {
        CornerId::new(self.index() as u32)
    }
}

/// A mesh of triangles in two arrays: the vertex and the opposite corner of each corner.
///
/// ```text
///   left(c) ─────── v ─────── right(c)      c = 3t + i is corner i of triangle t, here at v
///        \         /c\         /
///         \       /   \       /             opposite(c)  the corner across the edge that c faces
///          \     /  t  \     /              right(c)     opposite(next(c))
///           \   /       \   /               left(c)      opposite(prev(c))
///         next(c) ───── prev(c)             swing(c)     next(right(c)): at v, counter-clockwise
///              \         /                  unswing(c)   prev(left(c)): at v, clockwise
///               \       /
///              opposite(c)
/// ```
///
/// At a boundary edge, `opposite` and all operators that use `opposite` return `None`.
///
/// # Invariants
///
/// - I1  Triangle `t` has the corners `3t`, `3t + 1`, `3t + 2`, at three different vertices of the
///   mesh.
/// - I2  `opposite(opposite(c))` is `c`; `opposite(c)` is `None` if `c` faces a boundary edge.
/// - I3  `c` and `opposite(c)` face the same edge from its two sides: `vertex(next(c))` is
///   `vertex(prev(opposite(c)))`, and `vertex(prev(c))` is `vertex(next(opposite(c)))`.
/// - I4  `corner(v)` is a corner at `v`, or `None` if `v` is isolated.
/// - I5  If `v` is on a boundary, `corner(v)` is the first corner counter-clockwise, so `unswing`
///   returns `None` for this corner.
/// - I6  Repeated `swing` from `corner(v)` visits all corners at `v`, so every vertex is manifold.
/// - I7  No two edges have the same ends.
/// - I8  The corners of a deleted triangle have the vertex row `u32::MAX`, and each of these
///   corners is its own opposite. No corner of another triangle is its own opposite. A deleted
///   vertex has no corner. `face_holes` and `vertex_holes` contain exactly the rows of deleted
///   faces and vertices.
///
/// I1 to I7 apply to elements that are not deleted. A corner is the handle of the edge that it
/// faces if its opposite is `None` or has a higher row. By I8, a corner of a deleted triangle is
/// its own opposite, so it is not the handle of an edge.
///
/// # Memory
///
/// The tables use 16 bytes per vertex and 24 bytes per triangle. A large closed mesh uses 64 bytes
/// per vertex (16 words of 4 bytes). After the first deletion, the tables also use up to one bit
/// per vertex and one bit per triangle.
#[derive(Debug)]
pub struct CornerTable<E: Editing = Compact, P: Probe = Untraced> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) corner: Table<Slot<CornerId>, P>,
    pub(crate) vertex: Table<VertexId, P>,
    pub(crate) opposite: Table<Slot<CornerId>, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

sixfold_core::mesh_tables!(CornerTable {
    tables: positions, corner, vertex, opposite;
    holes: vertex_holes, face_holes;
});
sixfold_core::polygon_conversions!(CornerTable);

/// The vertex row of the corners of a deleted triangle.
pub(crate) const NO_VERTEX: VertexId = VertexId::new(u32::MAX);

/// The operators of the corner table (Rossignac et al.). Each operator takes O(1) time. An operator
/// that reads a table panics if the row does not exist. The operators do not check whether a
/// triangle was deleted: for a corner of a deleted triangle, they return the values of invariant
/// I8.
impl<P: Probe, E: Editing> CornerTable<E, P> {
    /// Returns the vertex at the corner `c`.
    #[inline]
    pub fn vertex(&self, c: CornerId) -> VertexId {
        *self.vertex.read(c.index())
    }

    /// Returns the corner across the edge that `c` faces, or `None` if the edge is a boundary edge.
    #[inline]
    pub fn opposite(&self, c: CornerId) -> Option<CornerId> {
        self.opposite.read(c.index()).get()
    }

    /// Returns the next corner in the triangle, counter-clockwise, without reading a table.
    #[inline]
    pub fn next(&self, c: CornerId) -> CornerId {
        c.next()
    }

    /// Returns the previous corner in the triangle, without reading a table.
    #[inline]
    pub fn prev(&self, c: CornerId) -> CornerId {
        c.prev()
    }

    /// Returns the triangle of the corner `c`, without reading a table.
    #[inline]
    pub fn triangle(&self, c: CornerId) -> FaceId {
        c.triangle()
    }

    /// Returns the corner across the edge from `vertex(c)` to `vertex(next(c))`, or `None` if the
    /// edge is a boundary edge.
    #[inline]
    pub fn left(&self, c: CornerId) -> Option<CornerId> {
        self.opposite(c.prev())
    }

    /// Returns the corner across the edge from `vertex(c)` to `vertex(prev(c))`, or `None` if the
    /// edge is a boundary edge.
    #[inline]
    pub fn right(&self, c: CornerId) -> Option<CornerId> {
        self.opposite(c.next())
    }

    /// Returns the next corner around the vertex of `c`, counter-clockwise, or `None` if a boundary
    /// edge comes first.
    #[inline]
    pub fn swing(&self, c: CornerId) -> Option<CornerId> {
        self.right(c).map(CornerId::next)
    }

    /// Returns the next corner around the vertex of `c`, clockwise, or `None` if a boundary edge
    /// comes first.
    #[inline]
    pub fn unswing(&self, c: CornerId) -> Option<CornerId> {
        self.left(c).map(CornerId::prev)
    }
}

/// Conversions between vertices, triangles, edges and corners. Each function panics if the row of
/// its argument does not exist.
impl<P: Probe, E: Editing> CornerTable<E, P> {
    /// Returns a corner at `v`, or `None` if `v` is isolated; O(1). If `v` is on a boundary,
    /// returns the corner at which the counter-clockwise walk around `v` starts.
    #[inline]
    pub fn corner_at(&self, v: VertexId) -> Option<CornerId> {
        let corner = self.corner.read(v.index()).get();
        if E::CAN_DELETE && corner.is_none() {
            self.expect_vertex(v);
        }
        corner
    }

    /// Returns the three corners of the triangle `t`, counter-clockwise; O(1).
    #[inline]
    pub fn corners_of(&self, t: FaceId) -> [CornerId; 3] {
        if 3 * t.index() >= self.vertex.len() || *self.vertex.read(3 * t.index()) == NO_VERTEX {
            self.no_such_triangle(t);
        }
        corners_of(t)
    }

    /// Returns the edge that the corner `c` faces; O(1).
    #[inline]
    pub fn edge(&self, c: CornerId) -> EdgeCorner {
        edge_between(c, *self.opposite.read(c.index()))
    }

    /// Returns whether the edge that `c` faces is a boundary edge; O(1).
    #[inline]
    pub fn is_boundary(&self, c: CornerId) -> bool {
        self.opposite(c).is_none()
    }

    /// Returns the number of corners: three for each triangle that was not deleted.
    #[inline]
    pub fn corner_count(&self) -> usize {
        self.vertex.len() - 3 * self.face_holes.len()
    }
}

/// Rows of a triangle or an edge. Each function panics if the element does not exist.
impl<P: Probe, E: Editing> CornerTable<E, P> {
    #[inline]
    pub(crate) fn vertices_of(&self, t: FaceId) -> [VertexId; 3] {
        let [a, b, c] = self.rows_of(&self.vertex, t);
        if E::CAN_DELETE && a == NO_VERTEX {
            self.no_such_triangle(t);
        }
        [a, b, c]
    }

    #[inline]
    pub(crate) fn opposites_of(&self, t: FaceId) -> [(CornerId, Slot<CornerId>); 3] {
        let [i, j, k] = corners_of(t);
        if E::CAN_DELETE {
            self.expect_triangle(t);
        }
        let [a, b, c] = self.rows_of(&self.opposite, t);
        [(i, a), (j, b), (k, c)]
    }

    #[inline]
    pub(crate) fn ends_of(&self, e: EdgeCorner) -> [VertexId; 2] {
        if e.index() >= self.vertex.len() {
            self.no_such_edge(e);
        }
        let [a, b] = [e.corner().next(), e.corner().prev()].map(|c| self.vertex(c));
        if E::CAN_DELETE && a == NO_VERTEX {
            self.no_such_edge(e);
        }
        [a, b]
    }

    #[inline]
    pub(crate) fn across(&self, e: EdgeCorner) -> Slot<CornerId> {
        let across = *self.opposite.read(e.index());
        if E::CAN_DELETE && across == Slot::some(e.corner()) {
            self.no_such_edge(e);
        }
        across
    }

    /// Panics if `v` was deleted.
    #[cold]
    #[inline(never)]
    pub(crate) fn expect_vertex(&self, v: VertexId) {
        if self.vertex_holes.has(v.index()) {
            self.no_such_vertex(v);
        }
    }

    #[cold]
    #[inline(never)]
    pub(crate) fn no_such_vertex(&self, v: VertexId) -> ! {
        panic!("no vertex {v}: it was deleted")
    }

    #[inline]
    fn rows_of<T: Copy>(&self, table: &Table<T, P>, t: FaceId) -> [T; 3] {
        let start = 3 * t.index();
        if start + 3 > table.len() {
            self.no_such_triangle(t);
        }
        match *table.read_range(start..start + 3) {
            [a, b, c] => [a, b, c],
            _ => unreachable!("a range of three rows"),
        }
    }

    /// Panics if `t` was deleted.
    #[inline(never)]
    fn expect_triangle(&self, t: FaceId) {
        if self.face_holes.has(t.index()) {
            self.no_such_triangle(t);
        }
    }

    #[cold]
    #[inline(never)]
    fn no_such_triangle(&self, t: FaceId) -> ! {
        let triangles = self.vertex.len() / 3;
        if t.index() < triangles {
            panic!("no face {t}: it was deleted");
        }
        panic!("no face {t}: there are {triangles} triangles")
    }

    #[cold]
    #[inline(never)]
    fn no_such_edge(&self, e: EdgeCorner) -> ! {
        let corners = self.vertex.len();
        if e.index() < corners {
            panic!("no edge {e}: the triangle of that corner was deleted");
        }
        panic!("no edge {e}: the mesh has {corners} corners")
    }
}

/// Returns the three corners of `t` without a check.
#[inline]
fn corners_of(t: FaceId) -> [CornerId; 3] {
    let c = 3 * t.index() as u32;
    [c, c + 1, c + 2].map(CornerId::new)
}

/// Returns the edge that both corners face; `across` is empty at a boundary edge.
#[inline]
pub(crate) fn edge_between(c: CornerId, across: Slot<CornerId>) -> EdgeCorner {
    let lower = Slot::some(c).min(across).get().unwrap_or(c);
    EdgeCorner::new(lower.index() as u32)
}

/// Returns the edge that `c` faces, if `c` names the edge. The corner of a deleted triangle also
/// gives an edge.
///
/// The compiler makes no branch for this order of steps; with [`names_edge`] it makes a branch. A
/// count of boundary edges in random order takes 1.4 ns per edge instead of 4 ns (20,480
/// triangles).
#[inline(always)]
pub(crate) fn named_edge(c: CornerId, across: Slot<CornerId>) -> Option<EdgeCorner> {
    let edge = edge_between(c, across);
    (edge.corner() == c).then_some(edge)
}

/// Returns whether `c` names the edge that it faces. False for a corner of a deleted triangle.
#[inline(always)]
pub(crate) fn names_edge(c: CornerId, across: Slot<CornerId>) -> bool {
    // An empty slot is greater than every corner.
    Slot::some(c) < across
}

/// The tables as they are in memory, for export and for the caller's own loops. Deleted rows (I8)
/// stay in the tables until the next call of [`compact`](sixfold_core::MeshEdit::compact).
impl<P: Probe, E: Editing> CornerTable<E, P> {
    /// Returns the position of each vertex.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// Returns one corner of each vertex (I4).
    pub fn vertex_corners(&self) -> &[Slot<CornerId>] {
        self.corner.rows()
    }

    /// Returns the vertex of each corner: three rows per triangle.
    pub fn corner_vertices(&self) -> &[VertexId] {
        self.vertex.rows()
    }

    /// Returns the opposite corner of each corner.
    pub fn opposite_corners(&self) -> &[Slot<CornerId>] {
        self.opposite.rows()
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, PolygonMesh, Representation};

    use super::*;

    fn tables() -> [CornerTable; 3] {
        let hole = sixfold_shapes::grid_with_hole(4, 4).expect("a valid size");
        [
            sixfold_shapes::icosahedron(),
            sixfold_shapes::triangle_grid(3, 2).expect("a valid size"),
            hole.triangulated().expect("small").polygons,
        ]
        .map(|polygons| CornerTable::from_polygons(&polygons).expect("manifold"))
    }

    fn corners<E: Editing>(mesh: &CornerTable<E>) -> impl Iterator<Item = CornerId> {
        (0..mesh.vertex.len() as u32).map(CornerId::new)
    }

    #[test]
    fn next_and_prev_agree_with_the_formulas_of_the_paper() {
        for c in 0..30 {
            let (id, t) = (CornerId::new(c), c / 3);
            assert_eq!(id.triangle(), FaceId::new(t));
            assert_eq!(id.next(), CornerId::new(3 * t + (c + 1) % 3));
            assert_eq!(id.prev(), id.next().next());
        }
    }

    #[test]
    fn the_operators_agree_with_each_other() {
        for mesh in tables() {
            for c in corners(&mesh) {
                let (next, prev) = (mesh.next(c), mesh.prev(c));
                assert!(mesh.corners_of(mesh.triangle(c)).contains(&c));
                assert_eq!(mesh.is_boundary(c), mesh.opposite(c).is_none());
                assert_eq!(
                    [mesh.left(c), mesh.right(c)],
                    [prev, next].map(|c| mesh.opposite(c))
                );
                if let Some(other) = mesh.opposite(c) {
                    assert_eq!(mesh.opposite(other), Some(c));
                    assert_eq!(mesh.edge(other), mesh.edge(c));
                    assert_eq!(mesh.edge(c).corner(), c.min(other));
                } else {
                    assert_eq!(mesh.edge(c).corner(), c);
                }
                if let Some(turned) = mesh.swing(c) {
                    assert_eq!(mesh.vertex(turned), mesh.vertex(c));
                    assert_eq!(mesh.vertex(mesh.next(turned)), mesh.vertex(prev));
                    assert_eq!(mesh.unswing(turned), Some(c));
                } else {
                    assert!(mesh.is_boundary(next));
                }
                assert_eq!(mesh.unswing(c).is_none(), mesh.is_boundary(prev));
            }
            let around: usize = mesh.vertices().map(|v| mesh.corners_at(v).count()).sum();
            assert_eq!(around, mesh.corner_count());
            for v in mesh.vertices() {
                assert!(mesh.corners_at(v).all(|c| mesh.vertex(c) == v));
                assert_eq!(mesh.corners_at(v).next(), mesh.corner_at(v));
            }
        }
    }

    #[test]
    fn a_tetrahedron_has_the_expected_tables() {
        // Triangle t0 lacks vertex v3, t1 lacks v2, t2 lacks v0, t3 lacks v1.
        let corners = [Point::ZERO, Point::X, Point::Y, Point::Z];
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let polygons = PolygonMesh::new(corners, triangles).expect("valid");
        let mesh: CornerTable = CornerTable::from_polygons(&polygons).expect("closed");
        let opposite: Vec<usize> = mesh
            .opposite_corners()
            .iter()
            .map(|o| o.get().unwrap().index())
            .collect();
        assert_eq!(opposite, [8, 5, 11, 7, 9, 1, 10, 3, 0, 4, 6, 2]);
        let edges: Vec<usize> = mesh.edges().map(EdgeCorner::index).collect();
        assert_eq!(edges, [0, 1, 2, 3, 4, 6]);
    }

    #[test]
    #[should_panic(expected = "no vertex 12: table `corner` has 12 rows")]
    fn a_missing_vertex_panics_with_its_row() {
        let _ = tables()[0].vertex_vertices(VertexId::new(12)).count();
    }

    #[test]
    #[should_panic(expected = "no face f20: there are 20 triangles")]
    fn a_missing_triangle_panics_with_its_handle() {
        let _ = tables()[0].face_vertices(FaceId::new(20)).count();
    }

    #[test]
    #[should_panic(expected = "no face f4294967295: there are 20 triangles")]
    fn the_largest_triangle_handle_panics_with_its_handle() {
        tables()[0].corners_of(FaceId::new(u32::MAX));
    }

    #[test]
    #[should_panic(expected = "no edge e60: the mesh has 60 corners")]
    fn a_missing_edge_panics_with_its_handle() {
        tables()[0].edge_vertices(EdgeCorner::new(60));
    }

    #[test]
    #[should_panic(expected = "no corner 60: table `opposite` has 60 rows")]
    fn a_missing_corner_panics_with_its_row() {
        tables()[0].opposite(CornerId::new(60));
    }
}
