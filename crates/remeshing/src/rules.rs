//! Conditions for edits that the operators check in addition to the rules of the structures.

use glam::DVec3;
use sixfold_core::MeshEdit;

use crate::numbering::{corners, corners_from};

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

/// Returns whether a collapse meets the link condition (Dey et al. 1999) in a triangle mesh. Tests
/// only structures that hold non-manifold edges; other structures refuse the collapse themselves.
pub(crate) fn meets_link_condition<M: MeshEdit>(mesh: &M, e: M::Edge) -> bool {
    if !M::CAPABILITIES.non_manifold_edges {
        return true;
    }
    let [a, b] = mesh.edge_vertices(e);
    let mut apexes = Vec::with_capacity(2);
    for f in mesh.edge_faces(e) {
        apexes.extend(corners(mesh, f).into_iter().find(|&v| v != a && v != b));
    }
    if apexes.len() > 2 || (apexes.len() == 2 && apexes[0] == apexes[1]) {
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
        return !(is_boundary(mesh, a) && is_boundary(mesh, b));
    }
    true
}

/// Returns whether `v` is an end of an edge with one face.
pub(crate) fn is_boundary<M: MeshEdit>(mesh: &M, v: M::Vertex) -> bool {
    mesh.vertex_edges(v)
        .any(|e| mesh.edge_faces(e).count() == 1)
}
