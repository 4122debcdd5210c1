//! Conditions for edits that the operators check in addition to the rules of the structures.

use glam::DVec3;
use sixfold_core::MeshEdit;

use crate::numbering::corners_from;

/// Minimum cosine of the angle between the normals of a face before and after an edit.
const MIN_COSINE: f64 = 0.2;

/// Returns the position of `v` in f64.
#[inline]
pub(crate) fn at<M: MeshEdit>(mesh: &M, v: M::Vertex) -> DVec3 {
    mesh.position(v).as_dvec3()
}

/// Returns whether all remaining triangles keep their orientation if both ends of an edge move to
/// `to`.
pub(crate) fn keeps_orientation<M: MeshEdit>(mesh: &M, [a, b]: [M::Vertex; 2], to: DVec3) -> bool {
    for (end, other) in [(a, b), (b, a)] {
        let from = at(mesh, end);
        for f in mesh.vertex_faces(end) {
            let [_, p, q] = corners_from(mesh, f, end);
            if p == other || q == other {
                continue;
            }
            let [p, q] = [at(mesh, p), at(mesh, q)];
            let before = (p - from).cross(q - from);
            let after = (p - to).cross(q - to);
            // A face without area has no orientation.
            let keeps = before == DVec3::ZERO
                || before.dot(after) > MIN_COSINE * before.length() * after.length();
            if !keeps {
                return false;
            }
        }
    }
    true
}

/// Returns whether a collapse of `e` would keep the mesh a manifold. Structures that hold only
/// manifolds refuse other collapses themselves.
pub(crate) fn may_collapse<M: MeshEdit>(mesh: &M, e: M::Edge) -> bool {
    !M::CAPABILITIES.non_manifold_edges || meets_link_condition(mesh, e)
}

/// Returns whether edge `e` of a manifold meets the link condition (Dey et al. 1999): a collapse of
/// `e` then keeps the topology of the surface. O(v²), where v is the valence of the ends of `e`.
///
/// Half-edge, winged-edge and corner-table meshes refuse a collapse that does not meet the
/// condition. Polygon soups, indexed face sets and face-vertex meshes also hold meshes that are not
/// manifolds, therefore [`MeshEdit::collapse_edge`] makes the collapse. A program that is to do the
/// same on all structures calls this function first.
///
/// The condition is met if all of the following is true:
///
/// - `e` has one or two faces.
/// - Each vertex that is adjacent to both ends of `e` is the third corner of a triangle along `e`,
///   and no two of these triangles have the same third corner.
/// - If `e` has two faces, an end of `e` is not on the boundary.
/// - `e` is not an edge of a tetrahedron.
///
/// # Examples
///
/// A torus of three by three vertices becomes narrower than a triangle by any collapse:
///
/// ```
/// use sixfold_core::{MeshQuery, Representation};
/// use sixfold_indexed_face_set::EditableIndexedFaceSet;
/// use sixfold_remeshing::meets_link_condition;
///
/// let sphere = sixfold_shapes::geodesic(2)?;
/// let torus = sixfold_shapes::triangle_torus(3, 3)?;
/// for (polygons, meet) in [(sphere, 120), (torus, 0)] {
///     let mesh = EditableIndexedFaceSet::from_polygons(&polygons)?;
///     let meeting = mesh.edges().filter(|&e| meets_link_condition(&mesh, e));
///     assert_eq!(meeting.count(), meet);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn meets_link_condition<M: MeshEdit>(mesh: &M, e: M::Edge) -> bool {
    let [a, b] = mesh.edge_vertices(e);
    let mut faces = 0;
    let mut apexes = Vec::with_capacity(2);
    for f in mesh.edge_faces(e) {
        faces += 1;
        if mesh.face_vertices(f).count() == 3 {
            apexes.extend(mesh.face_vertices(f).find(|&v| v != a && v != b));
        }
    }
    if faces > 2 || (apexes.len() == 2 && apexes[0] == apexes[1]) {
        return false;
    }
    let at_b: Vec<M::Vertex> = mesh.vertex_vertices(b).collect();
    let at_a: Vec<M::Vertex> = mesh.vertex_vertices(a).collect();
    let common = at_a.iter().filter(|v| at_b.contains(v)).count();
    if common != apexes.len() {
        return false;
    }
    if apexes.len() == 2 {
        // A collapse of a tetrahedron would make two triangles with the same corners.
        let closed = |v| mesh.vertex_faces(v).count() == 3;
        if at_a.len() == 3 && at_b.len() == 3 && closed(a) && closed(b) {
            return false;
        }
    }
    faces < 2 || !(is_boundary(mesh, a) && is_boundary(mesh, b))
}

/// Returns whether `v` is an end of an edge with one face.
pub(crate) fn is_boundary<M: MeshEdit>(mesh: &M, v: M::Vertex) -> bool {
    mesh.vertex_edges(v)
        .any(|e| mesh.edge_faces(e).count() == 1)
}
