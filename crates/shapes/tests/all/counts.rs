//! The counts, topology and geometry of every shape.

use sixfold_core::{Facts, Point, PolygonMesh, VertexId};
use sixfold_shapes::{ControlNet, ShapeError};

type ShapeResult = Result<PolygonMesh, ShapeError>;

struct Expected {
    vertices: usize,
    edges: usize,
    faces: usize,
    boundary_loops: usize,
    genus: Option<i64>,
}

impl Expected {
    fn disk(vertices: usize, edges: usize, faces: usize) -> Self {
        Self {
            vertices,
            edges,
            faces,
            boundary_loops: 1,
            genus: Some(0),
        }
    }

    fn closed(vertices: usize, edges: usize, faces: usize, genus: i64) -> Self {
        Self {
            boundary_loops: 0,
            genus: Some(genus),
            ..Self::disk(vertices, edges, faces)
        }
    }
}

/// Compares `mesh` with `expected`, and checks the properties of all shapes.
fn check(name: &str, mesh: &PolygonMesh, expected: &Expected) -> Facts {
    let facts = Facts::from_polygons(mesh);
    assert_eq!(facts.vertices, expected.vertices, "vertices of {name}");
    assert_eq!(facts.edges, expected.edges, "edges of {name}");
    assert_eq!(facts.faces, expected.faces, "faces of {name}");
    assert_eq!(
        facts.boundary_loops,
        Some(expected.boundary_loops),
        "boundary of {name}"
    );
    assert_eq!(facts.genus, expected.genus, "genus of {name}");
    assert_eq!(
        facts.orientable,
        Some(expected.genus.is_some()),
        "orientability of {name}"
    );
    let closed = expected.boundary_loops == 0;
    assert_eq!(facts.closed, closed, "{name}");
    let [v, e, f] = [expected.vertices, expected.edges, expected.faces].map(|x| x as i64);
    assert_eq!(facts.euler_characteristic, v - e + f, "χ of {name}");
    if let Some(genus) = expected.genus {
        let characteristic = 2 - 2 * genus - expected.boundary_loops as i64;
        assert_eq!(
            facts.euler_characteristic, characteristic,
            "χ by genus of {name}"
        );
    }
    assert_eq!(facts.components, 1, "{name}");
    let none = [
        facts.isolated_vertices,
        facts.non_manifold_edges,
        facts.non_manifold_vertices,
        facts.duplicate_faces,
        facts.degenerate_faces,
    ];
    assert_eq!(none, [0; 5], "{name}");
    // Only the faces of a one-sided shape have inconsistent orientations.
    assert_eq!(
        facts.inconsistent_edges > 0,
        expected.genus.is_none(),
        "{name}"
    );

    assert!(mesh.positions().iter().all(|p| p.is_finite()), "{name}");
    let mut positions: Vec<[u32; 3]> = mesh.positions().iter().map(bits).collect();
    positions.sort_unstable();
    positions.dedup();
    assert_eq!(
        positions.len(),
        mesh.vertex_count(),
        "two vertices of {name} at one position"
    );
    if closed {
        assert!(volume(mesh) > 0.0, "{name} is inside out");
    }
    facts
}

fn bits(point: &Point) -> [u32; 3] {
    point.to_array().map(|x| (x + 0.0).to_bits())
}

/// Returns the enclosed volume; negative if the mesh is inside out.
fn volume(mesh: &PolygonMesh) -> f64 {
    let mut volume = 0.0;
    for (_, face) in mesh.faces().iter() {
        let position = |v: VertexId| mesh.position(v).as_dvec3();
        for pair in face[1..].windows(2) {
            volume += position(face[0]).dot(position(pair[0]).cross(position(pair[1]))) / 6.0;
        }
    }
    volume
}

/// Checks that every face runs counter-clockwise as seen from above.
fn check_flat(name: &str, mesh: &PolygonMesh) {
    for (f, face) in mesh.faces().iter() {
        let mut double_area = 0.0;
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            let [a, b] = [a, b].map(|v| mesh.position(v));
            double_area += a.x * b.y - a.y * b.x;
            assert_eq!(a.z, 0.0, "{name}");
        }
        assert!(double_area > 0.0, "{f} of {name} is turned over");
    }
}

