//! Tests with mixers of known costs, on a simulated machine whose speed drifts.

use sixfold::{PolygonMesh, shapes};
use sixfold_workload::pages::Policy;
use sixfold_workload::{ElementSample, MixBackend, MixRun, Operation, Run, Series, Time, built_in};

use super::*;
use crate::pick::measurement::Outcome;
use crate::simulated_machine::SimulatedMachine;

struct KnownBackend {
    name: &'static str,
    machine: SimulatedMachine,
    operation_ns: f64,
    build_ns: f64,
    parts: usize,
    /// The result of one operation. Agreeing backends return 1.
    yield_per_operation: u64,
}

impl KnownBackend {
    fn time(&self, ns: f64, clock: &dyn sixfold_workload::Clock) -> Time {
        let start = clock.now();
        self.machine.work(ns);
        clock.now() - start
    }
}

impl MixBackend for KnownBackend {
    fn name(&self) -> &'static str {
        self.name
    }
    fn type_paths(&self) -> Vec<&'static str> {
        vec!["sixfold_half_edge::HalfEdgeMesh"]
    }
    fn bytes(&self) -> usize {
        1 << 20
    }
    fn merged_vertices(&self) -> usize {
        0
    }
    fn scans(&self) -> Vec<bool> {
        vec![false; self.parts]
    }
    fn run(
        &mut self,
        _: u64,
        turns: u64,
        copies: usize,
        clock: &dyn sixfold_workload::Clock,
    ) -> MixRun {
        let operations = 256 * turns * copies as u64;
        MixRun {
            time: self.time(self.operation_ns * operations as f64, clock),
            operations,
            yielded: operations,
            refused: 0,
        }
    }
    fn run_part(
        &mut self,
        _: usize,
        _: u64,
        operations: u64,
        clock: &dyn sixfold_workload::Clock,
    ) -> MixRun {
        MixRun {
            time: self.time(self.operation_ns * operations as f64, clock),
            operations,
            yielded: operations * self.yield_per_operation,
            refused: 0,
        }
    }
    fn cycle_length(&self, _: usize) -> u64 {
        1000
    }
    fn run_pass(&mut self, _: Operation, _: Option<ElementSample>, series: &Series<'_>) -> Run {
        Run::done(self.time(1e6, series.clock), None)
    }
    fn accepted_places(&mut self) -> Vec<Vec<bool>> {
        Vec::new()
    }
    fn keep_places(&mut self, _: &[Vec<bool>]) {}
    fn build(&self, series: &Series<'_>) -> Time {
        let untimed = series.untimed;
        (0..untimed).for_each(|_| self.machine.work(self.build_ns));
        self.time(self.build_ns, series.clock)
    }
}

fn settings(budget: Duration) -> PickSettings {
    PickSettings {
        workload: built_in("geodesic-dijkstra").expect("a built-in workload"),
        backends: Vec::new(),
        extra: Vec::new(),
        needs: Vec::new(),
        max_memory: None,
        budget,
        seed: 7,
        heap: Policy::Kept,
    }
}

/// The backend with a wrong result.
const FAULTY: &str = "face-vertex";

/// Measures an indexed face set of 50 ns per operation, and mixers with `costs_ns`.
fn measure_known(costs_ns: &[f64], seed: u64) -> Outcome {
    let study_mesh = StudyMesh::new("ball", shapes::icosahedron());
    let budget = Duration::from_secs(1);
    let settings = PickSettings {
        seed,
        ..settings(budget)
    };
    let counts = study_mesh.polygons.counts(study_mesh.facts.edges);
    let schedule = Schedule::new(&settings.workload, &counts);
    let machine = SimulatedMachine::default();
    let names = ["half-edge", "winged-edge", "corner-table", "face-vertex"];
    let known = |name, operation_ns| {
        let machine = machine.clone();
        Box::new(KnownBackend {
            name,
            machine,
            operation_ns,
            build_ns: 40e3,
            parts: schedule.parts.len(),
            yield_per_operation: if name == FAULTY { 2 } else { 1 },
        })
    };
    let mut backends: Vec<PickBackend<'_>> =
        vec![PickBackend::new(known("indexed-face-set", 50.0))];
    for (name, &cost) in names.into_iter().zip(costs_ns) {
        backends.push(PickBackend::new(known(name, cost)));
    }
    backends.push(PickBackend::control(known("half-edge", costs_ns[0])));
    let stop = AtomicBool::new(false);
    let measurement = PickMeasurement {
        study_mesh: &study_mesh,
        settings: &settings,
        counts,
        schedule: &schedule,
        budget,
        clock: &machine,
        memory: &mut Memory::start(Policy::Kept, CacheState::Warm, 0),
        stop: &stop,
        progress: &mut |_, _| (),
    };
    measurement.run(backends, Vec::new()).expect("enough time")
}

