//! The tables, their invariants, and the classic operators.

use mesh_core::{
    Editable, Editing, FACE_HOLES, FaceId, HoleSet, Point, Probe, Slot, Table, Untraced,
    VERTEX_HOLES, VertexId, Whole, row_id,
};

row_id! {
    /// The name of one corner, `c7`; the corners of triangle `t` are `3t`, `3t + 1` and `3t + 2`.
    pub struct CornerId, "c"
}

row_id! {
    /// The name of one edge, `e7`: the corner that faces it, of two the lower.
    ///
    /// Data by edge is a vector with a row for every corner, of which a closed mesh uses half.
    pub struct EdgeCorner, "e"
}

impl CornerId {
    /// The corner after this one in its triangle, counter-clockwise.
    ///
    /// Written with a comparison: `3 * (c / 3) + (c + 1) % 3` has two divisions where this has one
    /// multiplication, and every step around a vertex waits for it.
    #[inline]
    pub const fn next(self) -> Self {
        let c = self.index() as u32;
        Self::new(if c % 3 == 2 { c - 2 } else { c + 1 })
    }

    /// The corner before this one in its triangle: the next of the next.
    #[inline]
    pub const fn prev(self) -> Self {
        let c = self.index() as u32;
        Self::new(if c.is_multiple_of(3) { c + 2 } else { c - 1 })
    }

    /// The triangle that has this corner.
    #[inline]
    pub const fn triangle(self) -> FaceId {
        FaceId::new(self.index() as u32 / 3)
    }
}

impl EdgeCorner {
    /// The corner that faces the edge, of two the lower.
    #[inline]
    pub const fn corner(self) -> CornerId {
        CornerId::new(self.index() as u32)
    }
}

/// A mesh of triangles as two columns: the vertex of each corner, and the corner opposite to it.
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
/// Across a boundary edge there is no corner: `opposite`, and all that goes through it, has none.
///
/// # Invariants
///
/// - I1  Triangle `t` has the corners `3t`, `3t + 1`, `3t + 2`, at three vertices of the mesh.
/// - I2  `opposite(opposite(c))` is `c`; none where `c` faces a boundary edge.
/// - I3  `c` and `opposite(c)` face one edge from its two sides: `vertex(next(c))` is
///   `vertex(prev(opposite(c)))`, and `vertex(prev(c))` is `vertex(next(opposite(c)))`.
/// - I4  `corner(v)` is a corner at `v`; none if `v` is isolated.
/// - I5  If `v` is on a boundary, `corner(v)` has no `unswing`: the fan is entered at its start.
/// - I6  Swinging from `corner(v)` meets all corners at `v`: every vertex is manifold.
/// - I7  No two edges have the same ends.
/// - I8  The corners of a deleted triangle are at no vertex (the row `u32::MAX`), and each is opposite
///   to itself, as no other corner is; a deleted vertex has no corner. `face_holes` and `vertex_holes`
///   have just these rows.
///
/// I1 to I7 are about what is not deleted. By I8 a corner names an edge exactly where what is opposite
/// comes after it, or is none: a deleted corner names none, and nobody has to ask the holes.
///
/// # Memory
///
/// 12 bytes a vertex for its position and 4 for `corner`, 24 a triangle: 64 bytes, or 16 words, per
/// vertex of a large closed mesh. Once something was deleted, a bit a row besides.
#[derive(Debug)]
pub struct AnyCornerTable<P: Probe, E: Editing> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) corner: Table<Slot<CornerId>, P>,
    pub(crate) vertex: Table<VertexId, P>,
    pub(crate) opposite: Table<Slot<CornerId>, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

mesh_core::clone_by_field!(AnyCornerTable<P: Probe, E: Editing> { positions, corner, vertex, opposite, vertex_holes, face_holes });

/// A corner table of which nothing can be deleted: [`AnyCornerTable`] whose rows are all elements.
pub type CornerTable<P = Untraced> = AnyCornerTable<P, Whole>;

/// A corner table that can be edited ([`MeshEdit`](mesh_core::MeshEdit)): [`AnyCornerTable`] with holes.
pub type EditableCornerTable<P = Untraced> = AnyCornerTable<P, Editable>;

impl<P: Probe> From<CornerTable<P>> for EditableCornerTable<P> {
    fn from(mesh: CornerTable<P>) -> Self {
        let probe = mesh.positions.probe();
        Self {
            positions: mesh.positions,
            corner: mesh.corner,
            vertex: mesh.vertex,
            opposite: mesh.opposite,
            vertex_holes: Editable::no_holes(VERTEX_HOLES, probe.clone()),
            face_holes: Editable::no_holes(FACE_HOLES, probe),
        }
    }
}

/// The vertex that the corners of a deleted triangle are at: a row that no table has.
pub(crate) const NOWHERE: VertexId = VertexId::new(u32::MAX);

