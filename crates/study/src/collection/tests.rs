use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::shapes;

use super::*;
use crate::{Settings, Standing, StudyMesh, study};

fn shared_settings() -> SharedSettings {
    SharedSettings {
        backends: Vec::new(),
        externals: Vec::new(),
        operations: vec![Operation::Boundary],
        budget_s: 0.02,
        seed: 1,
        heap: Policy::Kept,
        caches: CacheState::Warm,
        triangulate: false,
        strict: false,
    }
}

/// A study in which the time of half-edge is `ratio` times the time of corner-table.
fn report(mesh: &str, ratio: f64) -> Report {
    let study_mesh = StudyMesh::new(mesh, shapes::icosahedron());
    let settings = Settings {
        operations: vec![Operation::Boundary],
        budget: Duration::from_millis(20),
        ..Settings::default()
    };
    let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let mut report = report.expect("a study");
    // Other tests of this program may have changed the policy.
    report.environment.heap.as_mut().expect("measured").policy = Policy::Kept;
    report
        .results
        .retain(|row| row.backend == "half-edge" || row.backend == "corner-table");
    for row in &mut report.results {
        let best = row.backend == "corner-table";
        let ratio = if best { 1.0 } else { ratio };
        row.ratio_to_best = Some(ratio);
        row.median_ns = Some(1000.0 * ratio);
        row.standing = Some(if best {
            Standing::Best
        } else {
            Standing::Slower
        });
    }
    report
}

fn failed(mesh: &str, reason: &str) -> Failed {
    Failed {
        mesh: mesh.into(),
        reason: reason.into(),
        kind: FailureKind::NotMeasured,
    }
}

fn names(list: &[&str]) -> Vec<String> {
    list.iter().map(|&name| name.to_owned()).collect()
}

#[test]
fn studies_are_in_the_order_of_the_meshes() {
    let mut all = Collection::new(names(&["a", "b", "c", "d"]), shared_settings());
    all.add_study(report("c", 8.0));
    all.add_study(report("a", 2.0));
    all.add_failure(failed("d", "no faces"));
    assert_eq!(all.missing, ["b"]);
    all.add_study(report("b", 4.0));
    let order: Vec<&str> = all.studies.iter().map(|s| s.mesh.name.as_str()).collect();
    assert_eq!((order, all.missing.len()), (vec!["a", "b", "c"], 0));
    all.add_study(report("b", 1.0));
    assert_eq!(all.studies.len(), 3);
}

#[test]
fn merged_shards_equal_one_whole_run() {
    let meshes = names(&["a", "b", "c"]);
    let mut whole = Collection::new(meshes.clone(), shared_settings());
    let studies = [report("a", 2.0), report("b", 3.0)];
    let [mut one, mut two] = [0, 1].map(|_| Collection::new(meshes.clone(), shared_settings()));
    for (study, shard) in studies.into_iter().zip([&mut one, &mut two]) {
        whole.add_study(study.clone());
        shard.add_study(study);
    }
    whole.add_failure(failed("c", "broken"));
    one.add_failure(failed("c", "broken"));
    let written = |collection: &Collection| {
        let mut text = Vec::new();
        collection.write_json(&mut text).expect("memory");
        String::from_utf8(text).expect("UTF-8")
    };
    let two = Collection::read_json(&written(&two)).expect("as written");
    one.merge(two).expect("the same meshes");
    assert_eq!(written(&one), written(&whole));
}

#[test]
fn different_meshes_or_settings_are_not_merged() {
    let mut one = Collection::new(names(&["a", "b"]), shared_settings());
    let other = Collection::new(names(&["a", "z"]), shared_settings());
    let error = one.merge(other).expect_err("another mesh").to_string();
    assert!(error.contains("meshes differ: z"), "{error}");
    let slower = SharedSettings {
        budget_s: 60.0,
        ..shared_settings()
    };
    let other = Collection::new(names(&["a", "b"]), slower);
    let error = one.merge(other).expect_err("another budget").to_string();
    assert!(error.contains("is 60 s, expected 0.02 s"), "{error}");
}
