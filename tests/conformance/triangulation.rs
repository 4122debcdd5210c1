//! Polygons of known area, cut into triangles by `sixfold-core`, which cannot use random polygons itself.

use proptest::collection;
use proptest::prelude::*;
use sixfold_conformance::strategy::touching_polygon;
use sixfold_core::glam::DVec3;
use sixfold_core::{Capabilities, FaceId, Point, PolygonCutter, PolygonMesh, VertexId};

fn polygon(points: &[[f32; 2]]) -> PolygonMesh {
    let points: Vec<Point> = points.iter().map(|&[x, y]| Point::new(x, y, 0.0)).collect();
    one_face(points)
}

fn one_face(points: Vec<Point>) -> PolygonMesh {
    let corners: Vec<u32> = (0..points.len() as u32).collect();
    PolygonMesh::new(points, [corners]).expect("valid")
}

fn triangulated(polygons: &PolygonMesh) -> PolygonMesh {
    polygons.triangulated().expect("small").polygons
}

fn areas(mesh: &PolygonMesh) -> Vec<DVec3> {
    let at = |v: VertexId| mesh.position(v).as_dvec3();
    let area = |face: &[VertexId]| -> DVec3 {
        let fan = face[1..].windows(2);
        fan.map(|pair| (at(pair[0]) - at(face[0])).cross(at(pair[1]) - at(face[0])))
            .sum()
    };
    mesh.faces().iter().map(|(_, face)| area(face)).collect()
}

/// Checks that each side occurs once, and each diagonal once in each direction.
fn assert_partition(mesh: &PolygonMesh, triangles: &PolygonMesh) {
    let sides = |mesh: &PolygonMesh| {
        let mut sides = Vec::new();
        for (_, face) in mesh.faces().iter() {
            let next = face.iter().cycle().skip(1);
            sides.extend(face.iter().zip(next).map(|(&a, &b)| (a, b)));
        }
        sides
    };
    let (whole, mut cut) = (sides(mesh), sides(triangles));
    for side in whole {
        let at = cut
            .iter()
            .position(|&s| s == side)
            .expect("every side of the polygon");
        cut.swap_remove(at);
    }
    while let Some((a, b)) = cut.pop() {
        let back = cut
            .iter()
            .position(|&s| s == (b, a))
            .expect("a diagonal both ways");
        cut.swap_remove(back);
    }
}

/// Checks that the triangles cover the polygon without overlap. If `exact`, no triangle may be
/// flat.
fn assert_covered(mesh: &PolygonMesh, exact: bool) {
    let triangles = triangulated(mesh);
    let whole: DVec3 = areas(mesh).into_iter().sum();
    assert_eq!(
        triangles.face_count(),
        mesh.corner_count() - 2 * mesh.face_count()
    );
    assert_partition(mesh, &triangles);
    let parts = areas(&triangles);
    let least = if exact { 0.0 } else { -1e-6 * whole.length() };
    assert!(
        parts.iter().all(|part| part.dot(whole.normalize()) > least),
        "{parts:?}"
    );
    let size: f64 = parts.iter().map(|part| part.length()).sum();
    assert!(
        (size / whole.length() - 1.0).abs() < 1e-5,
        "{size} of {}",
        whole.length()
    );
}

/// Bars side by side; most corners are collinear.
fn histogram() -> impl Strategy<Value = Vec<[f32; 2]>> {
    collection::vec(1..5_u8, 1..9).prop_map(|heights| {
        let width = heights.len();
        let mut points: Vec<[f32; 2]> = (0..=width).map(|x| [x as f32, 0.0]).collect();
        let mut height = 0;
        for (x, &to) in heights.iter().enumerate().rev() {
            while height != to {
                height = if height < to { height + 1 } else { height - 1 };
                points.push([x as f32 + 1.0, f32::from(height)]);
            }
            points.push([x as f32, f32::from(height)]);
        }
        for height in (1..height).rev() {
            points.push([0.0, f32::from(height)]);
        }
        points
    })
}

