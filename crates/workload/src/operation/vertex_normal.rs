//! Stores the normal of each face, and then for each vertex the normalised sum of the normals of its
//! faces.

use sixfold::{FaceMap, MeshQuery, Point, PolygonMesh, Relation, VertexMap};

use super::{Checksum, Description, ElementKind, Unit};
use crate::sweeps::{Elements, Outputs, SweepResult, count_each};

pub(super) const DESCRIPTION: Description = Description {
    name: "vertex_normal",
    about: "stores the normals of faces, then of vertices",
    unit: Unit::Element(ElementKind::Vertex),
    visits: &[(ElementKind::Face, &[Relation::FaceVertices]), (ElementKind::Vertex, &[Relation::VertexFaces])],
    checksum: Checksum::VertexValues,
    noise: |polygons| 12.0 * cancelled_normals(polygons) as f64,
    ..Description::TRAVERSAL
};

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

/// Counts the vertices whose face normals cancel. The direction of their sum is noise.
fn cancelled_normals(polygons: &PolygonMesh) -> usize {
    let mut sums = vec![(Point::ZERO, 0.0_f32); polygons.vertex_count()];
    for (_, face) in polygons.faces().iter() {
        let at = |corner: usize| polygons.position(face[corner]);
        let spokes = (1..face.len() - 1).map(|i| (at(i) - at(0)).cross(at(i + 1) - at(0)));
        let (mut normal, mut size) = (Point::ZERO, 0.0);
        for cross in spokes {
            normal += cross;
            size += cross.length();
        }
        for &v in face {
            let (sum, total) = &mut sums[v.index()];
            *sum += normal;
            *total += size;
        }
    }
    let cancels = |(sum, total): &&(Point, f32)| *total > 0.0 && sum.length() < 1e-3 * total;
    sums.iter().filter(cancels).count()
}
