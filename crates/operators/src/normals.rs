//! Normals of faces and of vertices.

use glam::DVec3;
use sixfold_core::{FaceMap, MeshQuery, Newell, Point, VertexMap};

/// The weight of a face in the normal of each of its vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalWeights {
    /// The area of the face. This weight costs nothing, because the normal is computed from a
    /// vector whose length is proportional to the area.
    #[default]
    Area,
    /// The angle of the face at the vertex (Thürmer & Wüthrich 1998). With this weight, the normal
    /// does not depend on how the surface is cut into faces.
    Angle,
}

/// Returns the unit normal of every face, by Newell's method; O(corners).
///
/// ```text
///        p2               n = Σ (pᵢ − p₀) × (pᵢ₊₁ − p₀)
///       ╱  ╲
///     p3    ╲             |n| is twice the area; n points to the side from which
///      │     p1           the corners run counter-clockwise. Valid for polygons
///      └── p0             of any shape; for bent polygons n is a mean.
/// ```
///
/// A face without area has the normal zero. Sutherland, Sproull & Schumacker (1974) describe
/// Newell's method.
pub fn face_normals<M: MeshQuery>(mesh: &M) -> FaceMap<M, Point> {
    let mut normals = mesh.face_map(Point::ZERO);
    mesh.faces().for_each(|f| {
        let mut newell = Newell::default();
        mesh.face_vertices(f)
            .for_each(|v| newell.add(mesh.position(v).as_dvec3()));
        normals[f] = unit(newell.normal);
    });
    normals
}

/// Returns the unit normal of every vertex: the direction of the mean of the normals of its faces,
/// weighted by `weights`. Takes O(corners) time.
///
/// ```text
///           n                 area    n ∝ Σ A(f) n(f)
///       ╲   ↑   ╱             angle   n ∝ Σ α(f) n(f),  α the angle of f at the vertex
///     f1 ╲  │  ╱ f2
///         ╲ │ ╱               Three squares at the corner of a cube: both give the diagonal.
///     ─────╲│╱─────           If one square is cut in two, only the angles still give it.
///       f0  v
/// ```
///
/// The normal is zero if the vertex has no faces or if the weighted face normals add up to zero.
/// One pass over the faces adds the weighted normal of each face to its vertices, so no structure
/// searches for the faces of a vertex.
pub fn vertex_normals<M: MeshQuery>(mesh: &M, weights: NormalWeights) -> VertexMap<M, Point> {
    let mut sums = mesh.vertex_map(DVec3::ZERO);
    let mut corners = Vec::new();
    mesh.faces().for_each(|f| {
        let mut newell = Newell::default();
        corners.clear();
        mesh.face_vertices(f).for_each(|v| {
            let at = mesh.position(v).as_dvec3();
            newell.add(at);
            corners.push((v, at));
        });
        match weights {
            NormalWeights::Area => corners.iter().for_each(|&(v, _)| sums[v] += newell.normal),
            NormalWeights::Angle => {
                let normal = newell.normal.normalize_or_zero();
                let Some(&(_, mut before)) = corners.last() else {
                    return; // unreachable: a face has at least three corners
                };
                for (i, &(v, at)) in corners.iter().enumerate() {
                    let (_, after) = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
                    sums[v] += angle(before - at, after - at, normal) * normal;
                    before = at;
                }
            }
        }
    });
    let mut normals = mesh.vertex_map(Point::ZERO);
    mesh.vertices().for_each(|v| normals[v] = unit(sums[v]));
    normals
}

/// Returns the angle from `after` to `before`, counter-clockwise about `normal`. The angle is above
/// π at a reflex corner.
fn angle(before: DVec3, after: DVec3, normal: DVec3) -> f64 {
    let sine = after.cross(before).dot(normal);
    let angle = sine.atan2(after.dot(before));
    if angle < 0.0 {
        angle + std::f64::consts::TAU
    } else {
        angle
    }
}

/// Returns `vector` scaled to length 1, or zero if `vector` has no direction.
fn unit(vector: DVec3) -> Point {
    vector.normalize_or_zero().as_vec3()
}

#[cfg(test)]
mod tests {
    use sixfold_core::{PolygonMesh, Representation};
    use sixfold_half_edge::HalfEdgeMesh;
    use sixfold_indexed_face_set::IndexedFaceSet;

    use super::*;

    const BOTH: [NormalWeights; 2] = [NormalWeights::Area, NormalWeights::Angle];

    fn set(polygons: &PolygonMesh) -> IndexedFaceSet {
        IndexedFaceSet::from_polygons(polygons).expect("it accepts any mesh")
    }

