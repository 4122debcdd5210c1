//! Catmull–Clark and Loop with creases are what OpenSubdiv makes of the same meshes.
//!
//! The variable `SIXFOLD_OPENSUBDIV` names the built program `opensubdiv/refine.cpp`; without it
//! these tests pass without looking. Vertices are matched by what they are the point of, never by
//! where they are. Seeds are fixed: a case that differs differs every time.
//!
//! What is left out, and why:
//!
//! - Chaikin steps in which OpenSubdiv extrapolates, or rounding decides: `Level::is_no_judge`.
//! - The limit of a smooth vertex of valence 2: OpenSubdiv leaves it where it is, which is not where
//!   the levels go.
//! - Loop on two triangles with the same corners: the halves of their edges have the same ends, and
//!   are two edges to OpenSubdiv.
//! - Normals on creases: OpenSubdiv takes the tangents of Biermann, Levin & Zorin (2000), who change
//!   the rules beside creases; of the rules as they are, `tangent.rs` derives others.

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

/// How far apart points may be, beside the size of the control mesh.
const NEAR: f32 = 1e-5;

/// Holds one level of ours to be OpenSubdiv's.
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
        // Every step sees that these are sharp.
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
    // Isolated vertices stay in any case; OpenSubdiv calls them corners.
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

/// Holds limits to be OpenSubdiv's, where they are defined; yields how many.
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
            // Isolated: where it is, whatever either calls it.
            continue;
        }
        let LimitPoint::Defined { position, normal } = limits[v] else {
            // All faces are quads by now: what is left is not for ever, or a dart.
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
        // Where the tangents are nearly one, their rounding is all that is left of the normal.
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

/// How many levels OpenSubdiv is a judge of.
fn judged(case: &Case, answer: &Answer) -> u32 {
    let mut levels = 0..case.levels;
    let is_no_judge =
        |&level: &u32| answer.levels[level as usize].is_no_judge(case.subdivision.creasing);
    levels.find(is_no_judge).unwrap_or(case.levels)
}

/// Holds every level of `case` on a structure, of which `next` makes the step after; `all` makes all
/// levels at once, without holes. Yields how many limits were compared; `None` where the structure
/// does not hold the mesh.
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

/// `polygons` without the faces that are holes to OpenSubdiv, and the vertices that they alone had.
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
    let number = |v: &VertexId| kept.binary_search(v).expect("of a face that stays") as u32;
    let faces = polygons.faces().iter().filter(|(f, _)| !is_hole[f.index()]);
    let faces = faces.map(|(_, face)| face.iter().map(number).collect::<Vec<u32>>());
    let points: Vec<Point> = kept.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(points, faces).expect("faces of a mesh")
}

/// Whether two triangles have the same corners.
fn has_twins(polygons: &PolygonMesh) -> bool {
    let mut seen = BTreeSet::new();
    polygons.faces().iter().any(|(_, face)| {
        let mut corners = face.to_vec();
        corners.sort();
        !seen.insert(corners)
    })
}

/// What was looked at, so that a test which compares nothing fails.
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

/// Puts `case` to OpenSubdiv, and holds all ways to run it to the answer.
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
            let mesh = M::from_polygons(&step.polygons).expect("it holds everything");
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

/// [`follow`] for native steps; `None` too where the structure does not split faces so.
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

/// Runs `cases` of a strategy, the same ones every time.
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
fn manifolds_are_opensubdivs() {
    if let Some(seen) = hold_random(300, 1998, cases::manifold()) {
        // Two by polygons, and at least half-edge, winged-edge and face-vertex natively.
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
fn non_manifolds_are_opensubdivs() {
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
fn creases_that_meet_are_opensubdivs() {
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
