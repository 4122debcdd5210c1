use std::collections::BTreeSet;

use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};
use sixfold_half_edge::EditableHalfEdgeMesh;
use sixfold_indexed_face_set::EditableIndexedFaceSet;
use sixfold_spatial::{Bvh, SpatialIndex, SurfaceQueries, polygon_triangles};

use super::*;
use crate::numbering::tests::two_cones;
use crate::rules::curve_at;

fn decimation(target: Target, boundary: DecimationBoundary) -> Decimation {
    Decimation {
        target,
        boundary,
        ..Decimation::default()
    }
}

fn decimated(polygons: &PolygonMesh, options: &Decimation) -> (EditableHalfEdgeMesh, Decimated) {
    let mut mesh = EditableHalfEdgeMesh::from_polygons(polygons).expect("a manifold");
    let report = decimate(&mut mesh, options).expect("triangles");
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(mesh.face_count(), report.faces);
    (mesh, report)
}

fn area(polygons: &PolygonMesh) -> f64 {
    let faces = polygons.faces().iter();
    let areas = faces.map(|(_, face)| {
        let [a, b, c] = [0, 1, 2].map(|i| polygons.position(face[i]).as_dvec3());
        (b - a).cross(c - a).length() / 2.0
    });
    areas.sum()
}

fn euler(mesh: &EditableHalfEdgeMesh) -> isize {
    mesh.vertex_count() as isize - mesh.edge_count() as isize + mesh.face_count() as isize
}

#[test]
fn a_sphere_stays_a_sphere() {
    let sphere = sixfold_shapes::geodesic(8).expect("small");
    let (mesh, report) = decimated(
        &sphere,
        &decimation(Target::Ratio(0.1), DecimationBoundary::Follow),
    );
    assert_eq!((report.faces, report.stop), (128, Stop::Done));
    assert_eq!(euler(&mesh), 2);
    for v in mesh.vertices() {
        let radius = mesh.position(v).length();
        assert!(
            (0.97..1.06).contains(&radius),
            "{v} is {radius} from the centre"
        );
    }
    assert!(report.max_error > 0.0 && report.collapses == (1280 - 128) / 2);
}

#[test]
fn a_flat_square_is_decimated_to_two_triangles() {
    let grid = sixfold_shapes::triangle_grid(12, 12).expect("small");
    let (mesh, report) = decimated(
        &grid,
        &decimation(Target::Faces(2), DecimationBoundary::Follow),
    );
    assert_eq!(report.faces, 2);
    assert!(
        report.max_error < 1e-6,
        "no error if flat: {}",
        report.max_error
    );
    let out = mesh.to_polygons();
    assert!(
        (area(&out) - area(&grid)).abs() < 1e-3 * area(&grid),
        "the outline stays"
    );
}

#[test]
fn a_fixed_boundary_keeps_its_exact_positions() {
    let grid = sixfold_shapes::triangle_grid(8, 8).expect("small");
    let original = EditableHalfEdgeMesh::from_polygons(&grid).expect("a manifold");
    let outline = |mesh: &EditableHalfEdgeMesh| -> BTreeSet<[u32; 3]> {
        let edges = mesh.edges().filter(|&e| mesh.edge_faces(e).count() == 1);
        let ends = edges.flat_map(|e| mesh.edge_vertices(e));
        ends.map(|v| mesh.position(v).to_array().map(f32::to_bits))
            .collect()
    };
    let (mesh, report) = decimated(
        &grid,
        &decimation(Target::Faces(0), DecimationBoundary::Fixed),
    );
    assert_eq!(outline(&mesh), outline(&original));
    assert_eq!(report.stop, Stop::NoLegalEdit);
    assert!(
        report.faces <= 40,
        "{} faces over 32 boundary edges",
        report.faces
    );
}

#[test]
fn an_unreachable_target_is_reported() {
    let (mesh, report) = decimated(
        &sixfold_shapes::icosahedron(),
        &decimation(Target::Faces(0), DecimationBoundary::Follow),
    );
    assert_eq!(report.stop, Stop::NoLegalEdit);
    assert_eq!(
        (report.faces, euler(&mesh)),
        (4, 2),
        "a tetrahedron is the smallest sphere"
    );
    let (_, report) = decimated(
        &sixfold_shapes::icosahedron(),
        &decimation(Target::Faces(99), DecimationBoundary::Follow),
    );
    assert_eq!(
        (report.faces, report.collapses, report.stop),
        (20, 0, Stop::Done)
    );
}

