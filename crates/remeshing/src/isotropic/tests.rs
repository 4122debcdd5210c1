use half_edge::EditableHalfEdgeMesh;
use indexed_face_set::EditableIndexedFaceSet;
use mesh_core::{MeshQuery, Point, PolygonMesh};

use super::*;

fn remeshed(polygons: &PolygonMesh, how: &Remeshing) -> (EditableHalfEdgeMesh, Remeshed) {
    let mut mesh = EditableHalfEdgeMesh::from_polygons(polygons).expect("a manifold");
    let report = remesh(&mut mesh, how).expect("triangles");
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(mesh.face_count(), report.faces);
    (mesh, report)
}

fn lengths(mesh: &EditableHalfEdgeMesh) -> Vec<f64> {
    let ends = mesh
        .edges()
        .map(|e| mesh.edge_vertices(e).map(|v| at(mesh, v)));
    ends.map(|[a, b]| a.distance(b)).collect()
}

#[test]
fn edges_come_to_the_length_asked_for() {
    // Triangles of a uv sphere are thin at the poles and large at the equator.
    let sphere = shapes::uv_sphere(24, 9)
        .expect("small")
        .fan_triangulated()
        .expect("small");
    for length in [0.15, 0.3] {
        let (mesh, report) = remeshed(&sphere, &Remeshing::to(length));
        assert_eq!(report.stop, Stop::Done);
        let lengths = lengths(&mesh);
        let even = lengths
            .iter()
            .filter(|&&l| (0.7 * length..1.4 * length).contains(&l));
        let share = even.count() as f64 / lengths.len() as f64;
        assert!(share > 0.95, "{share} of the edges are near {length}");
        let regular = mesh
            .vertices()
            .filter(|&v| (5..=7).contains(&mesh.vertex_edges(v).count()));
        assert!(regular.count() * 100 > mesh.vertex_count() * 95);
    }
}

#[test]
fn a_flat_square_keeps_its_outline() {
    let grid = shapes::triangle_grid(6, 6).expect("small");
    let length = {
        let mesh = EditableHalfEdgeMesh::from_polygons(&grid).expect("a manifold");
        lengths(&mesh).into_iter().fold(f64::INFINITY, f64::min)
    };
    let area =
        |mesh: &EditableHalfEdgeMesh| -> f64 { mesh.faces().map(|f| cross(mesh, f).z / 2.0).sum() };
    let before = area(&EditableHalfEdgeMesh::from_polygons(&grid).expect("a manifold"));
    for factor in [0.4, 2.5] {
        let (mesh, report) = remeshed(&grid, &Remeshing::to(factor * length));
        assert!((area(&mesh) - before).abs() < 1e-4 * before.abs());
        let edited = if factor < 1.0 {
            report.splits
        } else {
            report.collapses
        };
        assert!(edited > 10, "{report:?}");
    }
}

#[test]
fn any_length_is_refused_or_comes_to_an_end() {
    let sphere = shapes::geodesic(4).expect("small");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&sphere).expect("closed");
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let refused = remesh(&mut mesh, &Remeshing::to(length)).expect_err("no length");
        assert!(
            matches!(refused, RemeshError::BadLength { .. }),
            "{refused}"
        );
    }
    let refused = remesh(&mut mesh, &Remeshing::to(1e-9)).expect_err("too fine");
    assert!(matches!(refused, RemeshError::TooFine { .. }), "{refused}");
    let (mesh, _) = remeshed(&sphere, &Remeshing::to(1e30));
    assert!(mesh.face_count() >= 4);
    // Faces without an area have edges to be cut all the same.
    let line = [0.0, 1.0, 2.0].map(|x| mesh_core::Point::new(x, 0.0, 0.0));
    let flat = PolygonMesh::new(line, [[0, 1, 2]]).expect("valid");
    let mut flat = EditableHalfEdgeMesh::from_polygons(&flat).expect("a triangle");
    let refused = remesh(&mut flat, &Remeshing::to(1e-8)).expect_err("too fine");
    assert!(matches!(refused, RemeshError::TooFine { .. }), "{refused}");
    let few = Remeshing {
        most_faces: 400,
        ..Remeshing::to(0.2)
    };
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&sphere).expect("closed");
    let outcome = remesh(&mut mesh, &few);
    assert!(
        matches!(outcome, Err(RemeshError::TooFine { .. })),
        "{outcome:?}"
    );
}

#[test]
fn a_structure_that_scans_makes_the_same_mesh() {
    for polygons in [
        shapes::geodesic(4).expect("small"),
        shapes::triangle_grid(6, 5).expect("small"),
    ] {
        let how = Remeshing {
            iterations: 3,
            ..Remeshing::to(0.25)
        };
        let (walked, report) = remeshed(&polygons, &how);
        let mut scanned = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds all");
        assert_eq!(remesh(&mut scanned, &how), Ok(report));
        assert_eq!(
            walked.to_polygons().positions(),
            scanned.to_polygons().positions()
        );
    }
}

#[test]
fn what_positions_cannot_tell_is_refused_and_what_they_can_comes_to_an_end() {
    let grid = shapes::triangle_grid(20, 20).expect("small");
    // As survey coordinates are: half a unit is the step of singles there.
    let far = |p: &Point| Point::new(0.7 * p.x + 500_000.0, 0.7 * p.y + 4_650_000.0, 0.0);
    let far: Vec<Point> = grid.positions().iter().map(far).collect();
    let far = PolygonMesh::from_faces(far, grid.faces().clone()).expect("the same faces");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&far).expect("a manifold");
    let refused = remesh(&mut mesh, &Remeshing::to(0.3)).expect_err("half a step");
    assert!(
        matches!(refused, RemeshError::TooFar { step: 0.5, .. }),
        "{refused}"
    );
    for length in [2.0, 3.0] {
        let mut mesh = mesh.clone();
        let report = remesh(&mut mesh, &Remeshing::to(length)).expect("triangles");
        assert!(report.faces < 2 * grid.face_count(), "{report:?}");
        assert_eq!(mesh.validate(), Ok(()));
    }
    // Sums that overflow singles are no places.
    let huge = |p: &Point| (*p - Point::splat(10.0)) * 3.4e37;
    let huge: Vec<Point> = grid.positions().iter().map(huge).collect();
    let huge = PolygonMesh::from_faces(huge, grid.faces().clone()).expect("the same faces");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&huge).expect("a manifold");
    let to = Remeshing {
        most_faces: 5000,
        ..Remeshing::to(2.5e37)
    };
    let report = remesh(&mut mesh, &to).expect("triangles");
    assert!(report.faces <= 5000, "{report:?}");
    assert!(mesh.vertices().all(|v| mesh.position(v).is_finite()));
}

#[test]
fn it_ends_once_it_has_settled_and_makes_room_where_it_can() {
    let ball = shapes::geodesic(10).expect("small");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&ball).expect("closed");
    let to = Remeshing {
        iterations: usize::MAX,
        // Fewer than the mesh has, and more than the length takes.
        most_faces: 1000,
        ..Remeshing::to(0.3)
    };
    let report = remesh(&mut mesh, &to).expect("triangles");
    assert_eq!(report.stop, Stop::Done);
    assert!((200..500).contains(&report.faces), "{report:?}");
    assert!(report.iterations < 1000, "{report:?}");
}
