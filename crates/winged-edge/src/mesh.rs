//! The tables, their invariants, and the classic operators.

use mesh_core::{
    EDGE_HOLES, EdgeId, Editable, Editing, FACE_HOLES, FaceId, HoleSet, Point, Probe, Slot, Table,
    Untraced, VERTEX_HOLES, VertexId, Whole,
};

use crate::edge::{Edge, NO_EDGE, Run};

/// A mesh of edges that know their ends, their faces and the four edges around them.
///
/// ```text
///     left_next(e)         right_prev(e)
///                \         /
///                 ▲       │          start  end        ends
///                  \      ▼          left   right      faces
///                   ──▲──            four wings        next and prev of both sides
///           left(e)   │   right(e)
///                   e │
///                   ──┴──            Along the left face:   left_prev, e, left_next.
///                  ▲     \           Along the right face:  right_prev, e, right_next.
///                 /       ▼
///     left_prev(e)         right_next(e)
/// ```
///
/// The side of a boundary edge that has no face has wings as well: they follow the boundary loop, as
/// if it were a face. So all walks close, and a boundary costs no query more.
///
/// # Invariants
///
/// Below, an edge *run* along one side goes from its origin to its target: on the left from start
/// to end, on the right from end to start.
///
/// - I1  The two ends of an edge differ, and so do what is on its two sides: one comparison tells
///   the side. Every name in the tables is that of a row.
/// - I2  The next wing of a run starts at its target, the one before ends at its origin.
/// - I3  A run and its next wing have one face; none along a boundary loop.
/// - I4  `next` and `prev` undo each other.
/// - I5  `spoke(v)` ends at `v`, and leaves it with no face on its right if `v` is on a boundary;
///   none if `v` is isolated.
/// - I6  All edges at `v` are one cycle of turns around it: every vertex is manifold.
/// - I7  `side(f)` has face `f`, and its cycle names at least three vertices, each once.
/// - I8  No two edges have the same ends.
/// - I9  A deleted vertex has no spoke, a deleted edge starts nowhere, a deleted face has no side: the
///   last two hold a number that no row has. Nothing that is there names what is deleted.
///
/// # Memory
///
/// 12 bytes a vertex for its position and 4 for its spoke, 32 an edge, 4 a face: 120 bytes, or 30
/// words, per vertex of a large closed triangle mesh. Once something was deleted, also a bit for each
/// row up to the last hole.
#[derive(Debug)]
pub struct AnyWingedEdgeMesh<P: Probe, E: Editing> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) spokes: Table<Slot<EdgeId>, P>,
    pub(crate) edges: Table<Edge, P>,
    pub(crate) sides: Table<EdgeId, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) edge_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

mesh_core::clone_by_field!(AnyWingedEdgeMesh<P: Probe, E: Editing> { positions, spokes, edges, sides, vertex_holes, edge_holes, face_holes });

/// A winged-edge mesh of which nothing can be deleted: [`AnyWingedEdgeMesh`] whose rows are all elements.
pub type WingedEdgeMesh<P = Untraced> = AnyWingedEdgeMesh<P, Whole>;

/// A winged-edge mesh that can be edited ([`MeshEdit`](mesh_core::MeshEdit)): [`AnyWingedEdgeMesh`] with holes.
pub type EditableWingedEdgeMesh<P = Untraced> = AnyWingedEdgeMesh<P, Editable>;

impl<P: Probe> From<WingedEdgeMesh<P>> for EditableWingedEdgeMesh<P> {
    fn from(mesh: WingedEdgeMesh<P>) -> Self {
        let probe = mesh.positions.probe();
        Self {
            positions: mesh.positions,
            spokes: mesh.spokes,
            edges: mesh.edges,
            sides: mesh.sides,
            vertex_holes: Editable::no_holes(VERTEX_HOLES, probe.clone()),
            edge_holes: Editable::no_holes(EDGE_HOLES, probe.clone()),
            face_holes: Editable::no_holes(FACE_HOLES, probe),
        }
    }
}

