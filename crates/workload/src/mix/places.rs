//! Chooses the faces at which the edits of a mix are done. These faces are away from the queried
//! elements, and edits at different faces do not affect each other.

use sixfold::{Edit, FaceId, FaceVertexMesh, PolygonMesh, Representation};

use crate::edit_place::independent_faces;
use crate::mix::schedule::Schedule;
use crate::workload::Action;

/// Minimum number of vertices per place. The other vertices are left for queries.
const VERTICES_PER_PLACE: usize = 60;
/// Maximum number of places.
const MAX_PLACES: usize = 512;

/// The reason why a mix with edits cannot run on a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message explains each field")]
pub enum EditPlaceError {
    /// A face is not a triangle, and the edit is one of triangles.
    #[error("face {face} has {degree} corners, and {edit} needs triangles: triangulate the mesh")]
    NotATriangle {
        edit: Edit,
        face: FaceId,
        degree: usize,
    },
    /// The mesh is too small: it has too few vertices for the edits and the queries of the mix.
    #[error(
        "the mesh is too small for {edits} kinds of edits and for queries away from the edits: \
         use a larger mesh"
    )]
    TooSmall { edits: usize },
    /// Each face that was chosen for the edit is refused by at least one backend.
    #[error(
        "at least one backend refuses {edit} at every tried face: remove {edit} from the \
         workload, or use another mesh"
    )]
    NowhereAccepted { edit: Edit },
}

/// The faces at which edits are done, and the vertices near them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EditPlaces {
    /// For each edit of the schedule, its faces.
    pub(crate) by_edit: Vec<Vec<FaceId>>,
    /// For each vertex, whether it is near a place. Empty if there are no edits.
    pub(crate) occupied: Vec<bool>,
}

impl EditPlaces {
    /// Distributes the edits over `polygons` in proportion to their shares.
    pub(crate) fn new(schedule: &Schedule, polygons: &PolygonMesh) -> Result<Self, EditPlaceError> {
        let edits: Vec<(Edit, f64)> = schedule
            .edits()
            .map(|part| match schedule.parts[part].action {
                Action::Edit(edit) => (edit, schedule.shares[part]),
                _ => (Edit::Compact, 0.0), // unreachable: `edits` returns only edits
            })
            .collect();
        if edits.is_empty() {
            return Ok(Self::default());
        }
        let of_triangles =
            |(edit, _): &&(Edit, f64)| matches!(edit, Edit::BisectEdge | Edit::FlipEdge);
        if let Some(&(edit, _)) = edits.iter().find(of_triangles)
            && let Some((face, degree)) = polygons.first_polygon()
        {
            return Err(EditPlaceError::NotATriangle { edit, face, degree });
        }
        let too_small = EditPlaceError::TooSmall { edits: edits.len() };
        let max_count = (polygons.vertex_count() / VERTICES_PER_PLACE).min(MAX_PLACES);
        let mut faces = independent_faces(polygons, max_count.max(edits.len())).unwrap_or_default();
        if faces.len() < edits.len() {
            return Err(too_small);
        }
        // Each edit gets one place. Each further place goes to the edit with the fewest places
        // relative to its share.
        let mut by_edit: Vec<Vec<FaceId>> = faces.drain(..edits.len()).map(|f| vec![f]).collect();
        for face in faces {
            let fewest = (0..edits.len()).min_by(|&a, &b| {
                let per_share = |i: usize| by_edit[i].len() as f64 / edits[i].1;
                per_share(a).total_cmp(&per_share(b))
            });
            by_edit[fewest.unwrap_or(0)].push(face);
        }
        let occupied = vertices_near_places(&by_edit, polygons);
        let free = |corners: &[sixfold::VertexId]| corners.iter().all(|v| !occupied[v.index()]);
        if !polygons.faces().iter().any(|(_, corners)| free(corners)) {
            return Err(too_small);
        }
        Ok(Self { by_edit, occupied })
    }

    pub(crate) fn filter_accepted(&self, accepted: &[Vec<bool>]) -> Self {
        let keep = |(faces, accepted): (&Vec<FaceId>, &Vec<bool>)| {
            let both = faces.iter().zip(accepted);
            both.filter(|(_, accepted)| **accepted)
                .map(|(&f, _)| f)
                .collect()
        };
        Self {
            by_edit: self.by_edit.iter().zip(accepted).map(keep).collect(),
            occupied: self.occupied.clone(),
        }
    }
}

/// Returns for each vertex whether it is a corner of a face that touches a place.
fn vertices_near_places(by_edit: &[Vec<FaceId>], polygons: &PolygonMesh) -> Vec<bool> {
    let mut occupied = vec![false; polygons.vertex_count()];
    let Ok(mesh) = FaceVertexMesh::from_polygons(polygons) else {
        return occupied; // refused only if the mesh has too many elements
    };
    for &f in by_edit.iter().flatten() {
        let fans = mesh.face(f).iter().flat_map(|&v| mesh.fan(v));
        fans.flat_map(|&g| mesh.face(g))
            .for_each(|v| occupied[v.index()] = true);
    }
    occupied
}
