use proptest::collection;
use proptest::prelude::*;
use sixfold_conformance::strategy::manifold_mesh;
use sixfold_core::glam::{EulerRot, Quat};
use sixfold_core::{Facts, Point, RowId};

use super::*;

fn with_reversed(polygons: &PolygonMesh, reverse: impl Fn(usize) -> bool) -> PolygonMesh {
    let faces = polygons.faces().iter().map(|(f, _)| f);
    let reversed: Vec<FaceId> = faces.filter(|f| reverse(f.index())).collect();
    reverse_faces(polygons, &reversed)
}

fn face(row: u32) -> FaceId {
    FaceId::new(row)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The repair makes all faces agree with the fewest reversals.
    #[test]
    fn reversed_faces_are_reversed_back(
        polygons in manifold_mesh(),
        reverse in collection::vec(any::<bool>(), 1..20),
    ) {
        let reverse = |f: usize| reverse[f % reverse.len()];
        let repaired = oriented(&with_reversed(&polygons, reverse), Facing::Majority).expect("orientable");
        prop_assert_eq!(Facts::from_polygons(&repaired.polygons).inconsistent_edges, 0);
        prop_assert!(2 * repaired.reversed.len() <= polygons.face_count());
        // A face differs from the original only if its whole component is reversed.
        let unchanged = |f: FaceId| polygons.faces().face(f) == repaired.polygons.faces().face(f);
        let faces = polygons.faces();
        let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
        let neighbours = side_neighbours(faces, &incidence);
        for (f, _) in polygons.faces().iter() {
            prop_assert_eq!(unchanged(f), reverse(f.index()) == repaired.reversed.contains(&f));
            for corner in polygons.faces().range(f) {
                if let Some((g, _)) = neighbours[corner] {
                    prop_assert_eq!(unchanged(f), unchanged(g));
                }
            }
        }
        let again = oriented(&repaired.polygons, Facing::Majority).expect("orientable");
        prop_assert!(again.reversed.is_empty());
    }

    /// The closed shapes of this project face outward.
    #[test]
    fn closed_shapes_face_outward_again(reverse in collection::vec(any::<bool>(), 1..50)) {
        let torus = sixfold_shapes::torus(6, 5).expect("small");
        for shape in [sixfold_shapes::cube(), sixfold_shapes::dodecahedron(), torus] {
            let mixed = with_reversed(&shape, |f| reverse[f % reverse.len()]);
            let repaired = oriented(&mixed, Facing::Outward).expect("orientable");
            prop_assert_eq!(repaired.polygons, shape);
        }
    }
}

#[test]
fn an_inside_out_shape_is_reversed_only_by_outward() {
    let inside_out = with_reversed(&sixfold_shapes::cube(), |_| true);
    let majority = oriented(&inside_out, Facing::Majority).expect("orientable");
    assert!(majority.reversed.is_empty());
    let outward = oriented(&inside_out, Facing::Outward).expect("orientable");
    assert_eq!(outward.reversed, (0..6).map(face).collect::<Vec<_>>());
    assert_eq!(outward.polygons, sixfold_shapes::cube());
}

#[test]
fn components_without_volume_follow_the_majority() {
    let grid = sixfold_shapes::grid(3, 3).expect("small");
    let mixed = with_reversed(&grid, |f| f == 4);
    let repaired = oriented(&mixed, Facing::Outward).expect("orientable");
    assert_eq!(repaired.reversed, [face(4)]);
    // A pillow is closed, but flat.
    let corners = grid.positions()[..3].to_vec();
    let pillow = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
    let repaired = oriented(&pillow, Facing::Outward).expect("orientable");
    assert_eq!(repaired.reversed, [face(1)]);
}

#[test]
fn an_edge_of_three_faces_is_not_crossed() {
    let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(sixfold_core::Point::splat);
    let book = PolygonMesh::new(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]).expect("valid");
    let repaired = oriented(&book, Facing::Majority).expect("no faces disagree");
    assert_eq!((repaired.polygons, repaired.reversed), (book, vec![]));
}