/// What an edge knows. Each panics, and names the edge, if the mesh does not have it; all O(1), one
/// record read.
impl<P: Probe, E: Editing> AnyWingedEdgeMesh<P, E> {
    /// The record of `e`.
    #[inline]
    pub fn edge(&self, e: EdgeId) -> &Edge {
        let edge = self.record(e);
        if E::DELETES && edge.is_hole() {
            no_such_edge(e);
        }
        edge
    }

    /// The same for walks, which never come to a deleted edge.
    #[inline]
    pub(crate) fn record(&self, e: EdgeId) -> &Edge {
        self.edges.read(e.index())
    }

    /// The vertex where `e` starts.
    #[inline]
    pub fn start(&self, e: EdgeId) -> VertexId {
        self.edge(e).ends()[0]
    }

    /// The vertex where `e` ends.
    #[inline]
    pub fn end(&self, e: EdgeId) -> VertexId {
        self.edge(e).ends()[1]
    }

    /// The face on the left of `e`; none on a boundary.
    #[inline]
    pub fn left(&self, e: EdgeId) -> Option<FaceId> {
        self.edge(e).faces()[0]
    }

    /// The face on the right of `e`; none on a boundary.
    #[inline]
    pub fn right(&self, e: EdgeId) -> Option<FaceId> {
        self.edge(e).faces()[1]
    }

    /// The wing at the end of `e`, on its left: the next edge along the left face.
    #[inline]
    pub fn left_next(&self, e: EdgeId) -> EdgeId {
        self.edge(e).next()[0]
    }

    /// The wing at the start of `e`, on its left: the edge before along the left face.
    #[inline]
    pub fn left_prev(&self, e: EdgeId) -> EdgeId {
        self.edge(e).prev()[0]
    }

    /// The wing at the start of `e`, on its right: the next edge along the right face.
    #[inline]
    pub fn right_next(&self, e: EdgeId) -> EdgeId {
        self.edge(e).next()[1]
    }

    /// The wing at the end of `e`, on its right: the edge before along the right face.
    #[inline]
    pub fn right_prev(&self, e: EdgeId) -> EdgeId {
        self.edge(e).prev()[1]
    }

    /// Whether `e` has only one face.
    #[inline]
    pub fn is_boundary(&self, e: EdgeId) -> bool {
        self.edge(e).faces().contains(&None)
    }

    /// An edge at `v`, the first counter-clockwise if `v` is on a boundary; none if `v` is isolated.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[inline]
    pub fn spoke(&self, v: VertexId) -> Option<EdgeId> {
        let spoke = self.spokes.read(v.index()).get();
        if spoke.is_none() && self.vertex_holes.has(v.index()) {
            no_such_vertex(v);
        }
        spoke
    }

    /// An edge of `f`.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn side(&self, f: FaceId) -> EdgeId {
        let side = *self.sides.read(f.index());
        if E::DELETES && side == NO_EDGE {
            no_such_face(f);
        }
        side
    }
}

#[cold]
#[inline(never)]
pub(crate) fn no_such_vertex(v: VertexId) -> ! {
    panic!("no vertex {v}: it was deleted")
}

#[cold]
#[inline(never)]
fn no_such_edge(e: EdgeId) -> ! {
    panic!("no edge {e}: it was deleted")
}

#[cold]
#[inline(never)]
fn no_such_face(f: FaceId) -> ! {
    panic!("no face {f}: it was deleted")
}

/// Moves from an edge that know where they stand: Baumgart's ECCW, ECW and OTHER. Each panics if the
/// edge does not end at the vertex, or does not lie along the face; all O(1), one record read.
impl<P: Probe, E: Editing> AnyWingedEdgeMesh<P, E> {
    /// The end of `e` that is not `v`.
    #[inline]
    pub fn other_end(&self, e: EdgeId, v: VertexId) -> VertexId {
        self.run_from(e, v).target()
    }

