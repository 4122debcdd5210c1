//! Checks that all structures that can hold a mesh give the same answers. The other structures must
//! refuse the mesh with the expected error.

use proptest::prelude::*;
use sixfold::{MeshQuery, PolygonMesh, Representation, for_each_representation};
use sixfold_conformance::strategy::{any_mesh, faulty_mesh, manifold_mesh};
use sixfold_conformance::{answers, expected_check, gallery, one_line, welded};

/// Checks the error of every structure, and compares the answers of the structures that can hold
/// the mesh.
///
/// Structures that can hold several vertices at one position are compared on the mesh itself. All
/// structures are compared on the welded mesh, whose vertices have the order that a soup uses.
pub(crate) fn compare_structures(polygons: &PolygonMesh) {
    for_each_representation!(M => {
        let expected = expected_check(&M::CAPABILITIES, polygons).err();
        let refusal = M::from_polygons(polygons).err();
        assert_eq!(refusal, expected, "{} on {}", M::NAME, one_line(polygons));
    });
    compare_answers(polygons, false);
    if let Ok(welded) = welded(polygons) {
        compare_answers(&welded, true);
    }
}

fn compare_answers(polygons: &PolygonMesh, welded: bool) {
    let mut first = None;
    for_each_representation!(M => {
        if (welded || M::CAPABILITIES.coincident_vertices)
            && let Some(got) = answers::<M>(polygons)
        {
            let (name, expected) = first.get_or_insert_with(|| (M::NAME, got.clone()));
            for (query, answer) in expected.iter() {
                // The text of the mesh is made only for a failure, because there are many queries.
                let on = || format!("{query}, {} against {name}, on {}", M::NAME, one_line(polygons));
                assert_eq!(got.get(query), Some(answer), "{}", on());
            }
            assert_eq!(got.len(), expected.len(), "rings, {} against {name}", M::NAME);
        }
    });
}

#[test]
fn all_give_the_same_answers_on_the_gallery() {
    for entry in gallery() {
        compare_structures(&entry.polygons);
    }
}

#[test]
fn every_representation_holds_a_closed_triangle_mesh() {
    let icosahedron = sixfold::shapes::icosahedron();
    let mut structures = 0;
    for_each_representation!(M => {
        assert!(answers::<M>(&icosahedron).is_some(), "{}", M::NAME);
        structures += 1;
    });
    assert_eq!(structures, sixfold::structure_infos().len());
    assert!(structures >= 3);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn all_give_the_same_answers_on_manifolds(polygons in manifold_mesh()) {
        compare_structures(&polygons);
    }

    #[test]
    fn all_give_the_same_answers_or_refusals_on_faulty_meshes(faulty in faulty_mesh()) {
        compare_structures(&faulty.polygons);
    }

    #[test]
    fn all_give_the_same_answers_or_refusals_on_any_mesh(polygons in any_mesh()) {
        compare_structures(&polygons);
    }
}
