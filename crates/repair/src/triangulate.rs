//! Triangulation as a step: the algorithm is in `sixfold-core`.

use sixfold_core::{PolygonMesh, Slot, Triangulated};

use crate::error::RepairError;
use crate::outcome::{Left, Outcome, StepCounts};
use crate::trace::{CornerId, Trace, VertexTrace, corners_of};

/// Cuts polygons into triangles; [`PolygonMesh::triangulated`] states the time.
pub(crate) fn triangulate(polygons: &PolygonMesh) -> Result<Outcome, RepairError> {
    if polygons.first_polygon().is_none() {
        return Ok(Outcome::unchanged());
    }
    let Triangulated {
        polygons: triangles,
        crossing,
        ..
    } = polygons.triangulated()?;
    let mut faces = Vec::with_capacity(triangles.face_count());
    let mut corners = Vec::with_capacity(triangles.corner_count());
    // By vertex: its corner in the current polygon.
    let mut corner_at = vec![CornerId::new(0); polygons.vertex_count()];
    let mut faces_changed = 0;
    let mut cut = triangles.faces().iter().map(|(_, triangle)| triangle);
    // A polygon of n corners is replaced by n − 2 triangles, in the order of the polygons.
    for (f, face) in polygons.faces().iter() {
        for (v, corner) in corners_of(polygons, f) {
            corner_at[v.index()] = corner;
        }
        faces_changed += usize::from(face.len() > 3);
        for triangle in cut.by_ref().take(face.len() - 2) {
            faces.push(Slot::some(f));
            corners.extend(triangle.iter().map(|v| Slot::some(corner_at[v.index()])));
        }
    }
    drop(cut);
    let counts = StepCounts {
        faces_changed,
        faces_added: faces.len() - polygons.face_count(),
        ..StepCounts::default()
    };
    let trace = Trace {
        faces,
        corners,
        vertices: VertexTrace::identity(polygons),
    };
    let left = crossing.into_iter().map(|face| Left::CrossingFace { face });
    Ok(Outcome {
        left: left.collect(),
        ..Outcome::changed((triangles, trace), counts)
    })
}
