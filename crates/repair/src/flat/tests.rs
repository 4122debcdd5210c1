use sixfold_core::{FaceId, Facts, PolygonMesh};

use super::patch::Patch;
use crate::{Left, Step, StepCounts, measures, repair};

/// A box of side 2 with an additional vertex 8 in the middle of the edge from 0 to 1, which only the
/// bottom has. A face without area joins the edges.
fn split_box(front: &[&[u32]]) -> PolygonMesh {
    let mut points: Vec<[f32; 3]> = Vec::new();
    for (x, y) in [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)] {
        points.push([x, y, 0.0]);
    }
    points.extend_from_within(..);
    points[4..].iter_mut().for_each(|p| p[2] = 2.0);
    points.push([1.0, 0.0, 0.0]);
    let mut faces: Vec<&[u32]> = vec![
        &[1, 8, 0, 3, 2],
        &[4, 5, 6, 7],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
        &[0, 8, 1],
    ];
    faces.extend(front);
    PolygonMesh::new(points, faces).expect("valid")
}

fn removed(mesh: &PolygonMesh) -> (PolygonMesh, StepCounts, Vec<Left>) {
    let mut repaired = repair(mesh, &[Step::RemoveFlatFaces]).expect("small");
    let step = repaired.steps.remove(0);
    (repaired.polygons, step.counts, step.left)
}

#[test]
fn the_neighbour_gets_the_corner() {
    let with_triangles: &[&[u32]] = &[&[0, 1, 5], &[0, 5, 4]];
    let with_quad: &[&[u32]] = &[&[0, 1, 5, 4]];
    // A triangle becomes two, and a polygon remains one.
    for (front, faces) in [(with_triangles, 8), (with_quad, 6)] {
        let mesh = split_box(front);
        assert!(Facts::from_polygons(&mesh).closed);
        let (new, counts, left) = removed(&mesh);
        let facts = Facts::from_polygons(&new);
        assert!(facts.closed && facts.consistently_oriented == Some(true));
        assert_eq!((facts.faces, facts.vertices), (faces, 9));
        assert_eq!(measures(&new).volume, Some(8.0));
        assert_eq!((counts.faces_removed, counts.faces_changed), (1, 1));
        assert_eq!((counts.faces_added, left), (front.len() - 1, Vec::new()));
    }
}

#[test]
fn corners_at_one_position_are_merged() {
    // Vertex 8 is where vertex 1 is.
    let mesh = split_box(&[&[0, 1, 5], &[0, 5, 4]]);
    let mut points = mesh.positions().to_vec();
    points[8] = points[1];
    let mesh = PolygonMesh::from_faces(points, mesh.faces().clone()).expect("the same faces");
    let (new, counts, left) = removed(&mesh);
    let facts = Facts::from_polygons(&new);
    assert!(facts.closed && left.is_empty());
    assert_eq!((facts.faces, facts.vertices), (7, 8));
    assert_eq!((counts.vertices_merged, counts.faces_removed), (1, 1));
    assert_eq!(counts.faces_changed, 1, "the bottom has four corners");
    assert_eq!(measures(&new).volume, Some(8.0));
}

#[test]
fn a_polygon_without_area_is_cut_if_its_diagonals_are_free() {
    // The edge from 0 to 1 of a box, which has two more vertices on the bottom.
    let mut points = split_box(&[]).positions().to_vec();
    points.push(0.5 * (points[0] + points[8]));
    let faces: [&[u32]; 8] = [
        &[1, 8, 9, 0, 3, 2],
        &[4, 5, 6, 7],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
        &[0, 9, 8, 1],
        &[0, 1, 5],
        &[0, 5, 4],
    ];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let (new, _, left) = removed(&mesh);
    let facts = Facts::from_polygons(&new);
    assert!(facts.closed && facts.consistently_oriented == Some(true));
    assert_eq!((facts.faces, facts.vertices, left), (9, 10, vec![]));
    // Both diagonals of the first face are edges of others.
    let points = [[0, 0], [1, 0], [2, 0], [3, 0], [0, 1], [3, 1]];
    let points = points.map(|[x, y]: [i8; 2]| [f32::from(x), f32::from(y), 0.0]);
    let faces: [&[u32]; 3] = [&[0, 1, 2, 3], &[0, 2, 4], &[1, 3, 5]];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let (new, _, left) = removed(&mesh);
    let face = FaceId::new(0);
    assert_eq!((new, left), (mesh, vec![Left::FlatFace { face }]));
}

