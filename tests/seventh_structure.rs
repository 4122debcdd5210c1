//! Checks that a seventh structure can be used for studies, `pick`, subdivisions and edits, and
//! gives the same results as the six structures. The seventh structure is in one test file and
//! needs no change in any crate.

use std::num::NonZeroU32;
use std::sync::atomic::AtomicBool;

use sixfold::subdivision::{Method, Scheme};
use sixfold::{
    Creases, EditableIndexedFaceSet, FaceVertexMesh, PolygonMesh, Representation,
    repeat_for_structures, shapes,
};
use sixfold_results::{Agreement, Confidence, Need, PickReport, Policy, Standing};
use sixfold_study::{
    Backend, BackendRunner, EditPass, Editor, Effort, MachineClock, Operation, PickSettings,
    Refiner, Series, Settings, SingleEdit, StudyError, StudyMesh, SubdivisionJob, Way, built_in,
    inspect, pick, study,
};

use crate::face_and_edge_lists::FaceAndEdgeLists;

/// Returns the seventh structure without edits.
fn lists() -> Backend {
    Backend::new::<FaceAndEdgeLists>()
}

/// Returns the seventh structure with edits and native refinement, for which types of two other
/// structures are registered.
fn lists_with_all() -> Backend {
    let backend = lists().with_edits::<EditableIndexedFaceSet>();
    backend.with_refinement::<FaceVertexMesh>()
}

fn torus() -> PolygonMesh {
    shapes::triangle_torus(30, 20).expect("a small torus")
}

/// Checks that a study measures all operations on `seventh` except `refused` operations. Compares
/// the results with the other structures.
fn check_study(seventh: Backend, refused: usize) {
    let small = shapes::triangle_torus(6, 4).expect("a small torus");
    let settings = Settings {
        extra: vec![seventh],
        effort: Effort::Rounds(NonZeroU32::MIN),
        ..Settings::default()
    };
    let study_mesh = StudyMesh::new("torus", small);
    let interrupt = AtomicBool::new(false);
    let report = study(&study_mesh, &settings, &interrupt, &mut |_| ());
    let report = report.expect("all can hold a torus");

    let names: Vec<&str> = report.backends.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names.len(), Backend::structures().len() + 1, "{names:?}");
    assert_eq!(names.last(), Some(&seventh.name()));
    let refusals = report.refusals.iter();
    let refusals: Vec<_> = refusals.filter(|r| r.backend == seventh.name()).collect();
    assert_eq!(refusals.len(), refused, "{refusals:?}");
    let rows = report.results.iter();
    let rows: Vec<_> = rows.filter(|row| row.backend == seventh.name()).collect();
    assert_eq!(rows.len(), Operation::ALL.len() - refused);
    for row in rows {
        let operation = &row.operation;
        assert_eq!(row.agreement, Agreement::Same, "{operation}");
        assert_ne!(row.standing, Some(Standing::Alone), "{operation}");
        assert!(row.median_ns.is_some_and(|ns| ns > 0.0), "{operation}");
    }
}

#[test]
fn a_study_measures_a_seventh_structure() {
    // The structure refuses two native subdivisions and four passes of edits.
    check_study(lists(), 2 + 4);
}

#[test]
fn a_study_measures_the_edits_and_the_refinement_of_a_seventh_structure() {
    check_study(lists_with_all(), 0);
}

#[test]
fn an_inspection_and_an_error_name_a_seventh_structure() {
    let inspection = inspect(&StudyMesh::new("torus", torus()), &[lists()]);
    assert_eq!(inspection.backends.len(), 1);
    assert!(inspection.backends[0].holds, "{inspection:?}");
    let misspelt = format!("{}s", lists().name());
    let settings = Settings {
        backends: vec![misspelt],
        extra: vec![lists()],
        ..Settings::default()
    };
    let refusal = settings.chosen_backends().expect_err("a misspelt name");
    let suggestion = format!("(did you mean `{}`?)", lists().name());
    assert!(refusal.to_string().contains(&suggestion), "{refusal}");
}

