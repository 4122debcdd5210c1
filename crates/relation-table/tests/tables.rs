//! Every table row equals the answer of the structure, on random meshes.

use proptest::prelude::*;
use sixfold_conformance::strategy::any_mesh;
use sixfold_core::{
    EdgeId, FaceId, MeshEdit, MeshMove, MeshQuery, MoveError, Point, PolygonMesh, Relation,
    Representation, VertexId,
};
use sixfold_half_edge::{EditableHalfEdgeMesh, HalfEdgeMesh};
use sixfold_indexed_face_set::IndexedFaceSet;
use sixfold_polygon_soup::PolygonSoup;
use sixfold_relation_table::{Numbering, RelationTables};

fn check_tables<M: MeshQuery>(mesh: &M) -> Result<(), TestCaseError> {
    let numbers = Numbering::new(mesh);
    let tables = RelationTables::new(mesh, &Relation::ALL).expect("few items");
    prop_assert_eq!(tables.positions(), numbers.positions());
    prop_assert_eq!(tables.edge_count(), mesh.edge_count());
    prop_assert_eq!(tables.face_count(), mesh.face_count());
    macro_rules! check_table {
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
                prop_assert_eq!(table.row(number), row);
                let asked: Vec<_> = tables.$relation(number).into_iter().collect();
                prop_assert_eq!(row, &asked[..]);
                prop_assert_eq!(number, numbers.$from(element));
                prop_assert_eq!(number.index(), at);
            }
            prop_assert_eq!(
                table.iter().map(|(_, row)| row.len()).sum::<usize>(),
                table.items().len()
            );
        };
    }
    check_table!(vertex_vertices, vertices, vertex, vertex);
    check_table!(vertex_edges, vertices, vertex, edge);
    check_table!(vertex_faces, vertices, vertex, face);
    check_table!(edge_vertices, edges, edge, vertex);
    check_table!(edge_edges, edges, edge, edge);
    check_table!(edge_faces, edges, edge, face);
    check_table!(face_vertices, faces, face, vertex);
    check_table!(face_edges, faces, face, edge);
    check_table!(face_faces, faces, face, face);
    let positions = numbers.positions();
    for v in mesh.vertices() {
        prop_assert_eq!(positions[numbers.vertex(v).index()], mesh.position(v));
    }
    Ok(())
}

fn check_structure<M: Representation>(polygons: &PolygonMesh) -> Result<(), TestCaseError> {
    match M::from_polygons(polygons) {
        Ok(mesh) => check_tables(&mesh),
        Err(_) => Ok(()), // this structure cannot hold the mesh
    }
}

proptest! {
    #[test]
    fn rows_equal_the_answers_of_the_structure(polygons in any_mesh()) {
        check_structure::<PolygonSoup>(&polygons)?;
        check_structure::<IndexedFaceSet>(&polygons)?;
        check_structure::<HalfEdgeMesh>(&polygons)?;
    }
}

#[test]
fn removed_elements_get_no_numbers() {
    let ball = sixfold_shapes::icosahedron();
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&ball).expect("closed");
    mesh.remove_face(FaceId::new(3)).expect("it exists");
    mesh.remove_vertex(VertexId::new(0)).expect("it exists");
    check_tables(&mesh).expect("the same answers");
    let numbers = Numbering::new(&mesh);
    assert_eq!(numbers.vertex(VertexId::new(1)), VertexId::new(0));
    assert_eq!(numbers.vertices().handle(0), VertexId::new(1));
    assert_eq!(
        numbers.edge(mesh.edges().next().expect("edges")),
        EdgeId::new(0)
    );
}

/// Other tables store one offset per row, and one offset at the end.
#[test]
fn tables_store_no_offsets_if_all_rows_have_one_length() {
    let ball = sixfold_shapes::icosahedron();
    let mesh = HalfEdgeMesh::from_polygons(&ball).expect("closed");
    let numbers = Numbering::new(&mesh);
    assert_eq!(numbers.face_vertices().expect("few").bytes(), 4 * 60);
    assert_eq!(numbers.vertex_faces().expect("few").bytes(), 4 * 60);
    let grid = sixfold_shapes::grid(2, 2).expect("small");
    let mesh = HalfEdgeMesh::from_polygons(&grid).expect("open");
    let table = Numbering::new(&mesh).vertex_faces().expect("few");
    assert_eq!(table.bytes(), 4 * (16 + 9 + 1));
    let empty = IndexedFaceSet::from_polygons(&PolygonMesh::default()).expect("empty");
    assert!(
        Numbering::new(&empty)
            .vertex_faces()
            .expect("empty")
            .is_empty()
    );
}

#[test]
fn vertices_of_tables_move() {
    let mesh = HalfEdgeMesh::from_polygons(&sixfold_shapes::cube()).expect("a manifold");
    let mut tables = RelationTables::new(&mesh, &[Relation::FaceVertices]).expect("small");
    let mut moved = tables.vertex_map(Point::ZERO);
    for v in tables.vertices() {
        moved[v] = 2.0 * tables.position(v);
    }
    tables
        .set_positions(&moved)
        .expect("as many positions as vertices");
    let v = VertexId::new(3);
    assert_eq!(tables.position(v), 2.0 * mesh.position(v));
    tables.set_position(v, Point::ONE);
    assert_eq!(tables.position(v), Point::ONE);
    let others = IndexedFaceSet::from_polygons(&sixfold_shapes::octahedron()).expect("any mesh");
    let others = others.vertex_map(Point::ZERO);
    let refused = MoveError::OtherMesh {
        given: 6,
        vertices: 8,
    };
    assert_eq!(tables.set_positions(&others), Err(refused));
    assert_eq!(tables.position(v), Point::ONE);
    let contained = [7, 8].map(|v| tables.contains_vertex(VertexId::new(v)));
    assert_eq!(contained, [true, false]);
    assert!(tables.contains_edge(EdgeId::new(11)) && !tables.contains_edge(EdgeId::new(12)));
    assert!(tables.contains_face(FaceId::new(5)) && !tables.contains_face(FaceId::new(6)));
    assert_eq!(
        tables.bytes(),
        8 * 12 + 6 * 4 * 4,
        "positions, and four corners of each face"
    );
}

#[test]
#[should_panic(expected = "there is no table of vertex_faces: add `Relation::VertexFaces`")]
fn a_relation_without_a_table_is_named() {
    let mesh = HalfEdgeMesh::from_polygons(&sixfold_shapes::cube()).expect("a manifold");
    let tables = RelationTables::new(&mesh, &[Relation::FaceVertices]).expect("small");
    let _ = tables.vertex_faces(VertexId::new(0)).count();
}
