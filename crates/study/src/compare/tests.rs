use crate::heap::CacheState;
use sixfold_workload::pages::Policy;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::shapes;

use super::*;
use crate::{Settings, StudyMesh, study};

/// Returns a study with known samples: 1000 ns times `factor`.
fn report(factor: impl Fn(&str, Operation) -> f64) -> Report {
    let study_mesh = StudyMesh::new("ball", shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Boundary, Operation::EdgeLength, Operation::Build],
        budget: Duration::from_millis(400),
        ..Settings::default()
    };
    let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let mut report = report.expect("a study");
    report.control = None;
    // Other tests of this program may have changed the policy.
    report.environment.heap.as_mut().expect("measured").policy = Policy::Kept;
    let raw = report.results.iter().map(|row| {
        let base = 1000.0 * factor(&row.backend, row.operation);
        // Nine samples, from −2 % to +2 %.
        let known: Vec<f64> = (0..9)
            .map(|i| base * (1.0 + 0.005 * f64::from(i - 4)))
            .collect();
        RawSamples {
            backend: row.backend.clone(),
            operation: row.operation,
            control: false,
            rounds: (0..9).collect(),
            cpu_ns: Some(known.clone()),
            wall_ns: known,
            faults: None,
            slowdowns: vec![1.0; 9],
            first_ns: Vec::new(),
        }
    });
    report.raw = raw.collect();
    for row in &mut report.results {
        row.median_ns = Some(1000.0 * factor(&row.backend, row.operation));
        let fastest = row.backend == "half-edge";
        row.standing = Some(if fastest {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    report
}

#[test]
fn a_known_change_is_found_and_nothing_else() {
    let before = report(|_, _| 1.0);
    let after = report(|backend, operation| match (backend, operation) {
        ("half-edge", Operation::EdgeLength) => 1.5,
        ("corner-table", Operation::Build) => 0.5,
        // The change is smaller than the drift of a machine.
        ("winged-edge", Operation::Boundary) => 1.06,
        _ => 1.0,
    });
    let quiet = CompareSettings {
        drift: 1.05,
        ..CompareSettings::default()
    };
    assert_eq!(
        compare(&before, &after, quiet)
            .expect("one memory state")
            .changed()
            .count(),
        3
    );
    let changes = compare(&before, &after, CompareSettings::default()).expect("one memory state");
    assert_eq!(changes.rows.len(), before.results.len());
    let found: Vec<_> = changes
        .changed()
        .map(|row| (row.backend.as_str(), row.operation, row.verdict))
        .collect();
    assert_eq!(
        found,
        [
            ("corner-table", Operation::Build, Verdict::Faster),
            ("half-edge", Operation::EdgeLength, Verdict::Slower),
        ]
    );
    let row = changes.changed().last().expect("two");
    assert!((row.ratio - 1.5).abs() < 1e-9, "{row:?}");
    let (low, high) = row.ci_low.zip(row.ci_high).expect("nine samples each");
    assert!(
        low > 1.4 && low < 1.5 && high > 1.5 && high < 1.6,
        "{row:?}"
    );
    assert_eq!(changes.overall, Some(1.0));
    assert_eq!(changes.environment, []);
    assert!(
        changes.sentences[0].contains("1 is faster in the second study, 1 is slower"),
        "{:?}",
        changes.sentences
    );
}

#[test]
fn a_slower_machine_is_one_factor_that_relative_removes() {
    let before = report(|_, _| 1.0);
    let mut after = report(|backend, operation| match (backend, operation) {
        ("half-edge", Operation::EdgeLength) => 2.0,
        _ => 3.0,
    });
    after.environment.cpu_model = Some("an old one".into());
    let absolute = compare(&before, &after, CompareSettings::default()).expect("one memory state");
    assert_eq!(absolute.count(Verdict::Slower), absolute.rows.len());
    assert!(
        absolute.sentences[1].contains("takes 3.00 × the time of the first"),
        "{:?}",
        absolute.sentences
    );
    assert!(
        absolute.sentences[1].contains("--relative"),
        "{:?}",
        absolute.sentences
    );
    assert_eq!(absolute.environment[0].what, "processor");
    let relative = compare(
        &before,
        &after,
        CompareSettings {
            relative: true,
            ..CompareSettings::default()
        },
    )
    .expect("one memory state");
    let found: Vec<_> = relative
        .changed()
        .map(|row| (row.backend.as_str(), row.verdict))
        .collect();
    assert_eq!(found, [("half-edge", Verdict::Faster)]);
}

#[test]
fn different_heaps_and_caches_are_refused() {
    let before = report(|_, _| 1.0);
    let mut after = before.clone();
    let heap = after.environment.heap.as_mut().expect("measured");
    heap.policy = match heap.policy {
        Policy::Kept => Policy::System,
        Policy::System => Policy::Kept,
    };
    let refused = compare(&before, &after, CompareSettings::default());
    let message = refused.expect_err("two policies").to_string();
    assert!(
        message.contains("--heap kept") && message.contains("--heap system"),
        "{message}"
    );
    let mut after = before.clone();
    let caches = after.environment.cache_state.as_mut().expect("measured");
    caches.state = CacheState::Cold;
    let refused = compare(&before, &after, CompareSettings::default());
    let message = refused.expect_err("two states").to_string();
    assert!(message.contains("--caches cold"), "{message}");
    // Older versions used the system's heap and warm caches.
    let mut old = before.clone();
    (old.environment.heap, old.environment.cache_state) = (None, None);
    assert_eq!(old.environment.memory_settings(), ["system", "warm"]);
}

#[test]
fn missing_rows_other_checksums_and_new_winners_are_reported() {
    let before = report(|_, _| 1.0);
    let mut after = report(|_, _| 1.0);
    after
        .results
        .retain(|row| row.operation != Operation::Build);
    for row in &mut after.results {
        let now = row.backend == "corner-table";
        row.standing = Some(if now {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    let edge_length = |row: &&mut ResultRow| row.operation == Operation::EdgeLength;
    let row = after.results.iter_mut().find(edge_length).expect("a row");
    row.checksum = row.checksum.map(|sum| sum * 1.01);
    let name = row.backend.clone();
    after.backends[3].bytes = Some(7);
    let changes = compare(&before, &after, CompareSettings::default()).expect("one memory state");
    assert_eq!(changes.only_before.len(), 6);
    assert!(
        changes.only_before[0].starts_with("build on "),
        "{changes:?}"
    );
    let other: Vec<_> = changes.changed().map(|row| &row.backend).collect();
    assert_eq!(other, [&name]);
    assert_eq!(changes.bytes[0].0, "winged-edge");
    assert_eq!(changes.bytes[0].2, 7);
    assert_eq!(changes.winners.len(), 2);
    assert_eq!(changes.winners[0].after, "corner-table");
    assert!(
        changes.sentences.last().expect("sentences").contains(&name),
        "{:?}",
        changes.sentences
    );
}

#[test]
fn without_samples_only_ratios_above_two_count() {
    let before = report(|_, _| 1.0);
    let mut after = report(|backend, _| if backend == "half-edge" { 2.5 } else { 1.5 });
    after.raw.clear();
    let changes = compare(&before, &after, CompareSettings::default()).expect("one memory state");
    let found: Vec<_> = changes.changed().map(|row| row.backend.as_str()).collect();
    assert_eq!(found, ["half-edge"; 3]);
    assert!(changes.rows.iter().all(|row| row.ci_low.is_none()));
}

#[test]
fn studies_of_other_meshes_are_refused() {
    let before = report(|_, _| 1.0);
    let mut after = before.clone();
    after.mesh.name = "cube".into();
    // The name alone makes no difference: the file may have moved.
    compare(&before, &after, CompareSettings::default()).expect("one mesh");
    after.mesh.facts.faces = 12;
    let error = compare(&before, &after, CompareSettings::default()).expect_err("two meshes");
    assert!(
        error
            .to_string()
            .contains("the first is of ball (12 vertices, 20 faces), the second of cube"),
        "{error}"
    );
}
