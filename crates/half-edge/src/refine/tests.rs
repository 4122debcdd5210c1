//! The closed forms, compared with rows written by hand.

use sixfold_core::Representation;

use super::*;

/// A row: next, origin and face.
type Row = (u32, u32, Option<u32>);

fn mesh(vertices: usize, halves: &[Row], leaving: &[u32], first: &[u32]) -> HalfEdgeMesh {
    let slot = |f: Option<u32>| f.map(FaceId::new).into();
    let halves = halves.iter().map(|&(next, v, f)| half(next, v, slot(f)));
    let leaving = leaving.iter().map(|&h| Slot::some(HalfEdgeId::new(h)));
    let first = first.iter().map(|&h| HalfEdgeId::new(h));
    let mesh = HalfEdgeMesh::from_tables(
        vec![Point::ZERO; vertices],
        leaving.collect(),
        halves.collect(),
        first.collect(),
    );
    assert_eq!(mesh.validate(), Ok(()));
    mesh
}

fn split(mesh: &HalfEdgeMesh, split: Split) -> HalfEdgeMesh {
    let mut numbers = Ranks::default();
    mesh.number_edges(&mut numbers);
    let mut child = HalfEdgeMesh::empty();
    let done = mesh.split_into(split, &numbers, &mut child);
    assert_eq!(done, Ok(()));
    child
}

/// Checks that the child of a single triangle is `expected`.
fn triangle_becomes(expected: &HalfEdgeMesh, by: Split) {
    // v0 ─h0→ v1 ─h2→ v2 ─h4→ v0, with the boundary half-edges h1, h3 and h5.
    let inside = [(2, 0), (4, 1), (0, 2)].map(|(next, v)| (next, v, Some(0)));
    let outside = [(5, 1, None), (1, 2, None), (3, 0, None)];
    let rows = [0, 1, 2].map(|e| [inside[e], outside[e]]);
    let triangle = mesh(3, rows.as_flattened(), &[5, 1, 3], &[0]);
    let child = split(&triangle, by);
    assert_eq!(child.half_edge_rows(), expected.half_edge_rows());
    assert_eq!(child.leaving_rows(), expected.leaving_rows());
    assert_eq!(child.first_rows(), expected.first_rows());
    assert_eq!(child.vertex_count(), expected.vertex_count());
}

#[test]
fn a_triangle_into_quads() {
    let rows = [
        [(12, 0, Some(0)), (10, 4, None)],
        [(1, 1, None), (4, 4, Some(1))],
        [(14, 1, Some(1)), (2, 5, None)],
        [(5, 2, None), (8, 5, Some(2))],
        [(16, 2, Some(2)), (6, 6, None)],
        [(9, 0, None), (0, 6, Some(0))],
        [(17, 4, Some(0)), (3, 3, Some(1))],
        [(13, 5, Some(1)), (7, 3, Some(2))],
        [(15, 6, Some(2)), (11, 3, Some(0))],
    ];
    let leaving = [10, 2, 6, 13, 1, 5, 9];
    let expected = mesh(7, rows.as_flattened(), &leaving, &[0, 4, 8]);
    triangle_becomes(&expected, Split::Quads);
}

#[test]
fn a_triangle_into_four() {
    let rows = [
        [(12, 0, Some(0)), (10, 3, None)],
        [(1, 1, None), (4, 3, Some(1))],
        [(14, 1, Some(1)), (2, 4, None)],
        [(5, 2, None), (8, 4, Some(2))],
        [(16, 2, Some(2)), (6, 5, None)],
        [(9, 0, None), (0, 5, Some(0))],
        [(11, 3, Some(0)), (15, 5, Some(3))],
        [(3, 4, Some(1)), (17, 3, Some(3))],
        [(7, 5, Some(2)), (13, 4, Some(3))],
    ];
    let leaving = [10, 2, 6, 1, 5, 9];
    let expected = mesh(6, rows.as_flattened(), &leaving, &[0, 4, 8, 13]);
    triangle_becomes(&expected, Split::Triangles);
}

