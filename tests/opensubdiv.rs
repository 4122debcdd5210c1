//! Compares Catmull–Clark and Loop with creases with the results of OpenSubdiv on the same meshes.
//!
//! The environment variable `SIXFOLD_OPENSUBDIV` names the program built from
//! `opensubdiv/refine.cpp`. If it is not set, these tests do nothing. Vertices are matched by their
//! origin (the vertex, edge or face of the level above), never by position. Seeds are fixed, so
//! failures are reproducible.
//!
//! Not compared:
//!
//! - Chaikin steps in which OpenSubdiv extrapolates, or the result depends on rounding:
//!   `Level::is_no_judge`.
//! - The limit of a smooth vertex of valence 2: OpenSubdiv returns the vertex itself, but the
//!   levels converge to another point.
//! - Loop on two triangles with the same corners: the halves of their edges have the same ends, and
//!   OpenSubdiv keeps them as two edges.
//! - Normals on creases: OpenSubdiv uses the tangents of Biermann, Levin & Zorin (2000), which
//!   belong to changed rules near creases. `tangent.rs` derives the tangents of the unchanged
//!   rules.

#[path = "opensubdiv/cases.rs"]
mod cases;
#[path = "opensubdiv/judge.rs"]
mod judge;
#[path = "opensubdiv/names.rs"]
mod names;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use sixfold::subdivision::{LimitNormal, LimitPoint, Scheme, subdivide, subdivide_native};
use sixfold::subdivision::{Method, SubdivisionError};
use sixfold::{
    Creases, IndexedFaceSet, Point, PolygonMesh, Refine, Representation, SHARP_FOR_EVER, VertexId,
    for_each_refinable,
};

use judge::{Answer, Case, Judge, Level};
use names::{Names, upwards};

/// Maximum distance of two points that count as equal, relative to the size of the control mesh.
const NEAR: f32 = 1e-5;

/// Checks that one level of ours equals that of OpenSubdiv.
fn hold_level(level: &Level, names: &Names, polygons: &PolygonMesh, creases: &Creases, near: f32) {
    for (vertex, &name) in level.vertices.iter().zip(&names.vertices) {
        let at = polygons.positions()[name];
        let off = at.distance(vertex.at);
        let what = (vertex.origin, &vertex.rule);
        assert!(off <= near, "{what:?}: {at}, not {}, off {off}", vertex.at);
    }
    let mut ours = BTreeMap::new();
    for &(ends, sharpness) in creases.edges() {
        ours.insert(ends.ends().map(|v| v.index()), sharpness);
    }
    let uses = polygons.edge_uses();
    for edge in uses.iter().filter(|edge| edge.faces != 2) {
        // These are always sharp; no stored sharpness is needed.
        ours.insert(edge.ends.map(|v| v.index()), f32::INFINITY);
    }
    let theirs = level
        .edges
        .iter()
        .map(|&([a, b], sharpness)| (upwards([names.vertices[a], names.vertices[b]]), sharpness));
    hold_sharpness(&ours, &theirs.collect(), "edge");
    let mut is_used = vec![false; polygons.vertex_count()];
    for v in polygons.faces().corners() {
        is_used[v.index()] = true;
    }
    // Isolated vertices never move; OpenSubdiv reports them as corners.
    let ours = creases.corners().iter();
    let ours = ours.map(|&(v, sharpness)| (v.index(), sharpness));
    let theirs = level.corners.iter();
    let theirs = theirs.map(|&(v, sharpness)| (names.vertices[v], sharpness));
    let [ours, theirs]: [BTreeMap<usize, f32>; 2] = [
        ours.filter(|&(v, _)| is_used[v]).collect(),
        theirs.filter(|&(v, _)| is_used[v]).collect(),
    ];
    hold_sharpness(&ours, &theirs, "vertex");
}

fn hold_sharpness<K: Ord + std::fmt::Debug>(
    ours: &BTreeMap<K, f32>,
    theirs: &BTreeMap<K, f32>,
    what: &str,
) {
    let keys: BTreeSet<&K> = ours.keys().chain(theirs.keys()).collect();
    for key in keys {
        let [ours, theirs] = [ours, theirs].map(|all| all.get(key).copied().unwrap_or(0.0));
        let off = (ours.min(SHARP_FOR_EVER) - theirs).abs();
        assert!(off < 1e-5, "{what} {key:?} has {ours}, not {theirs}");
    }
}

