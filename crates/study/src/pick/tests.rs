//! Measurements of mixers with known costs, on a machine whose speed drifts.

use sixfold::{PolygonMesh, shapes};
use sixfold_workload::pages::Policy;
use sixfold_workload::{MixRun, Mixer, Operation, Run, Sample, Series, Time, built_in};

use super::*;
use crate::disturbed::Machine;
use crate::pick::contest::Outcome;

/// A mixer with a known time for each operation and a known building time.
struct Known {
    name: &'static str,
    machine: Machine,
    operation_ns: f64,
    build_ns: f64,
    parts: usize,
    /// What it yields per operation: 1, if it agrees with the others.
    yields: u64,
}

impl Known {
    fn time(&self, ns: f64, clock: &dyn sixfold_workload::Clock) -> Time {
        let start = clock.now();
        self.machine.work(ns);
        clock.now() - start
    }
}

impl Mixer for Known {
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
            yielded: operations * self.yields,
            refused: 0,
        }
    }
    fn cycle(&self, _: usize) -> u64 {
        1000
    }
    fn run_pass(&mut self, _: Operation, _: Option<Sample>, series: &Series<'_>) -> Run {
        Run::done(self.time(1e6, series.clock), None)
    }
    fn accepted(&mut self) -> Vec<Vec<bool>> {
        Vec::new()
    }
    fn keep(&mut self, _: &[Vec<bool>]) {}
    fn build(&self, series: &Series<'_>) -> Time {
        let untimed = series.untimed;
        (0..untimed).for_each(|_| self.machine.work(self.build_ns));
        self.time(self.build_ns, series.clock)
    }
}

fn question(budget: Duration) -> Question {
    Question {
        workload: built_in("geodesic-dijkstra").expect("a built-in workload"),
        backends: Vec::new(),
        needs: Vec::new(),
        max_memory: None,
        budget,
        seed: 7,
        heap: Policy::Kept,
    }
}

/// The backend whose results differ from the others.
const FAULTY: &str = "face-vertex";

/// Measures an indexed face set of 50 ns per operation, and mixers of these costs.
fn contest(costs_ns: &[f64], seed: u64) -> Outcome {
    let specimen = Specimen::new("ball", shapes::icosahedron());
    let budget = Duration::from_secs(1);
    let question = Question {
        seed,
        ..question(budget)
    };
    let counts = specimen.polygons.counts(specimen.facts.edges);
    let script = Script::of(&question.workload, &counts);
    let machine = Machine::default();
    let names = ["half-edge", "winged-edge", "corner-table", "face-vertex"];
    let known = |name, operation_ns| {
        let machine = machine.clone();
        Box::new(Known {
            name,
            machine,
            operation_ns,
            build_ns: 40e3,
            parts: script.parts.len(),
            yields: if name == FAULTY { 2 } else { 1 },
        })
    };
    let mut entrants: Vec<Entrant<'_>> = vec![Entrant::of(known("indexed-face-set", 50.0))];
    for (name, &cost) in names.into_iter().zip(costs_ns) {
        entrants.push(Entrant::of(known(name, cost)));
    }
    entrants.push(Entrant::control(known("half-edge", costs_ns[0])));
    let stop = AtomicBool::new(false);
    let contest = Contest {
        specimen: &specimen,
        question: &question,
        counts,
        script: &script,
        budget,
        clock: &machine,
        memory: &mut Memory::start(Policy::Kept, CacheState::Warm, 0),
        stop: &stop,
        progress: &mut |_, _| (),
    };
    contest.held(entrants, Vec::new()).expect("enough time")
}

#[test]
fn known_ratios_are_found_on_a_drifting_machine() {
    let outcome = contest(&[10.0, 10.5, 12.5, 10.0], 1);
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
    let outcome = contest(&[10.0, 60.0], 1);
    let row = |name: &str| outcome.break_even.iter().find(|row| row.backend == name);
    // 40 µs divided by 40 ns per operation; the machine drifts between building and running.
    let pays = row("half-edge")
        .and_then(|row| row.operations)
        .expect("it pays");
    assert!((700.0..1400.0).contains(&pays), "{pays}");
    let never = row("winged-edge").expect("it took part");
    assert_eq!(never.operations, None);
    assert!(never.saves_ns_per_operation < 0.0);
    assert!(row("indexed-face-set").is_none(), "it need not be built");
}

