use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};
use sixfold_half_edge::EditableHalfEdgeMesh;
use sixfold_indexed_face_set::EditableIndexedFaceSet;

use super::*;

fn remeshed(polygons: &PolygonMesh, options: &Remeshing) -> (EditableHalfEdgeMesh, Remeshed) {
    let mut mesh = EditableHalfEdgeMesh::from_polygons(polygons).expect("a manifold");
    let report = remesh(&mut mesh, options).expect("triangles");
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
fn edges_get_the_requested_length() {
    let sphere = sixfold_shapes::uv_sphere(24, 9)
        .expect("small")
        .triangulated()
        .expect("small")
        .polygons;
    for length in [0.15, 0.3] {
        let (mesh, report) = remeshed(&sphere, &Remeshing::with_edge_length(length));
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
    let grid = sixfold_shapes::triangle_grid(6, 6).expect("small");
    let length = {
        let mesh = EditableHalfEdgeMesh::from_polygons(&grid).expect("a manifold");
        lengths(&mesh).into_iter().fold(f64::INFINITY, f64::min)
    };
    let area =
        |mesh: &EditableHalfEdgeMesh| -> f64 { mesh.faces().map(|f| cross(mesh, f).z / 2.0).sum() };
    let before = area(&EditableHalfEdgeMesh::from_polygons(&grid).expect("a manifold"));
    for factor in [0.4, 2.5] {
        let (mesh, report) = remeshed(&grid, &Remeshing::with_edge_length(factor * length));
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
fn any_length_is_refused_or_remeshing_ends() {
    let sphere = sixfold_shapes::geodesic(4).expect("small");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&sphere).expect("closed");
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error =
            remesh(&mut mesh, &Remeshing::with_edge_length(length)).expect_err("invalid length");
        assert!(matches!(error, RemeshError::BadLength { .. }), "{error}");
    }
    let error = remesh(&mut mesh, &Remeshing::with_edge_length(1e-9)).expect_err("too fine");
    assert!(matches!(error, RemeshError::TooFine { .. }), "{error}");
    let (mesh, _) = remeshed(&sphere, &Remeshing::with_edge_length(1e30));
    assert!(mesh.face_count() >= 4);
    let line = [0.0, 1.0, 2.0].map(|x| sixfold_core::Point::new(x, 0.0, 0.0));
    let flat = PolygonMesh::new(line, [[0, 1, 2]]).expect("valid");
    let mut flat = EditableHalfEdgeMesh::from_polygons(&flat).expect("a triangle");
    let error = remesh(&mut flat, &Remeshing::with_edge_length(1e-8)).expect_err("too fine");
    assert!(matches!(error, RemeshError::TooFine { .. }), "{error}");
    let few = Remeshing {
        max_faces: 400,
        ..Remeshing::with_edge_length(0.2)
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
        sixfold_shapes::geodesic(4).expect("small"),
        sixfold_shapes::triangle_grid(6, 5).expect("small"),
    ] {
        let options = Remeshing {
            iterations: 3,
            ..Remeshing::with_edge_length(0.25)
        };
        let (walked, report) = remeshed(&polygons, &options);
        let mut scanned = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds all");
        assert_eq!(remesh(&mut scanned, &options), Ok(report));
        assert_eq!(
            walked.to_polygons().positions(),
            scanned.to_polygons().positions()
        );
    }
}

#[test]
fn lengths_below_the_precision_are_refused_and_others_end() {
    let grid = sixfold_shapes::triangle_grid(20, 20).expect("small");
    // With large coordinates, neighbouring f32 coordinates are half a unit apart.
    let far = |p: &Point| Point::new(0.7 * p.x + 500_000.0, 0.7 * p.y + 4_650_000.0, 0.0);
    let far: Vec<Point> = grid.positions().iter().map(far).collect();
    let far = PolygonMesh::from_faces(far, grid.faces().clone()).expect("the same faces");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&far).expect("a manifold");
    let error = remesh(&mut mesh, &Remeshing::with_edge_length(0.3)).expect_err("too short");
    assert!(
        matches!(error, RemeshError::BelowPrecision { step: 0.5, .. }),
        "{error}"
    );
    for length in [2.0, 3.0] {
        let mut mesh = mesh.clone();
        let report = remesh(&mut mesh, &Remeshing::with_edge_length(length)).expect("triangles");
        assert!(report.faces < 2 * grid.face_count(), "{report:?}");
        assert_eq!(mesh.validate(), Ok(()));
    }
    let huge = |p: &Point| (*p - Point::splat(10.0)) * 3.4e37;
    let huge: Vec<Point> = grid.positions().iter().map(huge).collect();
    let huge = PolygonMesh::from_faces(huge, grid.faces().clone()).expect("the same faces");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&huge).expect("a manifold");
    let options = Remeshing {
        max_faces: 5000,
        ..Remeshing::with_edge_length(2.5e37)
    };
    let report = remesh(&mut mesh, &options).expect("triangles");
    assert!(report.faces <= 5000, "{report:?}");
    assert!(mesh.vertices().all(|v| mesh.position(v).is_finite()));
}

