//! The conformance tests for the corner table.

use sixfold_conformance::{GalleryMesh, check_fold, gallery};
use sixfold_core::{MeshQuery, Representation};
use sixfold_corner_table::CornerTable;

sixfold_conformance::suite!(sixfold_corner_table::CornerTable);
sixfold_conformance::refine_suite!(sixfold_corner_table::CornerTable);
sixfold_conformance::edit_suite!(sixfold_corner_table::EditableCornerTable);
sixfold_conformance::walk_suite!(
    sixfold_corner_table::CornerTable,
    sixfold_corner_table::EditableCornerTable
);

#[test]
fn the_public_walk_yields_the_same_by_next_and_by_fold() {
    for GalleryMesh { name, polygons } in gallery() {
        let Ok(mesh) = CornerTable::from_polygons(&polygons) else {
            continue;
        };
        for v in mesh.vertices() {
            check_fold(name, "corners_at", v, || mesh.corners_at(v));
        }
    }
}
