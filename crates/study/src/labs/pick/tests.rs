//! Tests with mixers of known costs, on a simulated machine whose speed drifts.

use sixfold::{PolygonMesh, QueryCost, shapes};
use sixfold_measure::{Job, Operation, Outcome, Series, Task, TimedBackend, TimedRun};
use sixfold_results::{Confidence, Policy, Ranked, Results, Status};
use sixfold_workload::{MixBackend, built_in};

use super::*;
use crate::engine::simulated_machine::{SimulatedMachine, Work};
use sixfold_measure::pick::measurement::MeshOutcome;

struct KnownBackend {
    name: &'static str,
    machine: SimulatedMachine,
    operation_ns: f64,
    build_ns: f64,
    parts: usize,
    /// The result of one operation. Agreeing backends return 1.
    yield_per_operation: u64,
}

impl TimedBackend for KnownBackend {
    fn name(&self) -> &str {
        self.name
    }
    fn costs(&self) -> [QueryCost; 9] {
        [QueryCost::Local; 9]
    }
    fn merged_vertices(&self) -> usize {
        0
    }
    fn bytes(&self) -> usize {
        1 << 20
    }
    fn run(&mut self, job: &Job, series: &Series<'_>) -> TimedRun {
        let Self { operation_ns, .. } = *self;
        let (ns, operations) = match job.task {
            Task::Operation(Operation::Build) => (self.build_ns, 1),
            Task::Operation(_) => (1e6, 1),
            Task::Mix => (256.0 * operation_ns, 256),
            Task::Part(_) | Task::Program => (operation_ns, 1),
        };
        self.machine.work(ns * f64::from(series.untimed));
        let start = series.clock.now();
        self.machine.work(ns * f64::from(series.runs));
        let time = series.clock.now() - start;
        let outcome = Outcome {
            checksum: (operations * self.yield_per_operation) as f64,
            elements: operations,
            refused: 0,
        };
        TimedRun::done(time.scaled(1.0 / f64::from(series.runs)), Some(outcome))
    }
}

impl MixBackend for KnownBackend {
    fn type_paths(&self) -> Vec<&'static str> {
        vec!["sixfold_half_edge::HalfEdgeMesh"]
    }
    fn scans(&self) -> Vec<bool> {
        vec![false; self.parts]
    }
    fn accepted_places(&mut self) -> Vec<Vec<bool>> {
        Vec::new()
    }
    fn keep_places(&mut self, _: &[Vec<bool>]) {}
}

fn settings(effort: Effort) -> PickSettings {
    PickSettings {
        workload: built_in("geodesic-dijkstra").expect("a built-in workload"),
        backends: Vec::new(),
        extra: Vec::new(),
        needs: Vec::new(),
        max_memory: None,
        effort,
        confidence: Confidence::default(),
        seed: 7,
        heap: Policy::Kept,
    }
}

/// The backend with a wrong result.
const FAULTY: &str = "face-vertex";

