//! Tests of the records, the panic messages and the memory.

use sixfold_core::{
    EdgeId, EditError, FaceId, MeshEdit, MeshMove, MeshQuery, Point, PolygonMesh, Representation,
    RowId, VertexId,
};

use crate::EditableWingedEdgeMesh;
use crate::edge::Edge;

fn v(row: u32) -> VertexId {
    VertexId::new(row)
}

fn mesh(vertices: u16, faces: &[&[u32]]) -> EditableWingedEdgeMesh {
    let corners: Vec<_> = (0..vertices).map(|i| Point::splat(i.into())).collect();
    let polygons = PolygonMesh::new(corners, faces).expect("valid");
    EditableWingedEdgeMesh::from_polygons(&polygons).expect("manifold")
}

/// Returns a square of two triangles. The diagonal e1 runs from v0 to v2.
fn square() -> EditableWingedEdgeMesh {
    mesh(4, &[&[0, 1, 2], &[0, 2, 3]])
}

/// Returns the square without its second triangle and without v3.
fn half() -> EditableWingedEdgeMesh {
    let mut mesh = square();
    mesh.remove_face(FaceId::new(1)).expect("at the boundary");
    mesh.remove_vertex(v(3)).expect("isolated");
    mesh
}

fn between(mesh: &EditableWingedEdgeMesh, a: u32, b: u32) -> EdgeId {
    mesh.edge_between(v(a), v(b)).expect("an edge")
}

/// Returns the two ends, then a pair of faces, of next edges and of previous edges. Each pair has
/// the left value first.
fn row(edge: &Edge) -> ([u32; 2], [Option<u32>; 2], [u32; 2], [u32; 2]) {
    (
        edge.ends().map(RowId::row),
        edge.faces().map(|face| face.map(RowId::row)),
        edge.next().map(RowId::row),
        edge.prev().map(RowId::row),
    )
}

#[test]
fn a_flip_writes_the_expected_records() {
    let mut mesh = square();
    let e = between(&mesh, 0, 2);
    let [ab, bc, cd, da] =
        [[0, 1], [1, 2], [2, 3], [3, 0]].map(|[a, b]| between(&mesh, a, b).row());
    // Before the flip, `e` runs from v0 to v2 with f1 = (0, 2, 3) on the left. After the flip, `e`
    // runs from v1 to v3.
    assert_eq!(
        row(mesh.edge(e)),
        ([0, 2], [Some(1), Some(0)], [cd, ab], [da, bc])
    );
    assert_eq!(mesh.flip_edge(e), Ok(e));
    assert_eq!(
        row(mesh.edge(e)),
        ([1, 3], [Some(1), Some(0)], [da, bc], [ab, cd])
    );
    assert!(mesh.face_vertices(FaceId::new(1)).eq([1, 3, 0].map(v)));
    assert_eq!(mesh.validate(), Ok(()));
}

#[test]
fn spokes_start_on_the_boundary_after_edits() {
    let mut mesh = square();
    let m = mesh
        .split_edge(between(&mesh, 0, 1), Point::ZERO)
        .expect("always legal");
    assert_eq!(mesh.spoke(m), Some(between(&mesh, 4, 1)));
    // Without v1, its boundary edge to v2 is the first boundary edge of v4.
    let e = between(&mesh, 4, 1);
    mesh.collapse_edge(e, m, Point::ZERO)
        .expect("a boundary edge");
    assert_eq!(mesh.spoke(m), Some(between(&mesh, 4, 2)));
    assert_eq!(mesh.validate(), Ok(()));
}

