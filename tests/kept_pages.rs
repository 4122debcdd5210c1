//! Checks that no sample of a study or a pick has a page fault if freed pages are kept, and that
//! measurements with different heap policies do not run at the same time.
//!
//! This is a separate program with one thread: the policy must be set before other threads start.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::shapes;
use sixfold_study::{
    Backend, BackendRunner, HeapGuard, MachineClock, PickError, PickSettings, Policy, Series,
    Settings, Start, StudyError, StudyMesh, built_in, pick, study, timed,
};

const STRUCTURES: [&str; 4] = ["face-vertex", "winged-edge", "half-edge", "corner-table"];

sixfold_tests::main_on_one_thread!(
    no_sample_faults,
    other_policies_are_refused_while_one_is_active,
);

fn no_sample_faults() {
    let guard = HeapGuard::acquire(Policy::Kept).expect("the only guard");
    let heap = guard.report();
    if heap.policy != Policy::Kept || !heap.counts_faults {
        println!("nothing to test on this platform: {heap:?}");
        return;
    }
    freed_pages_are_kept_until_they_are_returned();
    for (frequency, seconds) in [(10, 2), (32, 3), (100, 8)] {
        with_time_enough(seconds, |budget| {
            no_sample_of_a_study_faults(frequency, budget)
        });
    }
    with_time_enough(3, no_sample_of_a_pick_faults);
    drop(guard);
}

fn other_policies_are_refused_while_one_is_active() {
    let study_mesh = StudyMesh::new("cube", shapes::cube());
    let guard = HeapGuard::acquire(Policy::System).expect("the only guard");
    let expected = HeapGuard::acquire(Policy::Kept).expect_err("another policy");
    let refused = |error: StudyError| {
        assert_eq!(error, StudyError::HeapPolicy(expected));
    };
    let settings = Settings::default();
    let never = AtomicBool::new(false);
    let report = study(&study_mesh, &settings, &never, &mut |_| ());
    refused(report.expect_err("another policy"));
    let settings = pick_settings(Duration::ZERO);
    let meshes = std::slice::from_ref(&study_mesh);
    match pick(meshes, &settings, &never, &mut |_, _| ()) {
        Err(PickError::Study(error)) => refused(error),
        other => panic!("{other:?}"),
    }
    let backend = Backend::find("half-edge").expect("a structure");
    let runner = || BackendRunner::new(&backend, &study_mesh.polygons);
    refused(runner().err().expect("another policy"));
    drop(guard);

    let runner = runner().expect("no guard is left");
    assert_eq!(
        HeapGuard::acquire(Policy::System).err().map(|e| e.active),
        Some(Policy::Kept)
    );
    drop(runner);
    drop(HeapGuard::acquire(Policy::System).expect("the runner has ended"));
}

/// Calls `test` with a budget of `seconds`. Doubles the budget until `test` returns true, because
/// other programs may run on this machine.
fn with_time_enough(seconds: u64, test: impl Fn(Duration) -> bool) {
    let mut budgets = [1, 2, 4, 8, 16]
        .map(|times| Duration::from_secs(times * seconds))
        .into_iter();
    assert!(budgets.any(test), "too few samples in the longest budget");
}

/// Returns the number of page faults when a block of `bytes` is filled.
fn faults_of(bytes: usize, start: Start<'_>) -> u64 {
    let clock = MachineClock::start();
    let series = Series {
        start,
        ..Series::once(&clock)
    };
    series.begin();
    let time = timed(&clock, || drop(std::hint::black_box(vec![1_u8; bytes])));
    time.faults.expect("page faults are counted")
}

fn freed_pages_are_kept_until_they_are_returned() {
    let bytes = 64 << 20;
    faults_of(bytes, Start::Warm);
    assert_eq!(faults_of(bytes, Start::Warm), 0, "the pages were kept");
    let fresh = faults_of(bytes, Start::FreshPages);
    assert!(fresh as usize > bytes / (64 << 10), "{fresh}: returned");
    assert_eq!(faults_of(bytes, Start::Warm), 0, "kept again");
}

/// Returns whether the budget was enough for more than 20 samples.
fn no_sample_of_a_study_faults(frequency: usize, budget: Duration) -> bool {
    let polygons = shapes::geodesic(frequency).expect("a sphere");
    let study_mesh = StudyMesh::new("sphere", polygons);
    let settings = Settings {
        backends: STRUCTURES.map(str::to_owned).to_vec(),
        budget,
        ..Settings::default()
    };
    let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let report = report.expect("all four can hold the mesh");
    let heap = report.run.environment.heap.as_ref().expect("a heap report");
    assert_eq!((heap.policy, &heap.reason), (Policy::Kept, &None));
    let mut samples = 0;
    for raw in &report.samples {
        let faults = raw.faults.as_ref().expect("page faults are counted");
        assert!(
            faults.iter().all(|&n| n == 0),
            "{}: {} on {}: {faults:?}",
            study_mesh.name,
            raw.operation,
            raw.backend
        );
        samples += faults.len();
    }
    // Building a mesh on fresh pages causes page faults.
    let builds = report.rows("build".parse().expect("an operation"));
    for row in builds.filter(|row| row.first_samples > 0) {
        assert!(row.first_faults > Some(0), "{row:?}");
    }
    let faces = report.mesh.facts.faces;
    println!("{faces} faces, {budget:?}: no fault in {samples} samples");
    samples > 20
}

/// Returns whether the budget was enough.
fn no_sample_of_a_pick_faults(budget: Duration) -> bool {
    let study_mesh = StudyMesh::new("sphere", shapes::geodesic(24).expect("a sphere"));
    let settings = pick_settings(budget);
    let never = AtomicBool::new(false);
    let report = pick(&[study_mesh], &settings, &never, &mut |_, _| ());
    let report = report.expect("all four can hold the mesh");
    if report.preliminary {
        return false;
    }
    for ranked in &report.ranking {
        assert_eq!(ranked.faults, Some(0), "{}", ranked.backend);
        assert!(ranked.first_build_ns > Some(0.0), "{}", ranked.backend);
    }
    true
}

fn pick_settings(budget: Duration) -> PickSettings {
    PickSettings {
        workload: built_in("remeshing").expect("a built-in workload"),
        backends: STRUCTURES.map(str::to_owned).to_vec(),
        extra: Vec::new(),
        needs: Vec::new(),
        max_memory: None,
        budget,
        seed: 1,
        heap: Policy::Kept,
    }
}
