//! Smoothing, compared with closed forms and invariants.

use proptest::prelude::*;
use sixfold_conformance::strategy::manifold_mesh;
use sixfold_core::{FaceId, MeshMove, MoveError, PolygonMesh, Representation};
use sixfold_half_edge::HalfEdgeMesh;
use sixfold_indexed_face_set::IndexedFaceSet;
use sixfold_polygon_soup::PolygonSoup;

use super::*;

const BOTH: [Weights; 2] = [Weights::Uniform, Weights::Cotangent];

fn set(polygons: &PolygonMesh) -> IndexedFaceSet {
    IndexedFaceSet::from_polygons(polygons).expect("it accepts any mesh")
}

fn moved(polygons: &PolygonMesh, smoothing: &Smoothing) -> Vec<Point> {
    let mesh = set(polygons);
    let moved = smoothed(&mesh, smoothing).expect("it can be smoothed");
    mesh.vertices().map(|v| moved[v]).collect()
}

fn with_positions(polygons: &PolygonMesh, place: impl Fn(usize, Point) -> Point) -> PolygonMesh {
    let positions = polygons.positions().iter().enumerate();
    let positions: Vec<Point> = positions.map(|(i, &p)| place(i, p)).collect();
    PolygonMesh::from_faces(positions, polygons.faces().clone()).expect("valid")
}

/// Returns a pseudo-random number from −1 to 1.
fn noise(i: usize) -> f32 {
    (i * 2_654_435 % 2001) as f32 / 1000.0 - 1.0
}

fn is_on_boundary(i: usize, m: usize, n: usize) -> bool {
    let (x, y) = (i % (m + 1), i / (m + 1));
    x == 0 || x == m || y == 0 || y == n
}

/// The mean of the neighbours of a vertex p is c·p. A forward step scales p by 1 − λ(1 − c), and a
/// backward step scales p by 1 − μ(1 − c).
#[test]
fn regular_solids_shrink_by_the_factor_of_their_ring() {
    let root5 = 5.0_f64.sqrt();
    let solids = [
        (sixfold_shapes::tetrahedron(), -1.0 / 3.0),
        (sixfold_shapes::cube(), 1.0 / 3.0),
        (sixfold_shapes::octahedron(), 0.0),
        (sixfold_shapes::dodecahedron(), root5 / 3.0),
        (sixfold_shapes::icosahedron(), 1.0 / root5),
    ];
    for (solid, c) in solids {
        for (step, step_back) in [(0.4, None), (0.33, Some(-0.34))] {
            let iterations = 3;
            let smoothing = Smoothing {
                step,
                step_back,
                iterations,
                ..Smoothing::default()
            };
            let once = (1.0 - step * (1.0 - c)) * (1.0 - step_back.unwrap_or(0.0) * (1.0 - c));
            let factor = once.powi(3) as f32;
            let triangles = solid.faces().uniform_degree() == Some(3);
            for weights in BOTH.into_iter().take(1 + usize::from(triangles)) {
                let moved = moved(
                    &solid,
                    &Smoothing {
                        weights,
                        ..smoothing
                    },
                );
                for (&p, &q) in solid.positions().iter().zip(&moved) {
                    assert!(
                        q.distance(factor * p) < 1e-6,
                        "{weights:?}: {q} of {p}, {factor}"
                    );
                }
            }
        }
    }
}

/// Every vertex is on an axis of symmetry and stays there.
#[test]
fn a_sphere_shrinks_towards_its_centre() {
    let sphere = sixfold_shapes::geodesic(2).expect("small");
    for weights in BOTH {
        let moved = moved(
            &sphere,
            &Smoothing {
                weights,
                ..Smoothing::default()
            },
        );
        for (&p, &q) in sphere.positions().iter().zip(&moved) {
            assert!(
                q.normalize().distance(p) < 1e-5 && q.length() < 0.9,
                "{weights:?}: {q} of {p}"
            );
        }
    }
}

#[test]
fn the_interior_of_a_regular_grid_does_not_move() {
    for grid in [
        sixfold_shapes::grid(5, 4),
        sixfold_shapes::triangle_grid(5, 4),
    ] {
        let grid = grid.expect("small");
        assert_eq!(moved(&grid, &Smoothing::default()), grid.positions());
    }
}

#[test]
fn a_plane_stays_a_plane() {
    let grid = sixfold_shapes::triangle_grid(6, 5).expect("small");
    let perturbed = with_positions(&grid, |i, p| {
        p + 0.3 * Point::new(noise(i), noise(3 * i + 1), 0.0)
    });
    for weights in BOTH {
        for boundary in [SmoothingBoundary::Fixed, SmoothingBoundary::Curve] {
            let moved = moved(
                &perturbed,
                &Smoothing {
                    weights,
                    boundary,
                    ..Smoothing::default()
                },
            );
            assert!(moved.iter().all(|p| p.z == 0.0));
        }
    }
}