#[test]
fn a_slit_with_a_face_without_area_is_closed() {
    // Vertices 1 and 2 are at one place, where the slit from vertex 0 ends.
    let points = [[0, 0], [1, 0], [1, 0], [2, 0], [1, 1], [1, -1]];
    let points = points.map(|[x, y]: [i8; 2]| [f32::from(x), f32::from(y), 0.0]);
    let faces = [[1, 2, 3], [0, 1, 4], [1, 3, 4], [0, 5, 2], [2, 5, 3]];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let (new, counts, left) = removed(&mesh);
    let facts = Facts::from_polygons(&new);
    assert_eq!((facts.faces, facts.boundary_edges), (4, 4));
    assert_eq!((counts.vertices_merged, left), (1, vec![]));
}

#[test]
fn three_sheets_meet_in_the_edges_of_a_face_without_area() {
    let points = [
        [0, 0, 0],
        [1, 0, 0],
        [2, 0, 0],
        [1, 1, 0],
        [1, -1, 0],
        [1, 0, 1],
    ];
    let points = points.map(|p: [i8; 3]| p.map(f32::from));
    let faces = [[0, 1, 2], [2, 0, 3], [0, 2, 4], [1, 0, 5], [2, 1, 5]];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let (new, _, left) = removed(&mesh);
    let facts = Facts::from_polygons(&new);
    assert_eq!((facts.faces, facts.non_manifold_edges), (6, 2));
    assert_eq!(left, []);
    // A fourth sheet would make an edge of four faces.
    let four = [&faces[..], &[[0, 1, 6]]].concat();
    let points = [&points[..], &[[1.0, 0.0, -1.0]]].concat();
    let mesh = PolygonMesh::new(points, four).expect("valid");
    let (new, _, left) = removed(&mesh);
    let face = FaceId::new(0);
    assert_eq!((new, left), (mesh, vec![Left::FlatFace { face }]));
}

#[test]
fn faces_without_area_on_each_other() {
    let points = [[0, 0], [1, 0], [2, 0], [3, 0], [1, 1], [1, -1]];
    let points = points.map(|[x, y]: [i8; 2]| [f32::from(x), f32::from(y), 0.0]);
    // Both have the longest edge, and others on the shorter ones.
    let faces = [
        [0, 1, 3],
        [3, 2, 0],
        [1, 0, 4],
        [3, 1, 4],
        [0, 2, 5],
        [2, 3, 5],
    ];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let (new, _, left) = removed(&mesh);
    assert_eq!(
        (Facts::from_polygons(&new).boundary_edges, left),
        (4, vec![])
    );
    // Without these two, the edges of the others would open.
    let faces = [[0, 1, 2], [2, 1, 0], [0, 1, 4], [1, 2, 5]];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let (new, _, left) = removed(&mesh);
    assert_eq!((new, left.len()), (mesh, 2));
}

#[test]
fn a_face_at_the_boundary_remains_if_an_edge_would_open() {
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
    ];
    let longest_inside = PolygonMesh::new(points, [[0, 1, 2], [2, 3, 0]]).expect("valid");
    let (new, _, left) = removed(&longest_inside);
    assert_eq!((new.face_count(), left), (2, Vec::new()));
    assert_eq!(Facts::from_polygons(&new).boundary_edges, 4);
    let longest_outside = [[0, 1, 3], [1, 2, 3], [0, 2, 1]];
    let longest_outside = PolygonMesh::new(points, longest_outside).expect("valid");
    let (new, counts, left) = removed(&longest_outside);
    assert_eq!((new, counts.is_change()), (longest_outside, false));
    let face = FaceId::new(2);
    assert_eq!(left, [Left::FlatFace { face }]);
    assert!(
        left[0]
            .to_string()
            .starts_with("face f2 has no area, but remains")
    );
    let alone = PolygonMesh::new(points, [[0, 1, 2]]).expect("valid");
    assert_eq!(removed(&alone).0.face_count(), 0);
}

/// The number of attempts is limited, so this ends soon.
#[test]
fn many_faces_on_a_line_end() {
    let n = 3000_u32;
    let places = (0..n).map(|i| [(i * 1031 % n) as f32, 0.0, 0.0]);
    let fan: Vec<[u32; 3]> = (1..n - 1).map(|i| [0, i, i + 1]).collect();
    let mesh = PolygonMesh::new(places, fan).expect("valid");
    let (new, ..) = removed(&mesh);
    let before = Facts::from_polygons(&mesh).boundary_edges;
    assert!(Facts::from_polygons(&new).boundary_edges <= before);
}

#[test]
fn what_was_removed_before_the_limit_is_kept() {
    let line = (0..6).map(|x| [x as f32, 0.0, 0.0]);
    let fan = PolygonMesh::new(line, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]).expect("valid");
    let flat: Vec<FaceId> = fan.faces().iter().map(|(f, _)| f).collect();
    let mut patch = Patch::new(&fan, &flat);
    patch.remove_flat(1);
    let (mesh, _) = patch
        .finish()
        .expect("small")
        .changed
        .expect("one face less");
    assert_eq!(mesh.face_count(), 3);
}
