use sixfold_core::{Point, PolygonMesh, RowId};

use super::*;

/// A square of side 2 around the z-axis, at height `z`.
fn square(z: f32) -> PolygonMesh {
    let corners = [
        [-1.0, -1.0, z],
        [1.0, -1.0, z],
        [1.0, 1.0, z],
        [-1.0, 1.0, z],
    ];
    PolygonMesh::new(corners, [[0, 1, 2, 3]]).expect("valid")
}

/// The square from (−1, −1) to (1, 1) at height 0, and a larger one of side `side`.
fn squares(side: f32) -> (PolygonMesh, PolygonMesh) {
    let large = square(0.0);
    let positions = large.positions().iter().map(|&p| p * (side / 2.0));
    let large = PolygonMesh::new(positions, [[0, 1, 2, 3]]).expect("valid");
    (square(0.0), large)
}

#[test]
fn parallel_squares_have_their_distance_everywhere() {
    let distance = mesh_distance(&square(0.0), &square(0.75), Sampling::default()).expect("faces");
    for (side, z) in [(distance.forward, 0.0), (distance.backward, 0.75)] {
        assert_eq!(side.farthest, DVec3::new(-1.0, -1.0, z), "the first vertex");
        assert_eq!(
            (side.mean, side.root_mean_square, side.largest),
            (0.75, 0.75, 0.75)
        );
        assert_eq!((side.samples, side.vertices), (100_000, 4));
    }
    assert_eq!(
        (
            distance.mean(),
            distance.root_mean_square(),
            distance.largest()
        ),
        (0.75, 0.75, 0.75)
    );
}

/// From a square of side 4 to the square of side 2 inside it. By symmetry the mean is that over the
/// trapezium |y| ≤ x, 1 ≤ x ≤ 2 and its mirror images: x − 1 where |y| ≤ 1, and the distance to a
/// corner elsewhere.
#[test]
fn the_means_of_a_frame_are_those_of_the_integral() {
    let (small, large) = squares(4.0);
    let sampling = Sampling {
        samples: 400_000,
        seed: 5,
    };
    let distance = mesh_distance(&small, &large, sampling).expect("faces");
    assert!(distance.forward.mean <= distance.forward.largest);
    assert!(distance.forward.largest < 1e-15);
    // Strips: four of 2 × 1 with mean 1/2. Corners: the mean distance of a point of the unit square
    // to its corner is (√2 + asinh 1) / 3, the mean square is 2/3.
    let corner = (2_f64.sqrt() + 1_f64.asinh()) / 3.0;
    let mean = (8.0 * 0.5 + 4.0 * corner) / 16.0;
    let mean_square: f64 = (8.0 / 3.0 + 4.0 * 2.0 / 3.0) / 16.0;
    assert!(
        (distance.backward.mean - mean).abs() < 2e-3,
        "{}",
        distance.backward.mean
    );
    let rms = distance.backward.root_mean_square;
    assert!((rms - mean_square.sqrt()).abs() < 2e-3, "{rms}");
    // The farthest point is a vertex, which no sample reaches.
    assert_eq!(distance.backward.largest, 2_f64.sqrt());
    assert_eq!(distance.backward.farthest.abs(), DVec3::new(2.0, 2.0, 0.0));
    assert!((distance.mean() - 0.5 * mean).abs() < 1e-3);
    let symmetric = (0.5 * mean_square).sqrt();
    assert!((distance.root_mean_square() - symmetric).abs() < 2e-3);
}

#[test]
fn a_mesh_has_no_distance_to_itself() {
    let mesh = sixfold_shapes::geodesic(6).expect("a small frequency");
    let moved = mesh
        .positions()
        .iter()
        .map(|&p| p * 0.3 + Point::new(0.7, -3.1, 0.2));
    let mesh = PolygonMesh::from_faces(moved.collect(), mesh.faces().clone()).expect("valid");
    let distance = mesh_distance(&mesh, &mesh, Sampling::default()).expect("faces");
    assert_eq!(distance.largest(), 0.0);
    // Also if the faces are others of the same surface, in any unit.
    let faces = mesh.faces().iter();
    let faces = faces.map(|(_, face)| face.iter().rev().map(|v| v.row()).collect());
    let faces: Vec<Vec<u32>> = faces.collect();
    for unit in [1e-3, 1.0, 1e3] {
        let points: Vec<Point> = mesh.positions().iter().map(|&p| unit * p).collect();
        let reversed = PolygonMesh::new(points.iter().copied(), &faces).expect("valid");
        let mesh = PolygonMesh::from_faces(points, mesh.faces().clone()).expect("valid");
        let distance = mesh_distance(&mesh, &reversed, Sampling::default()).expect("faces");
        assert_eq!(distance.largest(), 0.0);
    }
    // Not if they are other surfaces over the same vertices.
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 1.0],
    ];
    let over = |faces: [[u32; 3]; 2]| PolygonMesh::new(corners, faces).expect("valid");
    let [one, other] = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]].map(over);
    let distance = mesh_distance(&one, &other, Sampling::default()).expect("faces");
    assert!(distance.mean() > 0.1);
    // A thin triangle, and a surface that is a little apart.
    let thin = |height: f32| {
        let points = [
            [0.0, 0.0, height],
            [1.0, 1e-6, height],
            [1.0, 0.0, height + 1e-6],
        ];
        PolygonMesh::new(points, [[0, 1, 2]]).expect("valid")
    };
    let distance =
        |height| mesh_distance(&thin(0.0), &thin(height), Sampling::default()).expect("faces");
    assert_eq!(distance(0.0).largest(), 0.0);
    assert!(distance(1e-9).mean() > 1e-10);
}

