//! Checks on random meshes that every table row equals the answer of the structure.

use proptest::prelude::*;
use sixfold_conformance::strategy::any_mesh;
use sixfold_core::{EdgeId, FaceId, MeshEdit, MeshQuery, PolygonMesh, Representation, VertexId};
use sixfold_half_edge::{EditableHalfEdgeMesh, HalfEdgeMesh};
use sixfold_indexed_face_set::IndexedFaceSet;
use sixfold_polygon_soup::PolygonSoup;
use sixfold_relation_table::Numbering;

/// Queries each element of the structure and compares the answer with its row.
fn tables_are_answers<M: MeshQuery>(mesh: &M) -> Result<(), TestCaseError> {
    let numbers = Numbering::of(mesh);
    macro_rules! same {
        ($relation:ident, $all:ident, $from:ident, $to:ident) => {
            let table = numbers.$relation().expect("few items");
            prop_assert_eq!(table.len(), mesh.$all().count());
            let rows = table.iter().zip(mesh.$all());
            for (at, ((number, row), element)) in rows.enumerate() {
                let answer = mesh.$relation(element).into_iter();
                let answer: Vec<_> = answer.map(|found| numbers.$to(found)).collect();
                prop_assert_eq!(
                    row,
                    &answer[..],
                    "{} of {:?}",
                    stringify!($relation),
                    element
                );
                prop_assert_eq!(table.of(number), row);
                prop_assert_eq!(number, numbers.$from(element));
                prop_assert_eq!(number.index(), at);
            }
            prop_assert_eq!(
                table.iter().map(|(_, row)| row.len()).sum::<usize>(),
                table.items().len()
            );
        };
    }
    same!(vertex_vertices, vertices, vertex, vertex);
    same!(vertex_edges, vertices, vertex, edge);
    same!(vertex_faces, vertices, vertex, face);
    same!(edge_vertices, edges, edge, vertex);
    same!(edge_edges, edges, edge, edge);
    same!(edge_faces, edges, edge, face);
    same!(face_vertices, faces, face, vertex);
    same!(face_edges, faces, face, edge);
    same!(face_faces, faces, face, face);
    let positions = numbers.positions();
    for v in mesh.vertices() {
        prop_assert_eq!(positions[numbers.vertex(v).index()], mesh.position(v));
    }
    Ok(())
}

fn on<M: Representation>(polygons: &PolygonMesh) -> Result<(), TestCaseError> {
    match M::from_polygons(polygons) {
        Ok(mesh) => tables_are_answers(&mesh),
        Err(_) => Ok(()), // this structure cannot hold the mesh
    }
}

proptest! {
    #[test]
    fn rows_equal_the_answers_of_the_structure(polygons in any_mesh()) {
        on::<PolygonSoup>(&polygons)?;
        on::<IndexedFaceSet>(&polygons)?;
        on::<HalfEdgeMesh>(&polygons)?;
    }
}

#[test]
fn removed_elements_get_no_numbers() {
    let ball = sixfold_shapes::icosahedron();
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&ball).expect("closed");
    mesh.remove_face(FaceId::new(3), &mut ())
        .expect("it exists");
    mesh.remove_vertex(VertexId::new(0), &mut ())
        .expect("it exists");
    tables_are_answers(&mesh).expect("the same answers");
    let numbers = Numbering::of(&mesh);
    assert_eq!(numbers.vertex(VertexId::new(1)), VertexId::new(0));
    assert_eq!(
        numbers.edge(mesh.edges().next().expect("edges")),
        EdgeId::new(0)
    );
}

/// Rows of one length need no offsets. Other tables store one offset per row, and one at the end.
#[test]
fn tables_store_no_offsets_if_all_rows_have_one_length() {
    let ball = sixfold_shapes::icosahedron();
    let mesh = HalfEdgeMesh::from_polygons(&ball).expect("closed");
    let numbers = Numbering::of(&mesh);
    assert_eq!(numbers.face_vertices().expect("few").bytes(), 4 * 60);
    assert_eq!(numbers.vertex_faces().expect("few").bytes(), 4 * 60);
    let grid = sixfold_shapes::grid(2, 2).expect("small");
    let mesh = HalfEdgeMesh::from_polygons(&grid).expect("open");
    let table = Numbering::of(&mesh).vertex_faces().expect("few");
    assert_eq!(table.bytes(), 4 * (16 + 9 + 1));
    let none = IndexedFaceSet::from_polygons(&PolygonMesh::default()).expect("empty");
    assert!(
        Numbering::of(&none)
            .vertex_faces()
            .expect("empty")
            .is_empty()
    );
}
