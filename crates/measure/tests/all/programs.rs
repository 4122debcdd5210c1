//! Tests of programs of users on all structures.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use sixfold::prelude::*;
use sixfold::{Split, shapes};
use sixfold_measure::{
    EditProgram, Effort, MeasureError, MovingProgram, Outcome, Program, ProgramSettings,
    RefineProgram, StudyMesh, Suite, WalkProgram, pick_for_programs,
};
use sixfold_results::{PickReport, Results};

fn measure_with(suite: &Suite, mesh: StudyMesh, settings: &ProgramSettings) -> Vec<PickReport> {
    let stop = AtomicBool::new(false);
    let reports = pick_for_programs(&[mesh], suite, settings, &stop, &mut |_, _| (), &mut |_| ());
    reports.expect("a mesh with faces")
}

fn measure(suite: &Suite) -> Vec<PickReport> {
    measure_with(suite, torus(), &settings())
}

fn torus() -> StudyMesh {
    let torus = shapes::triangle_torus(12, 12).expect("a torus");
    StudyMesh::new("torus", torus)
}

fn settings() -> ProgramSettings {
    ProgramSettings {
        effort: Effort::Rounds(NonZeroU32::MIN),
        ..ProgramSettings::default()
    }
}

/// A program that is a function of a few properties of the structure.
struct Asks {
    name: &'static str,
    what: fn(&Answers) -> Outcome,
}

/// What [`Asks`] computes on a structure.
struct Answers {
    /// The sum of all indices of neighbours.
    neighbours: f64,
    count: u64,
    /// True on the half-edge structure, also while a run is recorded.
    on_half_edge: bool,
}

impl Program for Asks {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        self.name
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let mut count = 0;
        let lengths = mesh.vertices().map(|v| {
            let lengths = mesh.vertex_vertices(v).map(|w| {
                count += 1;
                f64::from(mesh.position(v).distance(mesh.position(w)))
            });
            lengths.sum::<f64>()
        });
        let neighbours = lengths.sum();
        (self.what)(&Answers {
            neighbours,
            count,
            on_half_edge: std::any::type_name::<M>().contains("HalfEdge"),
        })
    }
}

const RIGHT: Asks = Asks {
    name: "right",
    what: |answers| Outcome::new(answers.neighbours, answers.count),
};

fn names<'r>(rows: impl IntoIterator<Item = &'r String>) -> Vec<&'r str> {
    let mut names: Vec<&str> = rows.into_iter().map(String::as_str).collect();
    names.sort_unstable();
    names
}

#[test]
fn a_program_runs_on_all_structures_and_its_questions_are_counted() {
    let reports = measure(&Suite::from(RIGHT));
    let [report] = &reports[..] else {
        panic!("one report for each program");
    };
    let ranked = names(report.ranking.iter().map(|ranked| &ranked.backend));
    let all = [
        "corner-table",
        "face-vertex",
        "half-edge",
        "indexed-face-set",
        "polygon-soup",
        "relation-tables",
        "winged-edge",
    ];
    assert_eq!(ranked, all);
    assert_eq!(report.mismatches, Vec::<String>::new());
    assert!(report.choice.is_some());
    assert!(report.ranking.iter().all(|ranked| ranked.build_ns > 0.0));
    let program = report.program.as_ref().expect("a program");
    assert_eq!(program.kind, "queries");
    let asked = program.asked.as_ref().expect("recorded");
    let asked: Vec<(&str, u64)> = asked
        .iter()
        .map(|asked| (asked.operation.as_str(), asked.count))
        .collect();
    // 144 vertices with 6 neighbours each, and two positions for each neighbour.
    assert_eq!(asked, [("position", 1728), ("vertex_vertices", 144)]);
    assert!(
        report.sentences.iter().any(|s| s.contains("per run")),
        "{:?}",
        report.sentences
    );
}

