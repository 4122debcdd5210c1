//! Stores the normal of each face, and then for each vertex the normalised sum of the normals of its
//! faces.

use sixfold::{FaceMap, MeshQuery, Point, VertexMap};

use crate::sweeps::{Elements, Outputs, SweepResult, count_each};
use sixfold_measure::ElementKind;

#[inline]
pub(super) fn sweep<M: MeshQuery, E: Elements<M>>(
    kind: ElementKind,
    mesh: &M,
    elements: &E,
    outputs: &mut Outputs<M>,
) -> SweepResult {
    match kind {
        ElementKind::Face => face_normals(mesh, elements, &mut outputs.faces),
        _ => vertex_normals(mesh, elements, &outputs.faces, &mut outputs.vertices),
    }
}

/// Returns the unnormalised normal of a face: the sum of the cross products of its fan triangles.
#[inline(always)]
fn face_normal<M: MeshQuery>(mesh: &M, f: M::Face) -> Point {
    // Positions are read without `map`, because the `fold` of `map` is not always inlined.
    let mut corners = mesh.face_vertices(f);
    let (Some(first), Some(second)) = (corners.next(), corners.next()) else {
        return Point::ZERO; // unreachable, as a face has three corners; avoids the code of a panic
    };
    let first = mesh.position(first);
    let (mut spoke, mut normal) = (mesh.position(second) - first, Point::ZERO);
    for corner in corners {
        let next = mesh.position(corner) - first;
        normal += spoke.cross(next);
        spoke = next;
    }
    normal
}

#[inline(never)]
fn face_normals<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    normals: &mut FaceMap<M, Point>,
) -> SweepResult {
    count_each(elements.faces(mesh), |f| normals[f] = face_normal(mesh, f))
}

#[inline(never)]
fn vertex_normals<M: MeshQuery, E: Elements<M>>(
    mesh: &M,
    elements: &E,
    face_normals: &FaceMap<M, Point>,
    normals: &mut VertexMap<M, Point>,
) -> SweepResult {
    count_each(elements.vertices(mesh), |v| {
        let mut sum = Point::ZERO;
        mesh.vertex_faces(v).for_each(|f| sum += face_normals[f]);
        let length = sum.length();
        normals[v] = if length > 0.0 {
            sum * (1.0 / length)
        } else {
            sum
        };
    })
}