#[test]
fn two_backends_with_the_same_name_are_refused() {
    let twice = Settings {
        extra: vec![lists(); 2],
        ..Settings::default()
    };
    let refusal = twice.chosen_backends().expect_err("two with the same name");
    assert!(
        matches!(refusal, StudyError::RepeatedBackend { .. }),
        "{refusal}"
    );
}

/// Runs `workload` on `seventh` and on `others`. If `others` is empty, runs on all six structures.
fn pick_with(seventh: Backend, others: &[&str], workload: &str, needs: &[Need]) -> PickReport {
    let mut backends: Vec<String> = others.iter().map(|&name| name.into()).collect();
    if !others.is_empty() {
        backends.push(seventh.name().into());
    }
    let settings = PickSettings {
        workload: built_in(workload).expect("a built-in workload"),
        backends,
        extra: vec![seventh],
        needs: needs.to_vec(),
        max_memory: None,
        effort: Effort::Rounds(NonZeroU32::MIN),
        confidence: Confidence::default(),
        seed: 7,
        heap: Policy::Kept,
    };
    let study_mesh = [StudyMesh::new("torus", torus())];
    let report = pick(
        &study_mesh,
        &settings,
        &AtomicBool::new(false),
        &mut |_, _| (),
    );
    let report = report.expect("enough time");
    assert_eq!(report.mismatches, Vec::<String>::new(), "{workload}");
    report
}

/// Returns the ranked structures without relation tables.
fn ranked(report: &PickReport) -> Vec<&str> {
    let ranking = report.ranking.iter().filter(|row| row.made_from.is_none());
    ranking.map(|row| row.backend.as_str()).collect()
}

#[test]
fn a_pick_ranks_a_seventh_structure() {
    let report = pick_with(lists(), &[], "geodesic-dijkstra", &[]);
    let all = ranked(&report);
    assert_eq!(all.len(), 7, "{all:?}");
    assert!(all.contains(&lists().name()), "{all:?}");
    for workload in ["smoothing", "subdivision"] {
        let report = pick_with(lists(), &["half-edge", "face-vertex"], workload, &[]);
        assert_eq!(
            ranked(&report).len(),
            3,
            "{workload}: {:?}",
            report.excluded
        );
    }
}

#[test]
fn a_pick_ranks_a_seventh_structure_that_can_be_edited() {
    let report = pick_with(lists_with_all(), &["half-edge"], "remeshing", &[Need::Edit]);
    assert_eq!(ranked(&report).len(), 2, "{:?}", report.excluded);
    let report = pick_with(
        lists_with_all(),
        &["half-edge"],
        "smoothing",
        &[Need::Refine],
    );
    assert_eq!(ranked(&report).len(), 2, "{:?}", report.excluded);
}

#[test]
fn a_pick_excludes_a_seventh_structure_with_the_reason() {
    for (workload, needs, expected) in [
        ("remeshing", &[][..], "it cannot be edited"),
        (
            "smoothing",
            &[Need::Edit][..],
            "it cannot be edited (--needs edit)",
        ),
        (
            "smoothing",
            &[Need::Refine][..],
            "it cannot split its own tables (--needs refine)",
        ),
    ] {
        let report = pick_with(lists(), &["half-edge"], workload, needs);
        let excluded = report
            .excluded
            .iter()
            .find(|out| out.backend == lists().name());
        let reason = excluded.map(|out| out.reason.as_str());
        assert_eq!(reason, Some(expected), "{workload}");
    }
}

/// Returns the number of faces and the checksum after a subdivision, or `None` if `backend` does
/// not support the subdivision.
fn subdivided(backend: &Backend, job: SubdivisionJob) -> Option<(usize, f64)> {
    let polygons = shapes::geodesic(3).expect("small");
    let refiner = job.prepare(backend, &polygons, &Creases::default())?;
    let mut refiner: Box<dyn Refiner> = refiner.expect("it holds a sphere");
    refiner.run().ok().map(|()| refiner.result())
}

