//! Measurements of spatial indices on a simulated machine: the answers are real, and the times are
//! known.

use sixfold::{PolygonMesh, UnknownName};
use sixfold_measure::Task;
use sixfold_results::Agreement;

use super::*;
use crate::engine::simulated_machine::{SimulatedMachine, Work};
use sixfold_results::Results;

/// Costs in nanoseconds: to build an index, and to query it with a point for each vertex.
fn costs(work: &Work<'_>) -> f64 {
    let (build_ns, query_ns) = match work.backend {
        "list" => (0.0, 20_000.0),
        "grid" => (400_000.0, 500.0),
        "octree" => (900_000.0, 500.0),
        "kd-tree" => (1_600_000.0, 200.0),
        _ => (100_000_000.0, 400.0),
    };
    match work.task {
        Task::Part(part) if SpatialTask::ALL[part].build().is_none() => build_ns,
        _ => work.counts.vertices as f64 * query_ns,
    }
}

fn measure_on(
    machine: &SimulatedMachine,
    mesh: &StudyMesh,
    settings: &NeighboursSettings,
) -> NeighboursReport {
    let stop = AtomicBool::new(false);
    neighbours_on(machine, mesh, settings, &stop, &mut |_| {}).expect("a measurement")
}

fn measure(mesh: &StudyMesh, settings: &NeighboursSettings) -> NeighboursReport {
    measure_on(&SimulatedMachine::with_costs(costs), mesh, settings)
}

fn settings() -> NeighboursSettings {
    NeighboursSettings {
        effort: Effort::of_ms(1000),
        ..NeighboursSettings::default()
    }
}

fn ball(frequency: usize) -> StudyMesh {
    let mesh = sixfold::shapes::geodesic(frequency).expect("a shape");
    StudyMesh::new("ball", mesh)
}

#[test]
fn runs_of_a_sample_follow_from_what_a_query_visits() {
    let mesh = ball(2);
    let settings = NeighboursSettings {
        effort: Effort::of_rounds(1),
        ..settings()
    };
    let report = measure(&mesh, &settings);
    assert_eq!(report.queries, 42);
    let runs = |task: SpatialTask| {
        let rows = report.rows(task.name());
        rows.map(|row| row.runs_per_sample).collect::<Vec<_>>()
    };
    // 100,000 visits: a query of the list visits 42 vertices or 80 triangles, of another index 50.
    assert_eq!(runs(SpatialTask::NearestVertex), [57, 48, 48, 48, 48]);
    assert_eq!(runs(SpatialTask::ClosestPoint), [30, 48, 48, 48, 48]);
}

#[test]
fn all_indices_give_the_same_answers() {
    let mesh = ball(30);
    for points in [QueryPoints::Near, QueryPoints::Box] {
        let settings = NeighboursSettings {
            points,
            effort: Effort::of_rounds(1),
            ..settings()
        };
        let report = measure(&mesh, &settings);
        assert_eq!(report.queries, mesh.polygons.vertex_count());
        assert_eq!(report.results.len(), 7 * 5);
        for (figure, row) in report.figures().iter().zip(&report.results) {
            let expected = ResultRow {
                case: points.name().into(),
                ..row.clone()
            };
            assert_eq!(figure.row, expected);
        }
        for row in &report.results {
            let context = format!("{} {}", row.operation, row.backend);
            assert_eq!(row.agreement, Agreement::Same, "{context}");
        }
        let sampled = |task| {
            let rows = report.rows(task).filter(|row| row.sample_size.is_some());
            rows.map(|row| row.backend.as_str()).collect::<Vec<_>>()
        };
        // 9,002 vertices and queries: the list may visit 4 million.
        assert_eq!(sampled(SpatialTask::NearestVertex.name()), ["list"]);
        assert_eq!(sampled(SpatialTask::BuildVertices.name()), [""; 0]);
        // Each vertex of a ball is found by a query near it, and its neighbours within the radius.
        let within = report
            .rows(SpatialTask::VerticesWithin.name())
            .nth(1)
            .expect("a row");
        assert!(within.checksum > Some(0.0));
    }
}

#[test]
fn an_index_whose_queries_are_slow_answers_a_part_of_them_and_keeps_the_budget() {
    let mesh = ball(30);
    // A query of the grid takes 1 ms, so all 9,002 queries take 9 s.
    let slow = |work: &Work<'_>| match (work.backend, work.task) {
        ("grid", Task::Part(part)) if SpatialTask::ALL[part].build().is_some() => {
            work.counts.vertices as f64 * 1e6
        }
        _ => costs(work) / 10.0,
    };
    for budget_ms in [3000, 30_000] {
        let settings = NeighboursSettings {
            effort: Effort::of_ms(budget_ms),
            indices: ["grid", "octree", "kd-tree"].map(Into::into).into(),
            ..settings()
        };
        let machine = SimulatedMachine::with_costs(slow);
        let report = measure_on(&machine, &mesh, &settings);
        assert!(machine.ns() <= budget_ms as f64 * 1e6, "{}", machine.ns());
        let rows: Vec<&ResultRow> = report.rows(SpatialTask::NearestVertex.name()).collect();
        let sizes = rows.iter().map(|row| row.sample_size);
        let [grid, octree, kd_tree] = sizes.collect::<Vec<_>>()[..] else {
            panic!("three indices");
        };
        assert!(
            grid.is_some_and(|size| (256..9002).contains(&size)),
            "{grid:?}"
        );
        assert_eq!([octree, kd_tree], [None; 2], "45 and 18 ms for all queries");
        let each = rows[0].ns_per_element.expect("a time");
        assert!((each / 1e6 - 1.0).abs() < 1e-9, "{each}");
        assert!(rows.iter().all(|row| row.samples >= 1));
    }
}