fn check_sides(name: &str, mesh: &PolygonMesh, length: f32) {
    for (f, face) in mesh.faces().iter() {
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            let side = mesh.position(a).distance(mesh.position(b));
            assert!(
                (side - length).abs() < 1e-5 * length,
                "a side of {f} of {name}: {side}"
            );
        }
    }
}

/// Returns pairs of a value and its number of occurrences.
fn hist(spread: &Option<sixfold_core::Distribution>) -> Vec<(usize, usize)> {
    let hist = spread.as_ref().and_then(|spread| spread.hist.clone());
    hist.expect("a mesh with few different degrees")
        .into_iter()
        .collect()
}

#[test]
fn platonic_solids_and_their_duals() {
    let solids = [
        (
            "tetrahedron",
            sixfold_shapes::tetrahedron(),
            [4, 6, 4],
            8.0_f32.sqrt(),
        ),
        ("cube", sixfold_shapes::cube(), [8, 12, 6], 2.0),
        (
            "octahedron",
            sixfold_shapes::octahedron(),
            [6, 12, 8],
            2.0_f32.sqrt(),
        ),
        (
            "dodecahedron",
            sixfold_shapes::dodecahedron(),
            [20, 30, 12],
            5.0_f32.sqrt() - 1.0,
        ),
        (
            "icosahedron",
            sixfold_shapes::icosahedron(),
            [12, 30, 20],
            2.0,
        ),
    ];
    let facts = solids.map(|(name, mesh, [v, e, f], side)| {
        let facts = check(name, &mesh, &Expected::closed(v, e, f, 0));
        check_sides(name, &mesh, side);
        let radius = mesh.position(VertexId::new(0)).length();
        for p in mesh.positions() {
            assert!((p.length() - radius).abs() < 1e-6, "{name}");
        }
        (name, facts)
    });
    // The dual exchanges vertices and faces, valence and degree.
    for (i, dual) in [0, 2, 1, 4, 3].into_iter().enumerate() {
        let ((name, a), (other, b)) = (&facts[i], &facts[dual]);
        assert_eq!(
            (a.vertices, a.edges),
            (b.faces, b.edges),
            "{name} and {other}"
        );
        assert_eq!(hist(&a.valence), hist(&b.face_degree), "{name} and {other}");
        assert_eq!(hist(&a.valence).len(), 1, "{name}");
    }
}

#[test]
fn prisms_and_antiprisms() {
    for n in (3..40).chain([1000]) {
        let name = format!("prism {n}");
        let mesh = sixfold_shapes::prism(n).expect(&name);
        let facts = check(&name, &mesh, &Expected::closed(2 * n, 3 * n, n + 2, 0));
        assert_eq!(hist(&facts.valence), [(3, 2 * n)], "{name}");
        let name = format!("antiprism {n}");
        let mesh = sixfold_shapes::antiprism(n).expect(&name);
        let facts = check(&name, &mesh, &Expected::closed(2 * n, 4 * n, 2 * n + 2, 0));
        assert_eq!(hist(&facts.valence), [(4, 2 * n)], "{name}");
    }
    check_sides(
        "prism 4",
        &sixfold_shapes::prism(4).expect("a cube"),
        2.0_f32.sqrt(),
    );
    check_sides(
        "antiprism 3",
        &sixfold_shapes::antiprism(3).expect("an octahedron"),
        3.0_f32.sqrt(),
    );
}

#[test]
fn spheres() {
    for m in 3..12 {
        for n in 2..12 {
            let name = format!("uv-sphere {m} {n}");
            let mesh = sixfold_shapes::uv_sphere(m, n).expect(&name);
            let expected = Expected::closed(m * (n - 1) + 2, m * (2 * n - 1), m * n, 0);
            check(&name, &mesh, &expected);
            check_unit(&name, &mesh);
        }
    }
    for f in 1..=16 {
        let name = format!("geodesic {f}");
        let mesh = sixfold_shapes::geodesic(f).expect(&name);
        let expected = Expected::closed(10 * f * f + 2, 30 * f * f, 20 * f * f, 0);
        let facts = check(&name, &mesh, &expected);
        check_unit(&name, &mesh);
        let six = (6, 10 * f * f - 10);
        let valences = [(5, 12), six];
        assert_eq!(
            hist(&facts.valence),
            valences[..if f == 1 { 1 } else { 2 }],
            "{name}"
        );
        for (face, corners) in mesh.faces().iter() {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.position(corners[i]));
            assert!((b - a).cross(c - a).dot(a) > 0.0, "{face} of {name}");
        }
    }
}

