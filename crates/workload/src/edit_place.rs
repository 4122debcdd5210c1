//! Chooses faces of a mesh that are far apart, so that edits at these faces do not affect
//! each other.

use sixfold::{
    Edit, FaceId, FaceVertexMesh, MeshEdit, Point, PolygonMesh, Refusal, Representation,
};
use sixfold_core::{EditOf, edit_at_face};

/// Returns at most `max_count` faces, spread over the mesh. The surroundings of two faces share no
/// vertices. The surroundings of a face are all faces that touch a corner of the face.
pub(crate) fn independent_faces(
    polygons: &PolygonMesh,
    max_count: usize,
) -> Result<Vec<FaceId>, String> {
    let mesh = FaceVertexMesh::from_polygons(polygons).map_err(|refusal| refusal.to_string())?;
    let mut taken = vec![false; polygons.vertex_count()];
    let faces = polygons.face_count();
    // A stride coprime to the number of faces visits all faces.
    let mut stride = (faces as f64 * 0.618) as usize | 1;
    while gcd(stride, faces) != 1 {
        stride += 2;
    }
    let mut chosen = Vec::new();
    let mut at = 0;
    for _ in 0..faces {
        at = (at + stride) % faces;
        let f = FaceId::new(at as u32);
        let around = || {
            let corners = mesh.face(f).iter();
            let faces = corners.flat_map(|&v| mesh.fan(v));
            faces.flat_map(|&g| mesh.face(g)).map(|v| v.index())
        };
        if around().any(|v| taken[v]) {
            continue;
        }
        around().for_each(|v| taken[v] = true);
        chosen.push(f);
        if chosen.len() == max_count {
            break;
        }
    }
    Ok(chosen)
}

const fn gcd(mut a: usize, mut b: usize) -> usize {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Returns an edit of the given kind at face `f` of `polygons`. Prepares `mesh` for it.
pub(crate) fn prepare_edit<M: Representation + MeshEdit>(
    mesh: &mut M,
    polygons: &PolygonMesh,
    edit: Edit,
    f: FaceId,
) -> Result<EditOf<M>, Refusal<M>> {
    let ids = polygons.faces().face(f);
    let corners: Vec<M::Vertex> = (ids.iter().map(|&v| M::vertex_handle(polygons, v))).collect();
    let sum: Point = ids.iter().map(|&v| polygons.position(v)).sum();
    let at = sum / ids.len() as f32 + Point::splat(1e-3);
    edit_at_face(mesh, edit, M::face_handle(polygons, f), &corners, at)
}

#[cfg(test)]
mod tests {
    use sixfold::{VertexId, shapes};

    use super::*;

    #[test]
    fn independent_faces_do_not_touch() {
        let torus = shapes::triangle_torus(30, 30).expect("small");
        let faces = independent_faces(&torus, usize::MAX).expect("any structure holds it");
        assert!(faces.len() > 20, "{}", faces.len());
        let mut corners: Vec<VertexId> = faces
            .iter()
            .flat_map(|&f| torus.faces().face(f).to_vec())
            .collect();
        corners.sort_unstable();
        corners.dedup();
        assert_eq!(corners.len(), 3 * faces.len());
    }
}