/// The classic operators, each O(1). One that reads a table panics, and names the row, if there is none.
/// They do not look whether a triangle was deleted: what they say of its corners is I8.
impl<P: Probe, E: Editing> AnyCornerTable<P, E> {
    /// The vertex that `c` is at.
    #[inline]
    pub fn vertex(&self, c: CornerId) -> VertexId {
        *self.vertex.read(c.index())
    }

    /// The corner across the edge that `c` faces; none across a boundary edge.
    #[inline]
    pub fn opposite(&self, c: CornerId) -> Option<CornerId> {
        self.opposite.read(c.index()).get()
    }

    /// The next corner of the triangle, counter-clockwise; no table is read.
    #[inline]
    pub fn next(&self, c: CornerId) -> CornerId {
        c.next()
    }

    /// The corner before `c`, which is the next of its next; no table is read.
    #[inline]
    pub fn prev(&self, c: CornerId) -> CornerId {
        c.prev()
    }

    /// The triangle that has the corner `c`; no table is read.
    #[inline]
    pub fn triangle(&self, c: CornerId) -> FaceId {
        c.triangle()
    }

    /// The far corner of the triangle across the edge from `vertex(c)` to the next corner.
    #[inline]
    pub fn left(&self, c: CornerId) -> Option<CornerId> {
        self.opposite(c.prev())
    }

    /// The far corner of the triangle across the edge from `vertex(c)` to the corner before.
    #[inline]
    pub fn right(&self, c: CornerId) -> Option<CornerId> {
        self.opposite(c.next())
    }

    /// The corner after `c` around its vertex, counter-clockwise; none at the end of an open fan.
    #[inline]
    pub fn swing(&self, c: CornerId) -> Option<CornerId> {
        self.right(c).map(CornerId::next)
    }

    /// The corner before `c` around its vertex; none at the start of an open fan.
    #[inline]
    pub fn unswing(&self, c: CornerId) -> Option<CornerId> {
        self.left(c).map(CornerId::prev)
    }
}

/// From vertices, triangles and edges to corners, and back. Panics as the operators do.
impl<P: Probe, E: Editing> AnyCornerTable<P, E> {
    /// A corner at `v`, the first of the fan if `v` is on a boundary; none if `v` is isolated; O(1).
    #[inline]
    pub fn corner_at(&self, v: VertexId) -> Option<CornerId> {
        let corner = self.corner.read(v.index()).get();
        if E::DELETES && corner.is_none() {
            self.expect_vertex(v);
        }
        corner
    }

    /// The three corners of `t`, counter-clockwise; O(1).
    #[inline]
    pub fn corners_of(&self, t: FaceId) -> [CornerId; 3] {
        if 3 * t.index() >= self.vertex.len() || *self.vertex.read(3 * t.index()) == NOWHERE {
            self.no_such_triangle(t);
        }
        corners_of(t)
    }

    /// The edge that `c` faces; O(1).
    #[inline]
    pub fn edge(&self, c: CornerId) -> EdgeCorner {
        edge_between(c, *self.opposite.read(c.index()))
    }

    /// Whether `c` faces a boundary edge; O(1).
    #[inline]
    pub fn is_boundary(&self, c: CornerId) -> bool {
        self.opposite(c).is_none()
    }

    /// How many corners there are: three for each triangle.
    #[inline]
    pub fn corner_count(&self) -> usize {
        self.vertex.len() - 3 * self.face_holes.len()
    }
}

/// The rows of a triangle or an edge that must be there.
impl<P: Probe, E: Editing> AnyCornerTable<P, E> {
    /// The vertices of `t`.
    #[inline]
    pub(crate) fn vertices_of(&self, t: FaceId) -> [VertexId; 3] {
        let [a, b, c] = self.rows_of(&self.vertex, t);
        if E::DELETES && a == NOWHERE {
            self.no_such_triangle(t);
        }
        [a, b, c]
    }

    /// The corners of `t`, each with the one opposite to it.
    #[inline]
    pub(crate) fn opposites_of(&self, t: FaceId) -> [(CornerId, Slot<CornerId>); 3] {
        let [i, j, k] = corners_of(t);
        if E::DELETES {
            self.expect_triangle(t);
        }
        let [a, b, c] = self.rows_of(&self.opposite, t);
        [(i, a), (j, b), (k, c)]
    }

    /// The vertices at the two corners after the one that `e` is named by: its ends.
    #[inline]
    pub(crate) fn ends_of(&self, e: EdgeCorner) -> [VertexId; 2] {
        if e.index() >= self.vertex.len() {
            self.no_such_edge(e);
        }
        let [a, b] = [e.corner().next(), e.corner().prev()].map(|c| self.vertex(c));
        if E::DELETES && a == NOWHERE {
            self.no_such_edge(e);
        }
        [a, b]
    }

    /// The corner across `e`; none if `e` is a boundary edge.
    #[inline]
    pub(crate) fn across(&self, e: EdgeCorner) -> Slot<CornerId> {
        let across = *self.opposite.read(e.index());
        if E::DELETES && across == Slot::some(e.corner()) {
            self.no_such_edge(e);
        }
        across
    }

    /// Panics if `v` was deleted: for where there is no corner at it.
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

