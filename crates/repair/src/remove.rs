//! Removal of isolated vertices and of small components.

use sixfold_core::{Classes, FaceId, Incidence, PolygonMesh, Slot, VertexId, row};

use crate::error::RepairError;
use crate::outcome::{Outcome, StepCounts};
use crate::trace::{Rebuild, VertexTrace};

/// Removes vertices without a face; O(vertices + corners).
pub(crate) fn isolated_vertices(polygons: &PolygonMesh) -> Result<Outcome, RepairError> {
    let used = named_by(polygons, |_| true);
    without(polygons, |v| used[v.index()], |_| true)
}

/// Removes components with fewer than `min_faces` faces, and their vertices unless another face
/// names them; O(corners).
pub(crate) fn small_components(
    polygons: &PolygonMesh,
    min_faces: usize,
) -> Result<Outcome, RepairError> {
    let faces = polygons.faces();
    let mut components = Classes::new(faces.len());
    let incidence = Incidence::new(polygons.vertex_count(), faces, |_| true);
    for edge in incidence.edges() {
        let first = edge.first().face;
        for side in edge.sides().skip(1) {
            components.join(first.index(), side.face.index());
        }
    }
    let (component, count) = components.into_numbers();
    let mut sizes = vec![0; count];
    for &number in &component {
        sizes[number as usize] += 1;
    }
    let is_kept = |&number: &u32| sizes[number as usize] >= min_faces;
    let kept: Vec<bool> = component.iter().map(is_kept).collect();
    let keeps_face = |f: FaceId| kept[f.index()];
    let (before, after) = (named_by(polygons, |_| true), named_by(polygons, keeps_face));
    // Vertices that were isolated before remain.
    let keeps_vertex = |v: VertexId| after[v.index()] || !before[v.index()];
    without(polygons, keeps_vertex, keeps_face)
}

/// Returns for each vertex whether one of the faces that `counts` selects names it.
fn named_by(polygons: &PolygonMesh, counts: impl Fn(FaceId) -> bool) -> Vec<bool> {
    let mut named = vec![false; polygons.vertex_count()];
    for (_, face) in polygons.faces().iter().filter(|&(f, _)| counts(f)) {
        for v in face {
            named[v.index()] = true;
        }
    }
    named
}

/// Returns the mesh with the vertices and faces that are kept; kept faces name kept vertices only.
pub(crate) fn without(
    polygons: &PolygonMesh,
    keeps_vertex: impl Fn(VertexId) -> bool,
    keeps_face: impl Fn(FaceId) -> bool,
) -> Result<Outcome, RepairError> {
    let mut positions = Vec::with_capacity(polygons.vertex_count());
    let mut numbers = vec![Slot::NONE; polygons.vertex_count()];
    let mut origins = Vec::with_capacity(polygons.vertex_count());
    for v in polygons.vertices().filter(|&v| keeps_vertex(v)) {
        numbers[v.index()] = Slot::some(VertexId::new(row(positions.len())));
        origins.push(Slot::some(v));
        positions.push(polygons.position(v));
    }
    let mut faces_removed = 0;
    let mut rebuild = Rebuild::new(polygons);
    for (f, _) in polygons.faces().iter() {
        if !keeps_face(f) {
            faces_removed += 1;
            continue;
        }
        rebuild.keep(f, |v, _| {
            let number = numbers[v.index()].get();
            number.expect("kept faces name kept vertices")
        })?;
    }
    let counts = StepCounts {
        vertices_removed: polygons.vertex_count() - positions.len(),
        faces_removed,
        ..StepCounts::default()
    };
    if !counts.is_change() {
        return Ok(Outcome::unchanged());
    }
    let vertices = VertexTrace {
        replacements: numbers,
        origins,
    };
    let changed = rebuild.finish(positions, vertices)?;
    Ok(Outcome::changed(changed, counts))
}
