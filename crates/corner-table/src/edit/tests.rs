//! Tests of deleted elements and of handles of missing elements.

use sixfold_core::{MeshQuery, PolygonMesh};

use super::*;

pub(super) fn table(vertices: u16, triangles: &[[u32; 3]]) -> EditableCornerTable {
    let positions: Vec<_> = (0..vertices).map(|i| Point::splat(i.into())).collect();
    let polygons = PolygonMesh::new(positions, triangles.iter().copied()).expect("valid");
    EditableCornerTable::from_polygons(&polygons).expect("manifold")
}

/// Returns three triangles; the third triangle and v4 are deleted.
fn with_holes() -> EditableCornerTable {
    let mut mesh = table(8, &[[0, 1, 2], [0, 2, 3], [4, 5, 6]]);
    mesh.remove_face(FaceId::new(2)).expect("the face exists");
    mesh.remove_vertex(VertexId::new(4))
        .expect("the vertex exists");
    assert_eq!(mesh.validate(), Ok(()));
    mesh
}

#[test]
fn deleted_elements_are_not_listed_or_counted() {
    let mesh = with_holes();
    assert_eq!(
        [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
        [7, 5, 2]
    );
    assert_eq!(mesh.corner_count(), 6);
    assert!(mesh.edges().all(|e| e.index() < 6));
    let bytes = mesh.memory();
    let of_holes = bytes
        .tables
        .iter()
        .filter(|table| table.table.contains("holes"));
    assert_eq!(of_holes.count(), 2);
}

#[test]
fn handles_of_missing_elements_are_refused() {
    let mut mesh = with_holes();
    for row in [4, 8, u32::MAX] {
        let vertex = VertexId::new(row);
        let refused = mesh.set_position(vertex, Point::ZERO);
        assert_eq!(refused, Err(EditError::NoSuchVertex { vertex }));
    }
    // c1 names the edge that c5 faces; c7 is a deleted corner; c9 does not exist.
    for row in [5, 7, 9, u32::MAX] {
        let edge = EdgeCorner::new(row);
        let refused = mesh.flip_edge(edge);
        assert_eq!(refused, Err(EditError::NoSuchEdge { edge }));
    }
    for row in [2, 3, u32::MAX] {
        let face = FaceId::new(row);
        let refused = mesh.poke_face(face, Point::ZERO);
        assert_eq!(refused, Err(EditError::NoSuchFace { face }));
    }
}

#[test]
#[should_panic(expected = "no vertex v4: it was deleted")]
fn listing_the_edges_of_a_deleted_vertex_panics() {
    let _ = with_holes().vertex_edges(VertexId::new(4)).count();
}

#[test]
#[should_panic(expected = "no vertex v4: it was deleted")]
fn the_position_of_a_deleted_vertex_panics() {
    with_holes().position(VertexId::new(4));
}

#[test]
#[should_panic(expected = "no face f2: it was deleted")]
fn listing_the_vertices_of_a_deleted_face_panics() {
    let _ = with_holes().face_vertices(FaceId::new(2)).count();
}

#[test]
#[should_panic(expected = "no face f2: it was deleted")]
fn listing_the_neighbours_of_a_deleted_face_panics() {
    let _ = with_holes().face_faces(FaceId::new(2)).count();
}

#[test]
#[should_panic(expected = "no edge e7: the triangle of that corner was deleted")]
fn the_ends_of_a_deleted_edge_panic() {
    with_holes().edge_vertices(EdgeCorner::new(7));
}

#[test]
#[should_panic(expected = "no edge e7: the triangle of that corner was deleted")]
fn listing_the_neighbours_of_a_deleted_edge_panics() {
    let _ = with_holes().edge_edges(EdgeCorner::new(7)).count();
}