/// Checks that defined limits equal those of OpenSubdiv. Returns the number of compared limits.
fn hold_limits<M: Representation>(
    case: &Case,
    answer: &Answer,
    names: &Names,
    mesh: &M,
    creases: &Creases,
    near: f32,
) -> usize {
    let limits = case.subdivision.limit(mesh, creases);
    let limits = limits.expect("Catmull–Clark or Loop");
    let polygons = mesh.to_polygons();
    let vertices = &answer.levels[case.levels as usize].vertices;
    let mut compared = 0;
    for (number, (vertex, place)) in vertices.iter().zip(&answer.limits).enumerate() {
        let v = VertexId::new(names.vertices[number] as u32);
        let v = M::vertex_name(&polygons, v);
        let valence = mesh.vertex_edges(v).count();
        if valence == 0 {
            // An isolated vertex: it does not move.
            continue;
        }
        let LimitPoint::Defined { position, normal } = limits[v] else {
            // All faces are quads here, so the limit is undefined only near semi-sharp creases or
            // at darts.
            let is_semi_sharp = {
                let level = &answer.levels[case.levels as usize];
                let edges = level
                    .edges
                    .iter()
                    .filter(|(ends, _)| ends.contains(&number));
                let own = level.corners.iter().filter(|&&(v, _)| v == number);
                let mut all = edges.map(|&(_, s)| s).chain(own.map(|&(_, s)| s));
                all.any(|s| s < SHARP_FOR_EVER)
            };
            assert!(is_semi_sharp || vertex.rule == "dart", "{}", vertex.rule);
            continue;
        };
        if vertex.rule == "smooth" && valence == 2 && case.subdivision.scheme != Scheme::Loop {
            continue;
        }
        compared += 1;
        let off = position.distance(place[0]);
        assert!(
            off <= near,
            "limit of {number}: {position}, not {}",
            place[0]
        );
        let [along, across] = [place[1], place[2]];
        let square = along.normalize_or_zero().cross(across.normalize_or_zero());
        // If the tangents are nearly parallel, the normal is mostly rounding error.
        if let (LimitNormal::One(normal), true) = (normal, vertex.rule != "crease")
            && square.length() > 0.1
            && along.length().min(across.length()) > 100.0 * near
        {
            let off = normal.distance(square.normalize());
            assert!(
                off < 2e-2,
                "normal of {number}: {normal}, not {square}, off {off}"
            );
        }
    }
    compared
}

/// Returns the number of levels that can be compared with OpenSubdiv.
fn judged(case: &Case, answer: &Answer) -> u32 {
    let mut levels = 0..case.levels;
    let is_no_judge =
        |&level: &u32| answer.levels[level as usize].is_no_judge(case.subdivision.creasing);
    levels.find(is_no_judge).unwrap_or(case.levels)
}

/// Compares every level of `case` on one structure. `next` makes the next level; `all` makes all
/// levels at once, without holes. Returns the number of compared limits; `None` if the structure
/// cannot hold the mesh.
fn follow<M: Representation>(
    case: &Case,
    answer: &Answer,
    next: impl Fn(&M, &Creases, u32) -> Result<(M, Creases), SubdivisionError>,
    all: impl FnOnce(u32) -> PolygonMesh,
) -> Option<usize> {
    let subdivision = &case.subdivision;
    let mut mesh = M::from_polygons(&case.polygons).ok()?;
    let creases = subdivision.control(&mesh, &case.polygons, &case.creases);
    let mut creases = creases.expect("the scheme has creases");
    let sizes = case
        .polygons
        .positions()
        .iter()
        .map(|p| p.abs().max_element());
    let near = NEAR * sizes.fold(0.0, f32::max);
    let mut names = Names::given(&case.polygons);
    let mut polygons = mesh.to_polygons();
    hold_level(&answer.levels[0], &names, &polygons, &creases, near);
    let judged = judged(case, answer);
    for level in 0..judged {
        (mesh, creases) = next(&mesh, &creases, level).expect("a step");
        polygons = mesh.to_polygons();
        let theirs = &answer.levels[level as usize + 1];
        names = names.after(subdivision.scheme, theirs, &polygons);
        hold_level(theirs, &names, &polygons, &creases, near);
    }
    if judged > 0 {
        let theirs = &answer.levels[judged as usize];
        assert_eq!(all(judged), without_holes(theirs, &names, &polygons));
    }
    if judged < case.levels {
        return Some(0);
    }
    Some(hold_limits(case, answer, &names, &mesh, &creases, near))
}

/// Returns `polygons` without the faces that are holes in OpenSubdiv, and without vertices that
/// only such faces use.
fn without_holes(level: &Level, names: &Names, polygons: &PolygonMesh) -> PolygonMesh {
    let mut is_hole = vec![false; polygons.face_count()];
    for (face, &name) in level.faces.iter().zip(&names.faces) {
        is_hole[name] = face.is_hole;
    }
    let (mut stays, mut goes) = (BTreeSet::<VertexId>::new(), BTreeSet::new());
    for (f, face) in polygons.faces().iter() {
        let side = if is_hole[f.index()] {
            &mut goes
        } else {
            &mut stays
        };
        side.extend(face);
    }
    let kept = polygons
        .vertices()
        .filter(|v| stays.contains(v) || !goes.contains(v));
    let kept: Vec<VertexId> = kept.collect();
    let number = |v: &VertexId| kept.binary_search(v).expect("a vertex of a kept face") as u32;
    let faces = polygons.faces().iter().filter(|(f, _)| !is_hole[f.index()]);
    let faces = faces.map(|(_, face)| face.iter().map(number).collect::<Vec<u32>>());
    let points: Vec<Point> = kept.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(points, faces).expect("faces of a mesh")
}

