//! The tables of a winged-edge mesh, their invariants, and the classic operators.

use sixfold_core::{
    Compact, EdgeId, Editing, FaceId, HoleSet, Point, Probe, Slot, Table, Untraced, VertexId,
};

use crate::edge::{Edge, NO_EDGE, Run};

/// A mesh of edges. Each edge stores its two ends, its two faces, and the next and previous edge
/// along each face (four wings).
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
/// A boundary edge has wings on its side without a face, too. The wings on the side without a face
/// follow the boundary loop, so every walk returns to its start.
///
/// # Invariants
///
/// A *run* is an edge along one of its sides, from its origin to its target. The run on the left
/// side goes from start to end. The run on the right side goes from end to start.
///
/// - I1  The two ends of an edge differ. The two faces of an edge differ; one of the two may be
///   missing. Every handle in the tables refers to an existing row.
/// - I2  The next wing of a run starts at the target of the run. The previous wing of a run ends at
///   the origin of the run.
/// - I3  A run and its next wing have the same face. Along a boundary loop, the face is empty.
/// - I4  `prev` is the inverse of `next`: for every run, the previous run of the next run is the
///   run itself.
/// - I5  `spoke(v)` is an edge with the end `v`, or empty if `v` is isolated. If `v` is on a
///   boundary, the run of `spoke(v)` that ends at `v` has no face.
/// - I6  The steps around `v` visit all edges at `v` in one cycle: every vertex is manifold.
/// - I7  `side(f)` is an edge with face `f`. The cycle of runs along `f` has at least three
///   vertices, each once.
/// - I8  No two edges have the same ends.
/// - I9  In the tables of holes, a bit is set exactly if its vertex, edge or face was deleted. The
///   spoke of a deleted vertex is empty. The ends of a deleted edge, and the side of a deleted
///   face, hold values that no row has. Elements that are not deleted never refer to deleted
///   elements.
///
/// # Memory
///
/// The tables use 16 bytes per vertex, 32 bytes per edge and 4 bytes per face. A large closed
/// triangle mesh uses 120 bytes per vertex (30 words of 4 bytes). After the first deletion, the
/// tables also use one bit per row up to the last hole (row of a deleted element).
#[derive(Debug)]
pub struct WingedEdgeMesh<E: Editing = Compact, P: Probe = Untraced> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) spokes: Table<Slot<EdgeId>, P>,
    pub(crate) edges: Table<Edge, P>,
    pub(crate) sides: Table<EdgeId, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) edge_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

sixfold_core::mesh_tables!(WingedEdgeMesh {
    tables: positions, spokes, edges, sides;
    holes: vertex_holes, edge_holes, face_holes;
});
sixfold_core::polygon_conversions!(WingedEdgeMesh);

/// Access to the fields of edges, vertices and faces. Each function takes O(1) time, and panics if
/// its argument does not exist or was deleted.
impl<P: Probe, E: Editing> WingedEdgeMesh<E, P> {
    /// Returns the record of `e`.
    #[inline]
    pub fn edge(&self, e: EdgeId) -> &Edge {
        let edge = self.record(e);
        if E::CAN_DELETE && edge.is_deleted() {
            no_such_edge(e);
        }
        edge
    }

    /// Returns the record of `e` without a check; a walk never reaches a deleted edge.
    #[inline]
    pub(crate) fn record(&self, e: EdgeId) -> &Edge {
        self.edges.read(e.index())
    }

    /// Returns the vertex where `e` starts.
    #[inline]
    pub fn start(&self, e: EdgeId) -> VertexId {
        self.edge(e).ends()[0]
    }

    /// Returns the vertex where `e` ends.
    #[inline]
    pub fn end(&self, e: EdgeId) -> VertexId {
        self.edge(e).ends()[1]
    }

    /// Returns the face on the left of `e`, or `None` if there is no face.
    #[inline]
    pub fn left(&self, e: EdgeId) -> Option<FaceId> {
        self.edge(e).faces()[0]
    }

