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

/// Returns whether a collapse of `e` would keep the topology. Structures that hold only manifolds
/// refuse other collapses themselves.
pub(crate) fn may_collapse<M: MeshEdit>(mesh: &M, e: M::Edge) -> bool {
    !M::CAPABILITIES.non_manifold_edges || meets_link_condition(mesh, e)
}

/// Returns whether edge `e` meets the link condition (Dey et al. 1999): a collapse of `e` then keeps
/// the topology of the surface, and of the curves of edges that do not have two faces. O(v²), where v
/// is the valence of the ends of `e`.
///
/// Half-edge, winged-edge and corner-table meshes refuse a collapse that does not meet the
/// condition. Polygon soups, indexed face sets and face-vertex meshes also hold meshes that are not
/// manifolds, therefore [`MeshEdit::collapse_edge`] makes the collapse. A program that is to do the
/// same on all structures calls this function first.
///
/// Edges with one face (the boundary) and edges with three or more faces form curves. A curve ends at
/// its corners: vertices with other than two such edges, or with two that differ in their number of
/// faces. The condition is met if all of the following is true:
///
/// - Each vertex that is adjacent to both ends of `e` is the third corner of a triangle along `e`,
///   and no two of these triangles have the same third corner.
/// - If `e` has two faces, an end of `e` is not on a curve.
/// - If `e` is part of a curve, an end of `e` is not a corner, and no triangle along `e` has a curve on
///   both other sides.
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
    if (1..apexes.len()).any(|i| apexes[..i].contains(&apexes[i])) {
        return false;
    }
    let at_b: Vec<M::Vertex> = mesh.vertex_vertices(b).collect();
    let at_a: Vec<M::Vertex> = mesh.vertex_vertices(a).collect();
    let common = at_a.iter().filter(|v| at_b.contains(v)).count();
    if common != apexes.len() {
        return false;
    }
    // Two ends of a manifold are in a tetrahedron only if both have three neighbours.
    let may_be_tetrahedron = faces > 2 || at_a.len() == 3 && at_b.len() == 3;
    if may_be_tetrahedron && is_in_tetrahedron(mesh, [a, b], &apexes) {
        return false;
    }
    match faces {
        2 => !(is_on_curve(mesh, a) && is_on_curve(mesh, b)),
        _ => {
            let has_curves = |&apex: &M::Vertex| [a, b].iter().all(|&v| is_curve(mesh, v, apex));
            let may_move = !is_corner(mesh, a) || !is_corner(mesh, b);
            may_move && !apexes.iter().any(has_curves)
        }
    }
}

/// Returns whether two triangles on both ends have the same other two corners, which are `apexes`: a
/// collapse would make them one.
fn is_in_tetrahedron<M: MeshEdit>(mesh: &M, ends: [M::Vertex; 2], apexes: &[M::Vertex]) -> bool {
    let [at_a, at_b] = ends.map(|end| {
        let faces = mesh
            .vertex_faces(end)
            .filter(|&f| mesh.face_vertices(f).count() == 3);
        let opposite = faces.map(|f| {
            let [_, p, q] = corners_from(mesh, f, end);
            [p.min(q), p.max(q)]
        });
        let between = opposite.filter(|side| side.iter().all(|v| apexes.contains(v)));
        between.collect::<Vec<_>>()
    });
    at_a.iter().any(|side| at_b.contains(side))
}

/// Returns the numbers of faces of the edges at `v` that do not have two faces.
fn curves_at<M: MeshEdit>(mesh: &M, v: M::Vertex) -> impl Iterator<Item = usize> {
    let counts = mesh.vertex_edges(v).map(|e| mesh.edge_faces(e).count());
    counts.filter(|&faces| faces != 2)
}

fn is_on_curve<M: MeshEdit>(mesh: &M, v: M::Vertex) -> bool {
    curves_at(mesh, v).next().is_some()
}

/// Returns whether a curve ends at `v`.
fn is_corner<M: MeshEdit>(mesh: &M, v: M::Vertex) -> bool {
    let curves: Vec<usize> = curves_at(mesh, v).take(3).collect();
    !matches!(curves[..], [one, other] if one == other)
}

/// Returns whether the edge between two adjacent vertices does not have two faces.
fn is_curve<M: MeshEdit>(mesh: &M, a: M::Vertex, b: M::Vertex) -> bool {
    let e = mesh.edge_between(a, b);
    e.is_some_and(|e| mesh.edge_faces(e).count() != 2)
}

/// Returns whether `v` is an end of an edge with one face.
pub(crate) fn is_boundary<M: MeshEdit>(mesh: &M, v: M::Vertex) -> bool {
    mesh.vertex_edges(v)
        .any(|e| mesh.edge_faces(e).count() == 1)
}