/// Measures an indexed face set of 50 ns per operation, and mixers with `costs_ns`.
fn measure_known(costs_ns: &[f64], seed: u64) -> MeshOutcome {
    let study_mesh = StudyMesh::new("ball", shapes::icosahedron());
    let effort = Effort::of_ms(1000);
    let settings = PickSettings {
        seed,
        ..settings(effort)
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
    let prepared = |name, cost| PickBackend {
        mixer: known(name, cost),
        structure: None,
        made_from: None,
    };
    let mut backends = vec![prepared("indexed-face-set", 50.0)];
    backends.extend(
        names
            .into_iter()
            .zip(costs_ns)
            .map(|(name, &cost)| prepared(name, cost)),
    );
    let control = prepared("half-edge", costs_ns[0]);
    let stop = AtomicBool::new(false);
    let tasks = Tasks::new(&settings.workload, &schedule, &study_mesh.polygons, &counts);
    let mut bench =
        Bench::start(&machine, settings.run_settings(), 0, &stop).expect("no heap policy");
    let measurement = PickMeasurement {
        study_mesh: &study_mesh,
        plan: &tasks,
        seed: settings.seed,
        counts,
        effort,
        bench: &mut bench,
        progress: &mut |_, _| (),
    };
    let backends = backends.into_iter().map(PickBackend::split).collect();
    measurement.run(backends, Some(control.split()), Vec::new())
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
    assert!(outcome.noise().expect("a control") < 1.02);
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

/// Costs of structures of a small mesh: structures that scan take 200 times as long for a query.
fn costs(work: &Work<'_>) -> f64 {
    let query_ns = match work.backend {
        "polygon-soup" | "indexed-face-set" => 2000.0,
        "face-vertex" => 30.0,
        "relation-tables" => 8.0,
        "half-edge" => 10.0,
        _ => 20.0,
    };
    match work.task {
        Task::Mix => 256.0 * query_ns,
        Task::Part(_) | Task::Program => query_ns,
        Task::Operation(Operation::Build) => match work.backend {
            "relation-tables" => 90.0 * work.counts.faces as f64,
            _ => 60.0 * work.counts.faces as f64,
        },
        Task::Operation(_) => query_ns * work.counts.faces as f64,
    }
}

fn quick(settings: &PickSettings, meshes: &[PolygonMesh]) -> Result<PickReport, PickError> {
    quick_on(&SimulatedMachine::with_costs(costs), settings, meshes)
}

fn quick_on(
    machine: &SimulatedMachine,
    settings: &PickSettings,
    meshes: &[PolygonMesh],
) -> Result<PickReport, PickError> {
    let named = meshes.iter().enumerate();
    let study_meshes = named.map(|(i, mesh)| StudyMesh::new(format!("mesh {i}"), mesh.clone()));
    let study_meshes: Vec<StudyMesh> = study_meshes.collect();
    let stop = AtomicBool::new(false);
    pick_on(machine, &study_meshes, settings, &stop, &mut |_, _| ())
}

#[test]
fn tables_are_made_from_the_smallest_of_the_structures_that_make_them_fast() {
    // Six structures and the control are hosted first, then the tables of the structures without scans.
    for (slow, expected) in [
        (1.0, "corner-table"),
        (1.9, "corner-table"),
        (2.5, "face-vertex"),
    ] {
        let costs = move |work: &Work<'_>| match (work.task, work.place) {
            (Task::Operation(Operation::Build), 10) => slow * 50_000.0,
            (Task::Operation(Operation::Build), _) => 50_000.0,
            _ => work.usual_ns(),
        };
        for effort in [Effort::of_ms(2000), Effort::of_rounds(3)] {
            let machine = SimulatedMachine::with_costs(costs);
            let mesh = shapes::triangle_torus(12, 10).expect("a torus");
            let report = quick_on(&machine, &settings(effort), &[mesh]).expect("it has faces");
            let mut rows = report.ranking.iter();
            let tables = rows.find(|row| row.backend == "relation-tables");
            let made_from = tables.and_then(|row| row.made_from.as_deref());
            assert_eq!(made_from, Some(expected), "{slow} {effort:?}");
        }
    }
}

/// Returns the names of the ranked backends, the fastest first.
fn ranked(report: &PickReport) -> Vec<&str> {
    let ranking = report.ranking.iter();
    ranking.map(|row| row.backend.as_str()).collect()
}

#[test]
fn all_backends_are_ranked_by_their_times_on_machines_of_any_speed() {
    let torus = shapes::triangle_torus(24, 24).expect("a torus");
    for (speed, drifts) in [
        (1.0, false),
        (0.05, false),
        (30.0, false),
        (1.0, true),
        (0.05, true),
    ] {
        let machine = SimulatedMachine::with_costs(costs).at_speed(speed);
        let machine = if drifts { machine.drifting() } else { machine };
        for effort in [Effort::of_ms(2000), Effort::of_rounds(12)] {
            let report = quick_on(&machine, &settings(effort), std::slice::from_ref(&torus));
            let report = report.expect("all hold it");
            let context = format!("speed {speed}, drifts: {drifts}, {effort:?}");
            assert_eq!(report.ranking.len(), 7, "{context}: {:?}", report.ranking);
            assert!(report.excluded.is_empty());
            let names = ranked(&report);
            assert_eq!(names[..2], ["relation-tables", "half-edge"], "{context}");
            assert_eq!(names[4], "face-vertex", "{context}");
            let ratios: Vec<f64> = report.ranking.iter().map(|r| r.ratio_to_best).collect();
            assert!(ratios.is_sorted());
            assert_eq!(ratios[0], 1.0);
            assert_eq!(report.break_even.len(), 6);
            if !drifts {
                // 20 ns to 8 ns, and 30 ns to 8 ns.
                for (rank, ratio) in [(2, 2.5), (3, 2.5), (4, 3.75)] {
                    let found = ratios[rank];
                    assert!((found / ratio - 1.0).abs() < 1e-6, "{context}: {ratios:?}");
                }
            }
            let soup = report.ranking.last().expect("seven backends");
            assert!(soup.sampled && soup.ratio_to_best > 10.0, "{context}");
        }
    }
}

#[test]
fn a_mix_that_needs_edits_names_the_form_that_is_subdivided() {
    let torus = shapes::triangle_torus(12, 12).expect("a torus");
    let built_in = built_in("subdivision").expect("it is built in");
    let own = "summary = 'own'\noperations = 1\n[mix]\nloop_native = 1\nflip_edge = 1\n";
    let own = Workload::parse("own", "own.toml", own).expect("a workload");
    for (workload, needs, named) in [
        (built_in.clone(), vec![], None),
        (built_in, vec![Need::Edit], Some("(`subdivide`)")),
        (own, vec![], Some("(`loop_native`)")),
    ] {
        let settings = PickSettings {
            workload,
            needs,
            ..settings(Effort::of_rounds(6))
        };
        let report = quick(&settings, std::slice::from_ref(&torus)).expect("all hold it");
        let names_it =
            |sentence: &&String| sentence.contains("compact form of each structure is refined");
        let sentence = report.sentences.iter().find(names_it);
        assert_eq!(sentence.is_some(), named.is_some());
        assert!(
            sentence.is_none_or(|sentence| named.is_some_and(|named| sentence.contains(named)))
        );
    }
}

#[test]
fn the_report_explains_the_ranking() {
    let torus = shapes::triangle_torus(24, 24).expect("a torus");
    let report = quick(&settings(Effort::of_rounds(12)), &[torus]).expect("all hold it");
    assert!(
        report.sentences[0].contains("or geodesic-dijkstra, "),
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
    let document = Results::from(report);
    document.write_json(&mut json).expect("into memory");
    let json: serde_json::Value = serde_json::from_slice(&json).expect("it is JSON");
    let json = &json["findings"][0];
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
    assert!(json["excluded"].is_array() && json["break_even"].is_array());
}

#[test]
fn needs_and_memory_limits_exclude_backends() {
    let torus = shapes::triangle_torus(24, 24).expect("a torus");
    let with_limits = |needs: &[Need], max_memory| PickSettings {
        needs: needs.to_vec(),
        max_memory,
        ..settings(Effort::of_rounds(3))
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
        ..settings(Effort::of_rounds(3))
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
    let report = quick(&settings(Effort::of_rounds(3)), &meshes).expect("enough time");
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
    assert!(matches!(
        quick(&settings(Effort::of_rounds(3)), &[]),
        Err(PickError::NoMesh)
    ));
    let points = PolygonMesh::default();
    let message = quick(&settings(Effort::of_rounds(3)), &[points]).expect_err("no faces");
    assert!(
        matches!(message, PickError::Study(StudyError::NoFaces)),
        "{message}"
    );
    let quads = shapes::grid(20, 20).expect("a grid");
    let remeshing = PickSettings {
        workload: built_in("remeshing").expect("a built-in workload"),
        ..settings(Effort::of_rounds(3))
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
        message.contains("too small for 3 kinds of edits"),
        "{message}"
    );
}

#[test]
fn an_interrupted_measurement_keeps_its_samples() {
    let torus = shapes::triangle_torus(20, 20).expect("a torus");
    let study_mesh = [StudyMesh::new("torus", torus)];
    let stop = AtomicBool::new(false);
    let mut calls = 0;
    let report = pick_on(
        &SimulatedMachine::with_costs(costs),
        &study_mesh,
        &settings(Effort::of_ms(60_000)),
        &stop,
        &mut |_, what| {
            calls += usize::from(what.starts_with("measuring"));
            if calls > 20 {
                stop.store(true, Ordering::Relaxed);
            }
        },
    );
    let report = report.expect("the finished part");
    assert!(report.interrupted && !report.ranking.is_empty());
}

#[test]
fn each_fault_of_a_pick_has_a_warning() {
    let mut report =
        quick(&settings(Effort::of_rounds(8)), &[shapes::octahedron()]).expect("a report");
    let of_machine = sixfold_measure::pick::reasons::warnings(&report);
    assert!(
        !of_machine.iter().any(|w| w.contains("not significant")),
        "{of_machine:?}"
    );
    report.noise = Some(1.2);
    report.preliminary = true;
    report.mismatches = vec!["half-edge".into()];
    let warnings = sixfold_measure::pick::reasons::warnings(&report);
    let added = &warnings[of_machine.len()..];
    assert_eq!(added.len(), 3, "{added:?}");
    for (warning, part) in added
        .iter()
        .zip(["by 20 %", "only 8 samples", "half-edge gives"])
    {
        assert!(warning.contains(part), "{warning}");
    }
}

#[test]
fn the_figures_of_a_pick_are_its_times() {
    let report = quick(&settings(Effort::of_rounds(3)), &[shapes::octahedron()]).expect("a report");
    let figures = report.figures();
    let mut figures = figures.iter();
    for ranked in &report.ranking {
        let mix = figures.next().expect("the mix");
        assert_eq!(mix.row.case, report.workload.name);
        assert_eq!(mix.row.operation, "mix");
        assert_eq!(mix.row.median_ns, Some(ranked.ns_per_operation));
        assert_eq!(mix.row.samples, 3);
        let rounds = mix.samples.map(|samples| samples.rounds.len());
        // The samples of a mix on some of the elements are those of its parts.
        let expected = (!ranked.sampled).then_some(3);
        assert_eq!(rounds, expected, "{}", ranked.backend);
        for part in ranked.parts.iter().filter(|part| part.ns.is_some()) {
            let figure = figures.next().expect("a part");
            assert_eq!(figure.row.operation, part.operation.to_string());
            assert_eq!(figure.row.median_ns, part.ns);
        }
        let build = figures.next().expect("the build");
        assert_eq!(build.row.operation, "build");
        assert_eq!(build.row.median_ns, Some(ranked.build_ns));
        assert_eq!(build.row.case, report.workload.name);
    }
    assert!(figures.next().is_none());
}

#[test]
fn a_run_has_the_settings_of_its_pick() {
    let settings = PickSettings {
        backends: vec!["half-edge".into()],
        confidence: "99%".parse().expect("allowed"),
        seed: 9,
        heap: Policy::System,
        ..settings(Effort::of_rounds(3))
    };
    let expected = RunSettings {
        backends: vec!["half-edge".into()],
        confidence: "99%".parse().expect("allowed"),
        seed: 9,
        heap: Policy::System,
        ..Effort::of_rounds(3).run_settings()
    };
    assert_eq!(settings.run_settings(), expected);
}

#[test]
fn a_launch_with_cold_caches_counts_only_without_better_ones() {
    let settings = settings(Effort::of_rounds(3));
    let measured = quick(&settings, &[shapes::octahedron()]).expect("a report");
    let launch = |ns: f64, cold: bool| {
        let mut launch = measured.clone();
        for ranked in &mut launch.ranking {
            (ranked.ns_per_operation, ranked.warm_up_only) = (ns, cold);
        }
        launch
    };
    let pooled = |launches: [PickReport; 3]| {
        sixfold_measure::pick::pool_picks(launches.into()).ranking[0].clone()
    };
    let warm = pooled([launch(10.0, false), launch(12.0, false), launch(99.0, true)]);
    assert_eq!(warm.launch_ns, [Some(10.0), Some(12.0), None]);
    assert!(!warm.warm_up_only && !measured.ranking[0].warm_up_only);
    let cold = pooled([launch(10.0, false), launch(12.0, true), launch(99.0, true)]);
    assert_eq!(cold.launch_ns, [Some(10.0), Some(12.0), Some(99.0)]);
    let only_cold = pooled([launch(10.0, true), launch(12.0, true), launch(99.0, true)]);
    assert!(only_cold.warm_up_only);
}

/// Returns the result of a measurement in which only a lower bound of half the fastest time is known
/// of the winged-edge mesh.
fn with_a_bound() -> MeshOutcome {
    let mut outcome = measure_known(&[10.0, 20.0, 30.0, 40.0], 3);
    let best_ns = outcome.ranking[0].ns_per_operation;
    let bound = outcome
        .ranking
        .iter_mut()
        .find(|r| r.backend == "winged-edge");
    let bound = bound.expect("it is ranked");
    *bound = Ranked {
        ns_per_operation: 0.5 * best_ns,
        ratio_to_best: 0.5,
        ci_low: None,
        ci_high: None,
        tied_with_best: false,
        estimated: true,
        ..bound.clone()
    };
    outcome.ranking.sort_by(Ranked::measured_first);
    outcome
}

#[test]
fn a_lower_bound_below_a_measured_time_is_not_ranked_before_it() {
    let report_on = |outcomes| {
        let settings = settings(Effort::of_ms(1000));
        let measured = quick(&settings, &[shapes::octahedron()]).expect("a report");
        let question = pooled::Question {
            workload: settings.workload.report(),
            program: None,
            needs: Vec::new(),
            max_memory: None,
            excluded: Vec::new(),
        };
        pooled::pooled(outcomes, question, measured.timer, measured.run, false)
    };
    let report = report_on(vec![with_a_bound()]);
    let bound = report.ranking.last().expect("five backends").clone();
    assert_eq!(
        (bound.backend.as_str(), bound.ratio_to_best),
        ("winged-edge", 0.5)
    );
    let choice = report.choice.as_ref().expect("the others are measured");
    assert_eq!(choice.backend, "half-edge");
    assert!(choice.equally_fast.is_empty(), "{choice:?}");
    let said = report.sentences.join("\n");
    assert!(
        said.contains("Not ranked, because a run would exceed the budget: winged-edge (≥ 0.49"),
        "{said}"
    );
    assert!(!said.contains("winged-edge takes"), "{said}");
    // In tables, the bound is not a measured time, and has no ratio.
    let figures = report.figures();
    let mix = figures.iter().find(|f| f.row.backend == "winged-edge");
    let mix = mix.expect("a figure of the bound");
    assert_eq!(mix.status, Status::Estimated);
    assert_eq!((mix.row.median_ns, mix.row.ratio_to_best), (None, None));
    assert_eq!(mix.row.estimated_ns, Some(bound.ns_per_operation));
    // A mean over several meshes with the bound is not ranked either.
    let several = report_on(vec![
        with_a_bound(),
        measure_known(&[10.0, 20.0, 30.0, 40.0], 4),
    ]);
    let last = several.ranking.last().expect("five backends");
    assert_eq!(last.backend, "winged-edge");
    assert!(last.estimated && !last.tied_with_best && last.ci_low.is_none());
    // The root of 0.5 and 2.
    assert!((last.ratio_to_best - 1.0).abs() < 0.01, "{last:?}");
    assert_eq!(several.choice.expect("measured").backend, "half-edge");
    // If only bounds are known, nothing is chosen.
    let mut none = with_a_bound();
    none.ranking.drain(..4);
    let none = report_on(vec![none]);
    assert_eq!((none.choice, none.ranking.len()), (None, 1));
    assert!(
        none.sentences[0].starts_with("No backend was measured"),
        "{:?}",
        none.sentences
    );
}
