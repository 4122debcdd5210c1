//! Checks that no sample of a study or a pick has a page fault if freed pages are kept, and that
//! measurements with different heap policies do not run at the same time.
//!
//! The kernel can add page faults of its own, for example if memory is scarce or if it moves pages.
//! Such faults come and go, but pages that were not kept cause faults in every measurement. A
//! measurement with faults is therefore taken again. If even the last one has faults, the test
//! fails unless a loop over memory that is never freed has faults too.
//!
//! This is a separate program with one thread: the policy must be set before other threads start.

use std::fs;
use std::num::NonZeroU32;
use std::sync::atomic::AtomicBool;

use sixfold::shapes;
use sixfold_results::{Confidence, HeapReport, Policy};
use sixfold_study::{
    Backend, BackendRunner, Effort, HeapGuard, MachineClock, Operation, PickError, PickSettings,
    Series, Settings, Start, StudyError, StudyMesh, built_in, free_memory, pages, pick, study,
    timed,
};

const STRUCTURES: [&str; 4] = ["face-vertex", "winged-edge", "half-edge", "corner-table"];

/// Every measurement of this test keeps freed pages if at least this number of bytes and at least
/// this part of all memory are free.
const ENOUGH_MEMORY: u64 = 2 << 30;
const ENOUGH_PART: u64 = 10;

/// The number of rounds of a measurement. A pick with fewer rounds is preliminary.
const ROUNDS: NonZeroU32 = NonZeroU32::new(8).expect("above 0");

/// Maximum number of measurements, until one has no page faults.
const MAX_MEASUREMENTS: usize = 5;

/// Maximum number of times that a block is filled, until filling it has no page faults.
const MAX_FILLS: usize = 10;

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
    // All operations on a small mesh, and those that make another mesh on larger ones.
    measure_again(|| no_sample_of_a_study_faults(6, Vec::new()));
    for frequency in [24, 48] {
        let makes = |operation: &Operation| operation.creates_mesh() || operation.name() == "build";
        let making: Vec<Operation> = Operation::ALL.into_iter().filter(makes).collect();
        let some = making.into_iter().step_by(3).collect::<Vec<_>>();
        measure_again(|| no_sample_of_a_study_faults(frequency, some.clone()));
    }
    measure_again(no_sample_of_a_pick_faults);
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
    let settings = pick_settings();
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

/// The result of a measurement.
enum Outcome {
    /// There were enough samples, and none had a page fault.
    NoFault,
    /// The measurement returned freed pages to the kernel, because little memory was free.
    LittleMemory,
    Faults(String),
}

/// Calls `measure` until there is no fault.
fn measure_again(measure: impl Fn() -> Outcome) {
    let mut last = None;
    for _ in 0..MAX_MEASUREMENTS {
        match measure() {
            Outcome::NoFault => return,
            Outcome::LittleMemory => {
                println!("pages were not kept, because little memory is free");
                return;
            }
            Outcome::Faults(message) => {
                println!("measured again: {message}");
                last = Some(message);
            }
        }
    }
    let added = faults_without_allocation();
    assert!(added > 0, "{last:?}");
    println!("nothing to test: {added} faults in a loop that allocates nothing");
}

/// Returns the number of page faults in a loop over a block of memory that is already in use.
fn faults_without_allocation() -> u64 {
    const PASSES: u8 = 200;
    const PAGE_BYTES: usize = 4096;
    let mut block = vec![1_u8; 64 << 20];
    let before = pages::faults().expect("page faults are counted");
    for pass in 0..PASSES {
        block
            .iter_mut()
            .step_by(PAGE_BYTES)
            .for_each(|byte| *byte = pass);
        std::hint::black_box(&mut block);
    }
    pages::faults().expect("page faults are counted") - before
}

/// Returns whether freed pages were kept.
///
/// # Panics
///
/// Panics if they were not kept, although enough memory is free.
fn keeps_pages(heap: &HeapReport) -> bool {
    let is_kept = heap.policy == Policy::Kept;
    if !is_kept {
        let enough = ENOUGH_MEMORY.max(all_memory() / ENOUGH_PART);
        assert!(free_memory().is_some_and(|free| free < enough), "{heap:?}");
    }
    is_kept
}