#[test]
fn a_seventh_structure_is_subdivided_like_the_others() {
    for scheme in [Scheme::Loop, Scheme::CatmullClark] {
        assert_eq!(
            lists().info.support(scheme).methods,
            [Method::Gather, Method::Scatter]
        );
        let methods = lists_with_all().info.support(scheme).methods;
        assert_eq!(methods.last(), Some(&Method::Native));
        for way in Way::ALL {
            let job = SubdivisionJob::new(scheme, way, 2);
            let native = way.method() == Method::Native;
            assert_eq!(
                subdivided(&lists(), job).is_none(),
                native,
                "{scheme} {way}"
            );
            let (faces, sum) = subdivided(&lists_with_all(), job).expect("all ways");
            let others = Backend::structures().into_iter();
            let others: Vec<_> = others.filter_map(|b| subdivided(&b, job)).collect();
            assert!(others.len() >= 3, "{scheme} {way}");
            for (other_faces, other_sum) in others {
                assert_eq!(faces, other_faces, "{scheme} {way}");
                assert!((sum - other_sum).abs() < 1e-5 * sum, "{scheme} {way}");
            }
        }
    }
}

/// Runs edits once. Returns the number of edits and the checksum.
fn edited(mut editor: Box<dyn Editor>) -> (u64, f64) {
    editor.time(&Series::once(&MachineClock::start()));
    let edits = editor.result();
    (edits.done, edits.checksum)
}

#[test]
fn a_seventh_structure_is_edited_like_the_others() {
    let polygons = shapes::geodesic(3).expect("small");
    for pass in EditPass::ALL {
        assert!(lists().prepare_pass(pass, &polygons).is_none());
        let on = |backend: &Backend| {
            let editor = backend
                .prepare_pass(pass, &polygons)
                .expect("it can be edited");
            edited(editor.expect("triangles"))
        };
        let (done, sum) = on(&lists_with_all());
        for backend in Backend::structures() {
            let (other_done, other_sum) = on(&backend);
            assert_eq!(done, other_done, "{pass} on {}", backend.name());
            assert!((sum - other_sum).abs() < 1e-6 * sum, "{pass}");
        }
    }
    for edit in sixfold::Edit::ALL {
        let job = SingleEdit { edit, places: 8 };
        assert!(job.prepare(&lists(), &torus()).is_none());
        let on = |backend: &Backend| Some(edited(job.prepare(backend, &torus())?.ok()?));
        let seventh = on(&lists_with_all());
        assert!(seventh.is_some(), "{edit}");
        let half_edge = Backend::find("half-edge").and_then(|backend| on(&backend));
        if half_edge.is_some() {
            assert_eq!(seventh, half_edge, "{edit}");
        }
    }
}

#[test]
fn a_seventh_structure_runs_alone() {
    let polygons = torus();
    let mut runner = BackendRunner::new(&lists(), &polygons).expect("it holds every mesh");
    let run = runner.run_times(Operation::Build, 1, &MachineClock::start());
    assert_eq!(run.elements, polygons.face_count() as u64);
}

/// A structure whose line lacks `edit` or `refine` is left out only if this capability is required.
#[test]
fn a_line_of_the_list_can_lack_capabilities() {
    macro_rules! names {
        ($capability:ident) => {{
            let mut names = Vec::new();
            repeat_for_structures! { $capability M { names.push(M::NAME) }
                { query: FaceAndEdgeLists }
                { query: sixfold::IndexedFaceSet, edit: EditableIndexedFaceSet }
                { query: FaceVertexMesh, refine: FaceVertexMesh }
            }
            names
        }};
    }
    let all = ["face-and-edge-lists", "indexed-face-set", "face-vertex"];
    assert_eq!(names!(query), all);
    assert_eq!(names!(edit), ["indexed-face-set"]);
    assert_eq!(names!(refine), ["face-vertex"]);
}
