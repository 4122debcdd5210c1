//! Checks that a study can measure a seventh structure, written in one file, together with the six.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::shapes;
use sixfold_study::{
    Agreement, Backend, Operation, Settings, Standing, StudyError, StudyMesh, study,
};

// The file in which the conformance suite tests itself with faults; ARCHITECTURE.md explains it.
#[path = "../crates/conformance/tests/all/face_and_edge_lists.rs"]
mod face_and_edge_lists;

use face_and_edge_lists::FaceAndEdgeLists;

#[test]
fn a_study_measures_an_extra_structure() {
    let study_mesh = StudyMesh::new(
        "torus",
        shapes::triangle_torus(6, 4).expect("a small torus"),
    );
    let settings = Settings {
        extra: vec![Backend::new::<FaceAndEdgeLists>()],
        budget: Duration::from_millis(500),
        ..Settings::default()
    };
    let interrupt = AtomicBool::new(false);
    let report =
        study(&study_mesh, &settings, &interrupt, &mut |_| ()).expect("all can hold a torus");

    let names: Vec<&str> = report.backends.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names.len(), 7, "{names:?}");
    let seventh = names[6];
    let rows: Vec<_> = report
        .results
        .iter()
        .filter(|row| row.backend == seventh)
        .collect();
    // It refuses only native subdivisions (2) and edits (4).
    let refusals = report.refusals.iter();
    let refused: Vec<_> = refusals.filter(|one| one.backend == seventh).collect();
    assert_eq!(refused.len(), 2 + 4, "{refused:?}");
    assert_eq!(rows.len(), Operation::ALL.len() - refused.len());
    for row in rows {
        assert_eq!(row.agreement, Agreement::Same, "{}", row.operation);
        assert_ne!(row.standing, Some(Standing::Alone), "{}", row.operation);
        assert!(
            row.median_ns.is_some_and(|ns| ns > 0.0),
            "{}",
            row.operation
        );
    }
}

#[test]
fn two_backends_with_the_same_name_are_refused() {
    let twice = Settings {
        extra: vec![Backend::new::<FaceAndEdgeLists>(); 2],
        ..Settings::default()
    };
    let refusal = twice.chosen_backends().expect_err("two with the same name");
    assert!(
        matches!(refusal, StudyError::RepeatedBackend { .. }),
        "{refusal}"
    );
}