/// Returns the bytes of main memory of the machine.
fn all_memory() -> u64 {
    let text = fs::read_to_string("/proc/meminfo").expect("page faults are counted only on Linux");
    let total = text.lines().find_map(|line| line.strip_prefix("MemTotal:"));
    let total = total.and_then(|words| words.split_whitespace().next()?.parse::<u64>().ok());
    1024 * total.expect("the kernel gives kibibytes")
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
    let fills_without_faults = || (0..MAX_FILLS).any(|_| faults_of(bytes, Start::Warm) == 0);
    faults_of(bytes, Start::Warm);
    assert!(fills_without_faults(), "the pages were kept");
    let fresh = faults_of(bytes, Start::FreshPages);
    assert!(fresh as usize > bytes / (64 << 10), "{fresh}: returned");
    assert!(fills_without_faults(), "kept again");
}

fn no_sample_of_a_study_faults(frequency: usize, operations: Vec<Operation>) -> Outcome {
    let polygons = shapes::geodesic(frequency).expect("a sphere");
    let study_mesh = StudyMesh::new("sphere", polygons);
    let settings = Settings {
        backends: STRUCTURES.map(str::to_owned).to_vec(),
        operations,
        effort: Effort::Rounds(ROUNDS),
        ..Settings::default()
    };
    let report = study(&study_mesh, &settings, &AtomicBool::new(false), &mut |_| ());
    let report = report.expect("all four can hold the mesh");
    let heap = report.run.environment.heap.as_ref().expect("a heap report");
    if !keeps_pages(heap) {
        return Outcome::LittleMemory;
    }
    assert_eq!(heap.reason, None);
    let mut samples = 0;
    for raw in &report.samples {
        let faults = raw.faults.as_ref().expect("page faults are counted");
        if faults.iter().any(|&n| n > 0) {
            let (operation, backend) = (&raw.operation, &raw.backend);
            let message = format!("{frequency}: {operation} on {backend}: {faults:?}");
            return Outcome::Faults(message);
        }
        samples += faults.len();
    }
    // Building a mesh on fresh pages causes page faults.
    let builds = report.rows("build");
    for row in builds.filter(|row| row.first_samples > 0) {
        assert!(row.first_faults > Some(0), "{row:?}");
    }
    let faces = report.mesh.facts.faces;
    println!("{faces} faces: no fault in {samples} samples");
    assert!(samples >= report.results.len() * ROUNDS.get() as usize);
    Outcome::NoFault
}

fn no_sample_of_a_pick_faults() -> Outcome {
    let study_mesh = StudyMesh::new("sphere", shapes::geodesic(24).expect("a sphere"));
    let settings = pick_settings();
    let never = AtomicBool::new(false);
    let report = pick(&[study_mesh], &settings, &never, &mut |_, _| ());
    let report = report.expect("all four can hold the mesh");
    let heap = report.run.environment.heap.as_ref().expect("a heap report");
    if !keeps_pages(heap) {
        return Outcome::LittleMemory;
    }
    assert!(!report.preliminary);
    for ranked in &report.ranking {
        let faults = ranked.faults.expect("page faults are counted");
        if faults > 0 {
            return Outcome::Faults(format!("pick: {}: {faults}", ranked.backend));
        }
        assert!(ranked.first_build_ns > Some(0.0), "{}", ranked.backend);
    }
    Outcome::NoFault
}

fn pick_settings() -> PickSettings {
    PickSettings {
        workload: built_in("remeshing").expect("a built-in workload"),
        backends: STRUCTURES.map(str::to_owned).to_vec(),
        extra: Vec::new(),
        needs: Vec::new(),
        max_memory: None,
        effort: Effort::Rounds(ROUNDS),
        confidence: Confidence::default(),
        seed: 1,
        heap: Policy::Kept,
    }
}