#[test]
fn the_seed_chooses_the_samples_and_nothing_else() {
    let (cube, ball) = (sixfold_shapes::cube(), sixfold_shapes::icosahedron());
    let measure = |seed| {
        let sampling = Sampling {
            samples: 20_000,
            seed,
        };
        mesh_distance(&cube, &ball, sampling).expect("faces")
    };
    assert_eq!(measure(1), measure(1));
    assert_ne!(measure(1).forward.mean, measure(2).forward.mean);
    assert!((measure(1).mean() - measure(2).mean()).abs() < 0.01);
}

#[test]
fn the_number_of_threads_does_not_change_the_result() {
    let (cube, ball) = (
        sixfold_shapes::cube(),
        sixfold_shapes::geodesic(30).expect("small"),
    );
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads")
            .install(|| mesh_distance(&cube, &ball, Sampling::default()))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn the_unit_changes_neither_the_result_nor_the_work() {
    let scaled = |mesh: &PolygonMesh, factor: f64| super::scaled(mesh, factor);
    let cube = sixfold_shapes::cube();
    let ball = sixfold_shapes::geodesic(3).expect("small");
    let measure = |factor: f64| {
        let [cube, ball] = [&cube, &ball].map(|mesh| scaled(mesh, factor));
        let distance = mesh_distance(&cube, &ball, Sampling::default()).expect("faces");
        distance.scaled(1.0 / factor)
    };
    let usual = measure(1.0);
    // Squares of these coordinates are not numbers of `f32`.
    for exponent in [-101, -100, -41, -39, 49, 51, 100, 127] {
        assert_eq!(measure(2_f64.powi(exponent)), usual, "2^{exponent}");
    }
    // Numbers near the least one have few digits.
    let least = measure(2_f64.powi(-140));
    assert!(
        (least.mean() / usual.mean() - 1.0).abs() < 1e-2,
        "{least:?}"
    );
}

#[test]
fn scales_are_unusual_where_squares_leave_the_range() {
    for usual in [0.0, 1e-12, 1.0, 1e14] {
        assert_eq!(unusual_scale(usual), None, "{usual}");
    }
    for (unusual, factor) in [
        (3e-13, 2_f64.powi(42)),
        (3e15, 2_f64.powi(-51)),
        (1e-45, 2_f64.powi(149)),
    ] {
        assert_eq!(unusual_scale(unusual), Some(factor), "{unusual}");
    }
}

#[test]
fn isolated_vertices_are_not_measured() {
    let mut positions = square(0.0).positions().to_vec();
    positions.push(Point::splat(100.0));
    let with_point = PolygonMesh::new(positions, [[0, 1, 2, 3]]).expect("valid");
    let distance = mesh_distance(&with_point, &square(0.0), Sampling::default()).expect("faces");
    assert_eq!(distance.forward.vertices, 4);
    assert!(distance.largest() < 1e-15);
}

#[test]
fn a_mesh_without_area_is_measured_at_its_vertices() {
    let line = [[0.0, 0.0, 1.0], [0.5, 0.0, 3.0], [1.0, 0.0, 5.0]];
    let line = PolygonMesh::new(line, [[0, 1, 2]]).expect("valid");
    let distance = mesh_distance(&line, &square(0.0), Sampling::default()).expect("faces");
    let forward = distance.forward;
    assert_eq!(
        (forward.samples, forward.mean, forward.largest),
        (0, 3.0, 5.0)
    );
}

#[test]
fn meshes_without_faces_or_finite_positions_are_refused() {
    let points = PolygonMesh::new([[0.0; 3]], [[0_u32; 3]; 0]).expect("valid");
    let low = square(0.0);
    let measure = |a: &PolygonMesh, b: &PolygonMesh| {
        mesh_distance(a, b, Sampling::default()).expect_err("refused")
    };
    assert_eq!(
        measure(&points, &low),
        DistanceError::NoFaces { mesh: "first" }
    );
    assert_eq!(
        measure(&low, &points),
        DistanceError::NoFaces { mesh: "second" }
    );
    let many = Sampling {
        samples: usize::MAX,
        seed: 0,
    };
    let error = mesh_distance(&square(0.0), &square(1.0), many).expect_err("refused");
    assert!(
        matches!(error, DistanceError::TooManySamples { .. }),
        "{error}"
    );
    let broken = square(f32::NAN);
    let error = measure(&low, &broken).to_string();
    assert!(error.contains("second") && error.contains("v0"), "{error}");
}