#[test]
fn known_ratios_are_found_on_a_drifting_machine() {
    let outcome = measure_known(&[10.0, 10.5, 12.5, 10.0], 1);
    let of = |name: &str| {
        outcome
            .ranking
            .iter()
            .find(|r| r.backend == name)
            .expect("it took part")
    };
    let best = &outcome.ranking[0];
    assert!(
        ["half-edge", "face-vertex"].contains(&best.backend.as_str()),
        "{best:?}"
    );
    for (name, ratio) in [
        ("corner-table", 1.25),
        ("winged-edge", 1.05),
        ("indexed-face-set", 5.0),
    ] {
        let row = of(name);
        let found = row.ratio_to_best;
        assert!((found / ratio - 1.0).abs() < 0.02, "{name}: {found}");
        let [low, high] = [row.ci_low, row.ci_high].map(|end| end.expect("many rounds"));
        assert!(
            low <= ratio * 1.001 && ratio <= high * 1.001,
            "{name}: {low} to {high}"
        );
    }
    assert!(of("half-edge").tied_with_best && of("face-vertex").tied_with_best);
    assert!(!of("corner-table").tied_with_best && !of("indexed-face-set").tied_with_best);
    assert!(outcome.noise.expect("a control") < 1.02);
    assert_eq!(outcome.disagreeing, [FAULTY]);
}

#[test]
fn break_even_is_building_time_divided_by_time_saved() {
    let outcome = measure_known(&[10.0, 60.0], 1);
    let row = |name: &str| outcome.break_even.iter().find(|row| row.backend == name);
    // 40 µs divided by 40 ns per operation.
    let pays = row("half-edge")
        .and_then(|row| row.operations)
        .expect("it pays");
    assert!((700.0..1400.0).contains(&pays), "{pays}");
    let never = row("winged-edge").expect("it took part");
    assert_eq!(never.operations, None);
    assert!(never.saves_ns_per_operation < 0.0);
    assert!(row("indexed-face-set").is_none(), "it need not be built");
}

#[test]
fn intervals_cover_a_known_ratio() {
    let mut covered = 0;
    for seed in 0..40 {
        let outcome = measure_known(&[10.0, 13.0], seed);
        let row = outcome
            .ranking
            .iter()
            .find(|r| r.backend == "winged-edge")
            .expect("it took part");
        let [low, high] = [row.ci_low, row.ci_high].map(|end| end.expect("many rounds"));
        covered += usize::from(low <= 1.3 && 1.3 <= high);
    }
    assert!(covered >= 35, "{covered} of 40");
}

fn quick(settings: &PickSettings, meshes: &[PolygonMesh]) -> Result<PickReport, PickError> {
    let named = meshes.iter().enumerate();
    let study_meshes = named.map(|(i, mesh)| StudyMesh::new(format!("mesh {i}"), mesh.clone()));
    let study_meshes: Vec<StudyMesh> = study_meshes.collect();
    pick(
        &study_meshes,
        settings,
        &AtomicBool::new(false),
        &mut |_, _| (),
    )
}

#[test]
fn a_real_measurement_ranks_all_backends_with_reasons() {
    let torus = shapes::triangle_torus(24, 24).expect("a torus");
    let report = quick(&settings(Duration::from_secs(2)), &[torus]).expect("enough time");
    assert_eq!(report.ranking.len(), 7, "{:?}", report.ranking);
    assert!(report.excluded.is_empty());
    let times = report.ranking.iter().map(|row| row.ns_per_operation);
    assert!(times.is_sorted());
    assert_eq!(report.ranking[0].ratio_to_best, 1.0);
    assert_eq!(report.break_even.len(), 6);
    let soup = report.ranking.last().expect("seven backends");
    assert!(soup.sampled && soup.ratio_to_best > 10.0);
    assert!(
        report.sentences[0].starts_with("For geodesic-dijkstra, "),
        "{:?}",
        report.sentences
    );
    assert!(
        report
            .sentences
            .iter()
            .any(|sentence| sentence.contains("% of the time"))
    );
    let mut json = Vec::new();
    report.write_json(&mut json).expect("into memory");
    let json: serde_json::Value = serde_json::from_slice(&json).expect("it is JSON");
    for key in [
        "backend",
        "ns_per_operation",
        "ratio_to_best",
        "ci_low",
        "ci_high",
        "tied_with_best",
        "build_ns",
        "bytes",
    ] {
        assert!(!json["ranking"][0][key].is_null(), "{key}");
    }
    assert!(json["excluded"].is_object() && json["break_even"].is_array());
}

