//! All representations are the same mesh: those that hold it answer alike, and those that do not
//! say why in the words of the contract.

use conformance::strategy::{any_mesh, faulty_mesh, manifold_mesh};
use conformance::{answers, compact, gallery, verdict, welded};
use proptest::prelude::*;
use sixfold::{PolygonMesh, Representation, for_each_representation};

/// Every refusal is the one that brute force finds, and the others answer every query alike.
///
/// Structures that keep coincident vertices apart are compared on the mesh itself, and all of them
/// on the mesh welded: there, names are given in an order in which even the soup can give them.
pub(crate) fn agree(polygons: &PolygonMesh) {
    for_each_representation!(M => {
        let expected = verdict(&M::CAPABILITIES, polygons).err();
        let refusal = M::from_polygons(polygons).err();
        assert_eq!(refusal, expected, "{} on {}", M::NAME, compact(polygons));
    });
    answer_alike(polygons, false);
    if let Ok(welded) = welded(polygons) {
        answer_alike(&welded, true);
    }
}

/// Compares each structure that holds `polygons` with the first that does.
fn answer_alike(polygons: &PolygonMesh, welded: bool) {
    let mut first = None;
    for_each_representation!(M => {
        if (welded || M::CAPABILITIES.coincident_vertices)
            && let Some(got) = answers::<M>(polygons)
        {
            let (name, expected) = first.get_or_insert_with(|| (M::NAME, got.clone()));
            for (question, answer) in expected.iter() {
                let mesh = compact(polygons);
                assert_eq!(got.get(question), Some(answer), "{question}, {} against {name}, on {mesh}", M::NAME);
            }
            assert_eq!(got.len(), expected.len(), "rings, {} against {name}", M::NAME);
        }
    });
}

#[test]
fn gallery_meshes_are_answered_alike() {
    for specimen in gallery() {
        agree(&specimen.polygons);
    }
}

/// A comparison of one structure with itself would prove nothing.
#[test]
fn every_representation_holds_a_closed_triangle_mesh() {
    let icosahedron = sixfold::shapes::icosahedron();
    let mut held = 0;
    for_each_representation!(M => {
        assert!(answers::<M>(&icosahedron).is_some(), "{}", M::NAME);
        held += 1;
    });
    assert_eq!(held, sixfold::roster().len());
    assert!(held >= 3);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn manifolds_are_answered_alike(polygons in manifold_mesh()) {
        agree(&polygons);
    }

    #[test]
    fn faulty_meshes_are_answered_or_refused_alike(faulty in faulty_mesh()) {
        agree(&faulty.polygons);
    }

    #[test]
    fn chaos_is_answered_or_refused_alike(polygons in any_mesh()) {
        agree(&polygons);
    }
}