#[test]
fn cotangents_leave_a_plane_unchanged() {
    let (m, n) = (7, 6);
    let grid = sixfold_shapes::triangle_grid(m, n).expect("small");
    let perturbed = with_positions(&grid, |i, p| {
        p + 0.3 * Point::new(noise(i), noise(3 * i + 1), 0.0)
    });
    let run = |weights| {
        moved(
            &perturbed,
            &Smoothing {
                weights,
                step: 1.0,
                ..Smoothing::default()
            },
        )
    };
    let max_distance = |moved: &[Point]| {
        let pairs = perturbed.positions().iter().zip(moved);
        pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f32::max)
    };
    assert!(max_distance(&run(Weights::Cotangent)) < 1e-5);
    assert!(max_distance(&run(Weights::Uniform)) > 0.1);
}

#[test]
fn bumps_shrink_and_a_fixed_boundary_stays() {
    let (m, n) = (8, 8);
    let grid = sixfold_shapes::triangle_grid(m, n).expect("small");
    let bumpy = with_positions(&grid, |i, p| p + 0.2 * noise(i) * Point::Z);
    let height = |points: &[Point]| {
        points
            .iter()
            .enumerate()
            .filter(|&(i, _)| !is_on_boundary(i, m, n))
            .map(|(_, p)| p.z.abs())
            .sum::<f32>()
    };
    for weights in BOTH {
        let moved = moved(
            &bumpy,
            &Smoothing {
                weights,
                ..Smoothing::default()
            },
        );
        assert!(
            height(&moved) < 0.5 * height(bumpy.positions()),
            "{weights:?}"
        );
        for (i, (p, q)) in bumpy.positions().iter().zip(&moved).enumerate() {
            assert!(!is_on_boundary(i, m, n) || p == q, "{weights:?}");
        }
    }
}

/// The mean of the neighbours of p in a regular n-gon is cos(2π/n)·p.
#[test]
fn a_boundary_curve_shrinks_by_itself() {
    let n = 7;
    let angle = std::f64::consts::TAU / f64::from(n);
    let corner = |i: u32| {
        let (sin, cos) = (angle * f64::from(i)).sin_cos();
        Point::new(cos as f32, sin as f32, 0.0)
    };
    let mut points: Vec<Point> = (0..n).map(corner).collect();
    points.push(Point::Z); // above the middle: no corner depends on it
    let fan = (0..n).map(|i| [i, (i + 1) % n, n]);
    let cone = PolygonMesh::new(points, fan).expect("valid");
    for weights in BOTH {
        let smoothing = Smoothing {
            weights,
            boundary: SmoothingBoundary::Curve,
            step: 0.5,
            iterations: 1,
            ..Smoothing::default()
        };
        let moved = moved(&cone, &smoothing);
        let factor = (1.0 - 0.5 * (1.0 - angle.cos())) as f32;
        for i in 0..n {
            assert!(
                moved[i as usize].distance(factor * corner(i)) < 1e-6,
                "{weights:?}"
            );
        }
        assert!(
            moved[n as usize].distance(Point::Z / 2.0) < 1e-6,
            "{weights:?}"
        );
    }
}

/// Two triangles share one vertex. The vertex has four boundary edges.
#[test]
fn a_vertex_where_the_boundary_crosses_itself_stays() {
    let points = [
        Point::ZERO,
        Point::X,
        Point::new(1.0, 1.0, 0.0),
        Point::NEG_X,
        Point::new(-1.0, -1.0, 0.0),
    ];
    let bow_tie = PolygonMesh::new(points, [[0, 1, 2], [0, 3, 4]]).expect("valid");
    let smoothing = Smoothing {
        boundary: SmoothingBoundary::Curve,
        step: 1.0,
        iterations: 1,
        ..Smoothing::default()
    };
    let expected = [
        points[0],
        points[2] / 2.0,
        points[1] / 2.0,
        points[4] / 2.0,
        points[3] / 2.0,
    ];
    assert_eq!(moved(&bow_tie, &smoothing), expected);
}

#[test]
fn a_step_back_keeps_the_volume() {
    let sphere = sixfold_shapes::geodesic(4).expect("small");
    let radius = |step_back| {
        let smoothing = Smoothing {
            step: 0.33,
            step_back,
            ..Smoothing::default()
        };
        let moved = moved(&sphere, &smoothing);
        moved.iter().map(|p| p.length()).sum::<f32>() / moved.len() as f32
    };
    assert!(radius(None) < 0.9);
    assert!((radius(Some(-0.34)) - 1.0).abs() < 0.01);
}