#[test]
fn non_orientable_surfaces_are_rejected_with_an_edge() {
    let mut rejected = 0;
    for specimen in sixfold_conformance::gallery() {
        let facts = Facts::from_polygons(&specimen.polygons);
        match oriented(&specimen.polygons, Facing::Majority) {
            Ok(_) => assert_ne!(facts.orientable, Some(false), "{}", specimen.name),
            Err(OrientationError::NotOrientable { ends: [a, b] }) => {
                assert_eq!(facts.orientable, Some(false), "{}", specimen.name);
                let faces = specimen.polygons.faces().iter();
                let along = faces.filter(|(_, f)| f.contains(&a) && f.contains(&b));
                assert!(a < b && along.count() >= 2, "{}", specimen.name);
                rejected += 1;
            }
        }
    }
    assert!(
        rejected >= 3,
        "expected at least the Möbius strip, the Klein bottle and the projective plane"
    );
}

/// Returns a cube with the corners at ±`half` around a centre; turned inside out if `inward`.
fn cube(half: f32, centre: [f32; 3], inward: bool) -> PolygonMesh {
    let shape = sixfold_shapes::cube();
    let centre = Point::from_array(centre);
    let points = shape.positions().iter().map(|&p| half * p + centre);
    let moved = PolygonMesh::from_faces(points.collect(), shape.faces().clone()).expect("valid");
    match inward {
        true => with_reversed(&moved, |_| true),
        false => moved,
    }
}

pub(crate) fn together(parts: &[PolygonMesh]) -> PolygonMesh {
    let mut points = Vec::new();
    let mut faces = FaceList::default();
    for part in parts {
        let before = points.len() as u32;
        points.extend(part.positions());
        for (_, face) in part.faces().iter() {
            let moved = face.iter().map(|v| VertexId::new(v.row() + before));
            faces.push(moved).expect("small");
        }
    }
    PolygonMesh::from_faces(points, faces).expect("valid")
}

fn volume(mesh: &PolygonMesh) -> f64 {
    let at = |v: VertexId| mesh.position(v).as_dvec3();
    let faces = mesh.faces().iter().map(|(_, face)| {
        let fan = face[1..].windows(2);
        fan.map(|two| at(face[0]).dot(at(two[0]).cross(at(two[1]))))
            .sum::<f64>()
    });
    faces.sum::<f64>() / 6.0
}

fn outward_all(mesh: &PolygonMesh) -> OrientedComponents {
    oriented_components(mesh, Facing::Outward, Components::All)
}

#[test]
fn walls_of_cavities_face_the_cavity() {
    let at = [7.0, -3.0, 2.0];
    // Shells of sides 20, 8, 4 and 2: a solid, a cavity, a solid in it, a cavity in that.
    let halves = [10.0, 4.0, 2.0, 1.0];
    let expected = 8.0 * (1000.0 - 64.0 + 8.0 - 1.0);
    for pattern in 0..16_u32 {
        for order in [[0, 1, 2, 3], [3, 1, 0, 2]] {
            let shells = order.map(|i| cube(halves[i], at, pattern >> i & 1 == 1));
            let oriented = outward_all(&together(&shells));
            assert_eq!(oriented.undecided, []);
            assert!((volume(&oriented.polygons) - expected).abs() < 1e-6);
        }
    }
    // Solids beside each other, in a cavity that none of them fills.
    let parts = [
        cube(10.0, [0.0; 3], true),
        cube(8.0, [0.0; 3], false),
        cube(1.0, [-4.0, 0.0, 0.0], true),
        cube(1.0, [4.0, 1.0, 0.0], true),
    ];
    let oriented = outward_all(&together(&parts));
    assert!((volume(&oriented.polygons) - 8.0 * (1000.0 - 512.0 + 2.0)).abs() < 1e-6);
    assert_eq!(oriented.reversed.len(), 24);
}