fn check_unit(name: &str, mesh: &PolygonMesh) {
    for p in mesh.positions() {
        assert!((p.length() - 1.0).abs() < 1e-6, "{p} of {name}");
    }
}

#[test]
fn grids_and_tilings() {
    for m in 1..10 {
        for n in 1..10 {
            let (v, e, f) = ((m + 1) * (n + 1), 2 * m * n + m + n, m * n);
            let flat = |name: &str, result: ShapeResult, expected: Expected| {
                let name = format!("{name} {m} {n}");
                let mesh = result.expect(&name);
                check_flat(&name, &mesh);
                (check(&name, &mesh, &expected), mesh)
            };
            let (_, squares) = flat("grid", sixfold_shapes::grid(m, n), Expected::disk(v, e, f));
            check_sides("grid", &squares, 1.0);
            let halves = || Expected::disk(v, e + f, 2 * f);
            flat(
                "triangle-grid",
                sixfold_shapes::triangle_grid(m, n),
                halves(),
            );
            let (facts, triangles) = flat(
                "triangle-tiling",
                sixfold_shapes::triangle_tiling(m, n),
                halves(),
            );
            check_sides("triangle-tiling", &triangles, 1.0);
            let inner = |facts: &Facts, valence| {
                let of = |&(v, count)| (v == valence).then_some(count);
                hist(&facts.valence).iter().find_map(of).unwrap_or(0)
            };
            assert!(inner(&facts, 6) >= (m - 1) * (n - 1), "{{3, 6}} {m} {n}");
            let cut = f / 2;
            let mixed = Expected::disk(v, e + cut, f + cut);
            flat("mixed-grid", sixfold_shapes::mixed_grid(m, n), mixed);
            let hexagons = Expected::disk(2 * v - 2, 3 * f + 2 * m + 2 * n - 1, f);
            let (facts, hexagons) = flat(
                "hexagon-tiling",
                sixfold_shapes::hexagon_tiling(m, n),
                hexagons,
            );
            check_sides("hexagon-tiling", &hexagons, 1.0);
            assert_eq!(hist(&facts.face_degree), [(6, f)]);
            assert!(
                facts
                    .valence
                    .as_ref()
                    .is_some_and(|valence| valence.max <= 3)
            );
        }
    }
}

#[test]
fn grids_with_holes() {
    for m in 1..13 {
        for n in 1..13 {
            let (v, e, f) = ((m + 1) * (n + 1), 2 * m * n + m + n, m * n);
            if m >= 3 && n >= 3 {
                let (a, b) = (m / 3, n / 3);
                let name = format!("grid-with-hole {m} {n}");
                let mesh = sixfold_shapes::grid_with_hole(m, n).expect(&name);
                check_flat(&name, &mesh);
                let expected = Expected {
                    boundary_loops: 2,
                    ..Expected::disk(v - (a - 1) * (b - 1), e - 2 * a * b + a + b, f - a * b)
                };
                check(&name, &mesh, &expected);
            }
            let max_holes = ((m - 1) / 2) * ((n - 1) / 2);
            for holes in 0..=max_holes {
                let name = format!("grid-with-holes {m} {n} {holes}");
                let mesh = sixfold_shapes::grid_with_holes(m, n, holes).expect(&name);
                let expected = Expected {
                    boundary_loops: 1 + holes,
                    ..Expected::disk(v, e, f - holes)
                };
                check(&name, &mesh, &expected);
            }
            let error = sixfold_shapes::grid_with_holes(m, n, max_holes + 1).expect_err("no room");
            let message = format!(
                "holes = {} is out of range: choose a value from 0 to {max_holes}",
                max_holes + 1
            );
            assert_eq!(error.to_string(), message);
        }
    }
}

