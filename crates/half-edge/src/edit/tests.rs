//! Tests of the tables, the panic messages and the memory.

use std::panic::{AssertUnwindSafe, catch_unwind};

use sixfold_core::{
    EditError, EditRecord, FaceId, MeshEdit, MeshQuery, Point, PolygonMesh, Ranks, Refine,
    Representation, Slot, Split, VertexId,
};

use super::*;

fn v(row: u32) -> VertexId {
    VertexId::new(row)
}

fn mesh<const N: usize>(
    vertices: u32,
    faces: impl IntoIterator<Item = [u32; N]>,
) -> EditableHalfEdgeMesh {
    let positions = (0..vertices).map(|i| Point::splat(i as f32));
    let polygons = PolygonMesh::new(positions.collect::<Vec<_>>(), faces).expect("valid");
    EditableHalfEdgeMesh::from_polygons(&polygons).expect("manifold")
}

/// Returns next, origin and face of each row; `.` means no face.
fn rows(mesh: &EditableHalfEdgeMesh) -> Vec<String> {
    let row = |half: &Half| {
        let face = half.face.get().map_or(".".to_owned(), |f| f.to_string());
        format!("{} {} {face}", half.next, half.origin)
    };
    mesh.half_edge_rows().iter().map(row).collect()
}

fn corners(mesh: &EditableHalfEdgeMesh, f: u32) -> Vec<VertexId> {
    mesh.face_vertices(FaceId::new(f)).collect()
}

fn discard<T>(_: T) {}

fn edge(mesh: &EditableHalfEdgeMesh, a: u32, b: u32) -> EdgeId {
    mesh.edge_between(v(a), v(b)).expect("an edge")
}

#[test]
fn a_flip_writes_the_expected_rows() {
    let mut mesh = mesh(4, [[0, 1, 2], [0, 2, 3]]);
    let before = "h6 v0 f0, h4 v1 ., h8 v0 f1, h0 v2 f0, h9 v0 ., \
                  h2 v3 f1, h3 v1 f0, h1 v2 ., h5 v2 f1, h7 v3 .";
    assert_eq!(rows(&mesh).join(", "), before);
    // Before the flip, h2 runs from v0 to v2 along f1, and h3 runs back along f0. After the flip,
    // h2 runs from v1 to v3, and f1 keeps v0.
    let e = edge(&mesh, 0, 2);
    assert_eq!(mesh.edge_half_edges(e), [2, 3].map(HalfEdgeId::new));
    assert_eq!(mesh.flip_edge(e), Ok(e));
    let after = "h2 v0 f1, h4 v1 ., h5 v1 f1, h6 v3 f0, h9 v0 ., \
                 h0 v3 f1, h8 v1 f0, h1 v2 ., h3 v2 f0, h7 v3 .";
    assert_eq!(rows(&mesh).join(", "), after);
    assert_eq!(corners(&mesh, 0), [3, 1, 2].map(v));
    assert_eq!(corners(&mesh, 1), [1, 3, 0].map(v));
    assert_eq!(mesh.validate(), Ok(()));
}

