//! Whole studies on a simulated machine: the results are real, and the times are known.

use std::collections::BTreeSet;

use sixfold::subdivision::Method;
use sixfold::{PolygonMesh, shapes};
use sixfold_results::Agreement;

use super::*;
use crate::engine::simulated_machine::{SimulatedMachine, Work};
use sixfold_measure::{ElementKind, Task};
use sixfold_results::{RefusalKind, Results, Standing};

/// Speeds of machines, relative to the usual one.
const SPEEDS: [f64; 3] = [1.0, 0.02, 50.0];

fn quick_on(
    machine: &SimulatedMachine,
    study_mesh: &StudyMesh,
    settings: &Settings,
) -> Result<Report, StudyError> {
    let stop = AtomicBool::new(false);
    study_on(machine, study_mesh, settings, &stop, &mut |_| ())
}

fn quick(study_mesh: &StudyMesh, settings: &Settings) -> Result<Report, StudyError> {
    quick_on(&SimulatedMachine::usual(), study_mesh, settings)
}

fn settings(effort: Effort) -> Settings {
    Settings {
        effort,
        seed: 5,
        ..Settings::default()
    }
}

fn grid(m: usize, n: usize) -> StudyMesh {
    let mesh = shapes::triangle_grid(m, n).expect("a grid");
    StudyMesh::new("grid", mesh)
}

fn operation(row: &ResultRow) -> Operation {
    row.operation.parse().expect("an operation")
}

/// Returns the time of `row` on a usual machine of `speed`.
fn expected_ns(row: &ResultRow, counts: &Counts, speed: f64) -> f64 {
    let work = Work {
        backend: &row.backend,
        task: Task::Operation(operation(row)),
        counts,
        place: 0,
    };
    work.usual_ns() / speed
}

/// Returns the time of the queries of a scanning operation, each at all elements of a kind that
/// scans, on a usual machine of `speed`.
fn searches_ns(row: &ResultRow, counts: &Counts, speed: f64) -> f64 {
    let backend = Backend::find(&row.backend).expect("a structure");
    let scans = operation(row).scans(&backend.info.costs);
    let kinds = ElementKind::ALL
        .into_iter()
        .filter(|kind| scans[kind.index()]);
    let relations = kinds.flat_map(|kind| operation(row).relations(kind));
    let searches = relations.map(|&relation| {
        let search = ResultRow::new(&row.backend, relation.name(), "");
        expected_ns(&search, counts, speed)
    });
    searches.sum()
}

fn is_close(found: f64, expected: f64) -> bool {
    (found / expected - 1.0).abs() < 1e-9
}

fn counts_of(study_mesh: &StudyMesh) -> Counts {
    study_mesh.polygons.counts(study_mesh.facts.edges)
}

/// The number of results that are sampled, that are estimated, and that are left out because the
/// budget ended.
fn shortened(report: &Report) -> [usize; 3] {
    let rows = || report.results.iter();
    let ended = report.refusals.iter();
    [
        rows().filter(|row| row.sampled).count(),
        rows().filter(|row| row.estimated_ns.is_some()).count(),
        ended.filter(|r| r.kind == RefusalKind::BudgetEnded).count(),
    ]
}

#[test]
fn slow_operations_have_enough_samples_for_a_winner_if_there_is_time() {
    let study_mesh = grid(20, 20);
    let least_samples = |budget_ms| {
        let report = quick(&study_mesh, &settings(Effort::of_ms(budget_ms))).expect("a report");
        let rows = report.results.iter().filter(|row| row.median_ns.is_some());
        let local = rows
            .filter(|row| !["polygon-soup", "indexed-face-set"].contains(&row.backend.as_str()));
        local.map(|row| row.samples).min().expect("a time")
    };
    assert!(least_samples(4000) >= 4, "{}", least_samples(4000));
    // The decimations alone would take the whole budget.
    assert!(least_samples(400) < 4, "{}", least_samples(400));
}

#[test]
fn a_long_scan_is_run_once_unless_it_was_named() {
    let study_mesh = grid(30, 30);
    let samples = |operations: Vec<Operation>, budget_ms| {
        let settings = Settings {
            backends: vec!["polygon-soup".into(), "half-edge".into()],
            operations,
            ..settings(Effort::of_ms(budget_ms))
        };
        let report = quick(&study_mesh, &settings).expect("both hold it");
        let row = report.row(Operation::FfBfs.name(), "polygon-soup");
        let row = row.expect("the search was run");
        assert_eq!(row.standing, Some(Standing::Slower));
        (row.samples, row.warm_up_only)
    };
    // A search on the soup takes 3.3 ms, and half-edge 0.018 ms.
    assert_eq!(samples(Vec::new(), 500), (1, true));
    let (_, once) = samples(Operation::ALL.to_vec(), 500);
    assert!(!once);
}