#[test]
fn the_report_of_a_program_is_written_and_read() {
    let report = measure(&Suite::from(RIGHT)).remove(0);
    let document = Results::from(report.clone());
    let mut json = Vec::new();
    document.write_json(&mut json).expect("into memory");
    let text = String::from_utf8(json).expect("JSON is UTF-8");
    let read = Results::read_json(&text).expect("a document");
    let again = read.picks().next().expect("a finding");
    assert_eq!(again.program, report.program);
    let mut csv = Vec::new();
    document.write_csv(&mut csv).expect("into memory");
    let csv = String::from_utf8(csv).expect("CSV is UTF-8");
    assert!(csv.contains("right"), "{csv}");
    assert_eq!(
        csv.lines().filter(|line| line.contains(",run,")).count(),
        7,
        "{csv}"
    );
}

#[test]
fn a_structure_with_another_result_is_named() {
    let departs = Asks {
        name: "departs",
        what: |answers| {
            let error = if answers.on_half_edge { 0.1 } else { 0.0 };
            Outcome::new(answers.neighbours * (1.0 + error), answers.count)
        },
    };
    let report = measure(&Suite::from(departs)).remove(0);
    assert_eq!(report.mismatches, ["half-edge"]);
    let first = &report.warnings[0];
    assert!(first.starts_with("The results on torus differ"), "{first}");
    assert!(
        first.ends_with("; half-edge agrees with no other."),
        "{first}"
    );
    let answer = &report.sentences[0];
    assert!(answer.starts_with("The results differ"), "{answer}");
    assert!(!answer.contains("clearly"), "{answer}");
}

#[test]
fn faults_of_a_program_exclude_the_structure_with_the_reason() {
    let panics = Asks {
        name: "panics",
        what: |answers| match answers.on_half_edge {
            true => panic!("no such side"),
            false => Outcome::new(answers.neighbours, answers.count),
        },
    };
    let not_a_number = Asks {
        name: "nan",
        what: |answers| Outcome::new(f64::NAN, answers.count),
    };
    let idle = Asks {
        name: "idle",
        what: |answers| Outcome::new(answers.neighbours, 0),
    };
    let suite = Suite::new()
        .program(panics)
        .program(not_a_number)
        .program(idle);
    let reports = measure(&suite);
    let reasons = |report: &PickReport| -> Vec<String> {
        report.excluded.iter().map(|e| e.reason.clone()).collect()
    };
    let [panics, not_a_number, idle] = &reports[..] else {
        panic!("three reports");
    };
    assert_eq!(panics.ranking.len(), 6);
    let [reason] = &reasons(panics)[..] else {
        panic!("one: {:?}", panics.excluded)
    };
    let message = "the program panicked: no such side (at crates/measure/tests/all/programs.rs:";
    assert!(reason.starts_with(message), "{reason}");
    assert_eq!(panics.excluded[0].backend, "half-edge");
    for (report, reason) in [
        (not_a_number, "the checksum of the program is NaN"),
        (idle, "no work"),
    ] {
        assert!(report.ranking.is_empty());
        assert_eq!(report.choice, None);
        let reasons = reasons(report);
        assert_eq!(reasons.len(), 7, "six structures and tables: {reasons:?}");
        assert!(reasons.iter().all(|r| r.contains(reason)), "{reasons:?}");
        assert!(report.excluded.iter().all(|e| e.failed));
    }
}

/// Counts the vertices.
struct CountsVertices;

impl Program for CountsVertices {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "counts-vertices"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let count = mesh.vertices().count() as u64;
        Outcome::new(count as f64, count)
    }
}

#[test]
fn a_structure_that_merges_vertices_is_not_accused_of_another_result() {
    let corners = [
        Point::ZERO,
        Point::X,
        Point::Y,
        Point::ZERO,
        Point::Z,
        Point::NEG_X,
    ];
    let faces = PolygonMesh::new(corners.to_vec(), [[0, 1, 2], [3, 4, 5]]).expect("valid");
    let mesh = StudyMesh::new("touching", faces);
    let reports = measure_with(&Suite::from(CountsVertices), mesh, &settings());
    let [report] = &reports[..] else {
        panic!("one report")
    };
    let soup = report.ranking.iter().find(|r| r.backend == "polygon-soup");
    assert_eq!(soup.and_then(|soup| soup.result), Some(5.0), "merged");
    assert_eq!(report.mismatches, Vec::<String>::new());
}