#[test]
fn needs_and_memory_limits_exclude_backends() {
    let torus = shapes::triangle_torus(24, 24).expect("a torus");
    let with_limits = |needs: &[Need], max_memory| PickSettings {
        needs: needs.to_vec(),
        max_memory,
        ..settings(Duration::from_secs(1))
    };
    let report = quick(
        &with_limits(&[Need::Edit, Need::NonManifold], None),
        std::slice::from_ref(&torus),
    );
    let report = report.expect("enough time");
    let mut names: Vec<&str> = report
        .ranking
        .iter()
        .map(|row| row.backend.as_str())
        .collect();
    names.sort_unstable();
    assert_eq!(names, ["face-vertex", "indexed-face-set", "polygon-soup"]);
    assert_eq!(report.excluded.len(), 4, "{:?}", report.excluded);
    // The smallest structure takes nine words per vertex.
    let vertices = torus.vertex_count() as u64;
    let report = quick(
        &with_limits(&[], Some(36 * vertices)),
        std::slice::from_ref(&torus),
    )
    .expect("a report");
    assert!(
        report
            .ranking
            .iter()
            .all(|row| row.bytes as u64 <= 36 * vertices)
    );
    assert!(
        report
            .excluded
            .iter()
            .any(|out| out.reason.contains("--max-memory"))
    );
    let report = quick(&with_limits(&[], Some(10)), &[torus]).expect("a report");
    assert!(report.ranking.is_empty());
    assert_eq!(report.sentences, ["No backend qualifies."]);
}

#[test]
fn edits_are_done_by_all_at_the_same_places() {
    let torus = shapes::triangle_torus(30, 30).expect("a torus");
    let settings = PickSettings {
        workload: built_in("remeshing").expect("a built-in workload"),
        ..settings(Duration::from_secs(3))
    };
    let report = quick(&settings, &[torus]).expect("enough time");
    let names: Vec<&str> = report
        .ranking
        .iter()
        .map(|row| row.backend.as_str())
        .collect();
    assert!(
        names.len() >= 5 && !names.contains(&"relation-tables"),
        "{names:?}"
    );
}

#[test]
fn several_meshes_give_one_answer() {
    let meshes = [
        shapes::triangle_torus(20, 20).expect("a torus"),
        shapes::triangle_grid(20, 20).expect("a grid"),
        shapes::grid(12, 12).expect("a grid"),
    ];
    let report = quick(&settings(Duration::from_secs(3)), &meshes).expect("enough time");
    assert_eq!(report.by_mesh.len(), 3);
    assert!(
        report
            .ranking
            .iter()
            .all(|row| row.backend != "corner-table")
    );
    let out = report
        .excluded
        .iter()
        .find(|out| out.backend == "corner-table")
        .expect("it holds triangles only");
    assert!(out.reason.starts_with("mesh 2: "), "{}", out.reason);
    assert_eq!(report.ranking[0].ratio_to_best, 1.0);
}

#[test]
fn invalid_settings_are_refused() {
    let torus = shapes::triangle_torus(20, 20).expect("a torus");
    let nothing = quick(
        &settings(Duration::from_nanos(1)),
        std::slice::from_ref(&torus),
    );
    let message = nothing.expect_err("no time at all").to_string();
    assert!(
        message.contains("too small to measure anything") && message.contains("--budget"),
        "{message}"
    );
    assert!(matches!(
        quick(&settings(Duration::from_secs(1)), &[]),
        Err(PickError::NoMesh)
    ));
    let points = PolygonMesh::default();
    let message = quick(&settings(Duration::from_secs(1)), &[points]).expect_err("no faces");
    assert!(
        matches!(message, PickError::Study(StudyError::NoFaces)),
        "{message}"
    );
    let quads = shapes::grid(20, 20).expect("a grid");
    let remeshing = PickSettings {
        workload: built_in("remeshing").expect("a built-in workload"),
        ..settings(Duration::from_secs(1))
    };
    let message = quick(&remeshing, &[quads]).expect_err("quads").to_string();
    assert!(
        message.contains("mesh 0: face f0 has 4 corners"),
        "{message}"
    );
    let message = quick(&remeshing, &[shapes::tetrahedron()])
        .expect_err("tiny")
        .to_string();
    assert!(
        message.contains("no room for 3 kinds of edits"),
        "{message}"
    );
}

#[test]
fn an_interrupted_measurement_keeps_its_samples() {
    let torus = shapes::triangle_torus(20, 20).expect("a torus");
    let study_mesh = [StudyMesh::new("torus", torus)];
    let stop = AtomicBool::new(false);
    let mut calls = 0;
    let report = pick(
        &study_mesh,
        &settings(Duration::from_secs(60)),
        &stop,
        &mut |_, what| {
            calls += usize::from(what.starts_with("round"));
            if calls > 20 {
                stop.store(true, Ordering::Relaxed);
            }
        },
    );
    let report = report.expect("the finished part");
    assert!(report.interrupted && !report.ranking.is_empty());
}