#[test]
fn rounds_sample_scans_by_the_number_of_faces() {
    // A sample of a scan visits a million faces: 667 of the vertices of 1,500 faces.
    let study_mesh = grid(30, 25);
    let faces = study_mesh.facts.faces;
    assert_eq!(faces, 1500);
    let mut settings = settings(Effort::of_rounds(1));
    settings.operations = ["vertex_faces", "edge_faces", "edge_length"]
        .map(|name| name.parse().expect("an operation"))
        .to_vec();
    for (caches, is_one_run) in [(CacheState::Warm, false), (CacheState::Cold, true)] {
        settings.caches = caches;
        let mut warming = Vec::new();
        let machine = SimulatedMachine::usual();
        let stop = AtomicBool::new(false);
        let report = study_on(&machine, &study_mesh, &settings, &stop, &mut |at| {
            if at.stage == "warming up" {
                warming.push(at.done);
            }
        });
        let report = report.expect("all backends hold it");
        for row in &report.results {
            let scans = ["polygon-soup", "indexed-face-set"].contains(&row.backend.as_str())
                && operation(row) != Operation::EdgeLength;
            let context = format!("{} on {}, {caches:?}", row.operation, row.backend);
            assert_eq!(
                row.sample_size,
                scans.then_some(1_000_000 / faces),
                "{context}"
            );
            let one_run = scans || is_one_run;
            assert_eq!(row.runs_per_sample == 1, one_run, "{context}: {row:?}");
        }
        // The tasks are warmed up in the first tenth of the work. One backend is measured twice.
        let tasks = 3.0 * 7.0;
        assert_eq!(warming.len(), 21);
        for (i, done) in warming.into_iter().enumerate() {
            assert!((done - i as f64 / tasks * 0.1).abs() < 1e-12, "{i}: {done}");
        }
    }
}

#[test]
fn times_are_those_of_the_machine_at_any_speed() {
    let study_mesh = grid(30, 25);
    let counts = counts_of(&study_mesh);
    let facts = &study_mesh.facts;
    let budget = Duration::from_secs(4);
    for (speed, expected) in SPEEDS.into_iter().zip([[22, 0, 0], [22, 36, 2], [0, 0, 0]]) {
        let machine = SimulatedMachine::usual().at_speed(speed);
        let settings = settings(budget.into());
        let report = quick_on(&machine, &study_mesh, &settings).expect("all backends hold it");
        let ended = machine.ns() / 1e9;
        assert!(ended < 4.8, "speed {speed}: {ended} s of 4 s");
        let all = Operation::ALL.len() * report.backends.len();
        assert_eq!(report.results.len() + report.refusals.len(), all);
        assert_eq!(shortened(&report), expected, "speed {speed}");
        // Two structures cannot split their own tables, and corner tables cannot hold quads.
        assert_eq!(
            report.refusals.len() - expected[2],
            2 * 2 + 3,
            "{:?}",
            report.refusals
        );
        for row in &report.results {
            let context = format!("{} on {}, speed {speed}", row.operation, row.backend);
            let ns = row.median_ns.or(row.estimated_ns).expect("a time");
            let whole = expected_ns(row, &counts, speed);
            // An estimate is the longer of the times of patches and of searches.
            let ns_expected = match operation(row).creates_mesh() && row.estimated_ns.is_some() {
                true => whole.max(searches_ns(row, &counts, speed)),
                false => whole,
            };
            assert!(
                is_close(ns, ns_expected),
                "{context}: {ns}, not {ns_expected}"
            );
            let agreement = match row.estimated_ns {
                Some(_) => Agreement::Unchecked,
                None => Agreement::Same,
            };
            assert_eq!(row.agreement, agreement, "{context}: {row:?}");
            let elements = match row.per.as_str() {
                "vertex" => facts.vertices,
                "edge" => facts.edges,
                "face" => facts.faces,
                "new face" => match operation(row) {
                    Operation::Loop(_) => 4 * facts.faces,
                    _ => 3 * facts.faces,
                },
                _ => continue,
            };
            assert_eq!(row.elements, Some(elements as u64), "{context}");
        }
    }
}

