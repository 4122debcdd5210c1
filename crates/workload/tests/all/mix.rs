//! Checks that a mix does the same work on every structure.

use sixfold::{PolygonMesh, shapes};
use sixfold_measure::{Job, MachineClock, Operation, Outcome, Series, Task};
use sixfold_workload::{
    Access, Action, Backend, Draw, MixBackend, MixRefusal, Route, Schedule, Workload, built_in,
    built_ins, prepare_mix, tabulate,
};

struct Fixture {
    polygons: PolygonMesh,
    draw: Draw,
    schedule: Schedule,
    route: Route,
}

impl Fixture {
    fn new(workload: &Workload, polygons: PolygonMesh) -> Self {
        let edges = sixfold::Facts::from_polygons(&polygons).edges;
        Self {
            draw: Draw::new(&polygons, 3),
            schedule: Schedule::new(workload, &polygons.counts(edges)),
            route: Route::new(workload.access, &polygons, 3),
            polygons,
        }
    }

    /// Returns the backends that can run the mix, with the places that all of them accept.
    fn backends(&self) -> Vec<Box<dyn MixBackend + '_>> {
        let prepare = |backend: Backend| {
            prepare_mix(
                &backend,
                &self.polygons,
                &self.draw,
                &self.schedule,
                &self.route,
            )
        };
        let prepared = Backend::structures().into_iter().map(prepare);
        let mut backends: Vec<Box<dyn MixBackend + '_>> = prepared.filter_map(Result::ok).collect();
        let accepted: Vec<Vec<Vec<bool>>> =
            backends.iter_mut().map(|m| m.accepted_places()).collect();
        let mut common = accepted[0].clone();
        for other in &accepted[1..] {
            for (ours, theirs) in common.iter_mut().zip(other) {
                ours.iter_mut().zip(theirs).for_each(|(a, b)| *a &= b);
            }
        }
        backends
            .iter_mut()
            .for_each(|backend| backend.keep_places(&common));
        backends.extend(tabulate(
            &find("half-edge"),
            &self.polygons,
            &self.schedule,
            &self.route,
        ));
        backends
    }
}

fn find(name: &str) -> Backend {
    Backend::find(name).expect("one of six")
}

fn parsed(text: &str) -> Workload {
    Workload::parse("test", "test.toml", text).expect("a valid file")
}

/// Runs a task from run `first` on and returns its result.
fn result(
    backend: &mut Box<dyn MixBackend + '_>,
    task: Task,
    first: u64,
    runs: u32,
) -> (String, Outcome) {
    let clock = MachineClock::start();
    let series = Series::with_runs(runs, &clock).with_result();
    let job = Job {
        first,
        ..Job::new(task)
    };
    let run = backend.run(&job, &series);
    assert_eq!(run.refusal, None);
    (backend.name().to_owned(), run.outcome.expect("checked"))
}

const QUERIES: &str = "operations = 5\naccess = 'random'\n[mix]\nvertex_vertices = 3\n\
    vertex_edges = 1\nvertex_faces = 2\nedge_vertices = 1\nedge_edges = 0.5\nedge_faces = 2\n\
    face_vertices = 1\nface_edges = 1\nface_faces = 1\nposition = 4\nneighbour_positions = 1\n\
    corner_positions = 2\nend_positions = 1\n";

#[test]
fn all_structures_yield_the_same_along_a_route() {
    for access in [Access::Random, Access::Patches] {
        let workload = Workload {
            access,
            ..parsed(QUERIES)
        };
        for polygons in [
            shapes::triangle_torus(12, 9).expect("small"),
            shapes::mixed_grid(9, 7).expect("small"),
            shapes::icosahedron(),
        ] {
            let fixture = Fixture::new(&workload, polygons);
            let mut backends = fixture.backends();
            assert!(backends.len() >= 6, "{}", backends.len());
            for turn in [0, 1, 17] {
                let run = |backend| result(backend, Task::Mix, turn, 2);
                let runs: Vec<_> = backends.iter_mut().map(run).collect();
                let Outcome {
                    checksum, elements, ..
                } = runs[0].1;
                assert!(elements == 256 && checksum > 512.0, "{runs:?}");
                let same = |(_, outcome): &(String, Outcome)| *outcome == runs[0].1;
                assert!(runs.iter().all(same), "{access} {runs:?}");
            }
        }
    }
}

