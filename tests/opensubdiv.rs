//! Compares Catmull–Clark and Loop with OpenSubdiv on the same meshes with the same creases.
//!
//! The environment variable `SIXFOLD_OPENSUBDIV` contains the path of the program built from
//! `opensubdiv/refine.cpp`. If the variable is not set, these tests do nothing. Vertices are
//! matched by the vertex, edge or face from which they come. They are not matched by position.
//!
//! Not compared:
//!
//! - Chaikin steps for which `Level::is_incomparable` is true.
//! - The limit of a smooth vertex of valence 2: OpenSubdiv returns the vertex itself, but the
//!   levels converge to another point.
//! - Loop on two triangles with the same corners. The halves of their edges have the same ends, but
//!   OpenSubdiv keeps both halves.
//! - Normals on creases: OpenSubdiv uses the tangents of Biermann, Levin & Zorin (2000), which
//!   belong to other step rules. `tangent.rs` has the tangents for the rules of Sixfold.

#[path = "opensubdiv/cases.rs"]
mod cases;
#[path = "opensubdiv/numbers.rs"]
mod numbers;
#[path = "opensubdiv/reference.rs"]
mod reference;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use sixfold::subdivision::{LimitNormal, LimitPoint, Scheme, subdivide, subdivide_native};
use sixfold::subdivision::{Method, SubdivisionError};
use sixfold::{
    Creases, FaceVertexMesh, Point, PolygonMesh, Refine, Representation, SHARPNESS_INFINITE,
    VertexId, for_each_refinable,
};

use numbers::{NumberMap, sorted_pair};
use reference::{Answer, Case, Level, Reference};

/// Maximum distance of two equal points, relative to the size of the control mesh.
const TOLERANCE: f32 = 1e-5;

fn check_level(
    level: &Level,
    numbers: &NumberMap,
    polygons: &PolygonMesh,
    creases: &Creases,
    tolerance: f32,
) {
    for (vertex, &number) in level.vertices.iter().zip(&numbers.vertices) {
        let at = polygons.positions()[number];
        let distance = at.distance(vertex.at);
        let what = (vertex.origin, &vertex.rule);
        assert!(
            distance <= tolerance,
            "{what:?}: {at}, not {}, distance {distance}",
            vertex.at
        );
    }
    let mut ours = BTreeMap::new();
    for &(ends, sharpness) in creases.edges() {
        ours.insert(ends.ends().map(|v| v.index()), sharpness);
    }
    let uses = polygons.edge_uses();
    for edge in uses.iter().filter(|edge| edge.faces != 2) {
        // Boundary and non-manifold edges are always sharp.
        ours.insert(edge.ends.map(|v| v.index()), f32::INFINITY);
    }
    let theirs = level.edges.iter().map(|&([a, b], sharpness)| {
        (
            sorted_pair([numbers.vertices[a], numbers.vertices[b]]),
            sharpness,
        )
    });
    check_sharpness(&ours, &theirs.collect(), "edge");
    let mut is_used = vec![false; polygons.vertex_count()];
    for v in polygons.faces().corners() {
        is_used[v.index()] = true;
    }
    // OpenSubdiv reports isolated vertices as corners.
    let ours = creases.corners().iter();
    let ours = ours.map(|&(v, sharpness)| (v.index(), sharpness));
    let theirs = level.corners.iter();
    let theirs = theirs.map(|&(v, sharpness)| (numbers.vertices[v], sharpness));
    let [ours, theirs]: [BTreeMap<usize, f32>; 2] = [
        ours.filter(|&(v, _)| is_used[v]).collect(),
        theirs.filter(|&(v, _)| is_used[v]).collect(),
    ];
    check_sharpness(&ours, &theirs, "vertex");
}

fn check_sharpness<K: Ord + std::fmt::Debug>(
    ours: &BTreeMap<K, f32>,
    theirs: &BTreeMap<K, f32>,
    what: &str,
) {
    let keys: BTreeSet<&K> = ours.keys().chain(theirs.keys()).collect();
    for key in keys {
        let [ours, theirs] = [ours, theirs].map(|all| all.get(key).copied().unwrap_or(0.0));
        let difference = (ours.min(SHARPNESS_INFINITE) - theirs).abs();
        assert!(difference < 1e-5, "{what} {key:?} has {ours}, not {theirs}");
    }
}