/// Adds a cube and cubes in some of its eight parts, and so on in these, as `choices` says: in which
/// parts, and whether the cube is turned inside out. Returns the volume of the solid between them.
fn nested(
    half: f32,
    centre: [f32; 3],
    depth: usize,
    choices: &mut impl Iterator<Item = (u8, bool)>,
    shells: &mut Vec<PolygonMesh>,
) -> f64 {
    let Some((parts, is_inward)) = choices.next() else {
        return 0.0;
    };
    shells.push(cube(half, centre, is_inward));
    let mut volume = 8.0 * f64::from(half).powi(3);
    for part in (0..8).filter(|part| depth > 0 && parts >> part & 1 == 1) {
        let at = [0, 1, 2].map(|i| centre[i] + half * if part >> i & 1 == 1 { 0.5 } else { -0.5 });
        volume -= nested(0.375 * half, at, depth - 1, choices, shells);
    }
    volume
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Solids with cavities, in which there are solids again: the volume is exact, whatever the shells
    /// faced before and however the whole is turned.
    #[test]
    fn nested_shells_have_the_volume_between_them(
        choices in collection::vec((any::<u8>(), any::<bool>()), 1..40),
        turn in prop::array::uniform3(0.0_f32..6.0),
    ) {
        let mut shells = Vec::new();
        let mut choices = choices.into_iter();
        let mut expected = 0.0;
        for i in 0..3 {
            expected += nested(8.0, [20.0 * i as f32, 0.0, 0.0], 3, &mut choices, &mut shells);
        }
        let [x, y, z] = turn;
        let turn = Quat::from_euler(EulerRot::XYZ, x, y, z);
        let all = together(&shells);
        let points = all.positions().iter().map(|&p| turn * p);
        let turned = PolygonMesh::from_faces(points.collect(), all.faces().clone()).expect("valid");
        let oriented = outward_all(&turned);
        prop_assert_eq!(&oriented.undecided, &[]);
        let found = volume(&oriented.polygons);
        prop_assert!((found - expected).abs() < 1e-5 * expected, "{} {}", found, expected);
        prop_assert_eq!(&outward_all(&oriented.polygons).reversed, &[]);
    }
}

#[test]
fn parts_that_touch_or_cross_are_undecided() {
    let touching = [
        cube(1.0, [2.0, 0.0, 0.0], false),  // shares a side
        cube(1.0, [2.0, 2.0, 2.0], false),  // shares a corner
        cube(1.0, [1.0, 0.5, 0.25], false), // crosses
        cube(0.5, [0.5, 0.0, 0.0], false),  // inside, touches a side
        cube(1.0, [0.0; 3], true),          // the same place
    ];
    for other in touching {
        let oriented = outward_all(&together(&[cube(1.0, [0.0; 3], true), other]));
        assert_eq!(oriented.reversed, []);
        let reasons: Vec<UndecidedReason> = oriented.undecided.iter().map(|u| u.reason).collect();
        let expected = [6, 0].map(|f| UndecidedReason::Touches(face(f)));
        assert_eq!(reasons, expected);
    }
    // A part inside two that cross each other is undecided, too; one beside them is not.
    let parts = [
        cube(4.0, [0.0; 3], false),
        cube(4.0, [1.0, 1.0, 1.0], false),
        cube(1.0, [0.5; 3], false),
        cube(1.0, [9.0; 3], true),
    ];
    let oriented = outward_all(&together(&parts));
    let undecided: Vec<usize> = oriented.undecided.iter().map(|u| u.face.index()).collect();
    assert_eq!(undecided, [0, 6, 12]);
    assert_eq!(oriented.reversed, (18..24).map(face).collect::<Vec<_>>());
    // So is an open part inside them, and the others stay as they are.
    let open = without(&cube(0.5, [-2.0; 3], false), |f| f == 0);
    let oriented = outward_all(&together(&[&parts[..], &[open]].concat()));
    let undecided: Vec<usize> = oriented.undecided.iter().map(|u| u.face.index()).collect();
    assert_eq!(undecided, [0, 6, 12, 24]);
    assert_eq!(oriented.reversed, (18..24).map(face).collect::<Vec<_>>());
}