#[test]
fn flat_triangles_and_isolated_vertices_give_finite_positions() {
    let points = [
        Point::ZERO,
        Point::ZERO,
        Point::ZERO,
        Point::X,
        2.0 * Point::X,
        Point::new(1.0, 1e-20, 0.0),
        Point::new(0.5, 1.0, 0.0),
        7.0 * Point::ONE,
    ];
    let faces = [
        [0, 1, 2],
        [2, 1, 3],
        [0, 3, 4],
        [4, 5, 0],
        [0, 3, 6],
        [3, 4, 6],
        [6, 4, 0],
    ];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    for weights in BOTH {
        let moved = moved(
            &mesh,
            &Smoothing {
                weights,
                ..Smoothing::default()
            },
        );
        assert!(
            moved.iter().all(|p| p.is_finite()),
            "{weights:?}: {moved:?}"
        );
        assert_eq!(moved[7], points[7]);
    }
    let empty = PolygonMesh::default();
    assert!(moved(&empty, &Smoothing::default()).is_empty());
}

#[test]
fn each_invalid_input_returns_its_error() {
    let mesh = set(&sixfold_shapes::mixed_grid(2, 1).expect("small"));
    let refusal = |smoothing: Smoothing| smoothed(&mesh, &smoothing).err();
    let cotangent = Smoothing {
        weights: Weights::Cotangent,
        ..Smoothing::default()
    };
    let (face, degree) = (FaceId::new(0), 4);
    assert_eq!(
        refusal(cotangent),
        Some(SmoothingError::NotATriangle { face, degree })
    );
    for step in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        let got = refusal(Smoothing {
            step,
            ..Smoothing::default()
        });
        assert!(matches!(got, Some(SmoothingError::Step { .. })), "{step}");
    }
    for back in [0.3, -0.5, -9.0, f64::NAN, f64::NEG_INFINITY] {
        let got = refusal(Smoothing {
            step: 0.6,
            step_back: Some(back),
            ..Smoothing::default()
        });
        assert!(
            matches!(got, Some(SmoothingError::StepBack { .. })),
            "{back}"
        );
    }
    let taubin = Smoothing {
        step: 0.33,
        step_back: Some(-0.34),
        ..Smoothing::default()
    };
    assert_eq!(refusal(taubin), None);
}

/// Step 1 moves all vertices of the octahedron to the centre. The polygon soup identifies vertices
/// by their positions and returns an error.
#[test]
fn the_structure_decides_whether_vertices_may_coincide() {
    let whole = Smoothing {
        step: 1.0,
        iterations: 1,
        ..Smoothing::default()
    };
    let mut soup = PolygonSoup::from_polygons(&sixfold_shapes::octahedron()).expect("triangles");
    let moved = smoothed(&soup, &whole).expect("smooth");
    let face = FaceId::new(0);
    assert_eq!(
        soup.set_positions(&moved),
        Err(MoveError::CoincidentCorners { face })
    );
    let mut halves =
        HalfEdgeMesh::from_polygons(&sixfold_shapes::octahedron()).expect("a manifold");
    let moved = smoothed(&halves, &whole).expect("smooth");
    halves.set_positions(&moved).expect("positions may repeat");
    assert!(halves.vertices().all(|v| halves.position(v) == Point::ZERO));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn uniform_smoothing_commutes_with_affine_maps(
        polygons in manifold_mesh(),
        map in prop::array::uniform4(prop::array::uniform3(-2.0_f32..2.0)),
        curve in any::<bool>(),
    ) {
        let [x, y, z, shift] = map.map(Point::from_array);
        let mapped = |p: Point| p.x * x + p.y * y + p.z * z + shift;
        let boundary = if curve { SmoothingBoundary::Curve } else { SmoothingBoundary::Fixed };
        let smoothing = Smoothing { boundary, iterations: 3, ..Smoothing::default() };
        let after: Vec<Point> = moved(&polygons, &smoothing).into_iter().map(mapped).collect();
        let before = moved(&with_positions(&polygons, |_, p| mapped(p)), &smoothing);
        let size = after.iter().map(|p| p.abs().max_element()).fold(1.0, f32::max);
        for (a, b) in after.iter().zip(&before) {
            prop_assert!(a.distance(*b) < 1e-5 * size, "{} {}", a, b);
        }
    }

    #[test]
    fn cotangent_smoothing_commutes_with_similarities(
        axis in prop::array::uniform3(0.1_f32..1.0),
        angle in -3.0_f32..3.0,
        scale in 0.1_f32..10.0,
    ) {
        let turn = glam::Quat::from_axis_angle(Point::from_array(axis).normalize(), angle);
        let mapped = |p: Point| scale * (turn * p) + Point::ONE;
        let torus = sixfold_shapes::triangle_torus(9, 6).expect("small");
        let smoothing = Smoothing { weights: Weights::Cotangent, iterations: 3, ..Smoothing::default() };
        let after = moved(&torus, &smoothing).into_iter().map(mapped);
        let before = moved(&with_positions(&torus, |_, p| mapped(p)), &smoothing);
        for (a, b) in after.zip(before) {
            prop_assert!(a.distance(b) < 2e-5 * (1.0 + scale), "{} {}", a, b);
        }
    }
}