fn spiral(corners: usize, turns: f64) -> Vec<[f32; 2]> {
    let arm = |i: usize, width: f64| {
        let t = i as f64 / corners as f64;
        let (sin, cos) = (t * turns * std::f64::consts::TAU).sin_cos();
        let radius = 1.0 + turns * t + width;
        [(radius * cos) as f32, (radius * sin) as f32]
    };
    let out = (0..corners).map(|i| arm(i, 0.4));
    let back = (0..corners).rev().map(|i| arm(i, 0.0));
    out.chain(back).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// With integer coordinates, nothing is rounded.
    #[test]
    fn histograms_in_any_plane_are_covered(
        outline in histogram(),
        axes in prop::array::uniform2(prop::array::uniform3(-4..5_i8)),
        start in 0..40_usize,
    ) {
        let [u, v] = axes.map(|axis| Point::from_array(axis.map(f32::from)));
        prop_assume!(u.cross(v) != Point::ZERO);
        let mut points: Vec<Point> = outline.iter().map(|&[x, y]| x * u + y * v).collect();
        let start = start % points.len();
        points.rotate_left(start);
        assert_covered(&one_face(points), true);
    }

    #[test]
    fn stars_are_covered(
        radii in collection::vec(0.05_f64..1.0, 5..40),
        tilt in prop::array::uniform3(-1.0_f32..1.0),
    ) {
        let tilt = Point::from_array(tilt);
        prop_assume!(tilt.length() > 0.1);
        let (u, v) = tilt.normalize().any_orthonormal_pair();
        let points = radii.iter().enumerate().map(|(i, &radius)| {
            let angle = std::f64::consts::TAU * i as f64 / radii.len() as f64;
            (radius * angle.cos()) as f32 * u + (radius * angle.sin()) as f32 * v
        });
        assert_covered(&one_face(points.collect()), false);
    }

    /// Includes polygons that cross themselves, lie on a line or lie in a point.
    #[test]
    fn any_polygon_is_partitioned(
        points in collection::vec(prop::array::uniform3(-2..3_i8), 4..30),
        flat in any::<[bool; 3]>(),
    ) {
        let point = |p: &[i8; 3]| {
            let axis = |i: usize| if flat[i] { 0.0 } else { f32::from(p[i]) };
            Point::new(axis(0), axis(1), axis(2))
        };
        let mesh = one_face(points.iter().map(point).collect());
        let triangles = triangulated(&mesh);
        prop_assert_eq!(triangles.face_count(), points.len() - 2);
        assert_partition(&mesh, &triangles);
    }
}

#[test]
fn short_and_long_spirals_are_covered() {
    assert_covered(&polygon(&spiral(60, 3.0)), true);
    assert_covered(&polygon(&spiral(1500, 40.0)), false);
}

