//! Programs on machines whose time passes as the tests say.

use crate::{Outcome, Program};
use sixfold::prelude::*;
use sixfold::{
    BuildError, Capabilities, FaceId, InvariantError, MemoryFootprint, MoveError, Relation,
    VertexId, shapes,
};

use super::*;
use crate::engine::simulated_machine::{SimulatedMachine, Work};
use crate::pick::recording::record_program_on;

/// A face-vertex mesh whose queries take time on [`MACHINE`]: 10 ns, but 400 ns for the faces at a
/// face if `SLOW`.
#[derive(Clone)]
struct Ticking<const SLOW: bool>(FaceVertexMesh);

thread_local! {
    /// The machine on which the queries of [`Ticking`] take time.
    static MACHINE: SimulatedMachine = SimulatedMachine::steady();
}

fn tick(ns: f64) {
    MACHINE.with(|machine| machine.work(ns));
}

/// Passes the queries of relations on.
macro_rules! same {
    ($($name:ident($from:ident) -> $to:ident;)+) => {
        $(fn $name(&self, of: Self::$from) -> impl Iterator<Item = Self::$to> {
            tick(10.0);
            self.0.$name(of)
        })+
    };
}

impl<const SLOW: bool> MeshQuery for Ticking<SLOW> {
    type Vertex = <FaceVertexMesh as MeshQuery>::Vertex;
    type Edge = <FaceVertexMesh as MeshQuery>::Edge;
    type Face = <FaceVertexMesh as MeshQuery>::Face;

    const CAPABILITIES: Capabilities = FaceVertexMesh::CAPABILITIES;

    fn vertices(&self) -> impl Iterator<Item = Self::Vertex> {
        self.0.vertices()
    }
    fn edges(&self) -> impl Iterator<Item = Self::Edge> {
        self.0.edges()
    }
    fn faces(&self) -> impl Iterator<Item = Self::Face> {
        self.0.faces()
    }
    fn face_count(&self) -> usize {
        self.0.face_count()
    }
    fn position(&self, v: Self::Vertex) -> Point {
        self.0.position(v)
    }
    same! {
        vertex_vertices(Vertex) -> Vertex;
        vertex_edges(Vertex) -> Edge;
        vertex_faces(Vertex) -> Face;
        edge_edges(Edge) -> Edge;
        edge_faces(Edge) -> Face;
        face_vertices(Face) -> Vertex;
        face_edges(Face) -> Edge;
    }
    fn edge_vertices(&self, e: Self::Edge) -> [Self::Vertex; 2] {
        self.0.edge_vertices(e)
    }
    fn face_faces(&self, f: Self::Face) -> impl Iterator<Item = Self::Face> {
        tick(if SLOW { 400.0 } else { 10.0 });
        self.0.face_faces(f)
    }
    fn vertex_rows(&self) -> usize {
        self.0.vertex_rows()
    }
    fn edge_rows(&self) -> usize {
        self.0.edge_rows()
    }
    fn face_rows(&self) -> usize {
        self.0.face_rows()
    }
}

impl<const SLOW: bool> Representation for Ticking<SLOW> {
    const NAME: &'static str = if SLOW { "slow-face-faces" } else { "steady" };
    const COSTS: [QueryCost; 9] = FaceVertexMesh::COSTS;

    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError> {
        tick(10.0 * polygons.face_count() as f64);
        FaceVertexMesh::from_polygons(polygons).map(Self)
    }
    fn to_polygons(&self) -> PolygonMesh {
        self.0.to_polygons()
    }
    fn vertex_handle(polygons: &PolygonMesh, v: VertexId) -> Self::Vertex {
        FaceVertexMesh::vertex_handle(polygons, v)
    }
    fn face_handle(polygons: &PolygonMesh, f: FaceId) -> Self::Face {
        FaceVertexMesh::face_handle(polygons, f)
    }
    fn memory(&self) -> MemoryFootprint {
        self.0.memory()
    }
    fn validate(&self) -> Result<(), InvariantError> {
        self.0.validate()
    }
}

impl<const SLOW: bool> MeshMove for Ticking<SLOW> {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        _: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        self.0.set_positions(positions)
    }
}

/// Queries one relation of every element.
#[derive(Clone, Copy)]
struct Queries(Relation);

impl Program for Queries {
    type Scratch<M: MeshQuery> = ();

    fn name(&self) -> &str {
        self.0.name()
    }

    fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
        Ok(())
    }

    fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
        let results: usize = match self.0 {
            Relation::VertexVertices => mesh
                .vertices()
                .map(|v| mesh.vertex_vertices(v).count())
                .sum(),
            Relation::FaceVertices => mesh.faces().map(|f| mesh.face_vertices(f).count()).sum(),
            Relation::FaceFaces => mesh.faces().map(|f| mesh.face_faces(f).count()).sum(),
            _ => mesh.edges().map(|e| mesh.edge_faces(e).count()).sum(),
        };
        Outcome::new(results as f64, results as u64)
    }
}

/// Measures queries of four relations on both structures.
fn measure(effort: Effort) -> Vec<(Relation, PickReport)> {
    let relations = [
        Relation::VertexVertices,
        Relation::FaceVertices,
        Relation::FaceFaces,
        Relation::EdgeFaces,
    ];
    let suite = relations.iter().fold(Suite::new(), |suite, &relation| {
        suite
            .program(Queries(relation))
            .on_structure::<_, Ticking<true>>(Queries(relation))
            .on_structure::<_, Ticking<false>>(Queries(relation))
    });
    let torus = shapes::triangle_torus(10, 8).expect("small");
    let settings = ProgramSettings {
        backends: ["steady", "slow-face-faces"].map(str::to_owned).to_vec(),
        effort,
        ..ProgramSettings::default()
    };
    let meshes = [StudyMesh::new("torus", torus)];
    let stop = AtomicBool::new(false);
    let reports = pick_for_programs_on(
        &MACHINE.with(SimulatedMachine::clone),
        &meshes,
        &suite,
        &settings,
        &stop,
        &mut |_, _| (),
        &mut |_| (),
    );
    let reports = reports.expect("a mesh with faces");
    assert_eq!(reports.len(), relations.len());
    relations.into_iter().zip(reports).collect()
}

#[test]
fn a_planted_slow_relation_loses_the_programs_that_query_it() {
    for effort in [Effort::of_ms(300), Effort::of_rounds(3)] {
        for (relation, report) in measure(effort) {
            let of = |name: &str| {
                let mut ranking = report.ranking.iter();
                let found = ranking.find(|ranked| ranked.backend == name);
                found.expect("measured").ns_per_operation
            };
            let ratio = of("slow-face-faces") / of("steady");
            let expected = if relation == Relation::FaceFaces {
                40.0
            } else {
                1.0
            };
            let context = format!("{relation:?}, {effort:?}: {ratio}");
            assert!((ratio - expected).abs() < 1e-6, "{context}");
            if relation == Relation::FaceFaces {
                assert_eq!(report.ranking[0].backend, "steady");
                let choice = report.choice.as_ref().expect("a choice");
                assert_eq!(choice.backend, "steady", "{context}");
                assert!(!report.ranking[1].tied_with_best, "{context}");
            } else {
                assert!(report.ranking.iter().all(|r| r.tied_with_best), "{context}");
            }
            assert_eq!(report.mismatches, Vec::<String>::new());
        }
    }
}

#[test]
fn programs_are_measured_on_this_machine_with_the_settings_that_were_asked_for() {
    let mesh = [StudyMesh::new("cube", shapes::cube())];
    let suite = Suite::from(Queries(Relation::VertexVertices));
    let stop = AtomicBool::new(false);
    let measure = |settings: &ProgramSettings| {
        let (progress, finished) = (&mut |_: f64, _: &str| (), &mut |_: &PickReport| ());
        pick_for_programs(&mesh, &suite, settings, &stop, progress, finished)
    };
    let mut settings = ProgramSettings {
        backends: vec!["half-edge".into(), "winged-edge".into()],
        effort: Effort::of_rounds(1),
        confidence: "99%".parse().expect("allowed"),
        seed: 9,
        heap: Policy::System,
        ..ProgramSettings::default()
    };
    let reports = measure(&settings).expect("both hold a cube");
    let [report] = &reports[..] else {
        panic!("one program")
    };
    assert_eq!(report.ranking.len(), 2);
    let expected = RunSettings {
        backends: settings.backends.clone(),
        confidence: settings.confidence,
        seed: 9,
        heap: Policy::System,
        ..settings.effort.run_settings()
    };
    assert_eq!(report.run.settings, expected);
    settings.backends.push("abacus".into());
    let error = measure(&settings).expect_err("an unknown backend");
    assert!(matches!(error, MeasureError::UnknownBackend(_)), "{error}");
}