#[test]
fn a_collapse_marks_the_deleted_rows() {
    // A closed fan of four triangles around v4.
    let mut mesh = mesh(5, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
    let e = edge(&mesh, 0, 4);
    let gone = [e, edge(&mesh, 1, 4), edge(&mesh, 3, 4)];
    let mut record = EditRecord::new();
    assert_eq!(
        mesh.collapse_edge_logged(e, v(0), Point::X, &mut record),
        Ok(v(0))
    );
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(corners(&mesh, 1), [1, 2, 0].map(v));
    assert_eq!(corners(&mesh, 2), [2, 3, 0].map(v));
    assert_eq!(mesh.position(v(0)), Point::X);
    assert_eq!(record.vertices.removed, [v(4)]);
    for e in gone {
        assert!(record.edges.removed.contains(&e), "{e}");
        for h in mesh.edge_half_edges(e) {
            assert_eq!(mesh.half_edge_rows()[h.index()], Half::DELETED);
        }
    }
    assert_eq!([0, 3].map(|f| mesh.first_rows()[f]), [NO_HALF; 2]);
    assert_eq!(mesh.leaving_rows()[4], Slot::NONE);
    assert_eq!(mesh.hole_count(), 6);
}

#[test]
fn queries_of_deleted_elements_panic_with_their_handle() {
    let mut mesh = mesh(6, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
    let e = edge(&mesh, 0, 4);
    let [h, t] = mesh.edge_half_edges(e);
    mesh.remove_vertex(v(4)).expect("legal");
    mesh.remove_vertex(v(5)).expect("isolated");
    let f = FaceId::new(2);
    type Query<'a> = (&'a str, &'a dyn Fn());
    let queries: [Query; 16] = [
        ("v4", &|| discard(mesh.position(v(4)))),
        ("v5", &|| discard(mesh.position(v(5)))),
        ("v4", &|| discard(mesh.vertex_vertices(v(4)).count())),
        ("v5", &|| discard(mesh.vertex_edges(v(5)).count())),
        ("v4", &|| discard(mesh.vertex_faces(v(4)).count())),
        ("v4", &|| discard(mesh.vertex_half_edge(v(4)))),
        ("e1", &|| discard(mesh.edge_vertices(e))),
        ("e1", &|| discard(mesh.edge_edges(e).count())),
        ("e1", &|| discard(mesh.edge_faces(e).count())),
        ("f2", &|| discard(mesh.face_vertices(f).count())),
        ("f2", &|| discard(mesh.face_edges(f).count())),
        ("f2", &|| discard(mesh.face_faces(f).count())),
        ("h2", &|| discard(mesh.next(h))),
        ("h3", &|| discard(mesh.origin(t))),
        ("h3", &|| discard(mesh.face(t))),
        ("h2", &|| discard(mesh.prev(h))),
    ];
    assert_eq!((e, h), (EdgeId::new(1), HalfEdgeId::new(2)));
    for (i, (name, query)) in queries.into_iter().enumerate() {
        let panic = catch_unwind(AssertUnwindSafe(query)).expect_err("it was deleted");
        let message = panic.downcast_ref::<String>().expect("a message");
        assert_eq!(*message, format!("{name} was deleted"), "query {i}");
    }
}

#[test]
fn edits_refuse_handles_of_missing_elements() {
    let mut mesh = mesh(4, [[0, 1, 2], [0, 2, 3]]);
    let f = FaceId::new(1);
    mesh.remove_face(f).expect("legal");
    mesh.remove_vertex(v(3)).expect("isolated");
    for f in [f, FaceId::new(2), FaceId::new(u32::MAX)] {
        let refused = Err(EditError::NoSuchFace { face: f });
        assert_eq!(mesh.remove_face(f), refused);
        assert_eq!(mesh.poke_face(f, Point::ZERO).map(|_| ()), refused);
        assert_eq!(mesh.split_face(f, [v(0), v(1)]).map(|_| ()), refused);
    }
    for vertex in [v(3), v(4), v(u32::MAX)] {
        let refused = Err(EditError::NoSuchVertex { vertex });
        assert_eq!(mesh.remove_vertex(vertex), refused);
        assert_eq!(mesh.add_face(&[v(0), v(1), vertex]).map(|_| ()), refused);
        let moved = mesh.set_position(vertex, Point::ZERO);
        assert_eq!(moved.map(|_| ()), refused);
        let split = mesh.split_vertex(vertex, None, Some(v(0)), Point::ZERO);
        assert_eq!(split.map(|_| ()), refused);
    }
    for edge in [2, 4, 5, u32::MAX].map(EdgeId::new) {
        let refused = Err(EditError::NoSuchEdge { edge });
        assert_eq!(mesh.flip_edge(edge).map(|_| ()), refused);
        assert_eq!(mesh.dissolve_edge(edge).map(|_| ()), refused);
        let collapsed = mesh.collapse_edge(edge, v(0), Point::ZERO);
        assert_eq!(collapsed.map(|_| ()), refused);
        assert_eq!(mesh.split_edge(edge, Point::ZERO).map(|_| ()), refused);
    }
}

#[test]
fn compact_releases_memory() {
    let polygons = sixfold_shapes::triangle_grid(40, 40).expect("small");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&polygons).expect("manifold");
    let whole = mesh.memory().total();
    let last = mesh.vertex_rows() as u32;
    for vertex in (60..last).rev().map(VertexId::new) {
        mesh.remove_vertex(vertex).expect("on a boundary");
    }
    assert!(mesh.memory().total() > whole, "rows stay, bits are added");
    mesh.compact();
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(mesh.hole_count(), 0);
    assert!(mesh.memory().total() < whole / 8);
}

#[test]
fn an_edited_mesh_can_be_refined_after_into_compact() {
    let mut mesh = mesh(4, [[0, 1, 2], [0, 2, 3]]);
    mesh.remove_face(FaceId::new(1)).expect("legal");
    let mesh = mesh.into_compact();
    let (mut numbers, mut child) = (Ranks::default(), HalfEdgeMesh::empty());
    mesh.number_edges(&mut numbers);
    let done = mesh.split_into(Split::Quads, &numbers, &mut child);
    assert_eq!(done, Ok(()));
    assert_eq!((child.face_count(), child.vertex_count()), (3, 4 + 3 + 1));
    assert_eq!(child.validate(), Ok(()));
}
