//! Measures spatial indices on small meshes.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sixfold::PolygonMesh;
use sixfold_study::{
    Agreement, NeighboursError, NeighboursReport, NeighboursSettings, QueryPoints, Results,
    SpatialTask, StudyError, StudyMesh, neighbour_indices, neighbours,
};

fn measure(mesh: &StudyMesh, settings: &NeighboursSettings) -> NeighboursReport {
    neighbours(mesh, settings, &AtomicBool::new(false), &mut |_| {}).expect("a measurement")
}

fn settings() -> NeighboursSettings {
    NeighboursSettings {
        budget: Duration::from_millis(300),
        ..NeighboursSettings::default()
    }
}

fn ball(frequency: usize) -> StudyMesh {
    let mesh = sixfold::shapes::geodesic(frequency).expect("a shape");
    StudyMesh::new("ball", mesh)
}

#[test]
fn all_indices_give_the_same_answers() {
    let mesh = ball(30);
    for points in [QueryPoints::Near, QueryPoints::Box] {
        let report = measure(
            &mesh,
            &NeighboursSettings {
                points,
                ..settings()
            },
        );
        assert_eq!(report.queries, mesh.polygons.vertex_count());
        assert_eq!(report.results.len(), 7 * 5);
        for row in &report.results {
            assert_eq!(
                row.agreement,
                Agreement::Same,
                "{} {}",
                row.operation,
                row.backend
            );
            assert!(row.median_ns > 0.0, "{} {}", row.operation, row.backend);
        }
        let sampled = |task| {
            let rows = report.rows(task).filter(|row| row.sample_size.is_some());
            rows.map(|row| row.backend.as_str()).collect::<Vec<_>>()
        };
        // 9,002 vertices and queries: the list may visit 4 million.
        assert_eq!(sampled(SpatialTask::NearestVertex), ["list"]);
        assert_eq!(sampled(SpatialTask::BuildVertices), [""; 0]);
        // Each vertex of a ball is found by a query near it, and its neighbours within the radius.
        let within = report
            .rows(SpatialTask::VerticesWithin)
            .nth(1)
            .expect("a row");
        assert!(within.checksum > Some(0.0));
    }
}

#[test]
fn the_cheapest_index_changes_with_the_number_of_queries() {
    let report = measure(&ball(30), &settings());
    let queries: Vec<&str> = report.cheapest.iter().map(|c| c.operation.name()).collect();
    let expected = [
        "nearest_vertex",
        "vertices_within",
        "nearest_eight",
        "closest_point",
        "first_hit",
    ];
    assert_eq!(queries, expected);
    for query in &report.cheapest {
        let (first, last) = (&query.ranges[0], query.ranges.last().expect("a range"));
        assert_eq!(
            (first.from, first.index.as_str()),
            (1, "list"),
            "{}",
            query.operation
        );
        assert_ne!(last.index, "list", "{}", query.operation);
    }
    assert!(report.sentences.iter().any(|s| s.contains("With building")));
}

#[test]
fn a_finding_is_read_back_as_it_was_written() {
    let mut one = settings();
    one.indices = vec!["bvh".into(), "grid".into()];
    let report = measure(&ball(4), &one);
    let names: Vec<&str> = report.backends.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["grid", "bvh"]);
    assert!(report.noise.is_some_and(|noise| noise >= 1.0));
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
    assert!(csv.contains("closest_point,bvh"), "{csv}");
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
        NeighboursError::Study(StudyError::UnknownBackend {
            name: "quadtree".into(),
            known: neighbour_indices().to_vec(),
        })
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
    let report = neighbours(&ball(4), &settings(), &stop, &mut |_| {}).expect("a report");
    assert!(report.interrupted);
    assert!(report.results.len() <= 1, "{}", report.results.len());
}