/// Checks the limits that are defined. Returns the number of compared limits.
fn check_limits<M: Representation>(
    case: &Case,
    answer: &Answer,
    numbers: &NumberMap,
    mesh: &M,
    creases: &Creases,
    tolerance: f32,
) -> usize {
    let limits = case.subdivision.limit(mesh, creases);
    let limits = limits.expect("Catmull–Clark or Loop");
    let polygons = mesh.to_polygons();
    let vertices = &answer.levels[case.levels as usize].vertices;
    let mut compared = 0;
    for (number, (vertex, limit)) in vertices.iter().zip(&answer.limits).enumerate() {
        let v = VertexId::new(numbers.vertices[number] as u32);
        let v = M::vertex_handle(&polygons, v);
        let valence = mesh.vertex_edges(v).count();
        if valence == 0 {
            // An isolated vertex.
            continue;
        }
        let LimitPoint::Defined { position, normal } = limits[v] else {
            // All faces are quads, so the limit is undefined only at semi-sharp vertices and darts.
            let is_semi_sharp = {
                let level = &answer.levels[case.levels as usize];
                let edges = level
                    .edges
                    .iter()
                    .filter(|(ends, _)| ends.contains(&number));
                let own = level.corners.iter().filter(|&&(v, _)| v == number);
                let mut all = edges.map(|&(_, s)| s).chain(own.map(|&(_, s)| s));
                all.any(|s| s < SHARPNESS_INFINITE)
            };
            assert!(is_semi_sharp || vertex.rule == "dart", "{}", vertex.rule);
            continue;
        };
        if vertex.rule == "smooth" && valence == 2 && case.subdivision.scheme != Scheme::Loop {
            continue;
        }
        compared += 1;
        let distance = position.distance(limit[0]);
        assert!(
            distance <= tolerance,
            "limit of {number}: {position}, not {}",
            limit[0]
        );
        let [first, second] = [limit[1], limit[2]];
        let expected = first.normalize_or_zero().cross(second.normalize_or_zero());
        // If the tangents are nearly parallel, the normal is mostly rounding error.
        if let (LimitNormal::One(normal), true) = (normal, vertex.rule != "crease")
            && expected.length() > 0.1
            && first.length().min(second.length()) > 100.0 * tolerance
        {
            let difference = normal.distance(expected.normalize());
            assert!(
                difference < 2e-2,
                "normal of {number}: {normal}, not {expected}, difference {difference}"
            );
        }
    }
    compared
}

/// Returns the number of levels that can be compared with OpenSubdiv.
fn comparable_levels(case: &Case, answer: &Answer) -> u32 {
    let mut levels = 0..case.levels;
    let is_incomparable =
        |&level: &u32| answer.levels[level as usize].is_incomparable(case.subdivision.creasing);
    levels.find(is_incomparable).unwrap_or(case.levels)
}

/// Compares every level of `case` on one structure. `next` makes the next level. `all` makes all
/// levels at once, without holes. Returns the number of compared limits, or `None` if the structure
/// cannot hold the mesh.
fn compare_levels<M: Representation>(
    case: &Case,
    answer: &Answer,
    next: impl Fn(&M, &Creases, u32) -> Result<(M, Creases), SubdivisionError>,
    all: impl FnOnce(u32) -> PolygonMesh,
) -> Option<usize> {
    let subdivision = &case.subdivision;
    let mut mesh = M::from_polygons(&case.polygons).ok()?;
    let creases = subdivision.control_creases(&mesh, &case.polygons, &case.creases);
    let mut creases = creases.expect("the scheme has creases");
    let sizes = case
        .polygons
        .positions()
        .iter()
        .map(|p| p.abs().max_element());
    let tolerance = TOLERANCE * sizes.fold(0.0, f32::max);
    let mut numbers = NumberMap::identity(&case.polygons);
    let mut polygons = mesh.to_polygons();
    check_level(&answer.levels[0], &numbers, &polygons, &creases, tolerance);
    let compared_levels = comparable_levels(case, answer);
    for level in 0..compared_levels {
        (mesh, creases) = next(&mesh, &creases, level).expect("a step");
        polygons = mesh.to_polygons();
        let theirs = &answer.levels[level as usize + 1];
        numbers = numbers.next_level(subdivision.scheme, theirs, &polygons);
        check_level(theirs, &numbers, &polygons, &creases, tolerance);
    }
    if compared_levels > 0 {
        let theirs = &answer.levels[compared_levels as usize];
        assert_eq!(
            all(compared_levels),
            without_holes(theirs, &numbers, &polygons)
        );
    }
    if compared_levels < case.levels {
        return Some(0);
    }
    Some(check_limits(
        case, answer, &numbers, &mesh, &creases, tolerance,
    ))
}

/// Returns `polygons` without the faces that are holes in OpenSubdiv, and without the vertices of
/// these faces that no other face uses.
fn without_holes(level: &Level, numbers: &NumberMap, polygons: &PolygonMesh) -> PolygonMesh {
    let mut is_hole = vec![false; polygons.face_count()];
    for (face, &number) in level.faces.iter().zip(&numbers.faces) {
        is_hole[number] = face.is_hole;
    }
    let (mut used_by_kept, mut used_by_holes) = (BTreeSet::<VertexId>::new(), BTreeSet::new());
    for (f, face) in polygons.faces().iter() {
        let used = if is_hole[f.index()] {
            &mut used_by_holes
        } else {
            &mut used_by_kept
        };
        used.extend(face);
    }
    let kept = polygons
        .vertices()
        .filter(|v| used_by_kept.contains(v) || !used_by_holes.contains(v));
    let kept: Vec<VertexId> = kept.collect();
    let number = |v: &VertexId| kept.binary_search(v).expect("a vertex of a kept face") as u32;
    let faces = polygons.faces().iter().filter(|(f, _)| !is_hole[f.index()]);
    let faces = faces.map(|(_, face)| face.iter().map(number).collect::<Vec<u32>>());
    let points: Vec<Point> = kept.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(points, faces).expect("faces of a mesh")
}