/// Adds to what the run before left in the scratch data.
struct AddsUp;

impl Program for AddsUp {
    type Scratch<M: MeshQuery> = f64;

    fn name(&self) -> &str {
        "adds-up"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<f64, String> {
        Ok(0.0)
    }

    fn run<M: MeshQuery>(&self, mesh: &M, sum: &mut f64) -> Outcome {
        *sum += mesh.vertex_count() as f64;
        Outcome::new(*sum, 1)
    }
}

/// Draws another number in each run: the number of runs.
struct Draws(AtomicU64);

impl EditProgram for Draws {
    type Scratch<M: MeshEdit> = ();

    fn name(&self) -> &str {
        "draws"
    }

    fn set_up<M: MeshEdit>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshEdit>(&self, mesh: &mut M, (): &mut ()) -> Outcome {
        let drawn = self.0.fetch_add(1, Ordering::Relaxed);
        Outcome::new(mesh.face_count() as f64, 1 + drawn)
    }
}

#[test]
fn a_result_that_changes_from_run_to_run_is_a_failure() {
    let suite = Suite::new()
        .program(AddsUp)
        .edit_program(Draws(AtomicU64::new(0)));
    for report in measure(&suite) {
        assert_eq!(report.choice, None);
        assert!(report.excluded.len() >= 6, "{:?}", report.excluded);
        for excluded in &report.excluded {
            assert!(excluded.failed, "{excluded:?}");
            let reason = &excluded.reason;
            let message = "the result of the program changes from run to run: ";
            assert!(reason.starts_with(message), "{reason}");
        }
    }
}

/// Refuses every mesh.
struct Refuses;

impl Program for Refuses {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        "refuses"
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Err("the face 3 is too small".into())
    }

    fn run<M: MeshQuery>(&self, _: &M, (): &mut ()) -> Outcome {
        unreachable!("the set-up refuses")
    }
}

#[test]
fn refusals_and_limits_are_reasons() {
    let refused = measure(&Suite::from(Refuses)).remove(0);
    assert!(refused.ranking.is_empty());
    let reason = "the program refuses the mesh: the face 3 is too small";
    assert!(
        refused
            .excluded
            .iter()
            .all(|e| e.reason == reason && !e.failed),
        "{:?}",
        refused.excluded
    );

    let small = ProgramSettings {
        max_memory: Some(8_000),
        ..settings()
    };
    let report = measure_with(&Suite::from(RIGHT), torus(), &small).remove(0);
    let excluded = names(report.excluded.iter().map(|e| &e.backend));
    assert_eq!(excluded.len() + report.ranking.len(), 7);
    assert!(excluded.contains(&"winged-edge"), "{:?}", report.excluded);
    assert!(report.ranking.iter().all(|ranked| ranked.bytes <= 8_000));

    let open = shapes::triangle_torus(4, 4).expect("a torus");
    let unknown = ProgramSettings {
        backends: vec!["octree".into()],
        ..settings()
    };
    let stop = AtomicBool::new(false);
    let suite = Suite::from(RIGHT);
    let mesh = [StudyMesh::new("small", open)];
    let error = pick_for_programs(&mesh, &suite, &unknown, &stop, &mut |_, _| (), &mut |_| ());
    assert!(error.unwrap_err().to_string().contains("octree"));
    let error = pick_for_programs(&[], &suite, &settings(), &stop, &mut |_, _| (), &mut |_| ());
    assert_eq!(error.unwrap_err(), MeasureError::NoMesh);
}

/// Collapses the first edge that can be collapsed.
struct CollapsesOne;

