use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::shapes;

use super::*;
use crate::{Settings, StudyMesh, study};

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
        row.ratio_to_best = Some(if best { 1.0 } else { ratio });
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
fn ratios_are_pooled_by_geometric_means_over_meshes() {
    let mut all = Collection::new(names(&["a", "b", "c", "d"]), shared_settings());
    all.add_study(report("c", 8.0));
    all.add_study(report("a", 2.0));
    all.add_failure(failed("d", "no faces"));
    assert_eq!(all.missing, ["b"]);
    all.add_study(report("b", 4.0));
    let order: Vec<&str> = all.studies.iter().map(|s| s.mesh.name.as_str()).collect();
    assert_eq!((order, all.missing.len()), (vec!["a", "b", "c"], 0));
    let half_edge = all.pooled.iter().find(|row| row.backend == "half-edge");
    let half_edge = half_edge.expect("measured");
    assert!(
        (half_edge.ratio_to_best - 4.0).abs() < 1e-9,
        "{half_edge:?}"
    );
    let (low, high) = half_edge.ci_low.zip(half_edge.ci_high).expect("three");
    assert!(
        (2.0..4.0).contains(&low) && high > 4.0 && high <= 8.0,
        "{half_edge:?}"
    );
    let corner_table = all.pooled.iter().find(|row| row.backend == "corner-table");
    assert_eq!(corner_table.map(|row| (row.best, row.meshes)), Some((3, 3)));
    assert_eq!(all.sentences.len(), 1);
    assert!(
        all.sentences[0].contains("corner-table leads"),
        "{:?}",
        all.sentences
    );
    // A backend without a result on one mesh cannot lead.
    let mut other = report("b", 1.0);
    other.results.retain(|row| row.backend == "half-edge");
    other.results[0].ratio_to_best = Some(5.0);
    all.add_study(other);
    let sentence = &all.sentences[0];
    assert!(
        sentence.contains("half-edge leads the backends measured on all 3 meshes"),
        "{sentence}"
    );
    assert!(
        sentence.contains("lower ratio, but on fewer meshes: corner-table 1.00 × on 2"),
        "{sentence}"
    );
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
