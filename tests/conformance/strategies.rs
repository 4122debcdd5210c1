//! The random meshes have the documented properties and are varied enough.

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sixfold_conformance::one_line;
use sixfold_conformance::strategy::{Fault, any_mesh, faulty_mesh, manifold_mesh};
use sixfold_core::{BuildError, Capabilities, Facts, PolygonMesh};

const SAMPLES: usize = 1000;

fn samples<S: Strategy>(strategy: S) -> Vec<S::Value> {
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let sample = |_| {
        strategy
            .new_tree(&mut runner)
            .expect("nothing is filtered")
            .current()
    };
    (0..SAMPLES).map(sample).collect()
}

fn share<T>(items: &[T], predicate: impl Fn(&T) -> bool) -> usize {
    100 * items.iter().filter(|item| predicate(item)).count() / items.len()
}

/// Each entry is `(kind, floor, share)` in percent.
fn assert_shares(floors: &[(&str, usize, usize)]) {
    let below = floors.iter().filter(|(_, floor, share)| share < floor);
    let below: Vec<_> = below.collect();
    assert!(below.is_empty(), "too few (kind, floor, share): {below:?}");
}

fn has_distinct_positions(polygons: &PolygonMesh) -> bool {
    let mut positions: Vec<[u32; 3]> = polygons
        .positions()
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect();
    positions.sort_unstable();
    positions.windows(2).all(|pair| pair[0] != pair[1])
}

#[test]
fn random_manifolds_are_manifolds_of_every_kind() {
    let meshes = samples(manifold_mesh());
    for mesh in &meshes {
        let result = sixfold_conformance::expected_check(&Capabilities::ORIENTED_MANIFOLDS, mesh);
        assert_eq!(result, Ok(()), "{}", one_line(mesh));
        assert!(has_distinct_positions(mesh), "{}", one_line(mesh));
    }
    let facts: Vec<Facts> = meshes.iter().map(Facts::from_polygons).collect();
    let floors = [
        ("open", 30, share(&facts, |f| !f.closed)),
        ("closed", 15, share(&facts, |f| f.closed)),
        (
            "several boundary loops",
            12,
            share(&facts, |f| f.boundary_loops > Some(1)),
        ),
        ("with handles", 15, share(&facts, |f| f.genus > Some(0))),
        (
            "of genus 2 and more",
            4,
            share(&facts, |f| f.genus > Some(1)),
        ),
        (
            "several components",
            30,
            share(&facts, |f| f.components > 1),
        ),
        ("mixed degrees", 40, share(&facts, |f| spread(f) > 0)),
        (
            "faces of seven corners and more",
            10,
            share(&facts, |f| degree(f) > 6),
        ),
        (
            "triangles only",
            15,
            share(&facts, |f| spread(f) == 0 && degree(f) == 3),
        ),
        (
            "isolated vertices",
            10,
            share(&facts, |f| f.isolated_vertices > 0),
        ),
        (
            "no isolated vertices",
            60,
            share(&facts, |f| f.isolated_vertices == 0),
        ),
        (
            "vertices of valence 2 inside",
            5,
            share(&meshes, has_digon_neighbours),
        ),
        (
            "pillows and other duplicates",
            1,
            share(&facts, |f| f.duplicate_faces > 0),
        ),
        ("a single polygon", 1, share(&facts, |f| f.faces == 1)),
        (
            "thirty faces and more",
            15,
            share(&facts, |f| f.faces >= 30),
        ),
    ];
    assert_shares(&floors);
}

fn degree(facts: &Facts) -> usize {
    facts.face_degree.as_ref().map_or(0, |degree| degree.max)
}

fn spread(facts: &Facts) -> usize {
    facts
        .face_degree
        .as_ref()
        .map_or(0, |degree| degree.max - degree.min)
}

/// Returns whether two faces share two edges at a vertex of valence 2.
fn has_digon_neighbours(mesh: &PolygonMesh) -> bool {
    let oracle = sixfold_conformance::Oracle::new(mesh);
    oracle.vertices().any(|v| {
        let ring = oracle.one_ring(v);
        ring.is_some_and(|(ring, closed)| closed && ring.len() == 2)
    })
}

#[test]
fn faulty_meshes_have_exactly_their_faults() {
    let meshes = samples(faulty_mesh());
    for faulty in &meshes {
        let shown = || format!("{:?}: {}", faulty.faults, one_line(&faulty.polygons));
        let result = sixfold_conformance::expected_check(
            &Capabilities::ORIENTED_MANIFOLDS,
            &faulty.polygons,
        );
        let harmless = [Fault::IsolatedVertex, Fault::CoincidentVertices];
        let harmful = faulty.faults.iter().any(|fault| !harmless.contains(fault));
        assert_eq!(result.is_err(), harmful, "{}", shown());
        let coincident = faulty.faults.contains(&Fault::CoincidentVertices);
        assert_eq!(
            !has_distinct_positions(&faulty.polygons),
            coincident,
            "{}",
            shown()
        );
        if let [fault] = faulty.faults[..] {
            let facts = Facts::from_polygons(&faulty.polygons);
            let fits = match (fault, result) {
                (Fault::TurnedFace, Err(BuildError::RepeatedSide { .. }))
                | (Fault::ThirdFace, Err(BuildError::NonManifoldEdge { .. }))
                | (Fault::BowTie, Err(BuildError::NonManifoldVertex { .. })) => true,
                // The duplicate may be the third face at an edge.
                (Fault::DuplicateFace, Err(_)) => facts.duplicate_faces > 0,
                (Fault::IsolatedVertex, Ok(())) => facts.isolated_vertices == 1,
                (Fault::CoincidentVertices, Ok(())) => true,
                _ => false,
            };
            assert!(fits, "{}", shown());
        }
    }
    for fault in Fault::ALL {
        let share = share(&meshes, |faulty| faulty.faults == [fault]);
        assert!(share >= 3, "{fault:?} alone: {share} % of the meshes");
    }
}

#[test]
fn random_faces_have_faults_of_every_kind() {
    let meshes = samples(any_mesh());
    let refusal = |mesh: &PolygonMesh| Capabilities::ORIENTED_MANIFOLDS.check(mesh).err();
    let floors = [
        (
            "edges with three faces",
            20,
            share(&meshes, |m| {
                matches!(refusal(m), Some(BuildError::NonManifoldEdge { .. }))
            }),
        ),
        (
            "repeated sides",
            10,
            share(&meshes, |m| {
                matches!(refusal(m), Some(BuildError::RepeatedSide { .. }))
            }),
        ),
        (
            "bow-ties",
            2,
            share(&meshes, |m| {
                matches!(refusal(m), Some(BuildError::NonManifoldVertex { .. }))
            }),
        ),
        (
            "shared places",
            10,
            share(&meshes, |m| !has_distinct_positions(m)),
        ),
        ("no faces", 5, share(&meshes, |m| m.face_count() == 0)),
        ("manifolds", 10, share(&meshes, |m| refusal(m).is_none())),
    ];
    assert_shares(&floors);
}
