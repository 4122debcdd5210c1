//! The conformance tests for the half-edge mesh.

use sixfold_conformance::{GalleryMesh, check_fold, gallery};
use sixfold_core::{MeshQuery, Representation};
use sixfold_half_edge::HalfEdgeMesh;

sixfold_conformance::suite!(sixfold_half_edge::HalfEdgeMesh);
sixfold_conformance::refine_suite!(sixfold_half_edge::HalfEdgeMesh);
sixfold_conformance::edit_suite!(sixfold_half_edge::EditableHalfEdgeMesh);
sixfold_conformance::walk_suite!(
    sixfold_half_edge::HalfEdgeMesh,
    sixfold_half_edge::EditableHalfEdgeMesh
);

#[test]
fn the_public_walks_yield_the_same_by_next_and_by_fold() {
    for GalleryMesh { name, polygons } in gallery() {
        let Ok(mesh) = HalfEdgeMesh::from_polygons(&polygons) else {
            continue;
        };
        for v in mesh.vertices() {
            check_fold(name, "leaving", v, || mesh.leaving(v));
        }
        for f in mesh.faces() {
            check_fold(name, "around_face", f, || mesh.around_face(f));
        }
    }
}