    /// Returns the face on the right of `e`, or `None` if there is no face.
    #[inline]
    pub fn right(&self, e: EdgeId) -> Option<FaceId> {
        self.edge(e).faces()[1]
    }

    /// Returns the next edge after `e` along the left face of `e`, or along the boundary loop if
    /// there is no face.
    #[inline]
    pub fn left_next(&self, e: EdgeId) -> EdgeId {
        self.edge(e).next()[0]
    }

    /// Returns the edge before `e` along the left face of `e`, or along the boundary loop if there
    /// is no face.
    #[inline]
    pub fn left_prev(&self, e: EdgeId) -> EdgeId {
        self.edge(e).prev()[0]
    }

    /// Returns the next edge after `e` along the right face of `e`, or along the boundary loop if
    /// there is no face.
    #[inline]
    pub fn right_next(&self, e: EdgeId) -> EdgeId {
        self.edge(e).next()[1]
    }

    /// Returns the edge before `e` along the right face of `e`, or along the boundary loop if there
    /// is no face.
    #[inline]
    pub fn right_prev(&self, e: EdgeId) -> EdgeId {
        self.edge(e).prev()[1]
    }

    /// Returns whether `e` has exactly one face.
    #[inline]
    pub fn is_boundary(&self, e: EdgeId) -> bool {
        self.edge(e).faces().contains(&None)
    }

    /// Returns an edge at `v`, or `None` if `v` is isolated. If `v` is on a boundary, returns the
    /// boundary edge from which a counter-clockwise walk visits all faces at `v`.
    ///
    /// # Panics
    ///
    /// Panics if `v` is not a vertex of this mesh.
    #[inline]
    pub fn spoke(&self, v: VertexId) -> Option<EdgeId> {
        let spoke = self.spokes.read(v.index()).get();
        if spoke.is_none() && self.vertex_holes.has(v.index()) {
            no_such_vertex(v);
        }
        spoke
    }

    /// Returns an edge of `f`.
    ///
    /// # Panics
    ///
    /// Panics if `f` is not a face of this mesh.
    #[inline]
    pub fn side(&self, f: FaceId) -> EdgeId {
        let side = *self.sides.read(f.index());
        if E::CAN_DELETE && side == NO_EDGE {
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

/// Steps from an edge around a vertex or a face: Baumgart's ECCW, ECW and OTHER. Each step is O(1)
/// and reads one record. A step panics if the edge does not exist, if the vertex is not an end of
/// the edge, or if the edge is not a side of the face.
impl<P: Probe, E: Editing> WingedEdgeMesh<E, P> {
    /// Returns the end of `e` that is not `v`.
    #[inline]
    pub fn other_end(&self, e: EdgeId, v: VertexId) -> VertexId {
        self.run_from(e, v).target()
    }

    /// Returns the face of `e` that is not `f`, or `None` if `e` is a boundary edge.
    #[inline]
    pub fn other_face(&self, e: EdgeId, f: FaceId) -> Option<FaceId> {
        self.run_along(e, f).across().get()
    }

    /// Returns the edge after `e` around `v`, counter-clockwise.
    #[inline]
    pub fn ccw_around_vertex(&self, e: EdgeId, v: VertexId) -> EdgeId {
        self.run_from(e, v).ccw()
    }

    /// Returns the edge after `e` around `v`, clockwise.
    #[inline]
    pub fn cw_around_vertex(&self, e: EdgeId, v: VertexId) -> EdgeId {
        self.run_from(e, v).cw()
    }

    /// Returns the edge after `e` along `f`, counter-clockwise.
    #[inline]
    pub fn ccw_around_face(&self, e: EdgeId, f: FaceId) -> EdgeId {
        self.run_along(e, f).next()
    }

    /// Returns the edge after `e` along `f`, clockwise.
    #[inline]
    pub fn cw_around_face(&self, e: EdgeId, f: FaceId) -> EdgeId {
        self.run_along(e, f).prev()
    }

    fn run_from(&self, e: EdgeId, v: VertexId) -> Run<'_> {
        let edge = self.edge(e);
        assert!(edge.ends().contains(&v), "{v} is not an end of {e}");
        Run::from(edge, v)
    }

    fn run_along(&self, e: EdgeId, f: FaceId) -> Run<'_> {
        let edge = self.edge(e);
        let along = edge.faces().contains(&Some(f));
        assert!(along, "{e} is not a side of {f}");
        Run::along(edge, f)
    }
}

/// The tables as they are in memory, for export and for the caller's own loops. Invariant I9 of the
/// mesh defines the content of the rows of deleted elements.
impl<P: Probe, E: Editing> WingedEdgeMesh<E, P> {
    /// Returns the position of each vertex, in the order of the vertex rows.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// Returns one edge at each vertex (invariant I5), in the order of the vertex rows.
    pub fn spoke_rows(&self) -> &[Slot<EdgeId>] {
        self.spokes.rows()
    }

