//! Conditions for edits that the operators check in addition to the rules of the structures.

use glam::DVec3;
use sixfold_core::MeshEdit;

use crate::numbering::corners_from;

/// Minimum cosine of the angle between the normals of a face before and after an edit.
const MIN_COSINE: f64 = 0.2;

/// A vertex with more edges than this is a hub: edits visit its edges rarely.
pub(crate) const HUB: u32 = 64;

/// Returns the position of `v` in f64.
#[inline]
pub(crate) fn at<M: MeshEdit>(mesh: &M, v: M::Vertex) -> DVec3 {
    mesh.position(v).as_dvec3()
}

/// Returns whether all remaining triangles keep their orientation if both ends of an edge move to
/// `to`.
pub(crate) fn keeps_orientation<M: MeshEdit>(mesh: &M, [a, b]: [M::Vertex; 2], to: DVec3) -> bool {
    keeps_orientation_at(mesh, [a, b], to) && keeps_orientation_at(mesh, [b, a], to)
}

/// Returns whether all triangles at `end` and not at `other` keep their orientation if `end` moves to `to`.
pub(crate) fn keeps_orientation_at<M: MeshEdit>(
    mesh: &M,
    [end, other]: [M::Vertex; 2],
    to: DVec3,
) -> bool {
    let from = at(mesh, end);
    mesh.vertex_faces(end).all(|f| {
        let [_, p, q] = corners_from(mesh, f, end);
        if p == other || q == other {
            return true;
        }
        let [p, q] = [at(mesh, p), at(mesh, q)];
        let before = (p - from).cross(q - from);
        let after = (p - to).cross(q - to);
        // A face without area has no orientation.
        before == DVec3::ZERO || before.dot(after) > MIN_COSINE * before.length() * after.length()
    })
}

/// Returns whether edge `e` meets the link condition (Dey et al. 1999): a collapse of `e` then keeps
/// the topology of the surface, and of the curves of edges that do not have two faces. O(v log v), where
/// v is the valence of the ends of `e`, plus the costs of the queries.
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
    keeps_topology(mesh, e, mesh.edge_vertices(e), false, |v| curve_at(mesh, v))
}

/// The place of a vertex on the curves of edges that do not have two faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Curve {
    #[default]
    Off,
    Inside,
    /// A curve ends at the vertex, or several curves meet there.
    Corner,
}

impl Curve {
    /// Returns the place of a vertex whose edges on curves have these numbers of faces.
    pub(crate) fn from_face_counts(counts: impl Iterator<Item = usize>) -> Self {
        let counts: Vec<usize> = counts.take(3).collect();
        match counts[..] {
            [] => Self::Off,
            [one, other] if one == other => Self::Inside,
            _ => Self::Corner,
        }
    }
}

/// Returns the places of all vertices on the curves, from the vertex and the number of faces of each end of
/// an edge on a curve; O(ends log ends).
pub(crate) fn curves(mut spokes: Vec<[u32; 2]>, vertices: usize) -> Vec<Curve> {
    let mut curves = vec![Curve::Off; vertices];
    spokes.sort_unstable();
    for at_vertex in spokes.chunk_by(|one, other| one[0] == other[0]) {
        let counts = at_vertex.iter().map(|&[_, faces]| faces as usize);
        curves[at_vertex[0][0] as usize] = Curve::from_face_counts(counts);
    }
    curves
}

/// Returns the place of `v` on the curves.
pub(crate) fn curve_at<M: MeshEdit>(mesh: &M, v: M::Vertex) -> Curve {
    let counts = mesh.vertex_edges(v).map(|e| mesh.edge_faces(e).count());
    Curve::from_face_counts(counts.filter(|&faces| faces != 2))
}

