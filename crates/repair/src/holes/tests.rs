use proptest::prelude::*;
use sixfold_conformance::strategy::manifold_mesh;
use sixfold_core::{FaceId, Facts, Point, RowId};

use super::*;
use crate::report::Repaired;
use crate::step::{Step, repair};

fn filled(polygons: &PolygonMesh, method: HoleFilling, max_edges: Option<usize>) -> Repaired {
    let options = FillHoles { max_edges, method };
    repair(polygons, &[Step::FillHoles(options)]).expect("an oriented manifold")
}

const METHODS: [HoleFilling; 2] = [HoleFilling::MinimumArea, HoleFilling::EarClipping];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// A filled mesh is an oriented manifold, and only holes that the report names remain.
    #[test]
    fn holes_are_filled_or_named(polygons in manifold_mesh(), limit in 3..9_usize) {
        for method in METHODS {
            for max_edges in [None, Some(limit)] {
                let repaired = filled(&polygons, method, max_edges);
                let check = Capabilities::ORIENTED_MANIFOLDS.check(&repaired.polygons);
                prop_assert_eq!(check, Ok(()));
                let before = Facts::from_polygons(&polygons);
                let after = Facts::from_polygons(&repaired.polygons);
                let report = &repaired.steps[0];
                let loops = before.boundary_loops.expect("a manifold");
                prop_assert_eq!(report.counts.holes_filled + report.left.len(), loops);
                prop_assert_eq!(after.boundary_loops, Some(report.left.len()));
                let again = filled(&repaired.polygons, method, max_edges);
                prop_assert_eq!(&again.polygons, &repaired.polygons);
            }
        }
    }
}

/// Returns a sphere without the faces that `is_removed` names.
fn sphere_without(is_removed: impl Fn(usize) -> bool) -> PolygonMesh {
    let sphere = sixfold_shapes::geodesic(3).expect("small");
    let faces = sphere
        .faces()
        .iter()
        .filter(|(f, _)| !is_removed(f.index()));
    let faces: Vec<Vec<u32>> = faces
        .map(|(_, face)| face.iter().map(|v| v.row()).collect())
        .collect();
    PolygonMesh::new(sphere.positions().iter().copied(), faces).expect("valid")
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Holes that meet in vertices are filled, too: each boundary edge is closed, or in a hole that the
    /// report names.
    #[test]
    fn holes_that_meet_are_filled(removed in proptest::collection::vec(any::<bool>(), 180)) {
        let open = sphere_without(|f| removed[f]);
        let boundary = Facts::from_polygons(&open).boundary_edges;
        for method in METHODS {
            let repaired = filled(&open, method, None);
            let facts = Facts::from_polygons(&repaired.polygons);
            let left = repaired.steps[0].left.iter().map(|left| match left {
                Left::BlockedHole { edges, .. } | Left::CoveringHole { edges, .. } => *edges,
                other => panic!("{other}"),
            });
            prop_assert_eq!(facts.boundary_edges, left.sum::<usize>());
            prop_assert_eq!((facts.non_manifold_edges, facts.inconsistent_edges), (0, 0));
            let counts = &repaired.steps[0].counts;
            prop_assert_eq!(counts.faces_added + 2 * counts.holes_filled, boundary - facts.boundary_edges);
        }
    }
}

#[test]
fn two_holes_at_one_vertex_are_filled() {
    let sphere = sixfold_shapes::geodesic(3).expect("small");
    let v = sphere.faces().face(FaceId::new(0))[0];
    let at_v = sphere.faces().iter().filter(|(_, face)| face.contains(&v));
    let at_v: Vec<Vec<VertexId>> = at_v.map(|(_, face)| face.to_vec()).collect();
    // Two faces that share only this vertex.
    let is_apart = |face: &&Vec<VertexId>| face.iter().filter(|w| at_v[0].contains(w)).count() == 1;
    let other = at_v.iter().find(is_apart).expect("five faces or more");
    let is_removed = |f: usize| {
        let face = sphere.faces().face(FaceId::new(f as u32));
        face == at_v[0] || face == *other
    };
    let open = sphere_without(is_removed);
    assert!(Capabilities::ORIENTED_MANIFOLDS.check(&open).is_err());
    for method in METHODS {
        let repaired = filled(&open, method, None);
        let counts = &repaired.steps[0].counts;
        assert_eq!((counts.holes_filled, counts.faces_added), (2, 2));
        assert!(Facts::from_polygons(&repaired.polygons).closed);
    }
}