impl EditProgram for CollapsesOne {
    type Scratch<M: MeshEdit> = ();

    fn name(&self) -> &str {
        "collapses-one"
    }

    fn set_up<M: MeshEdit>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshEdit>(&self, mesh: &mut M, (): &mut ()) -> Outcome {
        let edges: Vec<M::Edge> = mesh.edges().collect();
        for e in edges {
            let [keep, _] = mesh.edge_vertices(e);
            let to = mesh.position(keep);
            if mesh.collapse_edge(e, keep, to).is_ok() {
                break;
            }
        }
        Outcome::new(mesh.face_count() as f64, 1)
    }
}

/// Moves all vertices by one unit.
struct Moves;

impl MovingProgram for Moves {
    type Scratch<M: Representation> = VertexMap<M, Point>;

    fn name(&self) -> &str {
        "moves"
    }

    fn set_up<M: Representation>(&self, mesh: &M) -> Result<VertexMap<M, Point>, String> {
        Ok(mesh.vertex_map(Point::ZERO))
    }

    fn run<M: Representation>(&self, mesh: &mut M, to: &mut VertexMap<M, Point>) -> Outcome {
        for v in mesh.vertices() {
            to[v] = mesh.position(v) + Point::X;
        }
        let moved = mesh.set_positions(to).is_ok();
        let sum = mesh.vertices().map(|v| f64::from(mesh.position(v).x));
        Outcome::new(sum.sum(), u64::from(moved))
    }
}

/// Counts the sides with a twin.
struct Walks;

impl WalkProgram for Walks {
    type Scratch<M: OrientedWalk> = ();

    fn name(&self) -> &str {
        "walks"
    }

    fn set_up<M: OrientedWalk>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: OrientedWalk>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let twins = mesh
            .sides()
            .filter(|&s| mesh.twin_side(s).is_some())
            .count();
        Outcome::new(twins as f64, twins as u64)
    }
}

/// Counts the edges by their numbers.
struct Refines;

impl RefineProgram for Refines {
    type Scratch<M: Refine> = M::EdgeNumbers;

    fn name(&self) -> &str {
        "refines"
    }

    fn set_up<M: Refine>(&self, _: &M) -> Result<M::EdgeNumbers, String> {
        Ok(M::EdgeNumbers::default())
    }

    fn run<M: Refine>(&self, mesh: &M, numbers: &mut M::EdgeNumbers) -> Outcome {
        mesh.number_edges(numbers);
        let mut child = M::empty();
        let split = mesh.split_into(Split::Quads, numbers, &mut child);
        Outcome::new(child.face_count() as f64, u64::from(split.is_ok()))
    }
}

#[test]
fn each_kind_of_program_runs_on_the_structures_that_have_what_it_needs() {
    let suite = Suite::new()
        .edit_program(CollapsesOne)
        .moving_program(Moves)
        .walk_program(Walks)
        .refine_program(Refines);
    let reports = measure(&suite);
    let ranked = |report: &PickReport| report.ranking.len();
    let [edits, moves, walks, refines] = &reports[..] else {
        panic!("four reports");
    };
    for report in &reports {
        assert_eq!(
            report.mismatches,
            Vec::<String>::new(),
            "{}",
            report.workload.name
        );
    }
    assert_eq!([ranked(edits), ranked(moves), ranked(walks)], [6, 6, 4]);
    // A corner table holds only triangles, so it does not split into quads.
    assert_eq!(ranked(refines), 3, "{:?}", refines.excluded);
    let asked = |report: &PickReport, name: &str| {
        let program = report.program.as_ref()?;
        let asked = program.asked.as_ref()?.iter().find(|a| a.operation == name);
        asked.map(|asked| asked.count)
    };
    assert_eq!(asked(edits, "collapse_edge"), Some(1));
    // 288 triangles with three sides each.
    assert_eq!(asked(walks, "side_step"), Some(864));
    assert_eq!(asked(moves, "position"), Some(288));
    assert_eq!(asked(refines, "position"), None);
}
