//! Checks that the examples give the same results on every structure, and expected results on
//! simple meshes.

use sixfold::prelude::*;
use sixfold::shapes::{cube, geodesic, tetrahedron, torus};
use sixfold::{for_each_editable, for_each_representation};

/// Includes an example as a module, so that tests can call its functions.
macro_rules! example {
    ($name:ident, $file:literal) => {
        #[path = $file]
        #[allow(
            clippy::duplicate_mod,
            dead_code,
            unreachable_pub,
            reason = "a test calls some functions of an example, and examples share a module"
        )]
        mod $name;
    };
}

example!(dijkstra, "../../examples/dijkstra.rs");
example!(taubin, "../../examples/taubin.rs");
example!(regions, "../../examples/regions.rs");
example!(feature_lines, "../../examples/feature_lines.rs");
example!(subdivide_creases, "../../examples/subdivide_creases.rs");
example!(choose_structure, "../../examples/choose_structure.rs");
example!(laplacian, "../../examples/laplacian.rs");
example!(remesh, "../../examples/remesh.rs");

fn build<M: Representation>(polygons: &PolygonMesh) -> M {
    M::from_polygons(polygons).expect("a closed oriented triangle mesh")
}

#[test]
fn distances_along_edges_are_those_of_the_tetrahedron_and_equal_on_all_structures() {
    let polygons = tetrahedron();
    let edge = polygons
        .position(VertexId::new(0))
        .distance(polygons.position(VertexId::new(1)));
    for_each_representation!(M => {
        let mesh: M = build(&polygons);
        let source = M::vertex_handle(&polygons, VertexId::new(0));
        let found = dijkstra::distances(&mesh, source);
        let lengths = polygons.vertices().map(|v| found[M::vertex_handle(&polygons, v)]);
        let lengths: Vec<f64> = lengths.collect();
        assert_eq!(lengths, [0.0, edge.into(), edge.into(), edge.into()], "{}", M::NAME);
    });
    let polygons = geodesic(4).expect("a small frequency");
    let mut expected: Option<Vec<f64>> = None;
    for_each_representation!(M => {
        let mesh: M = build(&polygons);
        let found = dijkstra::distances(&mesh, M::vertex_handle(&polygons, VertexId::new(0)));
        let lengths = polygons.vertices().map(|v| found[M::vertex_handle(&polygons, v)]);
        let lengths: Vec<f64> = lengths.collect();
        // The path along edges is longer than the chords and shorter than twice the arc.
        let farthest = lengths.iter().copied().fold(0.0, f64::max);
        assert!((2.9..6.3).contains(&farthest), "{farthest}");
        assert_eq!(*expected.get_or_insert(lengths.clone()), lengths, "{}", M::NAME);
    });
}

#[test]
fn taubin_smoothing_removes_noise_and_keeps_the_size() {
    let smooth = geodesic(8).expect("a small frequency");
    let noise = |i: usize| 1.0 + 0.05 * (((i * 2_654_435_761) >> 7) % 1_000) as f32 / 1_000.0;
    let positions = smooth.positions().iter().enumerate();
    let positions = positions.map(|(i, &p)| p * noise(i)).collect();
    let rough = PolygonMesh::from_faces(positions, smooth.faces().clone()).expect("the same faces");
    let radii = |mesh: &PolygonMesh| -> [f32; 2] {
        let radii: Vec<f32> = mesh.positions().iter().map(|p| p.length()).collect();
        let mean = radii.iter().sum::<f32>() / radii.len() as f32;
        let variance = radii.iter().map(|r| (r - mean) * (r - mean)).sum::<f32>();
        [mean, (variance / radii.len() as f32).sqrt()]
    };
    let [mean, deviation] = radii(&rough);
    for_each_representation!(M => {
        let mut mesh: M = build(&rough);
        taubin::smooth(&mut mesh, 10).expect("no two vertices at one position");
        let [smooth_mean, smooth_deviation] = radii(&mesh.to_polygons());
        assert!((smooth_mean / mean - 1.0).abs() < 0.01, "{}: {smooth_mean}", M::NAME);
        assert!(smooth_deviation < 0.6 * deviation, "{}: {smooth_deviation}", M::NAME);
    });
}