#[test]
fn a_triangle_into_three() {
    let rows = [
        [(8, 0, Some(0)), (5, 1, None)],
        [(10, 1, Some(1)), (1, 2, None)],
        [(6, 2, Some(2)), (3, 0, None)],
        [(11, 0, Some(2)), (0, 3, Some(0))],
        [(7, 1, Some(0)), (2, 3, Some(1))],
        [(9, 2, Some(1)), (4, 3, Some(2))],
    ];
    let expected = mesh(4, rows.as_flattened(), &[5, 1, 3, 7], &[0, 2, 4]);
    triangle_becomes(&expected, Split::Sqrt3 { trisect: false });
}

#[test]
fn a_triangle_with_its_boundary_cut_in_three() {
    let rows = [
        [(8, 5, Some(0)), (13, 1, None)],
        [(10, 7, Some(1)), (21, 2, None)],
        [(6, 9, Some(2)), (29, 0, None)],
        [(35, 0, Some(2)), (14, 3, Some(3))],
        [(19, 1, Some(0)), (22, 3, Some(5))],
        [(27, 2, Some(1)), (30, 3, Some(7))],
        [(18, 4, Some(4)), (15, 5, None)],
        [(16, 0, Some(3)), (5, 4, None)],
        [(7, 4, Some(3)), (12, 3, Some(4))],
        [(17, 5, Some(4)), (0, 3, Some(0))],
        [(26, 6, Some(6)), (23, 7, None)],
        [(24, 1, Some(5)), (1, 6, None)],
        [(9, 6, Some(5)), (20, 3, Some(6))],
        [(25, 7, Some(6)), (2, 3, Some(1))],
        [(34, 8, Some(8)), (31, 9, None)],
        [(32, 2, Some(7)), (3, 8, None)],
        [(11, 8, Some(7)), (28, 3, Some(8))],
        [(33, 9, Some(8)), (4, 3, Some(2))],
    ];
    let leaving = [5, 1, 3, 7, 15, 13, 23, 21, 31, 29];
    let first = [0, 2, 4, 14, 12, 22, 20, 30, 28];
    let expected = mesh(10, rows.as_flattened(), &leaving, &first);
    triangle_becomes(&expected, Split::Sqrt3 { trisect: true });
}

#[test]
fn the_edge_between_two_triangles_is_flipped() {
    // f0 = v0 v1 v2 and f1 = v0 v2 v3. h0 runs from v0 to v2 and has f1 on its left.
    let rows = [
        [(6, 0, Some(1)), (2, 2, Some(0))],
        [(4, 0, Some(0)), (9, 1, None)],
        [(1, 1, Some(0)), (3, 2, None)],
        [(8, 2, Some(1)), (5, 3, None)],
        [(0, 3, Some(1)), (7, 0, None)],
    ];
    let sheet = mesh(4, rows.as_flattened(), &[9, 3, 5, 7], &[2, 0]);
    let child = split(&sheet, Split::Sqrt3 { trisect: false });
    let flipped: [(usize, Row); 6] = [
        (0, (11, 4, Some(0))),
        (11, (14, 5, Some(0))),
        (14, (0, 0, Some(0))),
        (1, (13, 5, Some(1))),
        (13, (18, 4, Some(1))),
        (18, (1, 2, Some(1))),
    ];
    for (h, (next, v, f)) in flipped {
        let expected = half(next, v, f.map(FaceId::new).into());
        assert_eq!(child.half_edge_rows()[h], expected, "h{h}");
    }
}

#[test]
fn large_faces_are_linked() {
    // Degrees below and above the limit of `previous`: a face, and a pyramid over this face.
    for degree in 3..24 {
        let rim = (0..degree).collect::<Vec<u32>>();
        let sides = (0..degree).map(|i| vec![(i + 1) % degree, i, degree]);
        let faces: Vec<Vec<u32>> = sides.chain([rim]).collect();
        let corners = (0..=degree).map(|i| Point::splat(i as f32));
        let polygons = sixfold_core::PolygonMesh::new(corners.collect::<Vec<_>>(), faces);
        let pyramid = HalfEdgeMesh::from_polygons(&polygons.expect("valid")).expect("closed");
        let child = split(&pyramid, Split::Quads);
        assert_eq!(child.validate(), Ok(()), "degree {degree}");
        assert!(child.faces().all(|f| child.around_face(f).count() == 4));
    }
}