/// The outline runs twice along the bridge from the square to its hole.
#[test]
fn a_polygon_with_a_bridge_to_a_hole_is_covered() {
    let outline = [
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [0.0, 3.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [2.0, 2.0],
        [2.0, 1.0],
        [1.0, 1.0],
    ];
    for start in 0..outline.len() {
        let mut outline = outline;
        outline.rotate_left(start);
        assert_covered(&polygon(&outline), true);
    }
}

#[test]
fn large_degenerate_polygons_are_partitioned() {
    let line: Vec<[f32; 2]> = (0..1500).map(|i| [(i * 7 % 1500) as f32, 0.0]).collect();
    let zigzag: Vec<[f32; 2]> = (0..1500)
        .map(|i| [(i * 611 % 997) as f32, (i * i % 991) as f32])
        .collect();
    for points in [
        line,
        zigzag,
        vec![[f32::NAN; 2]; 300],
        vec![[f32::INFINITY; 2]; 300],
    ] {
        let mesh = polygon(&points);
        assert_eq!(triangulated(&mesh).face_count(), points.len() - 2);
    }
}

#[test]
fn the_better_of_two_diagonals_is_cut() {
    let rhombus = polygon(&[[0.0, 0.0], [3.0, -1.0], [6.0, 0.0], [3.0, 1.0]]);
    let triangles = triangulated(&rhombus);
    for (_, face) in triangles.faces().iter() {
        assert!(
            [1, 3].map(VertexId::new).iter().all(|v| face.contains(v)),
            "{face:?}"
        );
    }
}

#[test]
fn a_diagonal_that_is_an_edge_is_not_cut_again() {
    let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
    let pillow = PolygonMesh::new(square, [[0, 1, 2, 3], [3, 2, 1, 0]]).expect("valid");
    let triangles = triangulated(&pillow);
    assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
    // For a third square, both diagonals are already edges.
    let three = [[0, 1, 2, 3], [3, 2, 1, 0], [0, 1, 2, 3]];
    let three = PolygonMesh::new(square, three).expect("valid");
    assert_eq!(triangulated(&three).face_count(), 6);
}

#[test]
fn triangles_stay() {
    let icosahedron = sixfold::shapes::icosahedron();
    assert_eq!(triangulated(&icosahedron), icosahedron);
    let prism = sixfold::shapes::prism(7).expect("small");
    let triangles = triangulated(&prism);
    assert_eq!(triangles.face_count(), 2 * 7 + 2 * 5);
    assert_eq!(triangles.faces().face(FaceId::new(0)).len(), 3);
    assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&triangles), Ok(()));
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        cases: 2000,
        ..ProptestConfig::default()
    })]

    /// Coordinates are integers, so areas are exact.
    #[test]
    fn polygons_that_touch_themselves_are_covered(
        outline in touching_polygon(),
        axes in prop::array::uniform2(prop::array::uniform3(-4..5_i8)),
    ) {
        let [u, v] = axes.map(|axis| DVec3::from_array(axis.map(f64::from)));
        let normal = u.cross(v);
        prop_assume!(normal != DVec3::ZERO);
        let corners = outline.corners.iter().map(|&[x, y]| f64::from(x) * u + f64::from(y) * v);
        let corners: Vec<DVec3> = corners.collect();
        let mut cutter = PolygonCutter::default();
        let cut = cutter.cut(corners.iter().copied(), |_, _| false);
        prop_assert!(!cut.is_crossing, "{:?}", outline.corners);
        prop_assert_eq!(cut.triangles.len(), corners.len() - 2);
        let areas = cut.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| corners[i]);
            (b - a).cross(c - a).dot(normal) / normal.length_squared() / 2.0
        });
        let areas: Vec<f64> = areas.collect();
        prop_assert!(areas.iter().all(|&area| area >= 0.0), "{:?}", outline.corners);
        let sum: f64 = areas.iter().sum();
        prop_assert!((sum - f64::from(outline.area)).abs() < 1e-9);
    }
}

fn corners_of(points: &[[i32; 2]]) -> Vec<DVec3> {
    let point = |&[x, y]: &[i32; 2]| DVec3::new(f64::from(x), f64::from(y), 0.0);
    points.iter().map(point).collect()
}

#[test]
fn polygons_that_cross_themselves_are_named() {
    let crosses = |points: &[[i32; 2]]| {
        PolygonCutter::default()
            .cut(corners_of(points), |_, _| false)
            .is_crossing
    };
    let bow_tie = [[0, 0], [1, 1], [1, 0], [0, 1]];
    let uneven = [[0, 0], [3, 3], [3, 0], [0, 1]];
    let pentagram = [[0, 10], [6, -8], [-10, 3], [10, 3], [-6, -8]];
    for points in [&bow_tie[..], &uneven, &pentagram] {
        assert!(crosses(points), "{points:?}");
        let turned: Vec<[i32; 2]> = points.iter().rev().copied().collect();
        assert!(crosses(&turned), "{points:?}");
        assert!(triangulated_crosses(points));
    }
    // No triangle has to be turned over, because the polygons wind twice around some points. The second
    // is a strip whose end covers its beginning; the third crosses itself only in its corners.
    let strip = [
        [6, 0],
        [6, 6],
        [0, 6],
        [0, 1],
        [2, 1],
        [2, 4],
        [4, 4],
        [4, 2],
        [0, 2],
        [0, 0],
    ];
    let mut with_corner = strip.to_vec();
    with_corner.insert(8, [2, 2]);
    let pentagon = [[1, -1], [-1, 3], [3, 2], [1, -3], [0, 3]];
    let twice = [&pentagon[..], &strip, &with_corner];
    for points in twice {
        let mut points = points.to_vec();
        for _ in 0..points.len() {
            points.rotate_left(1);
            assert!(crosses(&points), "{points:?}");
        }
    }
    let on_a_line = [[0, 0], [2, 2], [1, 1], [3, 3]];
    assert!(!crosses(&on_a_line));
    // A corner that rounding moved across a side by a millionth of the length.
    let notch = |depth: f64| {
        let corners = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 2.0],
            [2.0, -depth],
            [0.0, 2.0],
        ];
        let corners = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
        PolygonCutter::default()
            .cut(corners, |_, _| false)
            .is_crossing
    };
    assert!(!notch(0.0) && !notch(1e-7) && notch(1e-3));
}

