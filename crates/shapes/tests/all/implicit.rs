//! Implicit surfaces: checks fields against their formulas, and surfaces against their topology.

use sixfold_core::{Facts, PolygonMesh};
use sixfold_shapes::generator;
use sixfold_shapes::implicit::{Blob, Field};

fn ball(x: f64, radius: f64) -> Field {
    Field::sphere([x, 0.0, 0.0], radius).expect("a ball")
}

fn ring(axis: [f64; 3]) -> Field {
    Field::torus([0.0; 3], axis, 1.0, 0.3).expect("a ring")
}

#[test]
fn fields_follow_their_formulas() {
    let assert_close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
    assert_close(ball(1.0, 0.5).at([1.0, 3.0, 4.0]), 4.5);
    assert_close(ring([0.0, 0.0, 7.0]).at([0.0, 5.0, 3.0]), 4.7);
    assert_close(ring([2.0, 0.0, 0.0]).at([0.0, 0.0, 0.0]), 0.7);
    let cuboid = Field::cuboid([0.0; 3], [1.0, 2.0, 3.0]).expect("a box");
    assert_close(cuboid.at([4.0, 6.0, 0.0]), 5.0);
    assert_close(cuboid.at([0.9, 0.0, 0.0]), -0.1);
    let [f, g] = [ball(0.0, 1.0), ball(1.0, 1.0)];
    for i in -20..20 {
        let point = [f64::from(i) / 7.0, 0.3, -0.2];
        let [a, b] = [f.at(point), g.at(point)];
        assert_close(
            f.clone().union(g.clone()).expect("two parts").at(point),
            a.min(b),
        );
        assert_close(
            f.clone()
                .intersection(g.clone())
                .expect("two parts")
                .at(point),
            a.max(b),
        );
        assert_close(
            f.clone()
                .difference(g.clone())
                .expect("two parts")
                .at(point),
            a.max(-b),
        );
        for alpha in [0.0, 0.3, 1.0] {
            let smooth = f.clone().smooth_union(g.clone(), alpha).expect("alpha");
            let expected = (a + b - (a * a + b * b - 2.0 * alpha * a * b).sqrt()) / (1.0 + alpha);
            assert_close(smooth.at(point), expected);
            // Outside the union, a blend makes the solid larger.
            assert!(smooth.at(point) <= a.min(b) + 1e-12 || a.min(b) < 0.0);
        }
        assert_close(f.clone().inflated(0.25).expect("by").at(point), a - 0.25);
    }
    let blobs = [([0.0; 3], 2.0, 0.5), ([1.0, 0.0, 0.0], -0.5, 3.0)];
    let blobs = blobs.map(|(centre, strength, sharpness)| Blob {
        centre,
        strength,
        sharpness,
    });
    let sum = Field::blobs(&blobs, 0.7).expect("two blobs");
    let expected = 0.7 - 2.0 * (-0.5_f64 * 5.0).exp() + 0.5 * (-3.0_f64 * 4.0).exp();
    assert_close(sum.at([1.0, 2.0, 0.0]), expected);
}

/// Checks that the mesh is closed, manifold and oriented, with distinct positions and about `faces`
/// triangles.
fn check(name: &str, mesh: &PolygonMesh, faces: usize) -> Facts {
    let facts = Facts::from_polygons(mesh);
    let tolerance = (faces / 20).max(20);
    assert!(
        facts.faces.abs_diff(faces) <= tolerance,
        "{name}: {} for {faces}",
        facts.faces
    );
    assert!(facts.closed, "{name}");
    assert_eq!(facts.consistently_oriented, Some(true), "{name}");
    let none = [
        facts.non_manifold_edges,
        facts.non_manifold_vertices,
        facts.isolated_vertices,
    ];
    assert_eq!(none, [0; 3], "{name}");
    let mut positions: Vec<_> = mesh
        .positions()
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect();
    positions.sort_unstable();
    positions.dedup();
    assert_eq!(positions.len(), mesh.vertex_count(), "{name}");
    let mut volume = 0.0;
    for (_, face) in mesh.faces().iter() {
        let [a, b, c] = [0, 1, 2].map(|i| mesh.position(face[i]).as_dvec3());
        volume += a.dot(b.cross(c));
    }
    assert!(volume > 0.0, "{name} is inside out");
    facts
}

