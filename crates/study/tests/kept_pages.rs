//! Where freed pages are kept, no sample has a page fault: in a study and in a pick, on three sizes.
//!
//! A program of its own with one thread: the policy has to be in force before other threads start.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::shapes;
use study::{
    MachineClock, Policy, Question, Series, Settings, Specimen, Start, built_in, pages, pick,
    study, timed,
};

const STRUCTURES: [&str; 4] = ["face-vertex", "winged-edge", "half-edge", "corner-table"];

fn main() {
    let heap = pages::put_in_force(Policy::Kept);
    if heap.policy != Policy::Kept || !heap.counts_faults {
        println!("nothing to test on this platform: {heap:?}");
        return;
    }
    freed_pages_are_there_until_they_are_given_back();
    for (frequency, budget) in [(10, 2), (32, 3), (100, 8)] {
        no_sample_of_a_study_faults(frequency, budget);
    }
    no_sample_of_a_pick_faults();
    assert_eq!(pages::put_in_force(Policy::System).policy, Policy::System);
}

/// The page faults of filling so many bytes.
fn faults_of(bytes: usize, start: Start<'_>) -> u64 {
    let clock = MachineClock::start();
    let series = Series {
        start,
        ..Series::once(&clock)
    };
    series.begin();
    let time = timed(&clock, || drop(std::hint::black_box(vec![1_u8; bytes])));
    time.faults.expect("they are counted")
}

fn freed_pages_are_there_until_they_are_given_back() {
    let bytes = 64 << 20;
    faults_of(bytes, Start::Warm);
    assert_eq!(faults_of(bytes, Start::Warm), 0, "the pages were kept");
    let fresh = faults_of(bytes, Start::FreshPages);
    assert!(fresh as usize > bytes / (64 << 10), "{fresh}: given back");
    assert_eq!(faults_of(bytes, Start::Warm), 0, "kept again");
}

fn no_sample_of_a_study_faults(frequency: usize, seconds: u64) {
    let polygons = shapes::geodesic(frequency).expect("a sphere");
    let specimen = Specimen::new("sphere", polygons);
    let settings = Settings {
        backends: STRUCTURES.map(str::to_owned).to_vec(),
        budget: Duration::from_secs(seconds),
        ..Settings::default()
    };
    let report = study(&specimen, &settings, &AtomicBool::new(false), &mut |_| ());
    let report = report.expect("all four hold it");
    let heap = report.environment.heap.as_ref().expect("it is stated");
    assert_eq!((heap.policy, &heap.reason), (Policy::Kept, &None));
    let mut samples = 0;
    for raw in &report.raw {
        let faults = raw.faults.as_ref().expect("they are counted");
        assert!(
            faults.iter().all(|&n| n == 0),
            "{}: {} on {}: {faults:?}",
            specimen.name,
            raw.operation,
            raw.backend
        );
        samples += faults.len();
    }
    // The other figure is all about faults: what builds a mesh on fresh pages has some.
    let builds = report.rows("build".parse().expect("an operation"));
    for row in builds.filter(|row| row.first_samples > 0) {
        assert!(row.first_faults > Some(0), "{row:?}");
    }
    let faces = report.mesh.facts.faces;
    println!("{faces} faces: no fault in {samples} samples");
    assert!(samples > 20, "{samples}");
}

fn no_sample_of_a_pick_faults() {
    let specimen = Specimen::new("sphere", shapes::geodesic(24).expect("a sphere"));
    let question = Question {
        workload: built_in("remeshing").expect("it is built in"),
        backends: STRUCTURES.map(str::to_owned).to_vec(),
        needs: Vec::new(),
        max_memory: None,
        budget: Duration::from_secs(3),
        seed: 1,
        heap: Policy::Kept,
    };
    let answer = pick(
        &[specimen],
        &question,
        &AtomicBool::new(false),
        &mut |_, _| (),
    );
    let answer = answer.expect("time enough");
    for ranked in &answer.ranking {
        assert_eq!(ranked.faults, Some(0), "{}", ranked.backend);
        assert!(ranked.first_build_ns > Some(0.0), "{}", ranked.backend);
    }
}