#[test]
fn an_open_part_may_cross_a_solid() {
    let open = without(&cube(0.5, [1.0, 0.0, 0.0], false), |f| f == 0);
    for parts in [
        [cube(1.0, [0.0; 3], true), open.clone()],
        [open, cube(1.0, [0.0; 3], true)],
    ] {
        let oriented = outward_all(&together(&parts));
        assert_eq!(oriented.undecided, []);
        let is_solid = |f: &&FaceId| (f.index() < 6) == (parts[0].face_count() == 6);
        assert!(oriented.reversed.iter().filter(is_solid).count() >= 5);
    }
}

/// Returns whether the side of a mesh that faces outward is decided. It must not depend on the unit of the
/// coordinates, on the place of the mesh and on its side before.
fn is_decided(mesh: &PolygonMesh) -> bool {
    let mut decided = Vec::new();
    for scale in [1e-3, 1.0, 1e3] {
        for place in [0.0, 11.3] {
            let points = mesh.positions().iter();
            let points = points.map(|&p| scale * (p + place * Point::new(1.0, -0.7, 0.4)));
            let moved = PolygonMesh::from_faces(points.collect(), mesh.faces().clone());
            let moved = moved.expect("the same faces");
            for inward in [false, true] {
                let oriented = outward_all(&with_reversed(&moved, |_| inward));
                let is_decided = oriented.undecided.is_empty();
                assert_eq!(oriented.polygons == moved, is_decided || !inward);
                decided.push(is_decided);
            }
        }
    }
    decided.dedup();
    assert_eq!(decided.len(), 1);
    decided[0]
}

/// Returns a sheet of squares with corners at these heights, in rows.
fn heights<const N: usize>(rows: &[[f32; N]]) -> PolygonMesh {
    let points = rows.iter().enumerate().flat_map(|(y, row)| {
        let point = move |(x, &z)| [x as f32, y as f32, z];
        row.iter().enumerate().map(point)
    });
    let n = N as u32;
    let corners = (0..rows.len() as u32 - 1).flat_map(|y| (0..n - 1).map(move |x| y * n + x));
    let squares = corners.map(|v| [v, v + 1, v + n + 1, v + n]);
    PolygonMesh::new(points, squares).expect("valid")
}

#[test]
fn a_side_is_decided_if_the_mesh_clearly_bulges() {
    // Cones.
    for (height, expected) in [(0.004, false), (0.006, true)] {
        let prism = sixfold_shapes::prism(16).expect("small");
        let mut points = prism.positions()[16..].to_vec();
        points.push(Point::new(0.0, 0.0, points[0].z + height));
        let cone = PolygonMesh::new(points, (0..16).map(|i| [i, (i + 1) % 16, 16]));
        assert_eq!(is_decided(&cone.expect("valid")), expected, "{height}");
    }
    // A hill beside a valley.
    for (depth, expected) in [(0.2, true), (0.4, false)] {
        let mesh = heights(&[[0.0; 5], [0.0, 1.0, 0.0, -depth, 0.0], [0.0; 5]]);
        let mesh = mesh.triangulated().expect("small").polygons;
        assert_eq!(is_decided(&mesh), expected, "{depth}");
    }
    // Squares so bent that the side depends on how they are cut.
    for (m, expected) in [(0.0, true), (-0.5, false)] {
        let mesh = heights(&[[0.0, m, 0.0], [m, 1.0, m], [0.0, m, 0.0]]);
        assert_eq!(is_decided(&mesh), expected, "{m}");
    }
    // A cube with a dent, and a flat closed part.
    let cube = sixfold_shapes::cube();
    let mut points = cube.positions().to_vec();
    points[0] = Point::ZERO;
    let dented = PolygonMesh::from_faces(points, cube.faces().clone()).expect("the same faces");
    assert!(is_decided(&dented));
    let pillow = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2], [0, 2, 1]]);
    let pillow = pillow.expect("valid");
    assert!(!is_decided(&pillow));
    let reason = outward_all(&pillow).undecided[0].reason;
    assert_eq!(reason, UndecidedReason::NoVolume);
}