#[test]
fn remeshing_ends_when_converged_and_collapses_make_room() {
    let ball = sixfold_shapes::geodesic(10).expect("small");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&ball).expect("closed");
    let options = Remeshing {
        iterations: usize::MAX,
        max_faces: 1000,
        ..Remeshing::with_edge_length(0.3)
    };
    let report = remesh(&mut mesh, &options).expect("triangles");
    assert_eq!(report.stop, Stop::Done);
    assert!((200..500).contains(&report.faces), "{report:?}");
    assert!(report.iterations < 1000, "{report:?}");
}

/// A collapse at a hub visits all of its edges, so those around it come first: they make it smaller.
#[test]
fn edges_at_hubs_are_collapsed_last() {
    // Vertex 0 is a pole, and so is the last one.
    let sphere = sixfold_shapes::uv_sphere(HUB as usize + 1, 5).expect("small");
    let sphere = sphere.triangulated().expect("small").polygons;
    let mesh = EditableHalfEdgeMesh::from_polygons(&sphere).expect("closed");
    let numbering = Numbering::new(&mesh).expect("triangles");
    let work = Work::new(&mesh, numbering, 1.0);
    let valences = work.numbering.valences(&mesh);
    let is_at_pole = |&[a, b]: &[u32; 2]| a == 0 || b as usize == mesh.vertex_count() - 1;
    let edges = work.numbering.edges(&mesh);
    assert!(is_at_pole(&edges[0]));
    let (at_poles, others): (Vec<_>, Vec<_>) = edges.into_iter().partition(is_at_pole);
    assert_eq!(
        work.collapse_order(&mesh, &valences),
        [others, at_poles].concat()
    );
}

/// What the other end of an edge at a hub forbids needs no visit of the hub.
#[test]
fn hubs_are_visited_last_and_not_too_often() {
    let n = 4 * HUB;
    // Tetrahedra with one vertex in common cannot collapse there.
    let tetrahedra = {
        let corners = (0..n).flat_map(|i| {
            let (sin, cos) = (i as f32).sin_cos();
            [[cos, sin, 0.0], [cos, sin, 0.001], [cos, sin + 0.001, 0.0]]
        });
        let points = std::iter::once([0.0; 3]).chain(corners);
        let faces = (0..n).flat_map(|i| {
            let [a, b, c] = [1, 2, 3].map(|k| 3 * i + k);
            [[0, a, b], [0, b, c], [0, c, a], [a, c, b]]
        });
        PolygonMesh::new(points, faces).expect("valid")
    };
    let fan = {
        let rim = (0..n).map(|i| {
            let (sin, cos) = (i as f32 * std::f32::consts::TAU / n as f32).sin_cos();
            [cos, sin, 0.0]
        });
        let points = std::iter::once([0.0; 3]).chain(rim);
        PolygonMesh::new(points, (0..n).map(|i| [0, i + 1, (i + 1) % n + 1])).expect("valid")
    };
    for (polygons, are_visited) in [(tetrahedra, false), (fan, true)] {
        let mesh = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds all");
        let numbering = Numbering::new(&mesh).expect("triangles");
        let work = Work::new(&mesh, numbering, 10.0);
        let valences = work.numbering.valences(&mesh);
        let mut edges = work.numbering.edges(&mesh);
        edges.retain(|ends| ends.iter().any(|&v| valences[v as usize] > HUB));
        let mut visits = 10 * n as usize;
        let mut allowed = 0;
        for &ends in edges.iter().step_by(16) {
            let e = work.numbering.edge(&mesh, ends).expect("an edge");
            let to = DVec3::ZERO;
            allowed += usize::from(work.may_collapse(&mesh, e, ends, to, &valences, &mut visits));
        }
        let most = if are_visited { 10 } else { 0 };
        assert_eq!(allowed, most);
        assert_eq!(visits, (10 - most) * n as usize);
    }
}
