//! Projection of vertices to a sphere.

use sixfold_core::{MeshQuery, Point, VertexId, VertexMap, row};

use crate::error::SphereError;

/// Returns the positions of all vertices after projection to a sphere: each vertex moves along a
/// ray from `centre` until its distance from `centre` is `radius`. Takes O(vertices) time.
///
/// ```text
///         ╭───●───╮          p' = c + r (p − c) / |p − c|
///       ╭─╯   ↑   ╰─╮
///       │     p     │        Only positions change. The faces cover the sphere once if each ray
///       │     │     │        from c meets the mesh once; otherwise they fold over.
///       │     c     │
/// ```
///
/// # Errors
///
/// Returns [`SphereError::InvalidSphere`] if the radius is not above 0, or if the radius or the
/// centre is not finite. Returns [`SphereError::NoDirection`] for the first vertex that is at the
/// centre or that has a coordinate that is not finite.
///
/// # Examples
///
/// This example divides every edge of an icosahedron into 6 parts, and every triangle into 36
/// triangles. The points are then projected to the sphere, as for a geodesic dome. The map `names`
/// finds the points that two faces share. The key of a point is a list of corners of the
/// icosahedron with their weights.
///
/// ```
/// use std::collections::BTreeMap;
///
/// use sixfold_indexed_face_set::IndexedFaceSet;
/// use sixfold_core::{MeshMove, MeshQuery, Point, PolygonMesh, Representation};
/// use sixfold_operators::projected_to_sphere;
///
/// let icosahedron = sixfold_shapes::icosahedron();
/// let radius = icosahedron.positions()[0].length();
/// let frequency = 6;
///
/// let (mut names, mut points, mut faces) = (BTreeMap::new(), Vec::new(), Vec::new());
/// for (_, corners) in icosahedron.faces().iter() {
///     let &[a, b, c] = corners else { unreachable!("triangles") };
///     // The point i steps from a towards b and j steps towards c.
///     let mut point = |i: u32, j: u32| {
///         let mut parts = vec![(a, frequency - i - j), (b, i), (c, j)];
///         parts.retain(|&(_, weight)| weight > 0);
///         parts.sort();
///         *names.entry(parts.clone()).or_insert_with(|| {
///             let at = |(v, weight)| icosahedron.position(v) * (weight as f32 / frequency as f32);
///             points.push(parts.into_iter().map(at).sum::<Point>());
///             points.len() as u32 - 1
///         })
///     };
///     for j in 0..frequency {
///         for i in 0..frequency - j {
///             faces.push([point(i, j), point(i + 1, j), point(i, j + 1)]);
///             if i + j + 1 < frequency {
///                 faces.push([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
///             }
///         }
///     }
/// }
///
/// let mut dome = IndexedFaceSet::from_polygons(&PolygonMesh::new(points, faces)?)?;
/// let on_sphere = projected_to_sphere(&dome, Point::ZERO, radius)?;
/// dome.set_positions(&on_sphere)?;
/// // V = 10f² + 2, E = 30f², F = 20f²; twelve vertices of valence 5, all others 6.
/// assert_eq!([dome.vertex_count(), dome.edge_count(), dome.face_count()], [362, 1080, 720]);
/// assert!(dome.vertices().all(|v| (dome.position(v).length() - radius).abs() < 1e-6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn projected_to_sphere<M: MeshQuery>(
    mesh: &M,
    centre: Point,
    radius: f32,
) -> Result<VertexMap<M, Point>, SphereError> {
    if !(centre.is_finite() && radius.is_finite() && radius > 0.0) {
        let centre = centre.to_array();
        return Err(SphereError::InvalidSphere { centre, radius });
    }
    let (from, length) = (centre.as_dvec3(), f64::from(radius));
    let mut projected = mesh.vertex_map(Point::ZERO);
    for (i, v) in mesh.vertices().enumerate() {
        let ray = mesh.position(v).as_dvec3() - from;
        let Some(direction) = ray.try_normalize() else {
            let vertex = VertexId::new(row(i));
            return Err(SphereError::NoDirection { vertex });
        };
        projected[v] = (from + length * direction).as_vec3();
    }
    Ok(projected)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sixfold_core::{PolygonMesh, Representation};
    use sixfold_half_edge::HalfEdgeMesh;

    use super::*;

    fn mesh(polygons: &PolygonMesh) -> HalfEdgeMesh {
        HalfEdgeMesh::from_polygons(polygons).expect("a manifold")
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn vertices_move_to_the_sphere_along_their_rays(
            centre in prop::array::uniform3(-5.0_f32..5.0),
            radius in 0.01_f32..100.0,
        ) {
            let torus = mesh(&sixfold_shapes::torus(7, 5).expect("small"));
            let centre = Point::from_array(centre);
            let moved = projected_to_sphere(&torus, centre, radius).expect("not at the centre");
            for v in torus.vertices() {
                let (ray, arm) = (torus.position(v) - centre, moved[v] - centre);
                prop_assert!((arm.length() - radius).abs() < 1e-5 * (radius + 5.0));
                prop_assert!(ray.normalize().distance(arm / radius) < 1e-5 * (1.0 + 5.0 / radius));
            }
        }
    }

    #[test]
    fn each_invalid_input_returns_its_error() {
        let grid = mesh(&sixfold_shapes::grid(2, 2).expect("small"));
        let project = |centre, radius| projected_to_sphere(&grid, centre, radius);
        let middle = Point::new(1.0, 1.0, 0.0);
        let vertex = VertexId::new(4);
        assert_eq!(
            project(middle, 1.0).err(),
            Some(SphereError::NoDirection { vertex })
        );
        for (centre, radius) in [
            (Point::NAN, 1.0),
            (Point::ZERO, 0.0),
            (Point::ZERO, -1.0),
            (Point::ZERO, f32::INFINITY),
            (Point::ZERO, f32::NAN),
        ] {
            let error = project(centre, radius).err();
            assert!(
                matches!(error, Some(SphereError::InvalidSphere { .. })),
                "{error:?}"
            );
        }
    }
}
