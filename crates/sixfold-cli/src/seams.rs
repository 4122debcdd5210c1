//! Seams: boundaries that lie on each other, because the vertices there are not shared.

use std::path::Path;

use sixfold::repair::{Repaired, Step, Weld, repair};
use sixfold::{Creases, Facts, PolygonMesh};
use sixfold_results::numbers::counted;

use crate::arguments::ReadFiles;
use crate::mesh_files::shown;
use crate::text::print_notice;

/// Joins vertices at equal positions if this closes seams, so that a command that moves vertices does
/// not open them. Prints what was joined, or why seams stay open.
pub(crate) fn without_seams(
    path: &Path,
    polygons: PolygonMesh,
    creases: Creases,
    chosen: ReadFiles,
) -> (PolygonMesh, Creases) {
    match joined(path, &polygons, chosen) {
        Some(joined) => {
            let (creases, _) = joined.carried_creases(&creases);
            (joined.polygons, creases)
        }
        None => (polygons, creases),
    }
}

/// Joins vertices as [`without_seams`] does, if this closes seams.
pub(crate) fn joined(path: &Path, polygons: &PolygonMesh, chosen: ReadFiles) -> Option<Repaired> {
    if chosen.as_stored {
        return None;
    }
    // If this fails, the command names what is wrong with the mesh.
    let welded = repair(polygons, &[Step::Weld(Weld::default())]).ok()?;
    let joined = welded.steps[0].counts.vertices_merged;
    if joined == 0 {
        return None;
    }
    let [before, after] = [polygons, &welded.polygons].map(Facts::from_polygons);
    if after.boundary_edges >= before.boundary_edges {
        return None;
    }
    let closed = before.boundary_edges - after.boundary_edges;
    let file = shown(path);
    let edges = counted(closed, "boundary edge", "boundary edges");
    if after.non_manifold_edges > before.non_manifold_edges
        || after.non_manifold_vertices > before.non_manifold_vertices
    {
        print_notice(&format!(
            "note: {file}: {edges} are at the positions of others and may come apart: `sixfold \
             repair --weld --cut` joins them"
        ));
        return None;
    }
    let vertices = counted(joined, "vertex", "vertices");
    print_notice(&format!(
        "note: {file}: joined {vertices} to others at equal positions, which closes {edges}: \
         --as-stored keeps them apart"
    ));
    Some(welded)
}
