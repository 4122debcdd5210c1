//! Runs whole studies with small budgets, so that scans are sampled or estimated.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::subdivision::Method;
use sixfold::{Facts, Relation, shapes};
use sixfold_study::{
    Agreement, Operation, Report, Settings, Standing, StudyError, StudyMesh, study,
};

fn quick(study_mesh: &StudyMesh, settings: &Settings) -> Result<Report, StudyError> {
    study(study_mesh, settings, &AtomicBool::new(false), &mut |_| ())
}

#[test]
fn scans_are_sampled_and_long_operations_are_estimated() {
    let mesh = shapes::triangle_grid(45, 40).expect("a grid");
    let facts = Facts::from_polygons(&mesh);
    let study_mesh = StudyMesh::new("grid", mesh);
    let settings = Settings {
        budget: Duration::from_secs(4),
        seed: 5,
        ..Settings::default()
    };
    let report = quick(&study_mesh, &settings).expect("all backends hold it");
    let expected_rows = Operation::ALL.len() * report.backends.len();
    assert_eq!(report.results.len() + report.refusals.len(), expected_rows);
    // Two structures cannot split their own tables. Corner tables cannot hold quads. On a busy
    // machine, the budget may end before the last operations.
    let ended = report
        .refusals
        .iter()
        .filter(|r| r.reason.contains("budget ended"));
    let (ended, all) = (ended.count(), report.refusals.len());
    assert!(
        all - ended <= 2 * 2 + 3 && all >= 2 * 2 + 3,
        "{:?}",
        report.refusals
    );
    for row in &report.results {
        let context = format!("{} on {}", row.operation, row.backend);
        let estimated = row.estimated_ns.is_some();
        match row.operation {
            Operation::FfBfs if estimated => assert_eq!(row.agreement, Agreement::Unchecked),
            // In this short time, only one structure may have run the operation.
            operation if operation.creates_mesh() => {
                assert!(row.agreement != Agreement::Mismatch, "{context}: {row:?}");
            }
            _ => assert_eq!(row.agreement, Agreement::Same, "{context}: {row:?}"),
        }
        let elements = match row.per.as_str() {
            "vertex" => facts.vertices,
            "edge" => facts.edges,
            "face" => facts.faces,
            "new face" => match row.operation {
                Operation::Loop(_) => 4 * facts.faces,
                _ => 3 * facts.faces,
            },
            _ => continue,
        };
        assert_eq!(row.elements, Some(elements as u64), "{context}");
    }
    let soup = |operation: Operation| {
        let mut rows = report.rows(operation);
        let row = rows.find(|row| row.backend == "polygon-soup");
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
        // One scan of 3,600 faces takes at least a microsecond.
        assert!(row.ns_per_element > Some(1000.0), "{row:?}");
    }
    let search = soup(Operation::FfBfs);
    assert!(search.estimated_ns.or(search.median_ns) > Some(1e6));
    assert!(!soup(Operation::FaceBarycenter).sampled);
    let sentences = report.sentences.join(" ");
    assert!(
        sentences.contains("polygon-soup scans all 3,600 faces"),
        "{sentences}"
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
    let mesh = sixfold::PolygonMesh::new(corners, fan).expect("valid");
    let study_mesh = StudyMesh::new("fan", mesh);
    let settings = Settings {
        budget: Duration::from_millis(200),
        ..Settings::default()
    };
    let start = std::time::Instant::now();
    let report = quick(&study_mesh, &settings).expect("all backends hold it");
    // A full run visits 10⁸ adjacent edges at one vertex.
    assert!(start.elapsed() < Duration::from_secs(15));
    assert_eq!(report.mismatches().count(), 0, "{:?}", report.sentences);
    let edges = Operation::Relation(Relation::EdgeEdges);
    for row in report.rows(edges) {
        assert!(row.sampled, "{row:?}");
        assert_eq!(row.agreement, Agreement::Same, "{row:?}");
    }
    for row in report.rows(Operation::EdgeLength) {
        assert!(!row.sampled, "{row:?}");
    }
    // A structure may be sampled although it does not scan.
    for walker in ["half-edge", "winged-edge", "corner-table", "face-vertex"] {
        let scans = format!("{walker} scans all");
        let found = report
            .sentences
            .iter()
            .any(|sentence| sentence.contains(&scans));
        assert!(!found, "{:?}", report.sentences);
    }
}

#[test]
fn a_csv_without_rows_has_the_same_header() {
    let study_mesh = StudyMesh::new("cube", shapes::cube());
    let settings = Settings {
        budget: Duration::ZERO,
        ..Settings::default()
    };
    let first_line = |stopped: bool| {
        let stop = AtomicBool::new(stopped);
        let report = study(&study_mesh, &settings, &stop, &mut |_| ()).expect("a cube");
        assert_eq!(report.results.is_empty(), stopped);
        let mut csv = Vec::new();
        report.write_csv(&mut csv).expect("memory");
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
    let empty = StudyMesh::new("nothing", sixfold::PolygonMesh::default());
    let none = quick(&empty, &Settings::default()).expect_err("no faces");
    assert_eq!(none, StudyError::NoFaces);
    let corners = [sixfold::Point::ZERO, sixfold::Point::X, sixfold::Point::Y];
    let twice = sixfold::PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
    let study_mesh = StudyMesh::new("twice", twice);
    let refused = quick(&study_mesh, &settings("half-edge")).expect_err("not oriented");
    assert!(refused.to_string().contains("v0→v1"), "{refused}");
}

/// Studies one subdivision on the polygon soup. The soup scans all faces for each vertex.
fn searched(operations: Vec<Operation>, budget: Duration) -> sixfold_study::ResultRow {
    let mesh = shapes::triangle_grid(40, 35).expect("a grid");
    let settings = Settings {
        backends: vec!["polygon-soup".into(), "half-edge".into()],
        operations,
        budget,
        ..Settings::default()
    };
    let report = quick(&StudyMesh::new("grid", mesh), &settings).expect("both hold it");
    let of_soup = |row: &&sixfold_study::ResultRow| {
        let gather = row.operation == Operation::Loop(Method::Gather);
        gather && row.backend == "polygon-soup"
    };
    let row = report.results.iter().find(of_soup);
    row.expect("measured or estimated").clone()
}

#[test]
fn a_scanning_subdivision_is_run_if_it_is_named() {
    let named = vec![Operation::Loop(Method::Gather)];
    let run = searched(named.clone(), Duration::from_secs(3));
    let measured_ns = run.median_ns.expect("it was run");
    assert_eq!(run.elements, Some(4 * 2 * 40 * 35));
    assert!(
        !run.by_name_only && run.agreement == Agreement::Same,
        "{run:?}"
    );
    // An operation longer than the budget is not run, even if it is named.
    let too_short = Duration::from_nanos(measured_ns as u64 / 100);
    let too_long = searched(named, too_short);
    let estimate = too_long.estimated_ns.expect("only estimated");
    assert!(
        too_long.median_ns.is_none() && !too_long.by_name_only,
        "{too_long:?}"
    );
    assert!(
        (0.2..5.0).contains(&(estimate / measured_ns)),
        "estimate {estimate}, measured {measured_ns}"
    );
}

#[test]
fn a_scheme_refuses_a_mesh_with_the_same_reason_on_all_backends() {
    let study_mesh = StudyMesh::new("cube", shapes::cube());
    let settings = Settings {
        budget: Duration::from_secs(2),
        ..Settings::default()
    };
    let report = quick(&study_mesh, &settings).expect("quads");
    let loops = |operation: Operation| matches!(operation, Operation::Loop(_));
    assert!(report.results.iter().all(|row| !loops(row.operation)));
    let refused = report.refusals.iter().filter(|r| loops(r.operation));
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
    let mesh = shapes::triangle_grid(20, 20).expect("a grid");
    let settings = Settings {
        operations: vec![Operation::Circulate, Operation::EdgeLength],
        budget: Duration::from_millis(300),
        ..Settings::default()
    };
    let report = quick(&StudyMesh::new("grid", mesh), &settings).expect("all backends hold it");
    assert_eq!(report.results.len(), 2 * report.backends.len());
    let control = report.control.expect("there was time for rounds");
    assert_eq!(control.backend, "face-vertex", "the first without scans");
    assert_eq!(control.operations.len(), 2);
    assert!(control.typical >= 1.0 && control.worst >= control.typical);
    let shown = |sentence: &String| sentence.starts_with("Noise: face-vertex was measured twice");
    assert!(report.sentences.iter().any(shown), "{:?}", report.sentences);
}