/// Returns whether edge `e` from `a` to `b` meets the link condition. `curve` returns the place of a
/// vertex on the curves. If `is_hub`, `b` is a hub: its edges are not listed, but looked up from `a`.
pub(crate) fn keeps_topology<M: MeshEdit>(
    mesh: &M,
    e: M::Edge,
    [a, b]: [M::Vertex; 2],
    is_hub: bool,
    curve: impl Fn(M::Vertex) -> Curve,
) -> bool {
    let mut faces = 0;
    let mut apexes = Vec::with_capacity(2);
    for f in mesh.edge_faces(e) {
        faces += 1;
        if mesh.face_vertices(f).count() == 3 {
            apexes.extend(mesh.face_vertices(f).find(|&v| v != a && v != b));
        }
    }
    apexes.sort_unstable();
    if apexes.windows(2).any(|pair| pair[0] == pair[1]) {
        return false;
    }
    let at_a = mesh.vertex_vertices(a);
    let common = if is_hub {
        at_a.filter(|&v| v != b && mesh.edge_between(v, b).is_some())
            .count()
    } else {
        let mut at_b: Vec<M::Vertex> = mesh.vertex_vertices(b).collect();
        if at_b.len() > HUB as usize {
            at_b.sort_unstable();
            at_a.filter(|v| at_b.binary_search(v).is_ok()).count()
        } else {
            at_a.filter(|v| at_b.contains(v)).count()
        }
    };
    if common != apexes.len() {
        return false;
    }
    // Does not look for an edge between the apexes first: both may be hubs.
    if apexes.len() > 1 && is_in_tetrahedron(mesh, [a, b], &apexes) {
        return false;
    }
    match faces {
        2 => curve(a) == Curve::Off || curve(b) == Curve::Off,
        _ => {
            let has_curves = |&apex: &M::Vertex| [a, b].iter().all(|&v| is_curve(mesh, v, apex));
            let may_move = curve(a) != Curve::Corner || curve(b) != Curve::Corner;
            may_move && !apexes.iter().any(has_curves)
        }
    }
}

/// Returns whether a triangle on each end has the same other two corners, which are two of the sorted
/// `apexes`: a collapse would make these triangles one. Looks at the triangles on `a`.
fn is_in_tetrahedron<M: MeshEdit>(mesh: &M, [a, b]: [M::Vertex; 2], apexes: &[M::Vertex]) -> bool {
    let is_triangle = |&f: &M::Face| mesh.face_vertices(f).count() == 3;
    mesh.vertex_faces(a).filter(is_triangle).any(|f| {
        let [_, p, q] = corners_from(mesh, f, a);
        let are_apexes = [p, q].iter().all(|v| apexes.binary_search(v).is_ok());
        let side = are_apexes.then(|| mesh.edge_between(p, q)).flatten();
        side.is_some_and(|side| {
            let mut triangles = mesh.edge_faces(side).filter(is_triangle);
            triangles.any(|f| mesh.face_vertices(f).any(|v| v == b))
        })
    })
}

/// Returns whether the edge between two adjacent vertices does not have two faces.
fn is_curve<M: MeshEdit>(mesh: &M, a: M::Vertex, b: M::Vertex) -> bool {
    let e = mesh.edge_between(a, b);
    e.is_some_and(|e| mesh.edge_faces(e).take(3).count() != 2)
}

#[cfg(test)]
mod tests {
    use sixfold_core::{MeshQuery, PolygonMesh, Representation, VertexId};
    use sixfold_indexed_face_set::EditableIndexedFaceSet;

    use super::*;
    use crate::decimation::tests::three_plates;

    /// In a plane, faces keep their orientation if none is turned over or without area.
    #[test]
    fn faces_in_a_plane_keep_their_side() {
        let grid = sixfold_shapes::triangle_grid(3, 3).expect("small");
        let mesh = EditableIndexedFaceSet::from_polygons(&grid).expect("holds all");
        for e in mesh.edges() {
            let ends = mesh.edge_vertices(e);
            for to in
                (0..49).map(|i| DVec3::new(f64::from(i % 7) / 2.0, f64::from(i / 7) / 2.0, 0.0))
            {
                let faces = mesh
                    .faces()
                    .map(|f| mesh.face_vertices(f).collect::<Vec<_>>());
                let others = faces.filter(|face| !ends.iter().all(|end| face.contains(end)));
                let moved = |v| if ends.contains(&v) { to } else { at(&mesh, v) };
                let mut areas = others.map(|face| {
                    let [a, b, c] = [0, 1, 2].map(|i| moved(face[i]));
                    (b - a).cross(c - a).z
                });
                let expected = areas.all(|area| area > 0.0);
                assert_eq!(
                    keeps_orientation(&mesh, ends, to),
                    expected,
                    "{ends:?} {to}"
                );
            }
        }
    }