#[test]
fn bad_input_is_refused() {
    let mut cube = EditableHalfEdgeMesh::from_polygons(&sixfold_shapes::cube()).expect("closed");
    let error = decimate(&mut cube, &Decimation::default()).expect_err("quads");
    assert!(
        matches!(error, RemeshError::NotATriangle { degree: 4, .. }),
        "{error}"
    );
    let mut mesh =
        EditableHalfEdgeMesh::from_polygons(&sixfold_shapes::icosahedron()).expect("closed");
    for ratio in [f64::NAN, -0.1, 1.1, f64::INFINITY] {
        let options = decimation(Target::Ratio(ratio), DecimationBoundary::Follow);
        let error = decimate(&mut mesh, &options).expect_err("invalid ratio");
        assert!(matches!(error, RemeshError::BadRatio { .. }), "{error}");
    }
    let nan_point = Point::new(0.0, f32::NAN, 0.0);
    let broken = PolygonMesh::new([Point::X, Point::Y, nan_point], [[0, 1, 2]]).expect("valid");
    let mut broken = EditableHalfEdgeMesh::from_polygons(&broken).expect("a triangle");
    let error = decimate(&mut broken, &Decimation::default()).expect_err("NaN");
    assert!(matches!(error, RemeshError::NotFinite { .. }), "{error}");
}

#[test]
fn a_structure_that_scans_makes_the_same_mesh() {
    for polygons in [
        sixfold_shapes::geodesic(4).expect("small"),
        sixfold_shapes::triangle_grid(9, 7).expect("small"),
        sixfold_shapes::triangle_torus(9, 8).expect("small"),
    ] {
        let options = decimation(Target::Ratio(0.3), DecimationBoundary::Follow);
        let (walked, report) = decimated(&polygons, &options);
        let mut scanned = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds all");
        assert_eq!(decimate(&mut scanned, &options), Ok(report));
        assert_eq!(
            walked.to_polygons().positions(),
            scanned.to_polygons().positions()
        );
    }
}

#[test]
fn watch_can_end_the_decimation() {
    let sphere = sixfold_shapes::geodesic(32).expect("small");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&sphere).expect("closed");
    let report = decimate_watched(
        &mut mesh,
        &decimation(Target::Faces(4), DecimationBoundary::Follow),
        &mut |_| ControlFlow::Break(()),
    );
    let report = report.expect("triangles");
    let tried = report.collapses + report.refused;
    assert_eq!((report.stop, tried), (Stop::Requested, 1024));
    assert_eq!(mesh.validate(), Ok(()));
}

