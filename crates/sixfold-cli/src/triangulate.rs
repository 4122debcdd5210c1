//! `--triangulate`: polygons cut into fans, and what that does to the mesh.

use ::study::Specimen;
use sixfold::{Facts, PolygonMesh, VertexId};

use crate::failure::Failure;
use crate::text::complain;
use ::study::numbers::{counted, grouped};

/// The mesh with every polygon cut into a fan; what else changes by that is on record, and said.
pub(crate) fn triangulated(specimen: Specimen) -> Result<Specimen, Failure> {
    let old = &specimen.polygons;
    let polygons = old
        .fan_triangulated()
        .map_err(|error| Failure::usage(format!("{}: {error}", specimen.name)))?;
    if polygons.face_count() == old.face_count() {
        return Ok(specimen);
    }
    let faces = counted(old.face_count(), "face", "faces");
    let triangles = counted(polygons.face_count(), "triangle", "triangles");
    let facts = Facts::of(&polygons);
    let mut news = differences(&Facts::of(old), &facts);
    let folded = folded_fans(old);
    if folded > 0 {
        let fans = counted(folded, "fan folds over", "fans fold over");
        news.push(format!(
            "{fans}, since the faces are not convex from their first corners"
        ));
    }
    for new in &news {
        complain(&format!(
            "note: {}: --triangulate changes more than faces: {new}",
            specimen.name
        ));
    }
    let mut changes = specimen.changes;
    changes.push(format!("cut {faces} into {triangles}"));
    changes.extend(news);
    Ok(Specimen {
        name: specimen.name,
        // The facts are those of the mesh that is studied; what was left out stays on record.
        facts: Facts {
            degenerate_faces: specimen.facts.degenerate_faces,
            ..facts
        },
        polygons,
        changes,
    })
}

/// What a cut inside a face should leave alone, and did not: a diagonal may be an edge already.
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
        .map(|(what, old, new)| format!("{what} {} before, {} now", grouped(old), grouped(new)))
        .collect()
}

/// How many faces have a triangle in their fan that looks the other way than the face: it lies over
/// others. O(corners).
fn folded_fans(mesh: &PolygonMesh) -> usize {
    let faces = mesh.faces().iter();
    faces.filter(|(_, face)| folds(mesh, face)).count()
}

fn folds(mesh: &PolygonMesh, face: &[VertexId]) -> bool {
    let at = |v: VertexId| mesh.position(v).to_array().map(f64::from);
    let Some((&first, rest)) = face.split_first() else {
        return false;
    };
    let first = at(first);
    // Their sum is the normal of the face, with twice its area for length.
    let triangles = || {
        rest.windows(2)
            .map(|pair| cross(minus(at(pair[0]), first), minus(at(pair[1]), first)))
    };
    let normal = triangles().fold([0.0; 3], |sum, n| [0, 1, 2].map(|i| sum[i] + n[i]));
    let whole = dot(normal, normal);
    // Corners in a line give triangles of no area; rounding must not turn them.
    triangles().any(|triangle| dot(triangle, normal) < -1e-6 * whole)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