#[test]
fn open_parts_face_the_side_to_which_they_bulge() {
    let sphere = sixfold_shapes::uv_sphere(12, 16).expect("small");
    let bowl = |least: f32| {
        let high = |f: &[VertexId]| f.iter().all(|&v| sphere.position(v).z > least);
        let faces = sphere.faces().iter().filter(|(_, f)| high(f));
        let faces = faces.map(|(_, f)| f.iter().map(|v| v.row()).collect::<Vec<u32>>());
        PolygonMesh::new(sphere.positions().iter().copied(), faces).expect("valid")
    };
    for least in [-0.8, 0.0, 0.5] {
        let bowl = bowl(least);
        assert!(outward_all(&bowl).reversed.is_empty());
        let inside_out = with_reversed(&bowl, |_| true);
        let oriented = outward_all(&inside_out);
        assert_eq!((oriented.polygons, oriented.undecided), (bowl, vec![]));
    }
    // Single faces that are not planar: they bulge to one side or the other, as they are cut.
    let wave: Vec<Point> = (0..6_u8)
        .map(|i| {
            let (sin, cos) = (f32::from(i) * std::f32::consts::FRAC_PI_3).sin_cos();
            Point::new(cos, sin, if i % 2 == 0 { 0.0 } else { 3.0 })
        })
        .collect();
    let saddle = [[0.0; 3], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
    for points in [wave, saddle.map(Point::from).to_vec()] {
        let n = points.len() as u32;
        for face in [(0..n).collect::<Vec<u32>>(), (0..n).rev().collect()] {
            let mesh = PolygonMesh::new(points.clone(), [face]).expect("valid");
            let oriented = outward_all(&mesh);
            assert_eq!((oriented.reversed.len(), oriented.undecided.len()), (0, 1));
        }
    }
    let grid = sixfold_shapes::grid(4, 4).expect("small");
    let flat = outward_all(&grid);
    assert_eq!(flat.reversed, []);
    let reasons: Vec<UndecidedReason> = flat.undecided.iter().map(|u| u.reason).collect();
    assert_eq!(reasons, [UndecidedReason::Flat]);
}

/// Returns the mesh without the faces for which `is_left_out` returns true.
fn without(mesh: &PolygonMesh, is_left_out: impl Fn(usize) -> bool) -> PolygonMesh {
    let faces = mesh.faces().iter().filter(|(f, _)| !is_left_out(f.index()));
    let faces = faces.map(|(_, face)| face.iter().map(|v| v.row()).collect::<Vec<u32>>());
    PolygonMesh::new(mesh.positions().iter().copied(), faces).expect("valid")
}

fn scaled(mesh: &PolygonMesh, by: f32, inward: bool) -> PolygonMesh {
    let points: Vec<Point> = mesh.positions().iter().map(|&p| by * p).collect();
    let mesh = PolygonMesh::from_faces(points, mesh.faces().clone()).expect("valid");
    with_reversed(&mesh, |_| inward)
}

/// Open parts have their place in the nesting, too: a wall of a cavity with a small hole faces the
/// cavity. If the outside can be seen from it, it is undecided.
#[test]
fn nested_open_parts_face_away_from_the_solid_or_are_undecided() {
    let ball = sixfold_shapes::geodesic(8).expect("small");
    let is_right = |mesh: &PolygonMesh| {
        let oriented = outward_all(mesh);
        oriented.reversed.is_empty() && oriented.undecided.is_empty()
    };
    let inner = scaled(&ball, 0.7, true);
    let high = |f: usize| {
        let face = ball.faces().face(face(f as u32));
        face.iter().map(|&v| ball.position(v).z).sum::<f32>() > 0.0
    };
    let half = |upper: bool| without(&ball, |f| high(f) != upper);
    for (outer, inner) in [
        (ball.clone(), without(&inner, |f| f == 5)),
        (without(&ball, |f| f == 7), inner.clone()),
        (without(&ball, |f| f == 7), without(&inner, |f| f == 5)),
        (together(&[half(true), half(false)]), inner.clone()),
    ] {
        let mesh = together(&[outer.clone(), inner.clone()]);
        assert!(is_right(&mesh));
        let turned = together(&[outer.clone(), with_reversed(&inner, |_| true)]);
        assert_eq!(outward_all(&turned).polygons, mesh);
        // Beside each other, both face outward.
        let points: Vec<Point> = inner
            .positions()
            .iter()
            .map(|&p| p + 4.0 * Point::X)
            .collect();
        let beside = PolygonMesh::from_faces(points, inner.faces().clone()).expect("valid");
        let oriented = outward_all(&together(&[outer, beside]));
        assert_eq!(oriented.reversed.len(), inner.face_count());
    }
    // A tube, and a cone with the same box on its rim, which hides the outside in some directions.
    let prism = sixfold_shapes::prism(6).expect("small");
    let mut points = prism.positions().to_vec();
    points.extend_from_within(6..12);
    points.push(Point::new(0.0, 0.0, points[0].z));
    let walls = (0..6).map(|i| vec![i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i]);
    let cone = (0..6).map(|i| vec![12 + i, 12 + (i + 1) % 6, 18]);
    let faces: Vec<Vec<u32>> = walls.chain(cone).collect();
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    assert!(outward_all(&mesh).undecided.is_empty());
    // A pipe: two tubes of different widths.
    let tube = |radius: f32, length: f32, inward: bool| {
        let prism = sixfold_shapes::prism(24).expect("small");
        let sides = without(&prism, |f| prism.faces().face(face(f as u32)).len() > 4);
        let points = sides.positions().iter();
        let points: Vec<Point> = points
            .map(|p| Point::new(radius * p.x, radius * p.y, length * p.z))
            .collect();
        let mesh = PolygonMesh::from_faces(points, sides.faces().clone()).expect("valid");
        with_reversed(&mesh, |_| inward)
    };
    for inward in [false, true] {
        let pipe = |length: f32| {
            let inner = tube(0.8, length, inward);
            outward_all(&together(&[tube(1.0, length, false), inner]))
        };
        let short = pipe(1.0);
        assert_eq!(short.reversed, []);
        let reasons: Vec<UndecidedReason> = short.undecided.iter().map(|u| u.reason).collect();
        assert_eq!(reasons, [UndecidedReason::PartlyInside(face(0))]);
        let long = pipe(9.0);
        assert_eq!((long.reversed.is_empty(), long.undecided), (inward, vec![]));
    }
}

/// An open part among nested solids changes nothing for them. Among very many open parts, it is undecided
/// which are around a part.
#[test]
fn many_open_parts_are_undecided() {
    let shells = |count: u32, is_open: &dyn Fn(u32) -> bool| {
        let shells = (1..=count).map(|i| {
            let shell = cube(i as f32, [0.0; 3], (count - i) % 2 == 1);
            without(&shell, |f| is_open(i) && f == 0)
        });
        together(&shells.collect::<Vec<_>>())
    };
    let mesh = shells(300, &|i| i == 1);
    let turned = with_reversed(&mesh, |f| f % 3 == 0);
    let oriented = outward_all(&turned);
    assert_eq!((oriented.polygons, oriented.undecided), (mesh, vec![]));
    for (count, are_many) in [(30, false), (300, true)] {
        let undecided = outward_all(&shells(count, &|_| true)).undecided;
        let is_many = |part: &Undecided| part.reason == UndecidedReason::ManyAround;
        assert!(!undecided.is_empty());
        assert_eq!(undecided.iter().any(is_many), are_many);
    }
}