/// Three plates of `n × n` squares that meet in the z axis, at 120 degrees; `2·n²` triangles each.
pub(crate) fn three_plates(n: u32) -> PolygonMesh {
    let mut points: Vec<Point> = (0..=n).map(|z| Point::new(0.0, 0.0, z as f32)).collect();
    let mut faces = Vec::new();
    for plate in 0..3 {
        let angle = f64::from(plate) * std::f64::consts::TAU / 3.0;
        let outward = Point::new(angle.cos() as f32, angle.sin() as f32, 0.0);
        let first = points.len() as u32;
        for x in 1..=n {
            points.extend((0..=n).map(|z| outward * x as f32 + Point::Z * z as f32));
        }
        let at = |x: u32, z: u32| match x {
            0 => z,
            _ => first + (x - 1) * (n + 1) + z,
        };
        for (x, z) in (0..n).flat_map(|x| (0..n).map(move |z| (x, z))) {
            let [a, b] = [at(x, z), at(x + 1, z)];
            let [c, d] = [at(x + 1, z + 1), at(x, z + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    PolygonMesh::new(points, faces).expect("valid")
}

#[test]
fn plates_on_one_line_keep_their_corners() {
    let plates = three_plates(6);
    let options = decimation(Target::Faces(6), DecimationBoundary::Follow);
    let mut mesh = EditableIndexedFaceSet::from_polygons(&plates).expect("holds all");
    let report = decimate(&mut mesh, &options).expect("triangles");
    assert_eq!((report.faces, report.stop), (6, Stop::Done));
    let out = mesh.to_polygons();
    assert!((area(&out) - 3.0 * 36.0).abs() < 1e-3, "{}", area(&out));
    let mut at_corners = 0;
    for p in mesh.vertices().map(|v| mesh.position(v)) {
        let far = p.truncate().length();
        let is_corner =
            (far < 1e-3 || (far - 6.0).abs() < 1e-3) && [0.0, 6.0].contains(&p.z.round());
        at_corners += usize::from(is_corner);
    }
    assert_eq!((mesh.vertex_count(), at_corners), (8, 8));
    // No fewer: each plate is a rectangle, and their topology stays.
    let options = decimation(Target::Faces(0), DecimationBoundary::Follow);
    let report = decimate(&mut mesh, &options).expect("triangles");
    assert_eq!(report.stop, Stop::NoLegalEdit);
    let counts = mesh.edges().map(|e| mesh.edge_faces(e).count());
    assert_eq!(counts.filter(|&faces| faces == 3).count(), 1);
}

fn bounded(distance: f64) -> Decimation {
    Decimation {
        target: Target::Faces(0),
        max_distance: Some(distance),
        ..Decimation::default()
    }
}

#[test]
fn the_largest_distance_is_kept() {
    let sphere = sixfold_shapes::geodesic(12).expect("small");
    let surface = Bvh::build(polygon_triangles(&sphere).expect("finite")).expect("small");
    let mut faces_before = sphere.face_count();
    for limit in [0.004, 0.01, 0.05, 0.2] {
        let (mesh, report) = decimated(&sphere, &bounded(limit));
        let largest = report.max_distance.expect("it was limited");
        assert!(
            largest <= limit && largest > 0.4 * limit,
            "{largest} of {limit}"
        );
        assert!(report.faces < faces_before, "{} at {limit}", report.faces);
        faces_before = report.faces;
        let out = mesh.to_polygons();
        for &p in out.positions() {
            let closest = surface.closest_point(p).expect("not empty");
            assert!(closest.distance() <= limit);
        }
        let new = Bvh::build(polygon_triangles(&out).expect("finite")).expect("small");
        // Vertices, the middles of edges and the centres of faces.
        let points = sphere.faces().iter().flat_map(|(_, face)| {
            let [a, b, c] = [0, 1, 2].map(|i| sphere.position(face[i]));
            [a, a.midpoint(b), (a + b + c) / 3.0]
        });
        for p in points {
            let closest = new.closest_point(p).expect("not empty");
            assert!(closest.distance() <= limit * (1.0 + 1e-6));
        }
    }
    assert!(faces_before < 40, "{faces_before}");
}

#[test]
fn the_largest_distance_is_kept_at_hubs() {
    for n in [2 * HUB, LARGE_HUB + 100] {
        let cones = two_cones(n);
        let surface = Bvh::build(polygon_triangles(&cones).expect("finite")).expect("small");
        let limit = 0.005;
        let (mesh, report) = decimated(&cones, &bounded(limit));
        assert!(report.max_distance.expect("it was limited") <= limit);
        assert!(report.faces < 150, "{}", report.faces);
        let out = mesh.to_polygons();
        let new = Bvh::build(polygon_triangles(&out).expect("finite")).expect("small");
        for (points, other) in [(out.positions(), &surface), (cones.positions(), &new)] {
            for &p in points {
                assert!(other.is_within(p, limit * (1.0 + 1e-6)), "{p}");
            }
        }
    }
}

#[test]
fn a_flat_surface_does_not_deviate() {
    let grid = sixfold_shapes::triangle_grid(10, 10).expect("small");
    let (_, report) = decimated(&grid, &bounded(1e-5));
    assert_eq!((report.faces, report.stop), (2, Stop::NoLegalEdit));
    // The diagonal of two triangles is not changed, although no vertex would be far away.
    let tent = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 0.0],
    ];
    let tent = PolygonMesh::new(tent, [[0, 1, 2], [0, 2, 3]]).expect("valid");
    let (_, report) = decimated(&tent, &bounded(0.1));
    assert_eq!(report.faces, 2);
    assert!(report.max_distance.expect("it was limited") < 1e-6);
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&tent).expect("a manifold");
    for distance in [f64::NAN, -1.0] {
        let error = decimate(&mut mesh, &bounded(distance)).expect_err("invalid");
        assert!(matches!(error, RemeshError::BadDistance { .. }), "{error}");
    }
}

/// Returns octahedra that share vertex 0.
fn octahedra_at_one_vertex(n: u32) -> PolygonMesh {
    let octahedron = sixfold_shapes::octahedron();
    let first = octahedron.position(sixfold_core::VertexId::new(0));
    let mut points = vec![Point::ZERO];
    let mut faces = Vec::new();
    for i in 0..n {
        let shift = points.len() as u32 - 1;
        let angle = f64::from(i) * std::f64::consts::TAU / f64::from(n);
        let turn = glam::Mat3::from_rotation_y(angle as f32);
        points.extend(
            octahedron.positions()[1..]
                .iter()
                .map(|&p| turn * (p - first)),
        );
        faces.extend(octahedron.faces().iter().map(|(_, face)| {
            [0, 1, 2].map(|i| match face[i].index() as u32 {
                0 => 0,
                other => other + shift,
            })
        }));
    }
    PolygonMesh::new(points, faces).expect("valid")
}

#[test]
fn collapses_keep_the_curves() {
    for polygons in [
        three_plates(6),
        octahedra_at_one_vertex(40),
        sixfold_shapes::triangle_grid(12, 12).expect("small"),
    ] {
        let mut mesh = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds all");
        let mut work = Work::new(&mesh, DecimationBoundary::Follow).expect("triangles");
        work.fill_queue(&mesh);
        let mut collapses = 0;
        while let Some((entry, _)) = work.next_entry() {
            collapses += usize::from(work.collapse(&mut mesh, &entry).is_some());
        }
        assert!(collapses > 10, "{collapses}");
        for v in mesh.vertices() {
            let vertex = work.vertices[work.numbering.number(v) as usize];
            assert_eq!(vertex.curve, curve_at(&mesh, v), "{v}");
        }
    }
}

#[test]
fn edges_at_hubs_are_tried_last_after_very_many_visits() {
    let polygons = octahedra_at_one_vertex(40);
    let mut mesh = EditableIndexedFaceSet::from_polygons(&polygons).expect("holds all");
    let mut faces = Vec::new();
    for visits in [None, Some(0)] {
        let mut mesh = mesh.clone();
        let mut work = Work::new(&mesh, DecimationBoundary::Follow).expect("triangles");
        work.fill_queue(&mesh);
        work.visits = visits.unwrap_or(work.visits);
        while let Some((entry, _)) = work.next_entry() {
            work.collapse(&mut mesh, &entry);
        }
        faces.push(mesh.face_count());
    }
    // No octahedron becomes smaller than a tetrahedron.
    assert_eq!(faces, [40 * 4; 2]);
    let report = decimate(&mut mesh, &bounded(f64::INFINITY)).expect("triangles");
    assert_eq!((report.faces, report.stop), (40 * 4, Stop::NoLegalEdit));
}

#[test]
fn watch_is_called_between_refused_edges() {
    // All triangles have one edge in common, and no edge can collapse.
    let n = 2000;
    let rim = (0..n).map(|i| {
        let (sin, cos) = (i as f32 * 0.003).sin_cos();
        Point::new(cos, sin, 0.0)
    });
    let points = [Point::ZERO, Point::Z].into_iter().chain(rim);
    let book = PolygonMesh::new(points, (0..n).map(|i| [0, 1, i + 2])).expect("valid");
    let mut mesh = EditableIndexedFaceSet::from_polygons(&book).expect("holds all");
    let options = decimation(Target::Faces(0), DecimationBoundary::Follow);
    let report = decimate_watched(&mut mesh, &options, &mut |_| ControlFlow::Break(()));
    let report = report.expect("triangles");
    assert_eq!((report.stop, report.collapses), (Stop::Requested, 0));
    assert!(report.refused < 1024, "{}", report.refused);
}