    /// The face of `e` that is not `f`; none on a boundary.
    #[inline]
    pub fn other_face(&self, e: EdgeId, f: FaceId) -> Option<FaceId> {
        self.run_along(e, f).across().get()
    }

    /// The edge after `e` around `v`, counter-clockwise.
    #[inline]
    pub fn ccw_around_vertex(&self, e: EdgeId, v: VertexId) -> EdgeId {
        self.run_from(e, v).ccw()
    }

    /// The edge after `e` around `v`, clockwise.
    #[inline]
    pub fn cw_around_vertex(&self, e: EdgeId, v: VertexId) -> EdgeId {
        self.run_from(e, v).cw()
    }

    /// The edge after `e` along `f`, counter-clockwise.
    #[inline]
    pub fn ccw_around_face(&self, e: EdgeId, f: FaceId) -> EdgeId {
        self.run_along(e, f).next()
    }

    /// The edge after `e` along `f`, clockwise.
    #[inline]
    pub fn cw_around_face(&self, e: EdgeId, f: FaceId) -> EdgeId {
        self.run_along(e, f).prev()
    }

    fn run_from(&self, e: EdgeId, v: VertexId) -> Run<'_> {
        let edge = self.edge(e);
        assert!(edge.ends().contains(&v), "{e} does not end at {v}");
        Run::from(edge, v)
    }

    fn run_along(&self, e: EdgeId, f: FaceId) -> Run<'_> {
        let edge = self.edge(e);
        let along = edge.faces().contains(&Some(f));
        assert!(along, "{e} does not lie along {f}");
        Run::along(edge, f)
    }
}

/// The tables as they lie in memory, for export and for loops of one's own.
impl<P: Probe, E: Editing> AnyWingedEdgeMesh<P, E> {
    /// Positions by vertex.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// An edge by vertex.
    pub fn spoke_rows(&self) -> &[Slot<EdgeId>] {
        self.spokes.rows()
    }

    /// The records by edge.
    pub fn edge_records(&self) -> &[Edge] {
        self.edges.rows()
    }

    /// An edge by face.
    pub fn side_rows(&self) -> &[EdgeId] {
        self.sides.rows()
    }
}

#[cfg(test)]
mod tests {
    use mesh_core::{MeshQuery, PolygonMesh, Representation};

    use super::*;

    fn mesh(vertices: u16, faces: &[&[u32]]) -> WingedEdgeMesh {
        let corners: Vec<_> = (0..vertices).map(|i| Point::splat(i.into())).collect();
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        WingedEdgeMesh::from_polygons(&polygons).expect("manifold")
    }

    fn between<E: Editing>(mesh: &AnyWingedEdgeMesh<Untraced, E>, [a, b]: [u32; 2]) -> EdgeId {
        let has = |e, v| mesh.edge(e).ends().contains(&VertexId::new(v));
        let mut edges = mesh.edges();
        edges.find(|&e| has(e, a) && has(e, b)).expect("an edge")
    }

