//! The option `--triangulate`: cuts polygons into triangles.

use crate::StudyMesh;
use sixfold::io::PolygonPlaces;
use sixfold::{FaceId, Facts, PolygonMesh, Triangulated, VertexId};

use crate::command::failure::Failure;
use crate::command::text::{print_notice, print_places};
use sixfold_results::numbers::{counted, grouped};

/// Cuts every polygon into triangles, and prints which polygons cross themselves. `places` are those
/// of the faces in the file with the name `name`.
pub fn cut_polygons(
    name: &str,
    polygons: &PolygonMesh,
    places: Option<&PolygonPlaces>,
) -> Result<Triangulated, Failure> {
    let cut = polygons
        .triangulated()
        .map_err(|error| Failure::usage(format!("{name}: {error}")))?;
    print_crossing(name, &cut.crossing, |face| match places {
        Some(places) => format!("{}: face {face}", places.place(face, polygons)),
        None => format!("face {face}"),
    });
    Ok(cut)
}

/// Prints which faces of the file with the name `name` cross themselves. `place` describes where a
/// face is.
pub fn print_crossing(name: &str, faces: &[FaceId], place: impl Fn(FaceId) -> String) {
    let places = faces.iter().map(|&face| place(face));
    print_places(&format!("{name}: {}", crossing(faces.len())), places);
}

/// Describes faces that cross themselves.
fn crossing(faces: usize) -> String {
    let faces = counted(faces, "face crosses itself", "faces cross themselves");
    format!("{faces}, so the triangles overlap")
}

/// Cuts every polygon into triangles. Records and prints all other changes of the mesh.
pub fn triangulated(
    study_mesh: StudyMesh,
    places: Option<&PolygonPlaces>,
) -> Result<StudyMesh, Failure> {
    let old = &study_mesh.polygons;
    let Triangulated {
        polygons,
        crossing: crossed,
        ..
    } = cut_polygons(&study_mesh.name, old, places)?;
    if polygons.face_count() == old.face_count() {
        return Ok(study_mesh);
    }
    let is_cut = |face: &[VertexId]| face.len() > 3;
    let cut = old.faces().iter().filter(|(_, face)| is_cut(face)).count();
    let faces = counted(old.face_count(), "face", "faces");
    let triangles = counted(polygons.face_count(), "triangle", "triangles");
    let facts = Facts::from_polygons(&polygons);
    let side_effects = differences(&Facts::from_polygons(old), &facts);
    for effect in &side_effects {
        print_notice(&format!(
            "note: {}: --triangulate has a side effect: {effect}",
            study_mesh.name
        ));
    }
    let mut changes = study_mesh.changes;
    changes.push(format!("cut {faces} into {triangles}"));
    changes.extend(side_effects);
    if !crossed.is_empty() {
        changes.push(crossing(crossed.len()));
    }
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
        picture: study_mesh.picture,
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