    /// Returns V − E + F, and the number of vertices where curves end.
    fn topology(mesh: &EditableIndexedFaceSet) -> (isize, usize) {
        let is_used = |&v: &VertexId| mesh.vertex_faces(v).next().is_some();
        let vertices: Vec<VertexId> = mesh.vertices().filter(is_used).collect();
        let counts = [vertices.len(), mesh.edge_count(), mesh.face_count()];
        let [v, e, f] = counts.map(|count| count as isize);
        let ends = vertices.iter().filter(|&&v| {
            let faces = mesh.vertex_edges(v).map(|e| mesh.edge_faces(e).count());
            let curves: Vec<usize> = faces.filter(|&faces| faces != 2).collect();
            !curves.is_empty() && (curves.len() != 2 || curves[0] != curves[1])
        });
        (v - e + f, ends.count())
    }

    /// Checks which edges of a mesh meet the link condition, and that their collapse keeps the topology.
    fn assert_meeting(
        polygons: &PolygonMesh,
        expected: impl Fn(&EditableIndexedFaceSet, [VertexId; 2]) -> bool,
    ) {
        let whole = EditableIndexedFaceSet::from_polygons(polygons).expect("holds all");
        for e in whole.edges() {
            let ends = whole.edge_vertices(e);
            let meets = meets_link_condition(&whole, e);
            assert_eq!(meets, expected(&whole, ends), "{ends:?}");
            if meets {
                let mut mesh = whole.clone();
                let to = mesh.position(ends[0]);
                mesh.collapse_edge(e, ends[0], to)
                    .expect("it meets the link condition");
                assert_eq!(topology(&mesh), topology(&whole), "{ends:?}");
                let faces = whole.face_count() - mesh.face_count();
                assert_eq!(faces, whole.edge_faces(e).count(), "{ends:?}");
            }
        }
    }

    #[test]
    fn curves_keep_their_ends_and_their_distance() {
        for n in 1..5 {
            let far = n as f32;
            assert_meeting(&three_plates(n), |mesh, ends| {
                let is_on_curve = ends.map(|v| {
                    let p = mesh.position(v);
                    let from_axis = p.truncate().length().round();
                    [p.z, from_axis].iter().any(|&x| x == 0.0 || x == far)
                });
                let e = mesh.edge_between(ends[0], ends[1]).expect("its ends");
                match mesh.edge_faces(e).count() {
                    // The axis alone has no other vertex.
                    3 => n > 1,
                    2 => is_on_curve != [true; 2],
                    _ => true,
                }
            });
        }
    }

    #[test]
    fn tetrahedra_do_not_collapse() {
        // Two tetrahedra with vertex 0 in common, and a triangle on an edge of each. Both triangles have
        // vertex 7, and one edge in common, which joins curves.
        let points = (0..8_u8).map(|i| {
            let x = f32::from(i);
            [x, x * x, x * x * x]
        });
        let faces = [
            [0, 1, 2],
            [1, 0, 3],
            [0, 2, 3],
            [1, 3, 2],
            [0, 4, 5],
            [4, 0, 6],
            [0, 5, 6],
            [4, 6, 5],
            [4, 0, 7],
            [0, 1, 7],
        ];
        let mesh = PolygonMesh::new(points, faces).expect("valid");
        let [zero, last] = [0, 7].map(VertexId::new);
        assert_meeting(&mesh, |_, ends| {
            ends.contains(&last) && !ends.contains(&zero)
        });
    }
}