#[test]
fn taubin_smoothing_keeps_the_boundary() {
    let polygons = sixfold::shapes::grid(6, 6).expect("a small grid");
    let mut mesh: HalfEdgeMesh = build(&polygons);
    let boundary = |mesh: &HalfEdgeMesh| -> Vec<Point> {
        let vertices = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v));
        vertices.map(|v| mesh.position(v)).collect()
    };
    let before = boundary(&mesh);
    taubin::smooth(&mut mesh, 3).expect("rows are handles");
    assert_eq!(before, boundary(&mesh));
}

#[test]
fn regions_are_the_sides_of_a_cube() {
    let polygons = cube().triangulated().expect("triangles").polygons;
    for_each_representation!(M => {
        let mesh: M = build(&polygons);
        let (regions, count) = regions::regions(&mesh, 20.0);
        assert_eq!(count, 6, "{}", M::NAME);
        for region in 0..count {
            let faces = mesh.faces().filter(|&f| regions[f] == Some(region)).count();
            assert_eq!(faces, 2, "{}", M::NAME);
        }
        assert_eq!(regions::regions(&mesh, 95.0).1, 2, "one side and four neighbours; the last");
    });
}

#[test]
fn feature_lines_end_at_branching_vertices_or_are_closed() {
    let polygons = cube().triangulated().expect("triangles").polygons;
    for_each_representation!(M => {
        let mesh: M = build(&polygons);
        let lines = feature_lines::feature_lines(&mesh, 30.0);
        assert_eq!(lines.len(), 12, "{}: the edges of a cube", M::NAME);
        assert!(lines.iter().all(|line| line.len() == 2));
    });
    let strip = sixfold::shapes::grid(5, 3).expect("a small grid");
    let mesh: HalfEdgeMesh = build(&strip);
    let lines = feature_lines::feature_lines(&mesh, 30.0);
    assert_eq!(lines.len(), 1, "the boundary of a flat grid");
    assert_eq!(lines[0].first(), lines[0].last());
    let smooth: HalfEdgeMesh = build(&torus(40, 20).expect("a small torus"));
    assert!(feature_lines::feature_lines(&smooth, 30.0).is_empty());
}

#[test]
fn sharp_edges_stay_sharp_for_as_many_levels_as_their_sharpness() {
    let polygons = cube();
    let creases = subdivide_creases::creases_around(&polygons, FaceId::new(0), 2.0);
    let creases = creases.expect("a finite sharpness");
    let mut counts = Vec::new();
    let mut results = Vec::new();
    macro_rules! subdivide {
        ($($mesh:ty),+) => {$(
            counts.clear();
            let smooth = subdivide_creases::subdivide::<$mesh>(&polygons, &creases, 3, |_, step| {
                counts.push((step.polygons.face_count(), step.creases.edges().len()));
            });
            results.push(smooth.expect("a cube"));
            assert_eq!(counts, [(24, 8), (96, 0), (384, 0)]);
        )+};
    }
    subdivide!(
        PolygonSoup,
        IndexedFaceSet,
        FaceVertexMesh,
        WingedEdgeMesh,
        HalfEdgeMesh
    );
    let highest = |mesh: &PolygonMesh| {
        let heights = mesh.positions().iter().map(|p| p.length());
        heights.fold(0.0, f32::max)
    };
    for smooth in &results {
        assert_eq!(smooth.vertex_count(), 386);
        let [soup, found] = [&results[0], smooth].map(highest);
        assert!((soup - found).abs() < 1e-6);
    }
    let level_two = |creases| {
        let smooth = subdivide_creases::subdivide::<HalfEdgeMesh>(&polygons, creases, 2, |_, _| {});
        highest(&smooth.expect("a cube"))
    };
    assert!(level_two(&creases) > level_two(&sixfold::Creases::default()));
}

