//! Chooses faces of a triangle mesh that are far apart, so that edits at these faces do not affect
//! each other.

use sixfold::{
    Edit, FaceId, FaceVertexMesh, MeshEdit, MeshQuery, Point, PolygonMesh, Refusal, Representation,
};

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

/// The arguments of an edit at one place.
pub(crate) struct EditPlace<M: MeshQuery> {
    pub(crate) face: M::Face,
    corners: [M::Vertex; 3],
    edge: Option<M::Edge>,
    /// A neighbour of the first corner that is not a corner of the face.
    far_neighbour: Option<M::Vertex>,
    position: Point,
}

impl<M: Representation> EditPlace<M> {
    /// Looks up the arguments of `edit` at face `f`.
    pub(crate) fn new(mesh: &M, polygons: &PolygonMesh, edit: Edit, f: FaceId) -> Self {
        let takes_edge = matches!(
            edit,
            Edit::SplitEdge
                | Edit::BisectEdge
                | Edit::SplitFace
                | Edit::DissolveEdge
                | Edit::FlipEdge
                | Edit::CollapseEdge
        );
        let ids = polygons.faces().face(f);
        let corners = [0, 1, 2].map(|i| M::vertex_handle(polygons, ids[i]));
        let [a, b, c] = [0, 1, 2].map(|i: usize| polygons.position(ids[i]));
        let mut place = Self {
            face: M::face_handle(polygons, f),
            corners,
            edge: None,
            far_neighbour: None,
            position: (a + b + c) / 3.0 + Point::splat(1e-3),
        };
        if takes_edge {
            place.edge = mesh.edge_between(corners[0], corners[1]);
        }
        if edit == Edit::SplitVertex {
            let mut around = mesh.vertex_vertices(corners[0]);
            place.far_neighbour = around.find(|v| !corners.contains(v));
        }
        place
    }
}

/// Prepares one place for the edit.
pub(crate) fn prepare_place<M: MeshEdit>(
    mesh: &mut M,
    edit: Edit,
    place: &mut EditPlace<M>,
) -> Result<(), Refusal<M>> {
    match edit {
        Edit::AddFace | Edit::Compact => mesh.remove_face(place.face),
        Edit::SplitFace => {
            let edge = place.edge.take();
            let edge = edge.expect("`EditPlace::new` looked up the edge");
            place.face = mesh.dissolve_edge(edge)?;
            Ok(())
        }
        _ => Ok(()),
    }
}

#[inline(always)]
pub(crate) fn apply_edit<M: MeshEdit>(
    mesh: &mut M,
    edit: Edit,
    place: &EditPlace<M>,
) -> Result<(), Refusal<M>> {
    let [a, b, c] = place.corners;
    let edge = || place.edge.expect("`EditPlace::new` looked up the edge");
    match edit {
        Edit::SetPosition => mesh.set_position(a, place.position).map(drop),
        Edit::AddVertex => mesh.add_vertex(place.position).map(drop),
        Edit::AddFace => mesh.add_face(&[a, b, c]).map(drop),
        Edit::RemoveFace => mesh.remove_face(place.face),
        Edit::RemoveVertex => mesh.remove_vertex(a),
        Edit::SplitEdge => mesh.split_edge(edge(), place.position).map(drop),
        Edit::BisectEdge => mesh.bisect_edge(edge(), place.position).map(drop),
        Edit::PokeFace => mesh.poke_face(place.face, place.position).map(drop),
        Edit::SplitFace => mesh.split_face(place.face, [a, b]).map(drop),
        Edit::DissolveEdge => mesh.dissolve_edge(edge()).map(drop),
        Edit::FlipEdge => mesh.flip_edge(edge()).map(drop),
        Edit::CollapseEdge => mesh.collapse_edge(edge(), a, place.position).map(drop),
        Edit::SplitVertex => mesh
            .split_vertex(a, Some(b), place.far_neighbour, place.position)
            .map(drop),
        // Passes over the whole mesh run elsewhere.
        _ => Ok(()),
    }
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
