//! The laws on the six structures, and the tests of the laws themselves.
//!
//! They are in this package and not in the crates of the structures, because what is compiled for each structure is
//! compiled without optimisation here (profile `test` in the workspace's `Cargo.toml`).

use sixfold::{CornerTable, HalfEdgeMesh, MeshQuery, Representation};
use sixfold_conformance::{GalleryMesh, check_fold, gallery};

mod detection;
mod flawed;
mod strategies;
mod triangulation;

mod polygon_soup {
    sixfold_conformance::suite!(sixfold::PolygonSoup);
    sixfold_conformance::edit_suite!(sixfold::EditablePolygonSoup);
}

mod indexed_face_set {
    sixfold_conformance::suite!(sixfold::IndexedFaceSet);
    sixfold_conformance::edit_suite!(sixfold::EditableIndexedFaceSet);
}

/// Makes the tests of a structure that can also refine its own tables and step from side to side.
macro_rules! linked_suite {
    ($mesh:ty, $editable:ty) => {
        sixfold_conformance::suite!($mesh);
        sixfold_conformance::refine_suite!($mesh);
        sixfold_conformance::edit_suite!($editable);
        sixfold_conformance::walk_suite!($mesh, $editable);
    };
}

mod face_vertex {
    linked_suite!(sixfold::FaceVertexMesh, sixfold::EditableFaceVertexMesh);
}

mod winged_edge {
    linked_suite!(sixfold::WingedEdgeMesh, sixfold::EditableWingedEdgeMesh);
}

mod half_edge {
    linked_suite!(sixfold::HalfEdgeMesh, sixfold::EditableHalfEdgeMesh);
}

mod corner_table {
    linked_suite!(sixfold::CornerTable, sixfold::EditableCornerTable);
}

/// A correct and slow structure.
mod face_and_edge_lists {
    sixfold_conformance::suite!(crate::face_and_edge_lists::FaceAndEdgeLists);
    sixfold_conformance::walk_suite!(crate::face_and_edge_lists::FaceAndEdgeLists);
}

#[test]
fn the_public_walks_yield_the_same_by_next_and_by_fold() {
    for GalleryMesh { name, polygons } in gallery() {
        if let Ok(mesh) = HalfEdgeMesh::from_polygons(&polygons) {
            for v in mesh.vertices() {
                check_fold(name, "leaving", v, || mesh.leaving(v));
            }
            for f in mesh.faces() {
                check_fold(name, "around_face", f, || mesh.around_face(f));
            }
        }
        if let Ok(mesh) = CornerTable::from_polygons(&polygons) {
            for v in mesh.vertices() {
                check_fold(name, "corners_at", v, || mesh.corners_at(v));
            }
        }
    }
}
