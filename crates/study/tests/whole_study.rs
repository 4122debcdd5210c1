//! A study from end to end, short of time, so that scans have to be sampled or left.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::{Facts, Relation, shapes};
use study::{Agreement, Operation, Report, Settings, Specimen, Standing, StudyError, study};

fn quick(specimen: &Specimen, settings: &Settings) -> Result<Report, StudyError> {
    study(specimen, settings, &AtomicBool::new(false), &mut |_| ())
}

#[test]
fn scans_are_sampled_alike_and_what_takes_too_long_is_estimated() {
    let mesh = shapes::triangle_grid(45, 40).expect("a grid");
    let facts = Facts::of(&mesh);
    let specimen = Specimen::new("grid", mesh);
    let settings = Settings {
        budget: Duration::from_millis(100),
        seed: 5,
        ..Settings::default()
    };
    let report = quick(&specimen, &settings).expect("everybody holds it");
    assert_eq!(report.results.len(), 18 * report.backends.len());
    for row in &report.results {
        let context = format!("{} on {}", row.operation, row.backend);
        let expected = match row.operation {
            Operation::FfBfs if row.estimated_ns.is_some() => Agreement::Unchecked,
            _ => Agreement::Same,
        };
        assert_eq!(row.agreement, expected, "{context}: {row:?}");
        let elements = match row.per {
            "vertex" => facts.vertices,
            "edge" => facts.edges,
            "face" => facts.faces,
            _ => continue,
        };
        assert_eq!(row.elements, Some(elements as u64), "{context}");
    }
    let soup = |operation: Operation| {
        let mut rows = report.rows(operation);
        let row = rows.find(|row| row.backend == "polygon-soup");
        row.expect("the soup holds it")
    };
    for relation in [
        Relation::VertexVertices,
        Relation::EdgeEdges,
        Relation::FaceFaces,
    ] {
        let row = soup(Operation::Relation(relation));
        assert!(row.sampled && row.sample_size >= Some(16), "{row:?}");
        assert_eq!(row.standing, Some(Standing::Slower), "{row:?}");
        // One scan of 3,600 faces takes a microsecond at the very least.
        assert!(row.ns_per_element > Some(1000.0), "{row:?}");
    }
    let search = soup(Operation::FfBfs);
    assert!(search.estimated_ns.or(search.median_ns) > Some(1e6));
    assert!(!soup(Operation::FaceBarycenter).sampled);
    let words = report.words.join(" ");
    assert!(
        words.contains("polygon-soup looks at all 3,600 faces"),
        "{words}"
    );
}

#[test]
fn a_vertex_of_many_faces_does_not_outlast_the_budget() {
    let rim = (0..10_000).map(|i| {
        let (y, x) = (i as f32 * 6.283e-4).sin_cos();
        sixfold::Point::new(x, y, 0.0)
    });
    let corners: Vec<_> = rim.chain([sixfold::Point::Z]).collect();
    let fan = (0..10_000).map(|i| [10_000, i, (i + 1) % 10_000]);
    let mesh = sixfold::PolygonMesh::new(corners, fan).expect("valid");
    let specimen = Specimen::new("fan", mesh);
    let settings = Settings {
        budget: Duration::from_millis(200),
        ..Settings::default()
    };
    let start = std::time::Instant::now();
    let report = quick(&specimen, &settings).expect("everybody holds it");
    // In full, the edges around that vertex alone are 10⁸ neighbours for each backend.
    assert!(start.elapsed() < Duration::from_secs(15));
    assert_eq!(report.mismatches().count(), 0, "{:?}", report.words);
    let edges = Operation::Relation(Relation::EdgeEdges);
    for row in report.rows(edges) {
        assert!(row.sampled, "{row:?}");
        assert_eq!(row.agreement, Agreement::Same, "{row:?}");
    }
    for row in report.rows(Operation::EdgeLength) {
        assert!(!row.sampled, "{row:?}");
    }
    // A sample is no scan.
    for walker in ["half-edge", "winged-edge", "corner-table", "face-vertex"] {
        let scans = format!("{walker} looks at all");
        let said = report.words.iter().any(|words| words.contains(&scans));
        assert!(!said, "{:?}", report.words);
    }
}

#[test]
fn a_csv_without_rows_has_the_same_first_line() {
    let specimen = Specimen::new("cube", shapes::cube());
    let settings = Settings {
        budget: Duration::ZERO,
        ..Settings::default()
    };
    let first_line = |stopped: bool| {
        let stop = AtomicBool::new(stopped);
        let report = study(&specimen, &settings, &stop, &mut |_| ()).expect("a cube");
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
fn what_cannot_be_studied_is_refused_by_name() {
    let specimen = Specimen::new("cube", shapes::cube());
    let settings = |backend: &str| Settings {
        backends: vec![backend.into()],
        ..Settings::default()
    };
    let unknown = quick(&specimen, &settings("abacus")).expect_err("no such backend");
    assert!(unknown.to_string().contains("half-edge"), "{unknown}");
    let empty = Specimen::new("nothing", sixfold::PolygonMesh::default());
    let none = quick(&empty, &Settings::default()).expect_err("no faces");
    assert_eq!(none, StudyError::NoFaces);
    let corners = [sixfold::Point::ZERO, sixfold::Point::X, sixfold::Point::Y];
    let twice = sixfold::PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 2]]).expect("valid");
    let specimen = Specimen::new("twice", twice);
    let refused = quick(&specimen, &settings("half-edge")).expect_err("not oriented");
    assert!(refused.to_string().contains("v0→v1"), "{refused}");
}
