//! Shrinks a failing mesh face by face.

use sixfold_core::{Point, PolygonMesh, VertexId};

/// Removes faces from `polygons` as long as the mesh still `fails`.
///
/// Proptest shrinks only the random choices that made a mesh, so its result may be large.
pub(crate) fn shrink(polygons: PolygonMesh, fails: impl Fn(&PolygonMesh) -> bool) -> PolygonMesh {
    let mut smallest = polygons;
    let mut at = 0;
    let mut kept = 0;
    while kept < smallest.face_count() {
        at %= smallest.face_count();
        let fewer = without_face(&smallest, at);
        if fails(&fewer) {
            (smallest, kept) = (fewer, 0);
        } else {
            (at, kept) = (at + 1, kept + 1);
        }
    }
    let used = without_isolated(&smallest);
    if fails(&used) { used } else { smallest }
}

fn without_face(polygons: &PolygonMesh, removed: usize) -> PolygonMesh {
    let faces = polygons
        .faces()
        .iter()
        .filter(|(f, _)| f.index() != removed);
    let faces = faces.map(|(_, corners)| vertex_numbers(corners, |v| v.index() as u32));
    PolygonMesh::new(polygons.positions().iter().copied(), faces)
        .expect("the other faces are unchanged")
}

fn without_isolated(polygons: &PolygonMesh) -> PolygonMesh {
    let mut used = polygons.faces().corners().to_vec();
    used.sort();
    used.dedup();
    let name = |v: &VertexId| used.iter().position(|u| u == v).unwrap_or_default() as u32;
    let faces = polygons.faces().iter();
    let faces = faces.map(|(_, corners)| vertex_numbers(corners, name));
    let points: Vec<Point> = used.iter().map(|&v| polygons.position(v)).collect();
    PolygonMesh::new(points, faces).expect("the corners of a face stay distinct")
}

fn vertex_numbers(corners: &[VertexId], name: impl Fn(&VertexId) -> u32) -> Vec<u32> {
    corners.iter().map(name).collect()
}
