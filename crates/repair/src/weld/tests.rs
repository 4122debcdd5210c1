use proptest::collection;
use proptest::prelude::*;
use sixfold_core::FaceId;

use super::*;
use crate::step::{Step, repair};

const METHODS: [WeldMethod; 2] = [WeldMethod::Grid, WeldMethod::KdTree];

/// Builds a mesh with these vertices and no faces.
fn points(positions: &[[f32; 3]]) -> PolygonMesh {
    PolygonMesh::new(positions.iter().copied(), [[0_u32; 3]; 0]).expect("small")
}

fn weld_with(polygons: &PolygonMesh, tolerance: Tolerance, method: WeldMethod) -> PolygonMesh {
    let step = Step::Weld(Weld { tolerance, method });
    repair(polygons, &[step])
        .expect("a good tolerance")
        .polygons
}

/// Returns the position of the representative of each vertex, by the rule itself: in lexicographic
/// order, a vertex joins the first representative within the tolerance.
fn expected(positions: &[[f32; 3]], tolerance: f64) -> Vec<[f32; 3]> {
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|&a, &b| positions[a].partial_cmp(&positions[b]).expect("finite"));
    let mut representatives: Vec<[f32; 3]> = Vec::new();
    let mut joined = vec![[0.0; 3]; positions.len()];
    for v in order {
        let at = positions[v];
        let is_near = |other: &&[f32; 3]| {
            let squares = at
                .iter()
                .zip(**other)
                .map(|(a, b)| (f64::from(*a) - f64::from(b)).powi(2));
            squares.sum::<f64>() <= tolerance * tolerance
        };
        let found = representatives.iter().find(is_near).copied();
        joined[v] = found.unwrap_or(at);
        if found.is_none() {
            representatives.push(at);
        }
    }
    joined
}

/// Returns the position of each old vertex after welding.
fn joined(positions: &[[f32; 3]], tolerance: f64, method: WeldMethod) -> Vec<[f32; 3]> {
    let tolerance = Tolerance::Absolute(tolerance);
    let step = Step::Weld(Weld { tolerance, method });
    let welded = repair(&points(positions), &[step]).expect("a good tolerance");
    let vertices = (0..row(positions.len())).map(VertexId::new);
    let new = vertices.map(|v| welded.vertices.new_elements(v)[0]);
    new.map(|v| welded.polygons.position(v).to_array())
        .collect()
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => (-3..4_i8).prop_map(f32::from),
        3 => -3.0..3.0_f32,
        1 => (-3..4_i8).prop_map(|i| f32::from(i) * 1e30),
        1 => (-3..4_i8).prop_map(|i| f32::from(i) * 1e-40),
    ]
}

fn tolerance() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(1.0),
        Just(2.0_f64.sqrt()),
        0.0..3.0_f64,
        Just(1e-40),
        Just(1e30),
        Just(1e300)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Both methods follow the rule, for every order of the input.
    #[test]
    fn representatives_are_chosen_greedily_in_lexicographic_order(
        positions in collection::vec([coordinate(), coordinate(), coordinate()], 0..60),
        tolerance in tolerance(),
        turn in 0..60_usize,
    ) {
        // Lists compare −0 and 0 as equal, and so do the sums below.
        let mut turned = positions.clone();
        turned.rotate_left(turn % positions.len().max(1));
        turned.reverse();
        for order in [positions, turned] {
            let expected = expected(&order, tolerance);
            for method in METHODS {
                prop_assert_eq!(&joined(&order, tolerance, method), &expected, "{:?}", method);
            }
        }
    }
}

#[test]
fn vertices_keep_their_order() {
    let mesh = points(&[[2.0, 0.0, 0.0], [0.0; 3], [2.0, 0.0, 0.1], [1.0, 0.0, 0.0]]);
    for method in METHODS {
        let welded = weld_with(&mesh, Tolerance::Absolute(0.2), method);
        let x: Vec<f32> = welded.positions().iter().map(|p| p.x).collect();
        assert_eq!(x, [2.0, 0.0, 1.0]);
        // The diagonal is about 2.
        let relative = weld_with(&mesh, Tolerance::Relative(0.1), method);
        assert_eq!(relative, welded);
    }
}

#[test]
fn positions_that_are_not_numbers_stay_separate() {
    let nan = [f32::NAN, 0.0, 0.0];
    let infinite = [f32::INFINITY, 0.0, 0.0];
    let mesh = points(&[nan, nan, infinite, infinite, [-0.0, 0.0, 0.0], [0.0; 3]]);
    for method in METHODS {
        for tolerance in [Tolerance::Exact, Tolerance::Absolute(1.0)] {
            let welded = weld_with(&mesh, tolerance, method);
            assert_eq!(welded.vertex_count(), 4, "{method:?}");
        }
    }
}

#[test]
fn faces_lose_repeated_corners() {
    let positions = [0.0, 1.0, 2.0, 2.0, 3.0, 0.0].map(|x| [x, x * x, 0.0]);
    let faces = [
        &[0_u32, 1, 2][..],
        &[1, 2, 3],
        &[0, 1, 2, 3],
        &[0, 1, 2, 5, 4, 3],
    ];
    let mesh = PolygonMesh::new(positions, faces).expect("valid");
    let welded = repair(&mesh, &[Step::Weld(Weld::default())]).expect("exact");
    let counts = welded.steps[0].counts;
    assert_eq!((counts.faces_removed, counts.faces_changed), (1, 2));
    // v0 v1 v2 v0 v4 v2: the chain back to v0 leaves v0 v4 v2.
    let faces: Vec<Vec<u32>> = welded
        .polygons
        .faces()
        .iter()
        .map(|(_, face)| face.iter().map(|v| v.index() as u32).collect())
        .collect();
    assert_eq!(faces[..2], [vec![0, 1, 2], vec![0, 1, 2]]);
    assert_eq!(counts.faces_added, faces.len() - 3);
    assert!(welded.faces.new_elements(FaceId::new(1)).is_empty());
}

#[test]
fn a_bad_tolerance_is_refused() {
    let refused = |tolerance| {
        let step = Step::Weld(Weld {
            tolerance,
            ..Weld::default()
        });
        repair(&points(&[]), &[step]).is_err()
    };
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(refused(Tolerance::Absolute(bad)) && refused(Tolerance::Relative(bad)));
    }
    assert!(refused(Tolerance::Relative(1.5)) && !refused(Tolerance::Absolute(1.5)));
}