#[test]
fn vertices_with_many_edges_can_be_edited() {
    for spokes in [5, 16, 17, 40] {
        let rim = |i: u32| 1 + i % spokes;
        let faces: Vec<Vec<u32>> = (0..spokes).map(|i| vec![0, rim(i), rim(i + 1)]).collect();
        let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
        let wheel = mesh(spokes as u16 + 1, &faces);

        let mut removed = wheel.clone();
        removed.remove_vertex(v(0)).expect("legal");
        assert_eq!([removed.edge_count(), removed.face_count()], [0, 0]);
        assert_eq!(removed.validate(), Ok(()));

        let mut closed = removed.clone();
        let outline: Vec<VertexId> = (1..=spokes).map(v).collect();
        closed.add_face(&outline).expect("one polygon");
        let twice = [&outline[..], &outline[..1]].concat();
        let vertex = v(1);
        assert_eq!(
            closed.add_face(&twice),
            Err(EditError::RepeatedVertex { vertex })
        );
        assert_eq!(closed.validate(), Ok(()));

        // The hub collapses into a rim vertex. Only the third corners are adjacent to both ends.
        let mut collapsed = wheel.clone();
        let e = between(&wheel, 0, 1);
        collapsed
            .collapse_edge(e, v(1), Point::ZERO)
            .expect("an inner end");
        assert_eq!(collapsed.vertex_edges(v(1)).count() as u32, spokes - 1);
        assert_eq!(collapsed.validate(), Ok(()));
        let mut split = collapsed.clone();
        let ring: Vec<VertexId> = collapsed.vertex_vertices(v(1)).collect();
        let (first, last) = (ring.first().copied(), ring.last().copied());
        split
            .split_vertex(v(1), first, last, Point::ZERO)
            .expect("two neighbours");
        assert_eq!(split.validate(), Ok(()));
    }
}

#[test]
fn compact_releases_memory() {
    let mut mesh = square();
    let bytes = mesh.memory().total();
    for _ in 0..6 {
        for f in mesh.faces().collect::<Vec<_>>() {
            mesh.poke_face(f, Point::ZERO).expect("always legal");
        }
    }
    let new: Vec<VertexId> = mesh.vertices().skip(4).collect();
    for v in new.into_iter().rev() {
        let spoke = mesh.spoke(v).expect("three edges");
        let keep = mesh.other_end(spoke, v);
        mesh.collapse_edge(spoke, keep, Point::ZERO)
            .expect("three triangles around it");
    }
    assert!(mesh.memory().tables.iter().any(|t| t.table == "edge holes"));
    mesh.compact();
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(mesh.memory().tables.len(), 4);
    assert!(mesh.memory().total() <= 2 * bytes + 64);
}

#[test]
fn set_positions_works_with_holes() {
    let mut mesh = half();
    let mut places = mesh.vertex_map(Point::ONE);
    places[v(2)] = Point::ZERO;
    mesh.set_positions(&places).expect("a map of this mesh");
    assert_eq!(mesh.position(v(2)), Point::ZERO);
    assert_eq!(mesh.validate(), Ok(()));
    assert!(std::panic::catch_unwind(|| mesh.position(v(3))).is_err());
}

#[test]
fn edits_refuse_handles_of_missing_elements() {
    let mut mesh = half();
    let (vertex, face) = (v(3), FaceId::new(1));
    let edge = between(&square(), 0, 3);
    let at = Point::ZERO;
    assert_eq!(
        mesh.set_position(vertex, at),
        Err(EditError::NoSuchVertex { vertex })
    );
    assert_eq!(
        mesh.poke_face(face, at),
        Err(EditError::NoSuchFace { face })
    );
    assert_eq!(mesh.flip_edge(edge), Err(EditError::NoSuchEdge { edge }));
    let edge = EdgeId::new(99);
    assert_eq!(
        mesh.split_edge(edge, at),
        Err(EditError::NoSuchEdge { edge })
    );
}

#[test]
#[should_panic(expected = "no vertex v3: it was deleted")]
fn a_deleted_vertex_panics_with_its_handle() {
    let _ = half().vertex_faces(v(3)).count();
}

#[test]
#[should_panic(expected = "no vertex v3: it was deleted")]
fn a_deleted_vertex_has_no_position() {
    half().position(v(3));
}

#[test]
#[should_panic(expected = "it was deleted")]
fn a_deleted_edge_has_no_ends() {
    half().edge_vertices(between(&square(), 0, 3));
}

#[test]
#[should_panic(expected = "it was deleted")]
fn a_deleted_edge_has_no_faces() {
    let _ = half().edge_faces(between(&square(), 0, 3)).count();
}

#[test]
#[should_panic(expected = "it was deleted")]
fn a_deleted_edge_has_no_neighbours() {
    let _ = half().edge_edges(between(&square(), 0, 3)).count();
}

#[test]
#[should_panic(expected = "no face f1: it was deleted")]
fn a_deleted_face_panics_with_its_handle() {
    let _ = half().face_vertices(FaceId::new(1)).count();
}