fn has_duplicate_triangles(polygons: &PolygonMesh) -> bool {
    let mut seen = BTreeSet::new();
    polygons.faces().iter().any(|(_, face)| {
        let mut corners = face.to_vec();
        corners.sort();
        !seen.insert(corners)
    })
}

/// Numbers of comparisons.
#[derive(Default)]
struct Counts {
    runs: Cell<usize>,
    limits: Cell<usize>,
    holes: Cell<usize>,
    cut_short: Cell<usize>,
}

fn add(count: &Cell<usize>, more: usize) {
    count.set(count.get() + more);
}

/// Compares the results of all methods with the answer of OpenSubdiv.
fn compare_case(reference: &Reference, case: &Case, counts: &Counts) {
    if case.subdivision.scheme == Scheme::Loop && has_duplicate_triangles(&case.polygons) {
        return;
    }
    let answer = reference.answer(case);
    let Case {
        subdivision,
        polygons,
        creases,
        ..
    } = case;
    add(
        &counts.cut_short,
        usize::from(comparable_levels(case, &answer) < case.levels),
    );
    add(
        &counts.holes,
        answer.levels[0]
            .faces
            .iter()
            .filter(|face| face.is_hole)
            .count(),
    );
    let record = |limits: Option<usize>| {
        add(&counts.runs, usize::from(limits.is_some()));
        add(&counts.limits, limits.unwrap_or(0));
    };
    for method in [Method::Gather, Method::Scatter] {
        type M = FaceVertexMesh;
        let next = |mesh: &M, creases: &Creases, level| {
            let step = match method {
                Method::Gather => subdivision.gather(mesh, creases, level)?,
                _ => subdivision.scatter(mesh, creases, level)?,
            };
            let mesh = M::from_polygons(&step.polygons).expect("it holds every mesh");
            Ok((mesh, step.creases))
        };
        let all = |levels| {
            let step = subdivide::<M>(subdivision, method, polygons, creases, levels);
            step.expect("all steps").polygons
        };
        record(compare_levels(case, &answer, next, all));
    }
    for_each_refinable!(M => {
        record(native::<M>(case, &answer));
    });
}

/// Runs [`compare_levels`] with native steps. Returns `None` if the structure cannot hold the mesh
/// or does not support the split.
fn native<M: Refine>(case: &Case, answer: &Answer) -> Option<usize> {
    let Case {
        subdivision,
        polygons,
        creases,
        ..
    } = case;
    let split = subdivision.split(0)?;
    if !M::SPLITS.contains(&split) {
        return None;
    }
    let next = |mesh: &M, creases: &Creases, level| {
        let (mut numbers, mut child) = (M::EdgeNumbers::default(), M::empty());
        let creases = subdivision.refine_into(mesh, creases, level, &mut numbers, &mut child)?;
        Ok((child, creases))
    };
    let all = |levels| {
        let step = subdivide_native::<M>(subdivision, polygons, creases, levels);
        step.expect("all steps").polygons
    };
    compare_levels(case, answer, next, all)
}

/// Compares `cases` random cases. `seed` makes the cases the same in every run.
fn compare_random(cases: u32, seed: u64, strategy: impl Strategy<Value = Case>) -> Option<Counts> {
    let reference = Reference::from_env()?;
    let mut runner = TestRunner::new(ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    });
    let counts = Counts::default();
    let outcome = runner.run(&strategy, |case| {
        compare_case(&reference, &case, &counts);
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
    Some(counts)
}

#[test]
fn manifolds_equal_those_of_opensubdiv() {
    if let Some(counts) = compare_random(300, 1998, cases::manifold()) {
        // Each case has two runs by polygons, and native runs of at least three structures.
        assert!(counts.runs.get() > 1200, "{} runs", counts.runs.get());
        assert!(
            counts.limits.get() > 100_000,
            "{} limits",
            counts.limits.get()
        );
        assert!(counts.holes.get() > 100, "{} holes", counts.holes.get());
        assert!(
            counts.cut_short.get() < 60,
            "{} are left",
            counts.cut_short.get()
        );
    }
}

#[test]
fn non_manifolds_equal_those_of_opensubdiv() {
    if let Some(counts) = compare_random(200, 2026, cases::non_manifold()) {
        assert!(counts.runs.get() > 500, "{} runs", counts.runs.get());
        assert!(
            counts.cut_short.get() < 40,
            "{} are left",
            counts.cut_short.get()
        );
    }
}

#[test]
fn creases_that_meet_equal_those_of_opensubdiv() {
    let Some(reference) = Reference::from_env() else {
        return;
    };
    let counts = Counts::default();
    let cases = cases::fixed();
    for case in &cases {
        compare_case(&reference, case, &counts);
    }
    assert!(counts.runs.get() >= 5 * cases.len());
    assert!(
        counts.cut_short.get() < cases.len() / 4,
        "{}",
        counts.cut_short.get()
    );
}
