//! Tests of the tables after an edit, their size, and panics.

use crate::EditableFaceVertexMesh;
use crate::mesh::{BLANK_PLACE, Fan};
use sixfold_core::{EditRecord, FaceSpans, MeshQuery, PolygonMesh, Representation};

use super::*;

fn build(faces: &[&[u32]], vertices: u16) -> EditableFaceVertexMesh {
    let positions = (0..vertices).map(|i| Point::splat(f32::from(i)));
    let polygons = PolygonMesh::new(positions.collect::<Vec<_>>(), faces).expect("valid");
    EditableFaceVertexMesh::from_polygons(&polygons).expect("holds every mesh")
}

fn v(row: u32) -> VertexId {
    VertexId::new(row)
}

fn f(row: u32) -> FaceId {
    FaceId::new(row)
}

fn edge(a: u32, b: u32) -> Edge {
    Pair::new(v(a), v(b))
}

/// Returns the start in the pool and the faces of each fan.
fn fans(mesh: &EditableFaceVertexMesh) -> Vec<(u32, Vec<usize>)> {
    let fan = |v: VertexId| {
        let faces = mesh.fan(v).iter().map(|f| f.index());
        (mesh.fans()[v.index()].start, faces.collect())
    };
    mesh.vertices().map(fan).collect()
}

#[test]
fn a_flip_changes_one_corner_per_face_and_four_fans() {
    // A square v0 v1 v2 v3, cut from v0 to v2.
    let mut mesh = build(&[&[0, 1, 2], &[0, 2, 3]], 4);
    let mut record = EditRecord::new();
    assert_eq!(
        mesh.flip_edge_logged(edge(0, 2), &mut record),
        Ok(edge(1, 3))
    );
    assert_eq!(mesh.validate(), Ok(()));
    // f1 runs along the edge from v0 to v2 and keeps v0.
    let corners: Vec<usize> = mesh.corners().iter().map(|v| v.index()).collect();
    assert_eq!(corners, [3, 1, 2, 0, 1, 3]);
    // The fans of v0 and v2 shrank in place. The fan of v1 moved to the end. The fan of v3 is last.
    let expected = [(0, vec![1]), (6, vec![0, 1]), (3, vec![0]), (5, vec![1])];
    assert_eq!(fans(&mesh)[..3], expected[..3]);
    assert_eq!(record.edges.renamed, [[edge(0, 2), edge(1, 3)]]);
    assert!(record.vertices.is_empty() && record.faces.is_empty());
}

#[test]
fn a_fan_uses_the_blank_behind_it_before_it_moves() {
    let mut mesh = build(&[&[0, 1, 2], &[0, 2, 3], &[0, 3, 4]], 5);
    assert_eq!(mesh.fans()[0], Fan { start: 0, len: 3 });
    mesh.remove_face(f(1)).expect("the face exists");
    assert_eq!(mesh.fan(v(0)), [f(0), f(2)]);
    assert_eq!(mesh.pool()[2], BLANK_PLACE);
    let again = mesh.add_face(&[v(0), v(2), v(3)]);
    assert_eq!(again, Ok(f(3)), "rows are not reused");
    assert_eq!(mesh.fans()[0], Fan { start: 0, len: 3 });
    let places = mesh.pool().len();
    let more = mesh.add_face(&[v(0), v(4), v(1)]);
    more.expect("three existing vertices");
    let moved = mesh.fans()[0];
    assert_eq!((moved.start as usize, moved.len), (places, 4));
    assert_eq!(mesh.pool()[..3], [BLANK_PLACE; 3]);
    // The new fan has eight places, four of them blank.
    assert_eq!(mesh.pool()[places + 4..places + 8], [BLANK_PLACE; 4]);
    assert_eq!(mesh.validate(), Ok(()));
}

#[test]
fn a_fan_that_grows_face_by_face_leaves_few_blanks() {
    let mut mesh = build(&[&[0, 1, 2]], 3);
    for next in 3..1003 {
        let at = Point::splat(next as f32);
        let added = mesh.add_vertex(at).expect("there is room");
        let corners = [v(0), VertexId::new(next - 1), added];
        mesh.add_face(&corners).expect("legal here");
    }
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(mesh.fan(v(0)).len(), 1001);
    // The hub moved at each power of two, to twice its length. Each rim vertex moved once, to 8
    // places.
    let hub = 4 * 1001;
    assert!(mesh.pool().len() <= hub + 9 * 1002 + 3);
    let one_by_one = mesh.pool().len();
    mesh.compact();
    assert_eq!(mesh.pool().len(), 3 * 1001);
    assert!(mesh.pool().len() < one_by_one / 2);
}