#[test]
fn scans_are_slower_and_their_samples_are_small() {
    let study_mesh = grid(30, 25);
    let report = quick(&study_mesh, &settings(Effort::of_ms(4000)));
    let report = report.expect("all backends hold it");
    let soup = |operation: Operation| {
        let row = report.row(operation.name(), "polygon-soup");
        row.expect("the soup can hold the mesh")
    };
    for relation in [
        Relation::VertexVertices,
        Relation::EdgeEdges,
        Relation::FaceFaces,
    ] {
        let row = soup(Operation::Relation(relation));
        assert!(row.sampled && row.sample_size >= Some(16), "{row:?}");
        assert_eq!(row.standing, Some(Standing::Slower), "{row:?}");
        // 1,500 faces at 1 ns, compared with 10 ns.
        assert!(
            is_close(row.ratio_to_best.expect("ranked"), 151.0),
            "{row:?}"
        );
    }
    let equal = report.rows(Operation::FaceBarycenter.name());
    for row in equal {
        assert!(!row.sampled);
        assert_eq!(row.standing, Some(Standing::Equal), "{row:?}");
        assert!(is_close(row.ratio_to_best.expect("ranked"), 1.0), "{row:?}");
    }
    let sentences = report.sentences.join(" ");
    assert!(
        sentences
            .contains("polygon-soup and indexed-face-set scan all 1,500 faces for most relations")
            || sentences.contains("indexed-face-set and polygon-soup scan all 1,500 faces"),
        "{sentences}"
    );
}

#[test]
fn a_small_difference_is_found_on_a_machine_that_drifts_and_stalls() {
    let study_mesh = grid(20, 20);
    let one = Settings {
        operations: vec![Operation::EdgeLength],
        ..settings(Effort::of_ms(2000))
    };
    let costs = |work: &Work<'_>| match work.backend {
        "half-edge" => 0.9 * work.usual_ns(),
        "winged-edge" => 0.995 * work.usual_ns(),
        _ => work.usual_ns(),
    };
    for speed in SPEEDS {
        let machine = SimulatedMachine::with_costs(costs)
            .at_speed(speed)
            .drifting();
        // Stalls of 20 ms in the middle of samples.
        let machine = (1..8).fold(machine, |m, i| m.with_stall(f64::from(i) * 231e6, 20e6));
        let report = quick_on(&machine, &study_mesh, &one).expect("all hold it");
        for row in &report.results {
            let ratio = row.ratio_to_best.expect("ranked");
            let context = format!("{} at speed {speed}: {ratio}", row.backend);
            match row.backend.as_str() {
                "half-edge" => assert_eq!(row.standing, Some(Standing::Best), "{context}"),
                "winged-edge" => assert!((ratio / (0.995 / 0.9) - 1.0).abs() < 0.02, "{context}"),
                _ => assert!((ratio * 0.9 - 1.0).abs() < 0.02, "{context}"),
            }
        }
    }
}

#[test]
fn a_fixed_number_of_rounds_does_the_same_work_on_every_machine() {
    let study_mesh = grid(30, 25);
    let mut first: Option<Report> = None;
    for speed in SPEEDS {
        let machine = SimulatedMachine::usual().at_speed(speed).drifting();
        let machine = machine.with_stall(1e6, 1e12);
        let report = quick_on(&machine, &study_mesh, &settings(Effort::of_rounds(3)));
        let report = report.expect("all backends hold it");
        // Of the 1,500 faces, a sample visits 666: these scan a million faces.
        assert_eq!(shortened(&report), [22, 0, 0], "speed {speed}");
        for row in &report.results {
            let context = format!("{} on {}: {row:?}", row.operation, row.backend);
            assert_eq!(row.samples + row.disturbed, 3, "{context}");
            assert!(!row.warm_up_only && row.retaken == 0, "{context}");
            assert!(row.sample_size.is_none_or(|size| size == 666), "{context}");
            assert_eq!(row.agreement, Agreement::Same, "{context}");
        }
        let work = |report: &Report| -> Vec<_> {
            let rows = report.results.iter();
            rows.map(|r| (r.sample_size, r.runs_per_sample, r.first_samples))
                .collect()
        };
        let first = first.get_or_insert_with(|| report.clone());
        assert_eq!(work(first), work(&report), "speed {speed}");
    }
    let run = first.expect("a report").run.settings;
    assert_eq!((run.budget_s, run.rounds.map(u32::from)), (None, Some(3)));
}