#[test]
fn the_own_data_of_a_program_take_time_and_change_no_result() {
    let without = parsed("operations = 5\n[mix]\nface_vertices = 1\nedge_vertices = 1\n");
    let with = parsed(
        "operations = 5\n[own_data]\nface = { read = 4096, written = 4096 }\n\
         [mix]\nface_vertices = 1\nedge_vertices = 1\n",
    );
    let [without, with] = [without, with]
        .map(|workload| Fixture::new(&workload, shapes::triangle_torus(30, 20).expect("small")));
    let clock = MachineClock::start();
    let series = Series::with_runs(20, &clock).with_untimed(5).with_result();
    for (mut a, mut b) in without.backends().into_iter().zip(with.backends()) {
        let run = |backend: &mut Box<dyn MixBackend + '_>| {
            let runs = (0..5).map(|_| backend.run(&Job::new(Task::Mix), &series));
            let runs: Vec<_> = runs.collect();
            let least = runs.iter().map(|run| run.time.ns());
            (runs[0].outcome, least.fold(f64::INFINITY, f64::min))
        };
        let ((result, fast), (same, slow)) = (run(&mut a), run(&mut b));
        assert!(result.is_some() && result == same, "{}", a.name());
        // 128 visits of faces, each with 1,024 words.
        assert!(slow > fast + 10_000.0, "{}: {slow} {fast}", a.name());
    }
}

#[test]
fn all_structures_yield_the_same_on_all_elements_in_their_own_order() {
    let workload = Workload {
        access: Access::Sequential,
        ..parsed(QUERIES)
    };
    let fixture = Fixture::new(&workload, shapes::mixed_grid(9, 7).expect("small"));
    let mut backends = fixture.backends();
    for part in fixture.schedule.elements() {
        let run = |backend| result(backend, Task::Part(part), 5, 3);
        let structures = backends.iter_mut().filter(|b| !b.scans()[part]);
        let runs: Vec<_> = structures.map(run).collect();
        assert!(runs.len() >= 3, "{runs:?}");
        let action = fixture.schedule.parts[part].action;
        let same = |(_, outcome): &(String, Outcome)| *outcome == runs[0].1;
        assert!(runs.iter().all(same), "{action} {runs:?}");
    }
}

#[test]
fn edits_are_accepted_repeatedly_at_the_places_that_all_accept() {
    let of_triangles = "bisect_edge = 1\ncollapse_edge = 1\nflip_edge = 2\npoke_face = 1\n\
         remove_face = 1\nsplit_vertex = 1";
    let of_polygons = "add_face = 1\nsplit_edge = 1\nsplit_face = 1\ndissolve_edge = 1\n\
         collapse_edge = 1\npoke_face = 1\nremove_face = 1\nsplit_vertex = 1";
    let triangles = shapes::triangle_torus(80, 60).expect("small");
    let quads = shapes::torus(80, 60).expect("small");
    edits_are_accepted(of_triangles, triangles, 6);
    // The corner table cannot hold the mesh.
    edits_are_accepted(of_polygons, quads, 5);
}

fn edits_are_accepted(edits: &str, polygons: PolygonMesh, backends_count: usize) {
    let workload = parsed(&format!(
        "operations = 5\naccess = 'patches'\n[mix]\n{edits}\nset_position = 5\n\
         vertex_faces = 40\nedge_faces = 40\nface_faces = 40"
    ));
    let fixture = Fixture::new(&workload, polygons);
    let mut backends = fixture.backends();
    let names: Vec<&str> = backends.iter().map(|backend| backend.name()).collect();
    assert_eq!(names.len(), backends_count, "{names:?}");
    for turn in [0, 1, 7, 7] {
        let runs: Vec<_> = backends
            .iter_mut()
            .map(|backend| result(backend, Task::Mix, turn, 2))
            .collect();
        let same = |(_, outcome): &(String, Outcome)| *outcome == runs[0].1;
        assert!(runs.iter().all(same), "{runs:?}");
        assert!(runs[0].1.elements >= 64 && runs[0].1.checksum > 64.0);
    }
    // One edit on each copy; then more edits than there are places.
    for (edits, accepted) in [(1, 1..2), (1000, 1..1000)] {
        for part in fixture.schedule.edits() {
            let task = Task::Part(part);
            let runs: Vec<_> = backends
                .iter_mut()
                .map(|backend| result(backend, task, 0, edits))
                .collect();
            let same = |(_, outcome): &(String, Outcome)| *outcome == runs[0].1;
            assert!(runs.iter().all(same), "{runs:?}");
            assert!(accepted.contains(&(runs[0].1.checksum as u32)), "{runs:?}");
        }
    }
}