/// Returns whether two triangles have the same corners.
fn has_twins(polygons: &PolygonMesh) -> bool {
    let mut seen = BTreeSet::new();
    polygons.faces().iter().any(|(_, face)| {
        let mut corners = face.to_vec();
        corners.sort();
        !seen.insert(corners)
    })
}

/// Counts of comparisons, so that a test that compares nothing fails.
#[derive(Default)]
struct Seen {
    runs: Cell<usize>,
    limits: Cell<usize>,
    holes: Cell<usize>,
    cut_short: Cell<usize>,
}

fn add(count: &Cell<usize>, more: usize) {
    count.set(count.get() + more);
}

/// Runs `case` in OpenSubdiv, and compares all our ways to run it with the answer.
fn hold(judge: &Judge, case: &Case, seen: &Seen) {
    if case.subdivision.scheme == Scheme::Loop && has_twins(&case.polygons) {
        return;
    }
    let answer = judge.answer(case);
    let Case {
        subdivision,
        polygons,
        creases,
        ..
    } = case;
    add(
        &seen.cut_short,
        usize::from(judged(case, &answer) < case.levels),
    );
    add(
        &seen.holes,
        answer.levels[0]
            .faces
            .iter()
            .filter(|face| face.is_hole)
            .count(),
    );
    let took = |limits: Option<usize>| {
        add(&seen.runs, usize::from(limits.is_some()));
        add(&seen.limits, limits.unwrap_or(0));
    };
    for method in [Method::Gather, Method::Scatter] {
        type M = IndexedFaceSet;
        let next = |mesh: &M, creases: &Creases, level| {
            let step = match method {
                Method::Gather => subdivision.gather(mesh, creases, level)?,
                _ => subdivision.scatter(mesh, creases, level)?,
            };
            let mesh = M::from_polygons(&step.polygons).expect("it holds every mesh");
            Ok((mesh, step.creases))
        };
        let all = |levels| {
            let step = subdivide::<M>(subdivision, method, polygons, creases, levels, |_, _| ());
            step.expect("all steps").polygons
        };
        took(follow(case, &answer, next, all));
    }
    for_each_refinable!(M => {
        took(native::<M>(case, &answer));
    });
}

/// Runs [`follow`] with native steps. Also returns `None` if the structure does not support the
/// split.
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
        let step = subdivide_native::<M>(subdivision, polygons, creases, levels, |_, _| ());
        step.expect("all steps").polygons
    };
    follow(case, answer, next, all)
}

/// Compares `cases` random cases of a strategy; `seed` makes them the same in every run.
fn hold_random(cases: u32, seed: u64, strategy: impl Strategy<Value = Case>) -> Option<Seen> {
    let judge = Judge::there()?;
    let mut runner = TestRunner::new(ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    });
    let seen = Seen::default();
    let held = runner.run(&strategy, |case| {
        hold(&judge, &case, &seen);
        Ok(())
    });
    held.unwrap_or_else(|failure| panic!("{failure}"));
    Some(seen)
}

#[test]
fn manifolds_equal_those_of_opensubdiv() {
    if let Some(seen) = hold_random(300, 1998, cases::manifold()) {
        // For each case: two runs by polygons, and native runs of at least three structures.
        assert!(seen.runs.get() > 1200, "{} runs", seen.runs.get());
        assert!(seen.limits.get() > 100_000, "{} limits", seen.limits.get());
        assert!(seen.holes.get() > 100, "{} holes", seen.holes.get());
        assert!(
            seen.cut_short.get() < 60,
            "{} are left",
            seen.cut_short.get()
        );
    }
}

#[test]
fn non_manifolds_equal_those_of_opensubdiv() {
    if let Some(seen) = hold_random(200, 2026, cases::non_manifold()) {
        assert!(seen.runs.get() > 500, "{} runs", seen.runs.get());
        assert!(
            seen.cut_short.get() < 40,
            "{} are left",
            seen.cut_short.get()
        );
    }
}

#[test]
fn creases_that_meet_equal_those_of_opensubdiv() {
    let Some(judge) = Judge::there() else { return };
    let seen = Seen::default();
    let cases = cases::fixed();
    for case in &cases {
        hold(&judge, case, &seen);
    }
    assert!(seen.runs.get() >= 5 * cases.len());
    assert!(
        seen.cut_short.get() < cases.len() / 4,
        "{}",
        seen.cut_short.get()
    );
}