    #[test]
    fn the_lecture_rows_come_out() {
        // The notes' first three rows, with v3 the far end of their e3, e4 and e12, and v4 that of
        // e16 and e18. They give e2 the faces f0 and f1; then f1 would have v0 twice, so it is a
        // face of its own here, f3.
        let mesh = mesh(
            5,
            &[
                &[0, 1, 2],
                &[1, 0, 3],
                &[2, 1, 4],
                &[0, 2, 3],
                &[1, 3, 2, 4],
            ],
        );
        let [e0, e1, e2] = [[0, 1], [1, 2], [2, 0]];
        let [e3, e4, e12, e16, e18] = [[0, 3], [3, 1], [2, 3], [4, 2], [1, 4]];
        // The edge as it runs; wings left ahead, right at the end, left behind, right at the start.
        let rows = [
            (e0, [e1, e4, e2, e3], [0, 1]),
            (e1, [e2, e16, e0, e18], [0, 2]),
            (e2, [e0, e3, e1, e12], [0, 3]),
        ];
        for (ends, wings, faces) in rows {
            let e = between(&mesh, ends);
            let [start, end] = ends.map(VertexId::new);
            let [left, right] = faces.map(FaceId::new);
            let wings = wings.map(|wing| between(&mesh, wing));
            if mesh.start(e) == start {
                let got = [
                    mesh.left_next(e),
                    mesh.right_prev(e),
                    mesh.left_prev(e),
                    mesh.right_next(e),
                ];
                assert_eq!(got, wings, "the wings of {ends:?}");
                assert_eq!([mesh.left(e), mesh.right(e)], [Some(left), Some(right)]);
            } else {
                // Stored the other way round: left and right, ahead and behind change places.
                assert_eq!([mesh.end(e), mesh.start(e)], [start, end]);
                let got = [
                    mesh.right_next(e),
                    mesh.left_prev(e),
                    mesh.right_prev(e),
                    mesh.left_next(e),
                ];
                assert_eq!(got, wings, "the wings of {ends:?}, which runs back");
                assert_eq!([mesh.right(e), mesh.left(e)], [Some(left), Some(right)]);
            }
            assert_eq!(mesh.other_face(e, left), Some(right));
            assert_eq!(mesh.other_end(e, end), start);
        }
    }

    #[test]
    fn moves_around_vertices_and_faces_undo_each_other() {
        let open = mesh(5, &[&[0, 1, 2, 3], &[1, 0, 4]]);
        for e in open.edges() {
            for v in open.edge_vertices(e) {
                let ccw = open.ccw_around_vertex(e, v);
                assert_eq!(open.cw_around_vertex(ccw, v), e);
                assert_eq!(open.other_end(e, open.other_end(e, v)), v);
            }
            for f in open.edge_faces(e) {
                let ccw = open.ccw_around_face(e, f);
                assert_eq!(open.cw_around_face(ccw, f), e);
                let across = open.other_face(e, f);
                assert_eq!(across.is_none(), open.is_boundary(e));
                assert!(across.is_none_or(|g| open.other_face(e, g) == Some(f)));
            }
        }
    }

    #[test]
    fn wings_without_a_face_follow_the_boundary() {
        let open = mesh(5, &[&[0, 1, 2, 3], &[1, 0, 4]]);
        // Clockwise around the outline from v0: 4, 1, 2, 3.
        let outline = [[0, 3], [3, 2], [2, 1], [1, 4], [4, 0]].map(|ends| between(&open, ends));
        for (i, &e) in outline.iter().enumerate() {
            let next = outline[(i + 1) % outline.len()];
            let (side, wing) = match [open.left(e), open.right(e)] {
                [None, Some(_)] => (0, open.left_next(e)),
                [Some(_), None] => (1, open.right_next(e)),
                faces => panic!("{e} has the faces {faces:?}"),
            };
            assert_eq!(wing, next, "after {e}");
            assert!(open.edge(next).prev().contains(&e), "side {side} of {next}");
        }
        let ring: Vec<_> = open.one_ring(VertexId::new(0)).expect("one fan").collect();
        assert_eq!(ring, [4, 1, 3].map(VertexId::new));
    }

    #[test]
    #[should_panic(expected = "no vertex 5: table `spokes` has 5 rows")]
    fn a_vertex_that_is_not_there_panics_by_name() {
        let _ = mesh(5, &[&[0, 1, 2]])
            .vertex_vertices(VertexId::new(5))
            .count();
    }

    #[test]
    #[should_panic(expected = "no edge 3: table `edges` has 3 rows")]
    fn an_edge_that_is_not_there_panics_by_name() {
        mesh(3, &[&[0, 1, 2]]).start(EdgeId::new(3));
    }

    #[test]
    #[should_panic(expected = "e0 does not end at v2")]
    fn an_edge_elsewhere_panics_by_name() {
        mesh(3, &[&[0, 1, 2]]).other_end(EdgeId::new(0), VertexId::new(2));
    }
}
