use sixfold_core::{PolygonMesh, Representation};

use super::*;

/// Splits one triangle. Edges e0 from v0 to v1 and e2 from v1 to v2 have the face on the left. Edge
/// e1 from v0 to v2 has the face on the right. The ranks of the runs of e0, e2 and e1 are 0, 2 and
/// 1.
fn split(split: Split) -> WingedEdgeMesh {
    let polygons = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]]);
    let mesh = WingedEdgeMesh::from_polygons(&polygons.expect("valid")).expect("manifold");
    let mut numbers = Ranks::default();
    mesh.number_edges(&mut numbers);
    let mut child = WingedEdgeMesh::empty();
    let done = mesh.split_into(split, &numbers, &mut child);
    done.expect("a triangle");
    child
}

type Row = ([u32; 2], [Option<u32>; 2], [u32; 2], [u32; 2]);

/// Returns the ends, the faces, the next wings and the previous wings, each left then right.
fn rows(mesh: &WingedEdgeMesh) -> Vec<Row> {
    let row_of = |edge: &Edge| {
        (
            edge.ends().map(RowId::row),
            edge.faces().map(|face| face.map(RowId::row)),
            edge.next().map(RowId::row),
            edge.prev().map(RowId::row),
        )
    };
    mesh.edge_records().iter().map(row_of).collect()
}

fn spokes(mesh: &WingedEdgeMesh) -> Vec<Option<u32>> {
    let spokes = mesh.spoke_rows().iter();
    spokes.map(|e| e.get().map(RowId::row)).collect()
}

#[test]
fn a_split_into_quads_gives_the_expected_tables() {
    // v3 is the face point; v4, v5 and v6 are the middles.
    let child = split(Split::Quads);
    let expected = [
        ([0, 4], [Some(0), None], [6, 2], [2, 1]),
        ([4, 1], [Some(2), None], [4, 0], [6, 4]),
        ([0, 5], [None, Some(0)], [3, 0], [0, 7]),
        ([5, 2], [None, Some(1)], [5, 7], [2, 5]),
        ([1, 6], [Some(2), None], [8, 1], [1, 5]),
        ([6, 2], [Some(1), None], [3, 4], [8, 3]),
        ([4, 3], [Some(0), Some(2)], [7, 1], [0, 8]),
        ([5, 3], [Some(1), Some(0)], [8, 2], [3, 6]),
        ([6, 3], [Some(2), Some(1)], [6, 5], [4, 7]),
    ];
    assert_eq!(rows(&child), expected);
    assert_eq!(child.side_rows(), [6, 7, 8].map(EdgeId::new));
    assert_eq!(spokes(&child), [0, 4, 3, 6, 1, 2, 5].map(Some));
}

#[test]
fn a_split_into_triangles_gives_the_expected_tables() {
    // v3, v4 and v5 are the middles; f3 is the middle triangle.
    let child = split(Split::Triangles);
    let expected = [
        ([0, 3], [Some(0), None], [6, 2], [2, 1]),
        ([3, 1], [Some(2), None], [4, 0], [8, 4]),
        ([0, 4], [None, Some(0)], [3, 0], [0, 6]),
        ([4, 2], [None, Some(1)], [5, 7], [2, 5]),
        ([1, 5], [Some(2), None], [8, 1], [1, 5]),
        ([5, 2], [Some(1), None], [3, 4], [7, 3]),
        ([3, 4], [Some(0), Some(3)], [2, 8], [0, 7]),
        ([4, 5], [Some(1), Some(3)], [5, 6], [3, 8]),
        ([5, 3], [Some(2), Some(3)], [1, 7], [4, 6]),
    ];
    assert_eq!(rows(&child), expected);
    assert_eq!(child.side_rows(), [6, 7, 8, 6].map(EdgeId::new));
    assert_eq!(spokes(&child), [0, 4, 3, 1, 2, 5].map(Some));
}
