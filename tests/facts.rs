//! Compares [`sixfold::Facts`] with brute force on small meshes. (The tests of `io` compare real
//! meshes with `truth.json`.)

mod brute_force;

use proptest::prelude::*;
use sixfold::{Facts, PolygonMesh};
use sixfold_conformance::strategy::{any_mesh, faulty_mesh, manifold_mesh};
use sixfold_conformance::{gallery, one_line};

fn compare_with_brute_force(polygons: &PolygonMesh) {
    let expected = brute_force::facts(polygons);
    assert_eq!(
        Facts::from_polygons(polygons),
        expected,
        "{}",
        one_line(polygons)
    );
    let of_faces = Facts::from_faces(polygons.vertex_count(), polygons.faces());
    assert_eq!(of_faces.as_ref(), Ok(&expected), "{}", one_line(polygons));
}

#[test]
fn facts_of_the_gallery_equal_brute_force() {
    for entry in gallery() {
        compare_with_brute_force(&entry.polygons);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn facts_of_manifolds_equal_brute_force(polygons in manifold_mesh()) {
        compare_with_brute_force(&polygons);
    }

    #[test]
    fn facts_of_faulty_meshes_equal_brute_force(faulty in faulty_mesh()) {
        compare_with_brute_force(&faulty.polygons);
    }

    #[test]
    fn facts_of_any_mesh_equal_brute_force(polygons in any_mesh()) {
        compare_with_brute_force(&polygons);
    }
}