#[test]
fn the_cheapest_index_changes_with_the_number_of_queries_on_any_machine() {
    let mesh = ball(8);
    for speed in [1.0, 0.1, 25.0] {
        for effort in [Effort::of_ms(5000), Effort::of_rounds(3)] {
            let settings = NeighboursSettings {
                effort,
                ..settings()
            };
            let machine = SimulatedMachine::with_costs(costs).at_speed(speed);
            let report = measure_on(&machine, &mesh, &settings);
            let queries: Vec<&str> = report
                .cheapest
                .iter()
                .map(|c| c.operation.as_str())
                .collect();
            let expected = [
                "nearest_vertex",
                "vertices_within",
                "nearest_eight",
                "closest_point",
                "first_hit",
            ];
            assert_eq!(queries, expected);
            for query in &report.cheapest {
                let ranges = query.ranges.iter();
                let ranges: Vec<_> = ranges.map(|r| (r.from, r.index.as_str())).collect();
                // 400,000 ns are saved at 19,500 ns per query, and 1,200,000 ns at 300 ns.
                let expected = [(1, "list"), (21, "grid"), (4001, "kd-tree")];
                let context = format!("{}, speed {speed}: {ranges:?}", query.operation);
                assert_eq!(ranges.len(), 3, "{context}");
                for ((from, index), expected) in ranges.into_iter().zip(expected) {
                    assert_eq!(index, expected.1, "{context}");
                    // The times have rounding errors, so an exact break-even may be one query off.
                    assert!(from.abs_diff(expected.0) <= 1, "{context}");
                }
            }
            let said = report
                .sentences
                .iter()
                .find(|s| s.contains("building included"));
            let said = said.expect("a sentence");
            assert!(
                said.contains("list up to 20 queries, then grid up to 4,000, then kd-tree."),
                "{said}"
            );
            let control = report.control.expect("one index is measured twice");
            assert_eq!(
                (control.worst, control.operations.len()),
                (1.0, SpatialTask::ALL.len())
            );
        }
    }
}

#[test]
fn a_list_can_be_cheapest_for_any_number_of_queries() {
    let machine = SimulatedMachine::with_costs(|work| match work.backend {
        "list" => 1000.0,
        _ => 2000.0,
    });
    let report = measure_on(&machine, &ball(4), &settings());
    for query in &report.cheapest {
        let ranges = query.ranges.iter().map(|r| r.index.as_str());
        assert_eq!(ranges.collect::<Vec<_>>(), ["list"], "{}", query.operation);
    }
}

#[test]
fn a_finding_is_read_back_as_it_was_written() {
    let mut one = settings();
    one.indices = vec!["bvh".into(), "grid".into()];
    let report = measure(&ball(4), &one);
    let names: Vec<&str> = report.backends.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["grid", "bvh"]);
    assert!(
        report
            .control
            .as_ref()
            .is_some_and(|control| control.worst >= 1.0)
    );
    let results = Results::from(report);
    let mut json = Vec::new();
    results.write_json(&mut json).expect("JSON");
    let read = Results::read_json(std::str::from_utf8(&json).expect("text")).expect("a document");
    let mut again = Vec::new();
    read.write_json(&mut again).expect("JSON");
    assert_eq!(json, again);
    let mut csv = Vec::new();
    read.write_csv(&mut csv).expect("CSV");
    let csv = String::from_utf8(csv).expect("text");
    assert_eq!(csv.lines().count(), 1 + 7 * 2, "{csv}");
    assert!(csv.contains("bvh,closest_point"), "{csv}");
}

#[test]
fn unusable_settings_and_meshes_are_refused() {
    let refusal = |mesh: &StudyMesh, settings: &NeighboursSettings| {
        neighbours(mesh, settings, &AtomicBool::new(false), &mut |_| {}).expect_err("an error")
    };
    let mut unknown = settings();
    unknown.indices = vec!["quadtree".into()];
    assert_eq!(
        refusal(&ball(2), &unknown),
        NeighboursError::Study(StudyError::UnknownBackend(UnknownName::new(
            "index",
            "quadtree",
            neighbour_indices()
        )))
    );
    let empty = StudyMesh::new("empty", PolygonMesh::default());
    let no_faces = NeighboursError::Study(StudyError::NoFaces);
    assert_eq!(refusal(&empty, &settings()), no_faces);
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, f32::NAN, 0.0]];
    let broken = PolygonMesh::new(corners, [[0, 1, 2]]).expect("a mesh");
    let error = refusal(&StudyMesh::new("broken", broken), &settings());
    assert!(matches!(error, NeighboursError::Spatial(_)), "{error}");
}

#[test]
fn a_stop_before_the_first_sample_leaves_an_empty_report() {
    let stop = AtomicBool::new(true);
    let machine = SimulatedMachine::with_costs(costs);
    let report = neighbours_on(&machine, &ball(4), &settings(), &stop, &mut |_| {});
    let report = report.expect("a report");
    assert!(report.interrupted);
    assert!(report.results.len() <= 1, "{}", report.results.len());
}
