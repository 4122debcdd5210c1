use proptest::prelude::*;
use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};
use sixfold_half_edge::EditableHalfEdgeMesh;

use super::*;

/// Builds a flat triangulated grid with moved inner vertices.
fn perturbed_grid(side: usize, offsets: &[[f32; 2]]) -> PolygonMesh {
    let grid = sixfold_shapes::triangle_grid(side, side).expect("small");
    let is_outer = |x: f32, max: f32| x <= 0.0 || x >= max;
    let max = grid.positions().iter().fold(0.0_f32, |max, p| max.max(p.x));
    let positions = grid
        .positions()
        .iter()
        .zip(offsets.iter().cycle())
        .map(|(p, [x, y])| {
            if is_outer(p.x, max) || is_outer(p.y, max) {
                *p
            } else {
                *p + Point::new(*x, *y, 0.0) * 0.4 * max / side as f32
            }
        });
    PolygonMesh::from_faces(positions.collect(), grid.faces().clone()).expect("the same faces")
}

proptest! {
    #[test]
    fn a_plane_becomes_delaunay(offsets in prop::collection::vec([-1.0_f32..1.0, -1.0_f32..1.0], 36)) {
        let polygons = perturbed_grid(5, &offsets);
        let mut mesh = EditableHalfEdgeMesh::from_polygons(&polygons).expect("a manifold");
        let report = flip_to_delaunay(&mut mesh).expect("triangles");
        prop_assert_eq!(mesh.validate(), Ok(()));
        prop_assert_eq!(report.stop, Stop::Done);
        let mut inside = 0;
        for f in mesh.faces() {
            let [a, b, c] = corners(&mesh, f).map(|v| at(&mesh, v));
            for v in mesh.vertices() {
                let d = at(&mesh, v);
                let [a, b, c] = [a - d, b - d, c - d];
                let lift = |p: DVec3| DVec3::new(p.x, p.y, p.length_squared());
                let incircle = lift(a).dot(lift(b).cross(lift(c)));
                inside += usize::from(incircle > 1e-4 * a.length() * b.length() * c.length());
            }
        }
        prop_assert!(inside == 0 || report.refused > 0, "{inside} vertices in circles");
    }
}

#[test]
fn a_delaunay_mesh_is_unchanged() {
    let mut mesh =
        EditableHalfEdgeMesh::from_polygons(&sixfold_shapes::icosahedron()).expect("closed");
    let report = flip_to_delaunay(&mut mesh).expect("triangles");
    assert_eq!(
        (report.flips, report.refused, report.stop),
        (0, 0, Stop::Done)
    );
}

#[test]
fn one_bad_edge_is_flipped() {
    let kite = [
        Point::new(0.0, 0.0, 0.0),
        Point::new(4.0, 0.0, 0.0),
        Point::new(2.0, 0.5, 0.0),
        Point::new(2.0, -0.5, 0.0),
    ];
    let polygons = PolygonMesh::new(kite, [[0, 1, 2], [1, 0, 3]]).expect("valid");
    let mut mesh = EditableHalfEdgeMesh::from_polygons(&polygons).expect("a manifold");
    assert_eq!(flip_to_delaunay(&mut mesh).expect("triangles").flips, 1);
    let v = sixfold_core::VertexId::new;
    assert!(mesh.edge_between(v(2), v(3)).is_some() && mesh.edge_between(v(0), v(1)).is_none());
}