    /// The three rows of a triangle in a table by corner.
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

    /// Panics if `t` was deleted: for a mesh with holes.
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
        panic!("no edge {e}: it is named by one of {corners} corners")
    }
}

/// The corners of a triangle that is there.
#[inline]
fn corners_of(t: FaceId) -> [CornerId; 3] {
    let c = 3 * t.index() as u32;
    [c, c + 1, c + 2].map(CornerId::new)
}

/// The edge that `c` and `across` face: the lower of the two names it.
#[inline]
pub(crate) fn edge_between(c: CornerId, across: Slot<CornerId>) -> EdgeCorner {
    let lower = Slot::some(c).min(across).get().unwrap_or(c);
    EdgeCorner::new(lower.index() as u32)
}

/// Whether `c`, with `across` opposite to it, is the corner that names the edge; of a deleted
/// triangle no corner is, being its own opposite.
#[inline(always)]
pub(crate) fn names_edge(c: CornerId, across: Slot<CornerId>) -> bool {
    // An empty slot comes after every corner.
    Slot::some(c) < across
}

/// The tables as they lie in memory, for export and for loops of one's own; with their holes (I8),
/// if something was deleted and [`compact`](mesh_core::MeshEdit::compact) has not been called since.
impl<P: Probe, E: Editing> AnyCornerTable<P, E> {
    /// Positions by vertex.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// A corner by vertex.
    pub fn corner_rows(&self) -> &[Slot<CornerId>] {
        self.corner.rows()
    }

    /// Vertices by corner: three by three, the triangles as an index list.
    pub fn vertex_rows(&self) -> &[VertexId] {
        self.vertex.rows()
    }

    /// Opposite corners by corner.
    pub fn opposite_rows(&self) -> &[Slot<CornerId>] {
        self.opposite.rows()
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{MeshQuery, PolygonMesh, Representation};

    use super::*;

    fn tables() -> [CornerTable; 3] {
        let hole = shapes::grid_with_hole(4, 4).expect("a size that is there");
        [
            shapes::icosahedron(),
            shapes::triangle_grid(3, 2).expect("a size that is there"),
            hole.fan_triangulated().expect("small"),
        ]
        .map(|polygons| CornerTable::from_polygons(&polygons).expect("manifold"))
    }

    fn corners<E: Editing>(mesh: &AnyCornerTable<Untraced, E>) -> impl Iterator<Item = CornerId> {
        (0..mesh.vertex.len() as u32).map(CornerId::new)
    }

    #[test]
    fn the_steps_within_a_triangle_are_those_of_the_paper() {
        for c in 0..30 {
            let (id, t) = (CornerId::new(c), c / 3);
            assert_eq!(id.triangle(), FaceId::new(t));
            assert_eq!(id.next(), CornerId::new(3 * t + (c + 1) % 3));
            assert_eq!(id.prev(), id.next().next());
        }
    }

    #[test]
    fn the_operators_keep_their_laws() {
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
                // A swing crosses the edge to the corner before, which then is the corner after.
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
    fn a_tetrahedron_has_the_table_worked_out_by_hand() {
        // Each triangle lacks one vertex: v3, v2, v0, v1. The corner across is at that vertex.
        let corners = [Point::ZERO, Point::X, Point::Y, Point::Z];
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let polygons = PolygonMesh::new(corners, triangles).expect("valid");
        let mesh = CornerTable::from_polygons(&polygons).expect("closed");
        let opposite: Vec<usize> = mesh
            .opposite_rows()
            .iter()
            .map(|o| o.get().unwrap().index())
            .collect();
        assert_eq!(opposite, [8, 5, 11, 7, 9, 1, 10, 3, 0, 4, 6, 2]);
        let edges: Vec<usize> = mesh.edges().map(EdgeCorner::index).collect();
        assert_eq!(edges, [0, 1, 2, 3, 4, 6]);
    }

    #[test]
    #[should_panic(expected = "no vertex 12: table `corner` has 12 rows")]
    fn a_vertex_that_is_not_there_panics_by_name() {
        let _ = tables()[0].vertex_vertices(VertexId::new(12)).count();
    }

    #[test]
    #[should_panic(expected = "no face f20: there are 20 triangles")]
    fn a_triangle_that_is_not_there_panics_by_name() {
        let _ = tables()[0].face_vertices(FaceId::new(20)).count();
    }

    #[test]
    #[should_panic(expected = "no face f4294967295: there are 20 triangles")]
    fn no_triangle_is_too_far_out_to_be_named() {
        tables()[0].corners_of(FaceId::new(u32::MAX));
    }

    #[test]
    #[should_panic(expected = "no edge e60: it is named by one of 60 corners")]
    fn an_edge_that_is_not_there_panics_by_name() {
        tables()[0].edge_vertices(EdgeCorner::new(60));
    }

    #[test]
    #[should_panic(expected = "no corner 60: table `opposite` has 60 rows")]
    fn a_corner_that_is_not_there_panics_by_name() {
        tables()[0].opposite(CornerId::new(60));
    }
}