#[test]
fn patches() {
    for (m, n) in [(1, 1), (1, 7), (6, 2), (20, 20)] {
        let (v, e, f) = ((m + 1) * (n + 1), 2 * m * n + m + n, m * n);
        for (columns, rows) in [(2, 2), (2, 5), (4, 4), (33, 3)] {
            let name = format!("bezier-patch {columns} × {rows}, {m} {n}");
            let net = ControlNet::saddle(columns, rows).expect(&name);
            let mesh = sixfold_shapes::bezier_patch(&net, m, n).expect(&name);
            check(&name, &mesh, &Expected::disk(v, e, f));
        }
        for (columns, rows, degree) in [(2, 2, 1), (4, 4, 3), (9, 5, 3), (6, 8, 5)] {
            let name = format!("b-spline-patch {columns} × {rows} of {degree}, {m} {n}");
            let net = ControlNet::waves(columns, rows).expect(&name);
            let mesh = sixfold_shapes::b_spline_patch(&net, degree, m, n).expect(&name);
            check(&name, &mesh, &Expected::disk(v, e, f));
        }
    }
}

#[test]
fn tori_surfaces_of_any_genus_and_the_moebius_strip() {
    for m in 3..12 {
        for n in 3..12 {
            let cells = m * n;
            let name = format!("torus {m} {n}");
            let mesh = sixfold_shapes::torus(m, n).expect(&name);
            let facts = check(&name, &mesh, &Expected::closed(cells, 2 * cells, cells, 1));
            assert_eq!(hist(&facts.valence), [(4, cells)], "{name}");
            let name = format!("triangle-torus {m} {n}");
            let mesh = sixfold_shapes::triangle_torus(m, n).expect(&name);
            let facts = check(
                &name,
                &mesh,
                &Expected::closed(cells, 3 * cells, 2 * cells, 1),
            );
            assert_eq!(hist(&facts.valence), [(6, cells)], "{name}");
        }
    }
    for g in 0..40 {
        let name = format!("genus {g}");
        let mesh = sixfold_shapes::genus(g).expect(&name);
        let expected = Expected::closed(16 * (g + 1), 36 * g + 28, 18 * g + 14, g as i64);
        check(&name, &mesh, &expected);
        let solid = (3 * (2 * g + 1) - g) as f64;
        assert!(
            (volume(&mesh) - solid).abs() < 1e-6,
            "{name} has the volume of its cubes"
        );
    }
    for n in 3..60 {
        let name = format!("moebius {n}");
        let mesh = sixfold_shapes::moebius(n).expect(&name);
        let expected = Expected {
            genus: None,
            ..Expected::disk(2 * n, 3 * n, n)
        };
        let facts = check(&name, &mesh, &expected);
        assert_eq!(facts.boundary_edges, 2 * n, "{name}");
        assert_eq!(facts.euler_characteristic, 0, "{name}");
    }
}

#[test]
fn the_built_in_mesh_is_the_same_on_every_machine() {
    let mesh = sixfold_shapes::built_in_mesh();
    let generated = sixfold_shapes::generator("built-in-mesh").expect("a shape");
    let generated = generated.build(&[]).expect("the default number of faces");
    assert_eq!(generated.positions(), mesh.positions());
    assert_eq!(generated.faces().corners(), mesh.faces().corners());
    let (v, e, f) = (
        mesh.vertex_count(),
        3 * mesh.face_count() / 2,
        mesh.face_count(),
    );
    let facts = check("built-in-mesh", &mesh, &Expected::closed(v, e, f, 7));
    let valence = facts.valence.expect("a mesh");
    assert!(valence.min <= 4 && valence.max >= 9, "{valence:?}");
    let common = valence.hist.iter().flat_map(|hist| hist.values()).max();
    assert!(
        common.is_some_and(|&common| 2 * common < v),
        "more than half of the vertices have the same valence: {valence:?}"
    );
    for (face, corners) in mesh.faces().iter() {
        let [a, b, c] = [0, 1, 2].map(|i| mesh.position(corners[i]));
        assert!((b - a).cross(c - a).length() > 1e-6, "{face} is a sliver");
    }
    // FNV-1a over every coordinate and corner. Published results need an unchanged mesh.
    let words = mesh.positions().iter().flat_map(bits);
    let words = words.chain(mesh.faces().corners().iter().map(|v| v.index() as u32));
    let hash = words.fold(0xCBF2_9CE4_8422_2325_u64, |hash, word| {
        (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01B3)
    });
    assert_eq!((v, f, hash), (9_988, 20_000, 12_851_112_267_927_841_803));
}