#[test]
fn rounds_rebuild_the_structures_every_fifth_time_and_measure_first_runs() {
    let study_mesh = grid(6, 6);
    let one = Settings {
        operations: vec![Operation::Build],
        backends: vec!["half-edge".into()],
        ..settings(Effort::of_rounds(11))
    };
    // Only building again takes time outside of samples.
    let machine = SimulatedMachine::usual();
    let report = quick_on(&machine, &study_mesh, &one).expect("it holds the mesh");
    let [row] = &report.results[..] else {
        panic!("one row: {:?}", report.results)
    };
    assert_eq!(row.samples, 11);
    let build_ns = row.median_ns.expect("measured");
    // Two structures (one twice) are built, then built again before the rounds 5 and 10. They are
    // warmed up by one run each, and have 11 samples of as many untimed as timed runs.
    let before = 2.0 * (1.0 + 2.0 + 1.0 + 11.0 * 2.0 * f64::from(row.runs_per_sample));
    let first_runs = match row.first_samples {
        0 => 0.0, // pages cannot be returned on this platform
        n => {
            assert_eq!(n, 9, "at most nine");
            3.0 * n as f64
        }
    };
    let builds = machine.ns() / build_ns;
    assert!(
        (builds - before - first_runs).abs() < 1e-6,
        "{builds} builds"
    );
}

#[test]
fn a_vertex_with_many_faces_stays_within_the_time_limit() {
    let rim = (0..10_000).map(|i| {
        let (y, x) = (i as f32 * 6.283e-4).sin_cos();
        sixfold::Point::new(x, y, 0.0)
    });
    let corners: Vec<_> = rim.chain([sixfold::Point::Z]).collect();
    let fan = (0..10_000).map(|i| [10_000, i, (i + 1) % 10_000]);
    let mesh = PolygonMesh::new(corners, fan).expect("valid");
    let study_mesh = StudyMesh::new("fan", mesh);
    let edges = Operation::Relation(Relation::EdgeEdges);
    // A full run visits 10⁸ adjacent edges at one vertex.
    let machine = SimulatedMachine::with_costs(move |work| match work.task {
        Task::Operation(operation) if operation.grows_with_valence().contains(&true) => 2e8,
        _ => work.usual_ns(),
    });
    let report = quick_on(&machine, &study_mesh, &settings(Effort::of_ms(200)));
    let report = report.expect("all backends hold it");
    assert!(machine.ns() < 2.0 * 200e6, "{}", machine.ns());
    assert_eq!(report.mismatches().count(), 0, "{:?}", report.sentences);
    for row in report.rows(edges.name()) {
        assert!(row.sampled, "{row:?}");
        assert_eq!(row.agreement, Agreement::Same, "{row:?}");
    }
    for row in report.rows(Operation::EdgeLength.name()) {
        assert!(!row.sampled, "{row:?}");
    }
    // A structure may be sampled although it does not scan.
    for walker in ["half-edge", "winged-edge", "corner-table", "face-vertex"] {
        let scans = format!("{walker} scans all");
        let mut sentences = report.sentences.iter();
        assert!(
            !sentences.any(|sentence| sentence.contains(&scans)),
            "{:?}",
            report.sentences
        );
    }
}

#[test]
fn what_the_budget_does_not_allow_is_left_out_unless_it_was_named() {
    let study_mesh = grid(10, 10);
    // Building takes almost the whole budget.
    let slow = |work: &Work<'_>| match work.task {
        Task::Operation(Operation::Build) => 15e6,
        _ => work.usual_ns(),
    };
    let machine = SimulatedMachine::with_costs(slow);
    let report = quick_on(&machine, &study_mesh, &settings(Effort::of_ms(110)));
    let report = report.expect("all hold it");
    let [_, _, ended] = shortened(&report);
    assert!(ended > 100, "{ended}");
    let reasons = report.refusals.iter().map(|r| r.reason.as_str());
    assert_eq!(
        reasons.filter(|r| r.contains("longer --budget")).count(),
        ended
    );
    let named = Settings {
        operations: vec![Operation::Boundary, Operation::EdgeLength],
        ..settings(Effort::of_ms(110))
    };
    let machine = SimulatedMachine::with_costs(slow);
    let report = quick_on(&machine, &study_mesh, &named).expect("all hold it");
    // The structures that do not scan come first; the others wait for the time that is left.
    let names = |report: &Report| -> BTreeSet<String> {
        report
            .results
            .iter()
            .map(|row| row.backend.clone())
            .collect()
    };
    let local = ["corner-table", "face-vertex", "half-edge", "winged-edge"];
    assert!(local.iter().all(|&name| names(&report).contains(name)));
    let forced = Settings {
        force: true,
        ..named
    };
    let machine = SimulatedMachine::with_costs(slow);
    let report = quick_on(&machine, &study_mesh, &forced).expect("all hold it");
    assert_eq!(report.results.len(), 2 * 6);
    assert_eq!(report.refusals.len(), 0);
}