/// The 95 % interval contains a known ratio in about 19 of 20 measurements, on a drifting machine.
#[test]
fn intervals_cover_a_known_ratio() {
    let mut covered = 0;
    for seed in 0..40 {
        let outcome = contest(&[10.0, 13.0], seed);
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

fn quick(question: &Question, meshes: &[PolygonMesh]) -> Result<Answer, PickError> {
    let named = meshes.iter().enumerate();
    let specimens = named.map(|(i, mesh)| Specimen::new(format!("mesh {i}"), mesh.clone()));
    let specimens: Vec<Specimen> = specimens.collect();
    pick(
        &specimens,
        question,
        &AtomicBool::new(false),
        &mut |_, _| (),
    )
}

#[test]
fn a_real_measurement_ranks_all_backends_with_reasons() {
    let torus = shapes::triangle_torus(24, 24).expect("a torus");
    let answer = quick(&question(Duration::from_secs(2)), &[torus]).expect("enough time");
    assert_eq!(answer.ranking.len(), 7, "{:?}", answer.ranking);
    assert!(answer.excluded.is_empty());
    let times = answer.ranking.iter().map(|row| row.ns_per_operation);
    assert!(times.is_sorted());
    assert_eq!(answer.ranking[0].ratio_to_best, 1.0);
    assert_eq!(answer.break_even.len(), 6);
    let soup = answer.ranking.last().expect("seven backends");
    assert!(soup.sampled && soup.ratio_to_best > 10.0);
    assert!(
        answer.words[0].starts_with("For geodesic-dijkstra, "),
        "{:?}",
        answer.words
    );
    assert!(
        answer
            .words
            .iter()
            .any(|words| words.contains("% of the time"))
    );
    let mut json = Vec::new();
    answer.write_json(&mut json).expect("into memory");
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
    let asked = |needs: &[Need], max_memory| Question {
        needs: needs.to_vec(),
        max_memory,
        ..question(Duration::from_secs(1))
    };
    let answer = quick(
        &asked(&[Need::Edit, Need::NonManifold], None),
        std::slice::from_ref(&torus),
    );
    let answer = answer.expect("enough time");
    let mut names: Vec<&str> = answer
        .ranking
        .iter()
        .map(|row| row.backend.as_str())
        .collect();
    names.sort_unstable();
    assert_eq!(names, ["face-vertex", "indexed-face-set", "polygon-soup"]);
    assert_eq!(answer.excluded.len(), 4, "{:?}", answer.excluded);
    // The smallest structure takes nine words per vertex.
    let vertices = torus.vertex_count() as u64;
    let answer = quick(
        &asked(&[], Some(36 * vertices)),
        std::slice::from_ref(&torus),
    )
    .expect("an answer");
    assert!(
        answer
            .ranking
            .iter()
            .all(|row| row.bytes as u64 <= 36 * vertices)
    );
    assert!(
        answer
            .excluded
            .iter()
            .any(|out| out.reason.contains("--max-memory"))
    );
    let answer = quick(&asked(&[], Some(10)), &[torus]).expect("an answer");
    assert!(answer.ranking.is_empty());
    assert_eq!(answer.words, ["No backend qualifies."]);
}

#[test]
fn edits_are_done_by_all_at_the_same_places() {
    let torus = shapes::triangle_torus(30, 30).expect("a torus");
    let question = Question {
        workload: built_in("remeshing").expect("a built-in workload"),
        ..question(Duration::from_secs(3))
    };
    let answer = quick(&question, &[torus]).expect("enough time");
    let names: Vec<&str> = answer
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
    let answer = quick(&question(Duration::from_secs(3)), &meshes).expect("enough time");
    assert_eq!(answer.by_mesh.len(), 3);
    assert!(
        answer
            .ranking
            .iter()
            .all(|row| row.backend != "corner-table")
    );
    let out = answer
        .excluded
        .iter()
        .find(|out| out.backend == "corner-table")
        .expect("it holds triangles only");
    assert!(out.reason.starts_with("mesh 2: "), "{}", out.reason);
    assert_eq!(answer.ranking[0].ratio_to_best, 1.0);
}

#[test]
fn invalid_questions_are_refused() {
    let torus = shapes::triangle_torus(20, 20).expect("a torus");
    let nothing = quick(
        &question(Duration::from_nanos(1)),
        std::slice::from_ref(&torus),
    );
    let said = nothing.expect_err("no time at all").to_string();
    assert!(
        said.contains("too small to measure anything") && said.contains("--budget"),
        "{said}"
    );
    assert!(matches!(
        quick(&question(Duration::from_secs(1)), &[]),
        Err(PickError::NoMesh)
    ));
    let points = PolygonMesh::default();
    let said = quick(&question(Duration::from_secs(1)), &[points]).expect_err("no faces");
    assert!(
        matches!(said, PickError::Study(StudyError::NoFaces)),
        "{said}"
    );
    let quads = shapes::grid(20, 20).expect("a grid");
    let remeshing = Question {
        workload: built_in("remeshing").expect("a built-in workload"),
        ..question(Duration::from_secs(1))
    };
    let said = quick(&remeshing, &[quads]).expect_err("quads").to_string();
    assert!(said.contains("mesh 0: face f0 has 4 corners"), "{said}");
    let said = quick(&remeshing, &[shapes::tetrahedron()])
        .expect_err("tiny")
        .to_string();
    assert!(said.contains("no room for 3 kinds of edits"), "{said}");
}

#[test]
fn an_interrupted_measurement_keeps_its_samples() {
    let torus = shapes::triangle_torus(20, 20).expect("a torus");
    let specimen = [Specimen::new("torus", torus)];
    let stop = AtomicBool::new(false);
    let mut heard = 0;
    let answer = pick(
        &specimen,
        &question(Duration::from_secs(60)),
        &stop,
        &mut |_, what| {
            heard += usize::from(what.starts_with("round"));
            if heard > 20 {
                stop.store(true, Ordering::Relaxed);
            }
        },
    );
    let answer = answer.expect("the finished part");
    assert!(answer.interrupted && !answer.ranking.is_empty());
}