    fn set_of(points: &[[f32; 3]], faces: &[&[u32]]) -> IndexedFaceSet {
        let points: Vec<Point> = points.iter().copied().map(Point::from_array).collect();
        set(&PolygonMesh::new(points, faces).expect("valid"))
    }

    #[test]
    fn normals_of_platonic_solids_point_from_the_centre() {
        for solid in [
            sixfold_shapes::tetrahedron(),
            sixfold_shapes::cube(),
            sixfold_shapes::octahedron(),
            sixfold_shapes::dodecahedron(),
            sixfold_shapes::icosahedron(),
        ] {
            let mesh = HalfEdgeMesh::from_polygons(&solid).expect("a manifold");
            let faces = face_normals(&mesh);
            for f in mesh.faces() {
                let centre: Point = mesh.face_vertices(f).map(|v| mesh.position(v)).sum();
                assert!(faces[f].distance(centre.normalize()) < 1e-6, "{f}");
            }
            for weights in BOTH {
                let normals = vertex_normals(&mesh, weights);
                for v in mesh.vertices() {
                    let radial = mesh.position(v).normalize();
                    assert!(normals[v].distance(radial) < 1e-6, "{v}, {weights:?}");
                }
            }
        }
    }

    /// Three unit squares meet at a corner of a cube. Each is cut into two triangles. Both triangles
    /// of the lower square are incident to the corner, but only one triangle of each other square.
    #[test]
    fn angle_weights_do_not_depend_on_how_a_surface_is_cut() {
        let points = [
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 1.0],
            [1.0, 0.0, 1.0],
        ];
        let mesh = set_of(
            &points,
            &[
                &[0, 1, 4],
                &[0, 4, 2],
                &[0, 2, 3],
                &[2, 5, 3],
                &[0, 3, 1],
                &[3, 6, 1],
            ],
        );
        let v = mesh.vertices().next().expect("v0");
        let diagonal = Point::ONE.normalize();
        let by_angle = vertex_normals(&mesh, NormalWeights::Angle)[v];
        assert!(by_angle.distance(diagonal) < 1e-6, "{by_angle}");
        // Areas at the corner: 1 of the lower square, 1/2 of each other square.
        let by_area = vertex_normals(&mesh, NormalWeights::Area)[v];
        assert!(
            by_area.distance(Point::new(1.0, 1.0, 2.0).normalize()) < 1e-6,
            "{by_area}"
        );
    }

    /// The L-shaped face has the angle 3π/2 at v3; the other face has a right angle.
    #[test]
    fn a_reflex_corner_counts_with_its_whole_angle() {
        let points = [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
            [1.0, 1.0, 1.0],
            [2.0, 1.0, 1.0],
        ];
        let mesh = set_of(&points, &[&[0, 1, 2, 3, 4, 5], &[3, 2, 7, 6]]);
        let faces = face_normals(&mesh);
        let normals: Vec<Point> = mesh.faces().map(|f| faces[f]).collect();
        assert_eq!(normals, [Point::Z, Point::NEG_Y]);
        let v = mesh.vertices().nth(3).expect("v3");
        let expected = Point::new(0.0, -1.0, 3.0).normalize();
        let got = vertex_normals(&mesh, NormalWeights::Angle)[v];
        assert!(got.distance(expected) < 1e-6, "{got}");
    }

    #[test]
    fn faces_and_vertices_without_direction_have_normal_zero() {
        // A face on a line, an isolated vertex, and a pillow whose normals cancel.
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = set_of(&points, &[&[0, 1, 2]]);
        let faces = face_normals(&mesh);
        assert!(mesh.faces().all(|f| faces[f] == Point::ZERO));
        for weights in BOTH {
            let normals = vertex_normals(&mesh, weights);
            assert!(mesh.vertices().all(|v| normals[v] == Point::ZERO));
        }
        let pillow = set_of(&points, &[&[0, 1, 3], &[3, 1, 0]]);
        for weights in BOTH {
            let normals = vertex_normals(&pillow, weights);
            assert!(pillow.vertices().all(|v| normals[v] == Point::ZERO));
        }
    }

    /// In single precision, the squares of these lengths overflow or underflow.
    #[test]
    fn huge_tiny_and_distant_meshes_have_correct_normals() {
        let triangle = [Point::ZERO, Point::X, Point::Y];
        for (scale, shift) in [(1e30, 0.0), (1e-30, 0.0), (1.0, 4096.0)] {
            let points = triangle.map(|p| p * scale + Point::splat(shift));
            let mesh = set(&PolygonMesh::new(points, [[0, 1, 2]]).expect("valid"));
            for weights in BOTH {
                let normals = vertex_normals(&mesh, weights);
                assert!(
                    mesh.vertices().all(|v| normals[v] == Point::Z),
                    "{scale} {shift}"
                );
            }
        }
    }
}