#[test]
fn every_structure_is_found_by_its_name() {
    let polygons = geodesic(3).expect("a small frequency");
    let mut task = choose_structure::MeanValence {
        polygons: &polygons,
    };
    let edges = 3 * polygons.face_count() / 2;
    let expected = 2.0 * edges as f64 / polygons.vertex_count() as f64;
    for info in sixfold::structure_infos() {
        let valence = sixfold::visit(info.name, &mut task).expect("a structure");
        assert_eq!(
            valence.expect("a closed triangle mesh"),
            expected,
            "{}",
            info.name
        );
    }
    assert!(sixfold::visit("quad-edge", &mut task).is_none());
}

#[test]
fn the_laplacian_of_constants_is_zero_and_that_of_coordinates_points_inwards() {
    let polygons = geodesic(6).expect("a small frequency");
    for_each_representation!(M => {
        let mesh: M = build(&polygons);
        let matrix = laplacian::laplacian(&mesh).map_err(|f| format!("{f:?}"));
        let laplacian::Laplacian { numbers, triplets } = matrix.expect("triangles");
        let ones = vec![1.0; numbers.len()];
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |max, v| max.max(v.abs()));
        assert!(largest(&laplacian::multiply(&triplets, &ones)) < 1e-9, "{}", M::NAME);
        let handles = numbers.handles();
        let heights: Vec<f64> = handles.iter().map(|&v| mesh.position(v).z.into()).collect();
        let product = laplacian::multiply(&triplets, &heights);
        for (&v, (&l, &z)) in handles.iter().zip(product.iter().zip(&heights)) {
            assert!(l * z <= 1e-9, "{}: {v:?}", M::NAME);
        }
        // Half the integral of |grad z|² over the sphere is 4π/3.
        let energy: f64 = product.iter().zip(&heights).map(|(l, z)| -l * z).sum::<f64>() / 2.0;
        let exact = 4.0 / 3.0 * std::f64::consts::PI;
        assert!((energy / exact - 1.0).abs() < 0.05, "{}: {energy}", M::NAME);
    });
    let mesh: HalfEdgeMesh = build(&cube());
    assert!(laplacian::laplacian(&mesh).is_err(), "a cube has quads");
}

#[test]
fn remeshing_makes_edges_of_one_length_and_faces_keep_their_material() {
    let polygons = geodesic(3).expect("a small frequency");
    let height = |corners: &mut dyn Iterator<Item = Point>| corners.map(|p| p.z).sum::<f32>();
    let mut counts = Vec::new();
    for_each_editable!(M => {
        let mesh: M = build(&polygons);
        let is_upper = |mesh: &M, f| {
            let mut corners = mesh.face_vertices(f).map(|v| mesh.position(v));
            u32::from(height(&mut corners) > 0.0)
        };
        let upper = mesh.faces().filter(|&f| is_upper(&mesh, f) == 1).count();
        let mut mesh = remesh::with_materials(mesh, is_upper);
        let [cut, _] = remesh::remesh(&mut mesh, 0.25);
        assert!(cut > polygons.face_count() / 2, "{}: {cut}", M::NAME);
        let (mesh, materials) = mesh.into_parts();
        assert_eq!(mesh.validate(), Ok(()), "{}", M::NAME);
        let after = mesh.faces().filter(|&f| materials[f] == 1).count();
        let [before, after] =
            [(upper, polygons.face_count()), (after, mesh.face_count())].map(|(n, all)| n as f64 / all as f64);
        assert!((before - after).abs() < 0.05, "{}: {before} and {after}", M::NAME);
        counts.push(mesh.face_count());
    });
    assert_eq!(counts.len(), 6);
}
