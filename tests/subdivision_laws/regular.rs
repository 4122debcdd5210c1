//! Checks schemes on regular meshes: convergence to the limit surface, symmetry, and the decrease
//! of sharpness.

use std::collections::BTreeMap;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use sixfold::subdivision::{ControlGrid, Ends, Scheme, Subdivision};
use sixfold::{Creases, Facts, Point, VertexId, shapes};

use super::{TOLERANCE, size, subdivided};

fn control_grids() -> impl Strategy<Value = ControlGrid> {
    let all = vec![Ends::Closed, Ends::Kept, Ends::Dropped];
    let parts = (4..7_usize, 4..6_usize, prop::array::uniform2(select(all)));
    parts.prop_flat_map(|(columns, rows, ends)| {
        let point = prop::array::uniform3(-1.0_f32..1.0).prop_map(Point::from);
        let grid = move |points| ControlGrid::new(columns, points, ends).expect("4 × 4");
        vec(point, columns * rows).prop_map(grid)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 24, ..ProptestConfig::default() })]

    /// All coordinates are at most 1. The distance of a vertex to its limit is at most the sum of:
    ///
    /// - 1/6 of the second difference along rows, which is at most 4
    /// - 1/6 of the second difference along columns, which is at most 4
    /// - 1/36 of the mixed second difference, which is at most 16
    ///
    /// A step divides the differences along rows and columns by 4, and the mixed difference by 16.
    /// So after k steps
    ///
    /// ```text
    ///   |vertex − limit| ≤ 4/3 · 4⁻ᵏ + 4/9 · 16⁻ᵏ
    /// ```
    #[test]
    fn regular_grids_converge_to_the_b_spline_patch(grid in control_grids()) {
        let polygons = grid.to_polygons().expect("small");
        let subdivision = Subdivision::new(Scheme::CatmullClark);
        let (vertices, columns) = (polygons.vertex_count(), grid.columns());
        let across = if grid.ends()[0] == Ends::Closed { columns } else { columns - 1 };
        let mut compared = BTreeMap::new();
        for levels in 0..=4 {
            let refined = subdivided(&subdivision, &polygons, &Creases::default(), levels).polygons;
            // Control vertices and the first face points keep their numbers at later levels.
            let old = (0..vertices).map(|v| (v, (v % columns) as f64, (v / columns) as f64, levels));
            let faces = (0..polygons.face_count()).filter(|_| levels > 0).map(|f| {
                let (i, j) = (f % across, f / across);
                (vertices + f, i as f64 + 0.5, j as f64 + 0.5, levels - 1)
            });
            for (v, i, j, steps) in old.chain(faces) {
                let Some(limit) = grid.evaluate(i, j) else { continue };
                let off = (refined.positions()[v] - limit).abs().max_element();
                let bound = 4.0 / 3.0 * 0.25_f32.powi(steps as i32)
                    + 4.0 / 9.0 * 0.0625_f32.powi(steps as i32);
                prop_assert!(off <= bound + 1e-6, "{} {} after {} steps: off {}", i, j, steps, off);
                *compared.entry(levels).or_insert(0) += 1;
            }
        }
        prop_assert!(compared[&4] >= 5, "{:?}", compared);
    }
}

#[test]
fn a_regular_torus_keeps_its_symmetry() {
    let torus = shapes::torus(6, 5).expect("a small torus");
    let step = subdivided(
        &Subdivision::new(Scheme::CatmullClark),
        &torus,
        &Creases::default(),
        2,
    );
    let facts = Facts::from_polygons(&step.polygons);
    assert_eq!([facts.vertices, facts.faces], [480, 480]);
    assert_eq!(facts.genus, Some(1));
    let turn = std::f32::consts::TAU / 6.0;
    let (sin, cos) = turn.sin_cos();
    let points = step.polygons.positions();
    let size = size(&torus);
    for p in points {
        let turned = Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z);
        let off = points.iter().map(|q| q.distance(turned));
        assert!(
            off.fold(f32::MAX, f32::min) <= TOLERANCE * size,
            "no point at {turned}"
        );
    }
}

#[test]
fn sharpness_of_ten_stays_and_less_decreases() {
    let grid = shapes::grid(2, 2).expect("a small grid");
    for (scheme, mesh) in [
        (Scheme::CatmullClark, grid.clone()),
        (Scheme::Loop, grid.triangulated().expect("small").polygons),
    ] {
        let inner = mesh.edge_uses();
        let inner = inner.iter().find(|edge| !edge.is_boundary());
        let [a, b] = inner.expect("an inner edge").ends.map(|v| v.index() as u32);
        for (given, left) in [
            (f32::INFINITY, f32::INFINITY),
            (10.0, f32::INFINITY),
            (9.99, 8.99),
            (1.25, 0.25),
            (1.0, 0.0),
        ] {
            let creases = Creases::new(&mesh, [([a, b], given)], [(a, given)]).expect("an edge");
            let subdivision = Subdivision::new(scheme);
            let step = subdivided(&subdivision, &mesh, &creases, 1);
            let a = VertexId::new(a);
            let halves: Vec<f32> = step.creases.edges().iter().map(|&(_, s)| s).collect();
            let expected = if left > 0.0 { vec![left; 2] } else { vec![] };
            assert_eq!(halves.len(), expected.len(), "{scheme}, {given}");
            let near = |s: f32, left: f32| s == left || (s - left).abs() < 1e-6;
            assert!(
                halves.iter().all(|&s| near(s, left)),
                "{scheme}: {halves:?}"
            );
            assert!(near(step.creases.corner(a), left), "{scheme}, {given}");
        }
    }
}