#[test]
fn compacting_gives_the_tables_of_a_new_build() {
    let mut mesh =
        EditableFaceVertexMesh::from_polygons(&sixfold_shapes::icosahedron()).expect("triangles");
    let faces: Vec<FaceId> = mesh.faces().collect();
    for &f in &faces {
        let at = Point::splat(f.index() as f32);
        mesh.poke_face(f, at).expect("always legal");
    }
    mesh.remove_vertex(v(3)).expect("v3 exists");
    mesh.split_edge(edge(0, 12), Point::ONE)
        .expect("it is an edge");
    let e = mesh.edges().find(|e| e.has(v(5))).expect("it has faces");
    mesh.collapse_edge(e, v(5), Point::ZERO)
        .expect("many faces remain");
    assert!(matches!(mesh.spans(), FaceSpans::Scattered(_)));
    let polygons = mesh.to_polygons();
    let names = mesh.compact_with_map();
    let rebuilt = EditableFaceVertexMesh::from_polygons(&polygons).expect("holds every mesh");
    assert_eq!(format!("{mesh:?}"), format!("{rebuilt:?}"));
    assert!(
        mesh.memory().total() <= 2 * rebuilt.memory().total(),
        "memory was released"
    );
    assert_eq!(mesh.vertex_rows(), mesh.vertex_count());
    // The first edge of v5 leads to v0.
    assert_eq!([0, 3].map(|gone| names.vertices[v(gone)]), [None; 2]);
    assert_eq!(names.vertices[v(4)], Some(v(2)));
}

#[test]
fn handles_of_missing_elements_are_refused() {
    let mut mesh = build(&[&[0, 1, 2], &[0, 2, 3]], 4);
    mesh.remove_vertex(v(3)).expect("v3 exists");
    for vertex in [v(3), v(4)] {
        let refused = Err(EditError::NoSuchVertex { vertex });
        assert_eq!(mesh.set_position(vertex, Point::ONE), refused);
        assert_eq!(
            mesh.split_vertex(vertex, None, Some(v(0)), Point::ONE),
            refused
        );
        assert_eq!(
            mesh.add_face(&[v(0), v(1), vertex]),
            Err(EditError::NoSuchVertex { vertex })
        );
    }
    for face in [f(1), f(2)] {
        assert_eq!(
            mesh.poke_face(face, Point::ONE),
            Err(EditError::NoSuchFace { face })
        );
    }
    for e in [edge(0, 3), edge(0, 4), edge(1, 1), edge(3, 3)] {
        let refused = Err(EditError::NoSuchEdge { edge: e });
        assert_eq!(mesh.split_edge(e, Point::ONE), refused);
        assert_eq!(mesh.collapse_edge(e, v(0), Point::ONE), refused);
        let refused = Err(EditError::NoSuchEdge { edge: e });
        assert_eq!(mesh.flip_edge(e), refused);
    }
    let diagonal = build(&[&[0, 1, 2, 3]], 4).collapse_edge(edge(0, 2), v(0), Point::ONE);
    assert_eq!(diagonal, Err(EditError::NoSuchEdge { edge: edge(0, 2) }));
}

/// Returns the square without v3 and the face of v3.
fn without_a_corner() -> EditableFaceVertexMesh {
    let mut mesh = build(&[&[0, 1, 2], &[0, 2, 3]], 4);
    mesh.remove_vertex(v(3)).expect("v3 exists");
    mesh
}

#[test]
#[should_panic(expected = "no vertex v3: it was deleted")]
fn the_fan_of_a_deleted_vertex_panics() {
    let _ = without_a_corner().vertex_vertices(v(3));
}

#[test]
#[should_panic(expected = "no vertex v3: it was deleted")]
fn the_position_of_a_deleted_vertex_panics() {
    let _ = without_a_corner().position(v(3));
}

#[test]
#[should_panic(expected = "no face f1: it was deleted")]
fn the_corners_of_a_deleted_face_panic() {
    let _ = without_a_corner().face_vertices(f(1));
}