    /// Returns the record of each edge, in the order of the edge rows.
    pub fn edge_records(&self) -> &[Edge] {
        self.edges.rows()
    }

    /// Returns one edge of each face (invariant I7), in the order of the face rows.
    pub fn side_rows(&self) -> &[EdgeId] {
        self.sides.rows()
    }
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, PolygonMesh, Representation};

    use super::*;

    fn mesh(vertices: u16, faces: &[&[u32]]) -> WingedEdgeMesh {
        let corners: Vec<_> = (0..vertices).map(|i| Point::splat(i.into())).collect();
        let polygons = PolygonMesh::new(corners, faces).expect("valid");
        WingedEdgeMesh::from_polygons(&polygons).expect("manifold")
    }

    fn between<E: Editing>(mesh: &WingedEdgeMesh<E>, [a, b]: [u32; 2]) -> EdgeId {
        let has = |e, v| mesh.edge(e).ends().contains(&VertexId::new(v));
        let mut edges = mesh.edges();
        edges.find(|&e| has(e, a) && has(e, b)).expect("an edge")
    }

    #[test]
    fn the_lecture_mesh_has_the_expected_rows() {
        // The first three rows of the lecture notes. Edges e3, e4 and e12 of the notes end at v3;
        // edges e16 and e18 end at v4. In the notes, the faces of e2 are f0 and f1; f1 would then
        // have v0 twice. So the second face of e2 is f3 here.
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
        // The ends; the wings left next, right prev, left prev and right next; the faces.
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
                assert_eq!([mesh.end(e), mesh.start(e)], [start, end]);
                let got = [
                    mesh.right_next(e),
                    mesh.left_prev(e),
                    mesh.right_prev(e),
                    mesh.left_next(e),
                ];
                assert_eq!(got, wings, "the wings of {ends:?}, stored in reverse");
                assert_eq!([mesh.right(e), mesh.left(e)], [Some(left), Some(right)]);
            }
            assert_eq!(mesh.other_face(e, left), Some(right));
            assert_eq!(mesh.other_end(e, end), start);
        }
    }

    #[test]
    fn moves_around_vertices_and_faces_are_inverse() {
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
        // The outline, clockwise from v0.
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
    fn a_missing_vertex_panics_with_its_handle() {
        let _ = mesh(5, &[&[0, 1, 2]])
            .vertex_vertices(VertexId::new(5))
            .count();
    }

    #[test]
    #[should_panic(expected = "no edge 3: table `edges` has 3 rows")]
    fn a_missing_edge_panics_with_its_handle() {
        mesh(3, &[&[0, 1, 2]]).start(EdgeId::new(3));
    }

    #[test]
    #[should_panic(expected = "v2 is not an end of e0")]
    fn a_vertex_that_is_not_an_end_of_the_edge_panics() {
        mesh(3, &[&[0, 1, 2]]).other_end(EdgeId::new(0), VertexId::new(2));
    }
}