#[test]
fn a_scanning_structure_that_would_take_too_long_is_excluded() {
    let costs = |work: &Work<'_>| {
        let faces = work.counts.faces as f64;
        match work.backend {
            "indexed-face-set" | "polygon-soup" => faces * faces,
            _ => 10.0 * faces,
        }
    };
    let torus = shapes::triangle_torus(30, 30).expect("a torus");
    let mesh = [StudyMesh::new("torus", torus)];
    // A run that scans 1,800 faces takes 3.24 ms, which is a tenth of 32.4 ms.
    for (speed, budget_ms, excluded) in [
        (1.0, 32, 2),
        (1.0, 33, 0),
        (0.1, 320, 2),
        (0.1, 330, 0),
        (10.0, 3, 2),
        (10.0, 4, 0),
    ] {
        let machine = SimulatedMachine::with_costs(costs).at_speed(speed);
        let settings = ProgramSettings {
            effort: Effort::of_ms(budget_ms),
            ..ProgramSettings::default()
        };
        let suite = Suite::from(Queries(Relation::VertexVertices));
        let stop = AtomicBool::new(false);
        let measure = |settings: &ProgramSettings| {
            let (progress, finished) = (&mut |_: f64, _: &str| (), &mut |_: &PickReport| ());
            pick_for_programs_on(&machine, &mesh, &suite, settings, &stop, progress, finished)
        };
        let report = measure(&settings).expect("a mesh with faces").remove(0);
        let names: Vec<&str> = report.excluded.iter().map(|e| e.backend.as_str()).collect();
        let context = format!("{budget_ms} ms at speed {speed}");
        let expected = &["polygon-soup", "indexed-face-set"][..excluded];
        assert_eq!(names, expected, "{context}");
        for Excluded { reason, .. } in &report.excluded {
            let about = format!("a run would take about {}", duration(3.24e6 / speed));
            assert!(reason.starts_with(&about), "{context}: {reason}");
        }
        assert_eq!(report.ranking.len(), 7 - excluded, "{context}");
        let rounds = ProgramSettings {
            effort: Effort::of_rounds(1),
            ..settings
        };
        let report = measure(&rounds).expect("a mesh with faces").remove(0);
        assert_eq!((report.excluded.len(), report.ranking.len()), (0, 7));
    }
}

#[test]
fn the_own_time_of_a_recorded_program_is_what_its_calls_do_not_take() {
    let torus = shapes::triangle_torus(12, 10).expect("a torus");
    let study_mesh = StudyMesh::new("torus", torus);
    let suite = Suite::from(Queries(Relation::VertexVertices));
    let [program] = suite.programs() else {
        panic!("one program")
    };
    // Four structures do not scan and are tried first. Then comes the trace.
    let costs = |work: &Work<'_>| match (work.task, work.place) {
        (Task::Program, 0..4) if work.backend == "winged-edge" => 50_000.0,
        (Task::Program, 0..4) => 60_000.0,
        (Task::Program, _) => 42_000.0,
        _ => 1000.0,
    };
    let record = |machine: SimulatedMachine, effort: Effort| {
        let settings = ProgramSettings {
            effort,
            ..ProgramSettings::default()
        };
        let stop = AtomicBool::new(false);
        let recorded = record_program_on(&machine, &study_mesh, program, &settings, &stop);
        let recorded = recorded.expect("it can be recorded");
        assert_eq!(recorded.structure, "winged-edge", "the fastest");
        recorded
    };
    // Neither drift nor jumps change which structure is the fastest, or the part of the own time.
    for effort in [Effort::of_ms(1000), Effort::of_rounds(100)] {
        let recorded = record(SimulatedMachine::with_costs(costs).drifting(), effort);
        let own = recorded.run.trace.own_ns / recorded.run_ns;
        assert!((own - 0.16).abs() < 0.01, "{own}");
    }
    for effort in [Effort::of_ms(100), Effort::of_rounds(2)] {
        let recorded = record(SimulatedMachine::with_costs(costs), effort);
        assert!((recorded.run_ns - 50_000.0).abs() < 1e-6);
        assert!((recorded.run.trace.own_ns - 8_000.0).abs() < 1e-6);
        let measured = recorded.run.trace.measured.expect("measured");
        assert_eq!(measured.structure, "winged-edge");
        assert!((measured.replay_ns - 42_000.0).abs() < 1e-6);
    }
}