#[test]
fn surfaces_have_their_topology_at_every_size() {
    let oblique = [1.0, 2.0, -0.5];
    let solids = [
        ("ball", ball(0.0, 1.0), 1, 0),
        ("ring", ring([0.0, 0.0, 1.0]), 1, 1),
        ("oblique ring", ring(oblique), 1, 1),
        (
            "two balls",
            ball(-2.0, 1.0).union(ball(2.0, 1.0)).expect("two parts"),
            2,
            0,
        ),
        (
            "lens",
            ball(-0.5, 1.0)
                .intersection(ball(0.5, 1.0))
                .expect("two parts"),
            1,
            0,
        ),
        (
            "shell",
            ball(0.0, 1.0)
                .difference(ball(0.0, 0.25))
                .expect("two parts"),
            2,
            0,
        ),
        (
            "off the origin",
            Field::cuboid([70.0, -9.0, 3.0], [1.0, 0.4, 0.6]).expect("a box"),
            1,
            0,
        ),
    ];
    for (name, field, components, genus) in solids {
        for faces in [1_000, 3_000, 20_000] {
            let mesh = field.polygonised(faces).expect(name);
            let facts = check(name, &mesh, faces);
            assert_eq!(
                (facts.components, facts.genus),
                (components, Some(genus)),
                "{name}"
            );
        }
    }
    for faces in [100, 101, 250, 999] {
        let mesh = ball(0.3, 1.0).polygonised(faces).expect("a coarse ball");
        assert_eq!(check("ball", &mesh, faces).genus, Some(0));
    }
}

#[test]
fn recipes_have_their_topology() {
    for (name, genus) in [("blobs", 0), ("csg", 5), ("smooth-union", 2)] {
        let generator = generator(name).expect(name);
        for faces in [4_000_u32, 9_000] {
            let mesh = generator.build(&[("faces", f64::from(faces))]).expect(name);
            let facts = check(name, &mesh, faces as usize);
            assert_eq!(
                (facts.components, facts.genus),
                (1, Some(genus)),
                "{name} {faces}"
            );
        }
    }
}

#[test]
fn vertices_lie_on_the_surface() {
    let field = ring([1.0, 2.0, -0.5]);
    let mesh = field.polygonised(20_000).expect("a ring");
    // By Cauchy's formula, a surface of area A crosses about 4.49 A / h² lattice edges, and has
    // twice as many faces. A crossing moves by at most 0.08 √3 h.
    let area = 4.0 * std::f64::consts::PI.powi(2) * 0.3;
    let spacing = (8.98 * area / mesh.face_count() as f64).sqrt();
    let distance = |p: &sixfold_core::Point| field.at(p.to_array().map(f64::from)).abs() / spacing;
    let distances: Vec<f64> = mesh.positions().iter().map(distance).collect();
    assert!(
        distances.iter().all(|&distance| distance < 0.16),
        "a vertex is far from the surface"
    );
    let near = distances
        .iter()
        .filter(|&&distance| distance < 1e-3)
        .count();
    assert!(
        near > distances.len() * 3 / 4,
        "only {near} of {} vertices are near the surface",
        distances.len()
    );
}

#[test]
fn a_long_chain_of_blended_balls_has_genus_zero() {
    let ball_at = |i: u32| ball(0.5 * f64::from(i), 1.0);
    let chain = (1..60).try_fold(ball_at(0), |chain, i| chain.smooth_union(ball_at(i), 0.0));
    let chain = chain
        .and_then(|chain| chain.inflated(0.05))
        .expect("sixty balls");
    let mesh = chain.polygonised(5_000).expect("a chain");
    let facts = check("chain", &mesh, 5_000);
    assert_eq!((facts.components, facts.genus), (1, Some(0)));
}

#[test]
fn small_targets_keep_the_topology_of_the_recipe() {
    for (name, genus, targets) in [
        ("csg", 5, [1_000.0, 1_111.0, 1_500.0, 2_345.0]),
        ("smooth-union", 2, [1_500.0, 1_777.0, 2_100.0, 2_345.0]),
        ("built-in-mesh", 7, [6_000.0, 6_543.0, 7_000.0, 7_777.0]),
    ] {
        for target in targets {
            let generator = sixfold_shapes::generator(name).expect("listed");
            let mesh = generator
                .build(&[("faces", target)])
                .expect("within its range");
            let facts = Facts::from_polygons(&mesh);
            assert_eq!(facts.genus, Some(genus), "{name} faces={target}");
            assert_eq!(facts.components, 1, "{name} faces={target}");
            let difference = (facts.faces as f64 - target).abs();
            assert!(
                difference <= 20.0_f64.max(0.05 * target),
                "{name}: {} for {target}",
                facts.faces
            );
        }
    }
}
