//! The option `--triangulate`: cuts polygons into triangles.

use sixfold::glam::DVec3;
use sixfold::{Facts, PolygonMesh, VertexId};
use sixfold_study::StudyMesh;

use crate::failure::Failure;
use crate::text::print_stderr;
use sixfold_study::numbers::{counted, grouped};

/// Cuts every polygon into a fan of triangles. Records and prints all other changes of the mesh.
pub(crate) fn triangulated(study_mesh: StudyMesh) -> Result<StudyMesh, Failure> {
    let old = &study_mesh.polygons;
    let polygons = old
        .fan_triangulated()
        .map_err(|error| Failure::usage(format!("{}: {error}", study_mesh.name)))?;
    if polygons.face_count() == old.face_count() {
        return Ok(study_mesh);
    }
    let is_cut = |face: &[VertexId]| face.len() > 3;
    let cut = old.faces().iter().filter(|(_, face)| is_cut(face)).count();
    let faces = counted(old.face_count(), "face", "faces");
    let triangles = counted(polygons.face_count(), "triangle", "triangles");
    let facts = Facts::from_polygons(&polygons);
    let mut side_effects = differences(&Facts::from_polygons(old), &facts);
    let folded = folded_fans(old);
    if folded > 0 {
        let fans = counted(folded, "fan folds over", "fans fold over");
        side_effects.push(format!(
            "{fans}, because the faces are not star-shaped around their first corners"
        ));
    }
    for effect in &side_effects {
        print_stderr(&format!(
            "note: {}: --triangulate has a side effect: {effect}",
            study_mesh.name
        ));
    }
    let mut changes = study_mesh.changes;
    changes.push(format!("cut {faces} into {triangles}"));
    changes.extend(side_effects);
    Ok(StudyMesh {
        name: study_mesh.name,
        // The facts describe the cut mesh, except for the number of degenerate faces.
        facts: Facts {
            degenerate_faces: study_mesh.facts.degenerate_faces,
            ..facts
        },
        polygons,
        changes,
        left_out_faces: study_mesh.left_out_faces,
        cut_faces: cut,
        file_sha256: study_mesh.file_sha256,
    })
}

/// Lists the counts that changed although the cut should not change them. For example, a diagonal
/// may already be an edge.
fn differences(old: &Facts, new: &Facts) -> Vec<String> {
    let counts = [
        (
            "non-manifold edges",
            old.non_manifold_edges,
            new.non_manifold_edges,
        ),
        (
            "non-manifold vertices",
            old.non_manifold_vertices,
            new.non_manifold_vertices,
        ),
        ("boundary edges", old.boundary_edges, new.boundary_edges),
        (
            "inconsistent edges",
            old.inconsistent_edges,
            new.inconsistent_edges,
        ),
        ("components", old.components, new.components),
        ("duplicate faces", old.duplicate_faces, new.duplicate_faces),
    ];
    let changed = counts.into_iter().filter(|(_, old, new)| old != new);
    changed
        .map(|(what, old, new)| format!("{what}: {} before, {} now", grouped(old), grouped(new)))
        .collect()
}

/// Counts the faces whose fan has a triangle with the opposite orientation; O(corners).
fn folded_fans(mesh: &PolygonMesh) -> usize {
    let faces = mesh.faces().iter();
    faces.filter(|(_, face)| folds(mesh, face)).count()
}

fn folds(mesh: &PolygonMesh, face: &[VertexId]) -> bool {
    let at = |v: VertexId| mesh.position(v).as_dvec3();
    let Some((&first, rest)) = face.split_first() else {
        return false;
    };
    let first = at(first);
    // The sum of the cross products is the normal of the face. The length of the normal is twice
    // the area.
    let triangles = || {
        rest.windows(2)
            .map(|pair| (at(pair[0]) - first).cross(at(pair[1]) - first))
    };
    let normal: DVec3 = triangles().sum();
    // Collinear corners give triangles with area 0. The tolerance allows for rounding errors.
    triangles().any(|triangle| triangle.dot(normal) < -1e-6 * normal.length_squared())
}
