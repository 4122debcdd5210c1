//! [`sixfold::Facts`] against brute force on small meshes. (On real ones `truth.json` is the judge,
//! in the tests of `mesh-io`.)

mod brute_force;

use conformance::strategy::{any_mesh, faulty_mesh, manifold_mesh};
use conformance::{compact, gallery};
use proptest::prelude::*;
use sixfold::{Facts, PolygonMesh};

fn same(polygons: &PolygonMesh) {
    let expected = brute_force::facts(polygons);
    assert_eq!(Facts::of(polygons), expected, "{}", compact(polygons));
    let of_faces = Facts::of_faces(polygons.vertex_count(), polygons.faces());
    assert_eq!(of_faces.as_ref(), Ok(&expected), "{}", compact(polygons));
}

#[test]
fn gallery_meshes_have_their_facts() {
    for specimen in gallery() {
        same(&specimen.polygons);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn manifolds_have_their_facts(polygons in manifold_mesh()) {
        same(&polygons);
    }

    #[test]
    fn faulty_meshes_have_their_facts(faulty in faulty_mesh()) {
        same(&faulty.polygons);
    }

    #[test]
    fn chaos_has_its_facts(polygons in any_mesh()) {
        same(&polygons);
    }
}