#[test]
fn a_csv_without_rows_has_the_same_header() {
    let study_mesh = StudyMesh::new("cube", shapes::cube());
    let first_line = |stopped: bool| {
        let stop = AtomicBool::new(stopped);
        let machine = SimulatedMachine::usual();
        let settings = settings(Effort::Budget(Duration::ZERO));
        let report = study_on(&machine, &study_mesh, &settings, &stop, &mut |_| ());
        let report = report.expect("a cube");
        assert_eq!(report.results.is_empty(), stopped);
        let mut csv = Vec::new();
        Results::from(report).write_csv(&mut csv).expect("memory");
        let text = String::from_utf8(csv).expect("text");
        text.lines().next().map(str::to_owned)
    };
    assert!(first_line(false).is_some());
    assert_eq!(first_line(true), first_line(false));
}

#[test]
fn unknown_backends_and_unsuitable_meshes_are_refused() {
    let study_mesh = StudyMesh::new("cube", shapes::cube());
    let settings = |backend: &str| Settings {
        backends: vec![backend.into()],
        ..Settings::default()
    };
    let unknown = quick(&study_mesh, &settings("abacus")).expect_err("no such backend");
    assert!(unknown.to_string().contains("half-edge"), "{unknown}");
    let empty = StudyMesh::new("nothing", PolygonMesh::default());
    let none = quick(&empty, &Settings::default()).expect_err("no faces");
    assert_eq!(none, StudyError::NoFaces);
    let corners = [sixfold::Point::ZERO, sixfold::Point::X, sixfold::Point::Y];
    let twice = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
    let study_mesh = StudyMesh::new("twice", twice);
    let refused = quick(&study_mesh, &settings("half-edge")).expect_err("not oriented");
    assert!(refused.to_string().contains("v0→v1"), "{refused}");
}

const GATHER: Operation = Operation::Loop(Method::Gather);

/// Studies one subdivision on the polygon soup. The soup scans all faces for each vertex.
fn searched(operations: Vec<Operation>, budget: Duration) -> (ResultRow, f64) {
    let study_mesh = grid(40, 35);
    let settings = Settings {
        backends: vec!["polygon-soup".into(), "half-edge".into()],
        operations,
        ..settings(budget.into())
    };
    let report = quick(&study_mesh, &settings).expect("both hold it");
    let of_soup =
        |row: &&ResultRow| row.operation == GATHER.name() && row.backend == "polygon-soup";
    let row = report.results.iter().find(of_soup);
    let row = row.expect("measured or estimated").clone();
    let whole = expected_ns(&row, &counts_of(&study_mesh), 1.0);
    (row, whole)
}

#[test]
fn a_scanning_subdivision_is_run_if_it_is_named() {
    let (run, whole_ns) = searched(vec![GATHER], Duration::from_secs(3));
    assert!(is_close(run.median_ns.expect("it was run"), whole_ns));
    assert_eq!(run.elements, Some(4 * 2 * 40 * 35));
    assert!(
        !run.by_name_only && run.agreement == Agreement::Same,
        "{run:?}"
    );
    // An operation longer than the budget is not run, even if it is named.
    let too_short = Duration::from_nanos(whole_ns as u64 / 3);
    let (too_long, _) = searched(vec![GATHER], too_short);
    let estimate = too_long.estimated_ns.expect("only estimated");
    assert!(
        too_long.median_ns.is_none() && !too_long.by_name_only,
        "{too_long:?}"
    );
    // The searches of the queried relations take longer than making the elements of a patch.
    let searches = searches_ns(&too_long, &counts_of(&grid(40, 35)), 1.0);
    assert!(is_close(estimate, searches), "{estimate}, not {searches}");
    // Among all operations, it is run only if that takes a small part of the budget.
    let (unnamed, _) = searched(Vec::new(), Duration::from_secs(3));
    assert!(unnamed.median_ns.is_some() && !unnamed.by_name_only);
    let little = Duration::from_nanos(20 * whole_ns as u64);
    let (unnamed, _) = searched(Vec::new(), little);
    assert!(
        unnamed.estimated_ns.is_some() && unnamed.by_name_only,
        "{unnamed:?}"
    );
}

