use sixfold_core::{PolygonMesh, Representation};

use super::*;

/// Splits two triangles with a common edge, which c1 and c5 face. The corners c0, c1, c2, c3 and c4
/// face the five edges.
fn split(split: Split) -> CornerTable {
    let positions = [0.0, 1.0, 2.0, 3.0].map(Point::splat);
    let polygons = PolygonMesh::new(positions, [[0, 1, 2], [0, 2, 3]]).expect("valid");
    let mesh = CornerTable::from_polygons(&polygons).expect("manifold");
    let mut numbers = EdgeNumbers::default();
    mesh.number_edges(&mut numbers);
    let mut child = CornerTable::empty();
    let done = mesh.split_into(split, &numbers, &mut child);
    done.expect("triangles");
    child
}

const NONE: u32 = u32::MAX;

fn rows(slots: &[Slot<CornerId>]) -> Vec<u32> {
    let rows = slots.iter().map(|c| c.get().map_or(NONE, RowId::row));
    rows.collect()
}

#[test]
fn splitting_two_triangles_in_four_gives_the_expected_tables() {
    let child = split(Split::Triangles);
    let vertices = [
        [0, 6, 5, 6, 1, 4, 5, 4, 2, 4, 5, 6],
        [0, 5, 8, 5, 2, 7, 8, 7, 3, 7, 8, 5],
    ];
    let got = child.corner_vertices().iter().map(|v| v.row());
    assert!(got.eq(vertices.into_iter().flatten()));
    let opposites = [
        [9, 14, NONE, NONE, 10, NONE, NONE, 17, 11, 0, 4, 8],
        [21, NONE, 1, NONE, 22, 7, NONE, NONE, 23, 12, 16, 20],
    ];
    assert_eq!(rows(child.opposite_corners()), opposites.as_flattened());
    assert_eq!(
        rows(child.vertex_corners()),
        [0, 4, 16, 20, 7, 2, 3, 19, 14]
    );
}

#[test]
fn splitting_two_triangles_in_three_gives_the_expected_tables() {
    // v4 and v5 are the points of the triangles, v6 to v13 the points of the boundary edges.
    let child = split(Split::Sqrt3 { trisect: true });
    let vertices = [
        [1, 6, 4],
        [2, 5, 4],
        [0, 8, 4],
        [2, 10, 5],
        [3, 12, 5],
        [0, 4, 5],
        [6, 7, 4],
        [7, 2, 4],
        [8, 9, 4],
        [9, 1, 4],
        [10, 11, 5],
        [11, 3, 5],
        [12, 13, 5],
        [13, 0, 5],
    ];
    let got = child.corner_vertices().iter().map(|v| v.row());
    assert!(got.eq(vertices.into_iter().flatten()));
    let opposites = [
        [19, 27, NONE],
        [15, 21, 10],
        [25, 17, NONE],
        [31, 5, NONE],
        [37, 33, NONE],
        [3, 39, 7],
        [22, 0, NONE],
        [4, 18, NONE],
        [28, 6, NONE],
        [1, 24, NONE],
        [34, 9, NONE],
        [13, 30, NONE],
        [40, 12, NONE],
        [16, 36, NONE],
    ];
    assert_eq!(rows(child.opposite_corners()), opposites.as_flattened());
    // v0 keeps the triangle of c2, v1 the triangle of c0, v2 the triangle of c3, and v3 the
    // triangle of c4.
    let corners = [6, 0, 9, 12, 2, 11, 18, 21, 24, 27, 30, 33, 36, 39];
    assert_eq!(rows(child.vertex_corners()), corners);
    let whole = split(Split::Sqrt3 { trisect: false });
    let opposites = [
        [4, 6, NONE],
        [15, 0, 10],
        [1, 17, NONE],
        [13, 5, NONE],
        [16, 9, NONE],
        [3, 12, 7],
    ];
    assert_eq!(rows(whole.opposite_corners()), opposites.as_flattened());
    assert_eq!(rows(whole.vertex_corners()), [6, 0, 9, 12, 2, 11]);
}