#[test]
fn passes_over_tables_give_the_results_of_structures() {
    let workload = parsed(
        "operations = 5\n[mix]\ncirculate = 1\nface_barycenter = 1\nvertex_normal = 1\n\
         vv_smooth = 1\nedge_length = 1\nboundary = 1\nff_bfs = 1\nall_queries = 1",
    );
    let fixture = Fixture::new(&workload, shapes::mixed_grid(9, 7).expect("small"));
    let mut backends = fixture.backends();
    let names: Vec<String> = backends.iter().map(|b| b.name().to_owned()).collect();
    assert_eq!(names.last().map(String::as_str), Some("relation-tables"));
    for part in fixture.schedule.passes() {
        let Action::Pass(operation) = fixture.schedule.parts[part].action else {
            panic!("only passes");
        };
        let outcomes: Vec<_> = backends
            .iter_mut()
            .map(|backend| result(backend, Task::Operation(operation), 0, 2).1)
            .collect();
        for (outcome, name) in outcomes.iter().zip(&names) {
            let difference = (outcome.checksum - outcomes[0].checksum).abs();
            let limit = 1e-4 * outcomes[0].checksum.abs();
            assert!(difference <= limit, "{operation} on {name}: {outcomes:?}");
            let elements = outcomes[0].elements;
            assert_eq!(outcome.elements, elements, "{operation} on {name}");
        }
    }
}

#[test]
fn workloads_that_change_connectivity_have_no_tables() {
    for (name, changes) in [
        ("decimation", true),
        ("modelling", true),
        ("remeshing", true),
        ("subdivision", true),
        ("smoothing", false),
    ] {
        let workload = built_in(name).expect("it is built in");
        let torus = shapes::triangle_torus(30, 20).expect("small");
        let fixture = Fixture::new(&workload, torus);
        let tables = tabulate(
            &find("half-edge"),
            &fixture.polygons,
            &fixture.schedule,
            &fixture.route,
        );
        assert_eq!(tables.is_none(), changes, "{name}");
    }
}

#[test]
fn every_built_in_runs() {
    for (name, _) in built_ins() {
        let workload = built_in(name).expect("it is built in");
        let torus = shapes::triangle_torus(30, 20).expect("small");
        let fixture = Fixture::new(&workload, torus);
        let mut backends = fixture.backends();
        // The corner table cannot do all edits of `modelling`.
        assert!(backends.len() >= 5, "{name}");
        let half_edge = backends
            .iter_mut()
            .find(|backend| backend.name() == "half-edge");
        let half_edge = half_edge.expect("it holds tori");
        if fixture.schedule.on_elements > 0.0 {
            let (_, outcome) = result(half_edge, Task::Mix, 0, 1);
            assert!(outcome.checksum > 0.0, "{name}");
        }
        for part in fixture.schedule.passes() {
            let operation = match fixture.schedule.parts[part].action {
                Action::Pass(operation) => operation,
                _ => Operation::Loop(sixfold::subdivision::Method::Native),
            };
            result(half_edge, Task::Operation(operation), 0, 1);
        }
    }
}

#[test]
fn backends_that_cannot_run_the_mix_give_the_reason() {
    let splits = parsed("operations = 5\n[mix]\nsplit_edge = 1\nvertex_faces = 9");
    let torus = shapes::triangle_torus(30, 20).expect("small");
    let fixture = Fixture::new(&splits, torus);
    let refusal_of = |fixture: &'_ Fixture, name: &str| {
        let Fixture {
            polygons,
            draw,
            schedule,
            route,
        } = fixture;
        prepare_mix(&find(name), polygons, draw, schedule, route).err()
    };
    let refusal = refusal_of(&fixture, "corner-table");
    assert!(
        matches!(refusal, Some(MixRefusal::UnsupportedEdit(_))),
        "{refusal:?}"
    );
    let unedited = Backend::new::<sixfold::HalfEdgeMesh>();
    let Fixture {
        polygons,
        draw,
        schedule,
        route,
    } = &fixture;
    let refusal = prepare_mix(&unedited, polygons, draw, schedule, route).err();
    assert_eq!(refusal, Some(MixRefusal::NotEditable));
    let smoothing = built_in("smoothing").expect("it is built in");
    let quads = Fixture::new(&smoothing, shapes::grid(4, 4).expect("small"));
    let refusal = refusal_of(&quads, "corner-table");
    assert!(matches!(refusal, Some(MixRefusal::Build(_))), "{refusal:?}");
}
