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
    for flat in [triangle, grid] {
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