#[test]
fn a_cube_without_a_face_is_closed() {
    let cube = sixfold_shapes::cube();
    let faces = cube.faces().iter().skip(1);
    let faces: Vec<Vec<u32>> = faces
        .map(|(_, face)| face.iter().map(|v| v.index() as u32).collect())
        .collect();
    let open = PolygonMesh::new(cube.positions().iter().copied(), &faces).expect("valid");
    for method in METHODS {
        let repaired = filled(&open, method, None);
        let facts = Facts::from_polygons(&repaired.polygons);
        assert_eq!((facts.faces, facts.closed, facts.genus), (7, true, Some(0)));
        assert!(repaired.faces.old_elements(FaceId::new(6)).is_empty());
        let left = &filled(&open, method, Some(3)).steps[0].left;
        let vertex = VertexId::from_row(
            cube.faces()
                .face(FaceId::new(0))
                .iter()
                .map(|v| v.row())
                .min()
                .expect("corners"),
        );
        assert_eq!(left[..], [Left::LargeHole { vertex, edges: 4 }]);
    }
}

#[test]
fn a_hole_whose_diagonals_are_edges_remains() {
    // A tetrahedron's edges join all four vertices of the hole, so it has no free diagonal.
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.5, 1.0],
        [0.5, 0.5, -1.0],
    ];
    // The hole is v0 v1 v2 v3; v0–v2 and v1–v3 are edges of fins that leave through v4 and v5.
    let faces = [[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]];
    let cone = PolygonMesh::new(points, faces).expect("valid");
    let repaired = filled(&cone, HoleFilling::EarClipping, None);
    assert_eq!(repaired.steps[0].counts.holes_filled, 1);
    let holes = Holes::new(&cone);
    let mut blocked = Holes {
        edges: holes.edges.clone(),
        sides: holes.sides.clone(),
        faces: holes.faces.clone(),
        diagonals: FxHashSet::default(),
    };
    let v = VertexId::new;
    blocked
        .edges
        .extend([Pair::new(v(0), v(2)), Pair::new(v(1), v(3))]);
    for method in METHODS {
        let hole = &blocked.loops(&cone)[0];
        assert_eq!(blocked.triangulate(&cone, hole, method), None);
    }
}

#[test]
fn a_mesh_with_a_non_manifold_edge_is_refused() {
    let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| [x, x * x, 0.0]);
    let book = PolygonMesh::new(points, [[0, 1, 2], [1, 0, 3], [0, 1, 4]]).expect("valid");
    let refused = repair(&book, &[Step::FillHoles(FillHoles::default())]).unwrap_err();
    assert!(matches!(refused, RepairError::NotOrientedManifold(_)));
}

#[test]
fn holes_whose_triangles_would_lie_on_the_mesh_remain() {
    // A face that shares no edge, the outer boundary of a flat part, and a ring with two boundaries,
    // of which the outer one has its triangles on the ring.
    let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]]).expect("valid");
    let grid = sixfold_shapes::grid(4, 4).expect("small");
    // So far away that rounding errors are larger than the distance within which faces count.
    let far = Point::new(131_072.0, 131_072.0, 0.0);
    let points = grid.positions().iter().map(|&p| p + far);
    let far = PolygonMesh::from_faces(points.collect(), grid.faces().clone()).expect("valid");
    for flat in [triangle, grid, far] {
        let filled = repair(&flat, &[Step::FillHoles(FillHoles::default())]).expect("a manifold");
        assert!(!filled.is_changed());
        let left = &filled.steps[0].left;
        assert!(matches!(left[..], [Left::CoveringHole { .. }]), "{left:?}");
    }
    let grid = sixfold_shapes::grid(3, 3).expect("small");
    let faces = grid.faces().iter().filter(|(f, _)| f.index() != 4);
    let faces: Vec<Vec<u32>> = faces
        .map(|(_, face)| face.iter().map(|v| v.row()).collect())
        .collect();
    let ring = PolygonMesh::new(grid.positions().iter().copied(), faces).expect("valid");
    let filled = repair(&ring, &[Step::FillHoles(FillHoles::default())]).expect("a manifold");
    assert_eq!(filled.steps[0].counts.holes_filled, 1);
    assert_eq!(filled.steps[0].left.len(), 1);
}