#[test]
fn a_scheme_refuses_a_mesh_with_the_same_reason_on_all_backends() {
    let study_mesh = StudyMesh::new("cube", shapes::cube());
    let report = quick(&study_mesh, &settings(Effort::of_rounds(1))).expect("quads");
    let loops = |operation: &str| operation.starts_with("loop_");
    assert!(report.results.iter().all(|row| !loops(&row.operation)));
    let refused = report.refusals.iter().filter(|r| loops(&r.operation));
    let reasons: Vec<&str> = refused.map(|r| r.reason.as_str()).collect();
    assert_eq!(reasons.len(), 3 * 5, "five of six backends hold quads");
    assert!(
        reasons[0].starts_with("face f0 has 4 corners"),
        "{reasons:?}"
    );
    assert!(reasons.iter().all(|reason| *reason == reasons[0]));
    for row in &report.results {
        assert_eq!(row.agreement, Agreement::Same, "{row:?}");
    }
}

#[test]
fn one_backend_is_measured_twice_to_show_the_noise() {
    let study_mesh = grid(20, 20);
    let two = Settings {
        operations: vec![Operation::Circulate, Operation::EdgeLength],
        ..settings(Effort::of_ms(300))
    };
    // The second copy of the face-vertex mesh, hosted last, takes 3 % longer.
    let machine = SimulatedMachine::with_costs(|work| match work.place {
        6 => 1.03 * work.usual_ns(),
        _ => work.usual_ns(),
    });
    let report = quick_on(&machine, &study_mesh, &two).expect("all backends hold it");
    assert_eq!(report.results.len(), 2 * report.backends.len());
    let control = report.control.expect("there was time for rounds");
    assert_eq!(control.backend, "face-vertex", "the first without scans");
    assert_eq!(control.operations.len(), 2);
    assert!(is_close(control.typical, 1.03) && is_close(control.worst, 1.03));
    let shown = |sentence: &String| {
        sentence
            .contains("two measurements of face-vertex differ by 3.0 % (median; at most 3.0 % in")
    };
    assert!(report.sentences.iter().any(shown), "{:?}", report.sentences);
}

#[test]
fn a_study_on_this_machine_measures_what_its_settings_name() {
    let chosen = Settings {
        backends: vec!["half-edge".into(), "corner-table".into()],
        operations: vec![Operation::Boundary],
        ..settings(Effort::of_rounds(2))
    };
    let stop = AtomicBool::new(false);
    let report = study(&grid(4, 4), &chosen, &stop, &mut |_| ()).expect("both hold a grid");
    let rows: Vec<(&str, &str, bool)> = (report.results.iter())
        .map(|row| {
            (
                row.backend.as_str(),
                row.operation.as_str(),
                row.median_ns.is_some(),
            )
        })
        .collect();
    let expected = ["half-edge", "corner-table"].map(|name| (name, "boundary", true));
    assert_eq!(rows, expected);
    assert_eq!(report.run.settings.seed, 5);
}

#[test]
fn equally_many_refusals_of_different_edits_are_other_edits() {
    use Agreement::{OtherEdits, Same};
    let clock = MachineClock::start();
    let operation = "split_collapse".parse().expect("an edit pass");
    let names = ["indexed-face-set", "corner-table", "half-edge"];
    // Two triangles on the same three vertices.
    let pillow = PolygonMesh::new(
        [sixfold::Point::ZERO, sixfold::Point::X, sixfold::Point::Y],
        [[0, 1, 2], [0, 2, 1]],
    );
    let pillow = pillow.expect("valid");
    let mut entries = Vec::new();
    let mut subjects = Vec::new();
    for (i, name) in names.into_iter().enumerate() {
        let backend = Backend::find(name).expect("a structure");
        let (mut subject, _) = backend.prepare(&pillow, None).expect("a closed manifold");
        let mut entry = crate::engine::measure::Entry::new(i, operation);
        let series = sixfold_measure::Series::once(&clock).with_result();
        entry.outcome = subject.run(&entry.job, &series).outcome;
        entries.push(entry);
        subjects.push(subject);
    }
    let stop = AtomicBool::new(false);
    let agreements = crate::engine::agreement::compare_checksums(
        &entries,
        &mut subjects,
        &pillow,
        &clock,
        &stop,
    );
    assert_eq!(agreements, [OtherEdits, Same, Same]);
}