fn triangulated_crosses(points: &[[i32; 2]]) -> bool {
    let points: Vec<[f32; 2]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let cut = polygon(&points).triangulated().expect("small");
    cut.crossing == [FaceId::new(0)]
}

/// The polygon crosses itself along the axis nearest to its normal, which is z, but not along its
/// normal.
#[test]
fn bent_polygons_are_cut_along_their_normal() {
    let corners = [[-3, 0, 2], [0, 3, 0], [3, -1, 0], [3, 0, -2], [0, -2, -3]];
    let crosses = |height: f64| {
        let corners = corners.map(|p| DVec3::from_array(p.map(f64::from)));
        let scaled = corners.map(|p| DVec3::new(p.x, p.y, height * p.z));
        let mut cutter = PolygonCutter::default();
        cutter.cut(scaled, |_, _| false).is_crossing
    };
    assert!(!crosses(1.0) && crosses(0.0));
}

#[test]
fn faces_with_repeated_vertices_have_parts_without() {
    let parts = |face: &[u32], points: &[[i32; 2]]| {
        let face: Vec<VertexId> = face.iter().map(|&v| VertexId::new(v)).collect();
        let corners = corners_of(points);
        let parts = PolygonCutter::default().parts(&face, |i| corners[face[i].index()]);
        assert!(!parts.is_crossing);
        let part = |part: &[usize]| part.iter().map(|&i| face[i].index() as u32).collect();
        parts.iter().map(part).collect::<Vec<Vec<u32>>>()
    };
    let square = [[0, 0], [1, 0], [1, 1], [0, 1]];
    assert_eq!(parts(&[0, 1, 2, 3], &square), [[0, 1, 2, 3]]);
    assert_eq!(parts(&[0, 0, 1, 2, 2, 3, 0], &square), [[0, 1, 2, 3]]);
    assert_eq!(parts(&[1, 1, 2, 3, 3], &square), [[1, 2, 3]]);
    for empty in [
        &[][..],
        &[0],
        &[0, 0, 0],
        &[0, 1],
        &[0, 1, 0, 1],
        &[0, 1, 1, 0],
    ] {
        assert_eq!(parts(empty, &square), Vec::<Vec<u32>>::new(), "{empty:?}");
    }
    // A spike to vertex 3.
    assert_eq!(parts(&[0, 1, 3, 1, 2], &square).len(), 1);
    // An outer square of side 3 and a hole of side 1, joined by a bridge from 0 to 4.
    let places = [
        [0, 0],
        [3, 0],
        [3, 3],
        [0, 3],
        [1, 1],
        [1, 2],
        [2, 2],
        [2, 1],
    ];
    let keyhole = parts(&[0, 1, 2, 3, 0, 4, 5, 6, 7, 4], &places);
    assert_eq!(keyhole.len(), 8);
    let corners = corners_of(&places);
    let area = |face: &Vec<u32>| {
        let [a, b, c] = [0, 1, 2].map(|i| corners[face[i] as usize]);
        0.5 * (b - a).cross(c - a).z
    };
    assert!(keyhole.iter().all(|face| area(face) > 0.0));
    assert_eq!(keyhole.iter().map(area).sum::<f64>(), 8.0);
}