/// Returns the squares of a lattice that `is_solid` names, in space: turned, and two units apart from
/// the lattice.
fn squares(size: [i32; 2], is_solid: impl Fn(i32, i32) -> bool) -> PolygonMesh {
    let [columns, rows] = size;
    let at = |x: i32, y: i32| (y * (columns + 1) + x) as u32;
    let mut faces = Vec::new();
    for (x, y) in cells(size).filter(|&(x, y)| is_solid(x, y)) {
        faces.push([at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
    }
    let points = cells([columns + 1, rows + 1]).map(|(x, y)| {
        let turn = glam::DQuat::from_rotation_x(0.4) * glam::DQuat::from_rotation_z(0.3);
        (turn * DVec3::new(f64::from(x), f64::from(y), 2.0)).as_vec3()
    });
    PolygonMesh::new(points, faces).expect("valid")
}

fn cells([columns, rows]: [i32; 2]) -> impl Iterator<Item = (i32, i32)> {
    (0..rows).flat_map(move |y| (0..columns).map(move |x| (x, y)))
}

/// Returns the number of faces of a mesh of [`squares`] over a point of the lattice.
fn faces_over(mesh: &PolygonMesh, columns: i32, point: [f64; 2]) -> usize {
    let lattice = |v: VertexId| {
        let [x, y] = [
            v.index() as i32 % (columns + 1),
            v.index() as i32 / (columns + 1),
        ];
        [f64::from(x) - point[0], f64::from(y) - point[1]]
    };
    let is_over = |face: &[VertexId]| {
        let corners: Vec<[f64; 2]> = face.iter().map(|&v| lattice(v)).collect();
        let next = corners.iter().cycle().skip(1);
        let turns: Vec<f64> = corners
            .iter()
            .zip(next)
            .map(|(p, q)| p[0] * q[1] - p[1] * q[0])
            .collect();
        turns.iter().all(|&turn| turn > 0.0) || turns.iter().all(|&turn| turn < 0.0)
    };
    mesh.faces()
        .iter()
        .filter(|(_, face)| is_over(face))
        .count()
}

/// Returns the sum of the areas.
fn area(mesh: &PolygonMesh) -> f64 {
    crate::measures(mesh).area
}

fn covering(repaired: &Repaired) -> usize {
    let is_covering = |left: &&Left| matches!(left, Left::CoveringHole { .. });
    repaired.steps[0].left.iter().filter(is_covering).count()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever the holes of a flat mesh are, no two faces of the result lie on each other.
    #[test]
    fn flat_meshes_stay_flat(solid in proptest::collection::vec(prop::bool::weighted(0.7), 48)) {
        let size = [8, 6];
        let flat = squares(size, |x, y| solid[(y * 8 + x) as usize]);
        for method in METHODS {
            let result = filled(&flat, method, None);
            for (x, y) in cells(size) {
                // Points on no line between corners.
                for [dx, dy] in [[0.31, 0.17], [0.713, 0.37], [0.237, 0.791], [0.871, 0.619]] {
                    let point = [f64::from(x) + dx, f64::from(y) + dy];
                    let faces = faces_over(&result.polygons, size[0], point);
                    prop_assert!(faces <= 1, "{faces} faces at {point:?}");
                }
            }
        }
    }

    /// The windows of a plate are filled, except for those with an island, which remain together with
    /// the rim of the island and the rim of the plate. A window of an island is filled.
    #[test]
    fn windows_are_filled_around_nothing(
        blocks in proptest::collection::vec((1..3_i32, 1..3_i32, 5..8_i32, 5..8_i32, 0..3_u8), 1..5),
    ) {
        let size = [9 * blocks.len() as i32, 9];
        let kind = |x: i32, y: i32| {
            let (left, bottom, right, top, island) = blocks[(x / 9) as usize];
            let [x, y] = [x % 9, y];
            let is_in_window = (left..=right).contains(&x) && (bottom..=top).contains(&y);
            let is_in_island = (left + 1..right).contains(&x) && (bottom + 1..top).contains(&y);
            let is_in_middle = (left + 2..right - 1).contains(&x) && (bottom + 2..top - 1).contains(&y);
            (is_in_window, is_in_island && island > 0, is_in_middle && island > 1)
        };
        let plate = squares(size, |x, y| {
            let (is_in_window, is_in_island, is_in_middle) = kind(x, y);
            !is_in_window || (is_in_island && !is_in_middle)
        });
        let islands = blocks.iter().filter(|(.., island)| *island > 0).count();
        let gap = |(x, y): &(i32, i32)| {
            let (is_in_window, is_in_island, _) = kind(*x, *y);
            is_in_window && !is_in_island && blocks[(*x / 9) as usize].4 > 0
        };
        let expected = 9 * size[0] - cells(size).filter(gap).count() as i32;
        for method in METHODS {
            let result = filled(&plate, method, None);
            prop_assert!((area(&result.polygons) - f64::from(expected)).abs() < 1e-3);
            prop_assert_eq!(covering(&result), 1 + 2 * islands);
            prop_assert_eq!(result.steps[0].left.len(), 1 + 2 * islands);
        }
    }

    /// Two cones whose rims coincide nearly remain open; at a visible distance, both are closed.
    #[test]
    fn patches_do_not_coincide(n in 3..40_u32, twice in any::<bool>(), gap in -6.0..-3.7_f32) {
        let other = if twice { 2 * n.max(24) } else { n };
        let n = if twice { n.max(24) } else { n };
        let edge = std::f32::consts::TAU / other as f32;
        let cones = |gap: f32| {
            crate::orientation::tests::together(&[cone(n, 0.0, 1.0), cone(other, -gap, -1.0)])
        };
        for method in METHODS {
            let close = filled(&cones(edge * 10.0_f32.powf(gap)), method, None);
            prop_assert_eq!((close.is_changed(), covering(&close)), (false, 2));
            let apart = filled(&cones(0.1 * edge), method, None);
            prop_assert_eq!(apart.steps[0].counts.holes_filled, 2);
        }
    }
}

/// Returns a cone without its base: the rim with `n` edges and radius 1 at `height`, the tip at `tip`.
fn cone(n: u32, height: f32, tip: f32) -> PolygonMesh {
    let rim = (0..n).map(|i| {
        let (sin, cos) = (i as f32 * std::f32::consts::TAU / n as f32).sin_cos();
        [cos, sin, height]
    });
    let points = rim.chain([[0.0, 0.0, tip]]);
    let faces = (0..n).map(|i| [i, (i + 1) % n, n]);
    PolygonMesh::new(points, faces).expect("valid")
}

/// Returns a tube without its bases, from height 0 to 3.
fn tube(n: u32, radius: f32) -> PolygonMesh {
    let points = (0..2 * n).map(|i| {
        let (sin, cos) = (i as f32 * std::f32::consts::TAU / n as f32).sin_cos();
        [radius * cos, radius * sin, if i < n { 0.0 } else { 3.0 }]
    });
    let faces = (0..n).map(|i| [i, (i + 1) % n, n + (i + 1) % n, n + i]);
    PolygonMesh::new(points, faces).expect("valid")
}

#[test]
fn one_of_two_nested_tubes_is_closed() {
    for (other, filled_discs) in [(0.8, 2), (0.99, 0)] {
        let tubes = crate::orientation::tests::together(&[tube(32, 1.0), tube(32, other)]);
        for method in METHODS {
            let result = filled(&tubes, method, None);
            assert_eq!(result.steps[0].counts.holes_filled, filled_discs);
            assert_eq!(covering(&result), 4 - filled_discs);
            let disc = 16.0 * (std::f64::consts::TAU / 32.0).sin() * f64::from(other).powi(2);
            let more = area(&result.polygons) - area(&tubes);
            assert!((more - filled_discs as f64 * disc).abs() < 1e-5, "{more}");
        }
    }
}

#[test]
fn a_hole_in_a_thin_solid_is_filled() {
    // The walls are 1/100 of an edge apart. The other wall does not lie on the patch.
    let top = squares([6, 6], |x, y| ![(2, 2), (3, 2), (4, 4)].contains(&(x, y)));
    let normal = glam::DQuat::from_rotation_x(0.4) * DVec3::Z;
    let wall = squares([6, 6], |_, _| true);
    let lower = wall
        .positions()
        .iter()
        .map(|p| (p.as_dvec3() - 0.01 * normal).as_vec3());
    let faces = wall.faces().iter().map(|(_, face)| face.iter().rev());
    let faces: Vec<Vec<u32>> = faces.map(|face| face.map(|v| v.row()).collect()).collect();
    let lower = PolygonMesh::new(lower, faces).expect("valid");
    let solid = crate::orientation::tests::together(&[top, lower]);
    for method in METHODS {
        let result = filled(&solid, method, None);
        assert_eq!(result.steps[0].counts.holes_filled, 2);
        assert!((area(&result.polygons) - 72.0).abs() < 1e-4);
        assert_eq!(covering(&result), 2);
    }
}

/// The triangles of a hub that are not joined: each hole has the triangle of its own face.
#[test]
fn triangles_with_one_corner_at_one_place_are_covered_by_themselves() {
    let count = 1000_u32;
    let points = (0..3 * count).map(|i| {
        let angle =
            (f64::from(i / 3) + 0.5 * f64::from(i % 3)) * std::f64::consts::TAU / f64::from(count);
        let (sin, cos) = angle.sin_cos();
        match i % 3 {
            0 => Point::ZERO,
            _ => DVec3::new(cos, sin, 0.3).as_vec3(),
        }
    });
    let faces = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let fans = PolygonMesh::new(points, faces).expect("valid");
    for method in METHODS {
        let result = filled(&fans, method, None);
        assert_eq!(
            (result.is_changed(), covering(&result)),
            (false, count as usize)
        );
    }
}

/// Returns large triangles at random places in the unit cube, not joined.
pub(super) fn scattered(count: u32) -> PolygonMesh {
    let mut state = 1_u64;
    let mut draw = || {
        // Marsaglia 2003.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 24) as f32
    };
    let points: Vec<[f32; 3]> = (0..3 * count).map(|_| [draw(), draw(), draw()]).collect();
    PolygonMesh::new(points, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2])).expect("valid")
}

