//! Example meshes from lectures on mesh data structures, including the faults of the printed
//! meshes.

use sixfold_core::{Point, PolygonMesh};

use super::Named;

/// Returns all meshes of the lectures, and a corrected version of the face-vertex box.
pub(super) fn fixtures() -> Vec<Named> {
    let with_lids = |lids: [[u32; 3]; 4]| {
        let faces = [&BOX_SIDES[..], &lids].concat();
        PolygonMesh::new(box_points(), faces).expect("the lecture's box")
    };
    vec![
        (
            "lecture: half-edge cube",
            PolygonMesh::new(CUBE_POINTS.map(Point::from_array), half_edge_cube())
                .expect("the lecture's cube"),
        ),
        (
            "lecture: indexed cube, some faces reversed",
            PolygonMesh::new(CUBE_POINTS.map(Point::from_array), INDEXED_CUBE)
                .expect("the lecture's cube"),
        ),
        (
            "lecture: indexed tetrahedron, some faces reversed",
            PolygonMesh::new(TETRAHEDRON_POINTS.map(Point::from_array), TETRAHEDRON)
                .expect("the lecture's tetrahedron"),
        ),
        (
            "lecture: face-vertex box with a misplaced lid",
            with_lids(FAULTY_LID),
        ),
        (
            "lecture: face-vertex box as in its lists, a lid reversed",
            with_lids(LISTED_LID),
        ),
        (
            "lecture: face-vertex box, corrected",
            with_lids(LISTED_LID.map(|[a, b, c]| [a, c, b])),
        ),
    ]
}

const CUBE_POINTS: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

/// By half-edge: its origin, and the next half-edge along its face.
const HALF_EDGES: [(u32, usize); 24] = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (4, 5),
    (5, 6),
    (1, 7),
    (0, 4),
    (1, 9),
    (5, 10),
    (6, 11),
    (2, 8),
    (2, 13),
    (6, 14),
    (7, 15),
    (3, 12),
    (7, 17),
    (4, 18),
    (0, 19),
    (3, 16),
    (5, 21),
    (4, 22),
    (7, 23),
    (6, 20),
];

/// Returns the faces of the half-edge table.
fn half_edge_cube() -> [[u32; 4]; 6] {
    [0, 8, 4, 16, 12, 20].map(|first| {
        let mut half_edge = first;
        [(); 4].map(|()| {
            let (start, next) = HALF_EDGES[half_edge];
            half_edge = next;
            start
        })
    })
}

const INDEXED_CUBE: [[u32; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
    [4, 5, 6, 7],
];

const TETRAHEDRON_POINTS: [[f32; 3]; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]];

fn box_points() -> Vec<Point> {
    let centres = [[0.5, 0.5, 1.0], [0.5, 0.5, 0.0]];
    CUBE_POINTS
        .into_iter()
        .chain(centres)
        .map(Point::from_array)
        .collect()
}

/// The four walls (faces f0 to f7) and the lid around vertex v8 (faces f8 to f11).
const BOX_SIDES: [[u32; 3]; 12] = [
    [0, 4, 5],
    [0, 5, 1],
    [1, 5, 6],
    [1, 6, 2],
    [2, 6, 7],
    [2, 7, 3],
    [3, 7, 4],
    [3, 4, 0],
    [8, 5, 4],
    [8, 6, 5],
    [8, 7, 6],
    [8, 4, 7],
];

/// Faces f12 to f15 as printed: a second lid on edges that already have a lid.
const FAULTY_LID: [[u32; 3]; 4] = [[9, 5, 4], [9, 6, 5], [9, 7, 6], [9, 4, 7]];

/// Faces f12 to f15 as in the printed vertex lists. Their orientation does not match the
/// orientation of the walls.
const LISTED_LID: [[u32; 3]; 4] = [[9, 1, 0], [9, 2, 1], [9, 3, 2], [9, 0, 3]];