#[test]
fn the_sides_of_a_single_face_are_not_a_hole() {
    let triangles = scattered(3000);
    let skew = [[0.0; 3], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
    let skew = PolygonMesh::new(skew, [[0, 1, 2, 3]]).expect("valid");
    for (mesh, count) in [(triangles, 3000), (skew, 1)] {
        for method in METHODS {
            let result = filled(&mesh, method, None);
            assert_eq!((result.is_changed(), covering(&result)), (false, count));
        }
    }
}

/// Pyramids without a base that cross each other: each is closed, or named.
#[test]
fn crowded_holes_are_filled_or_named() {
    let pyramids = scattered(600);
    let apex = |f: u32| 3 * f + 3;
    let faces = (0..300).map(|i| 2 * i).flat_map(|f| {
        let [a, b, c] = [0, 1, 2].map(|i| 3 * f + i);
        [[a, b, apex(f)], [b, c, apex(f)], [c, a, apex(f)]]
    });
    let pyramids = PolygonMesh::new(pyramids.positions().iter().copied(), faces).expect("valid");
    for method in METHODS {
        let result = filled(&pyramids, method, None);
        let filled = result.steps[0].counts.holes_filled;
        assert_eq!(filled + covering(&result), 300);
        assert!(filled > 290, "{filled}");
    }
}

/// Fans in nearly parallel planes with one common vertex.
#[test]
fn crowded_fans_are_covered_by_themselves() {
    let count = 200_u32;
    let rim = (0..11 * count).map(|i| {
        let (sin, cos) = (0.3 * (i % 11) as f32).sin_cos();
        [cos, sin, 0.001 * (i / 11) as f32]
    });
    let faces = (0..11 * count)
        .filter(|i| i % 11 != 10)
        .map(|i| [0, i + 1, i + 2]);
    let fans = PolygonMesh::new([[0.0; 3]].into_iter().chain(rim), faces).expect("valid");
    for method in METHODS {
        let result = filled(&fans, method, None);
        assert_eq!(
            (result.is_changed(), covering(&result)),
            (false, count as usize)
        );
    }
}
