//! Reads meshes to measure.

use std::fs;
use std::path::Path;

use sixfold::io::{FileMesh, LeftOut, PolygonPlaces};
use sixfold::shapes;
use sixfold_results::Failed;
use sixfold_results::numbers::counted;

use crate::command::failure::Failure;
use crate::command::mesh_files::{ReadFiles, read_mesh, shown};
use crate::command::meshes::Mesh;
use crate::command::text::{print_notice, print_places};
use crate::command::triangulate::triangulated;
use crate::{StudyMesh, sha256_of};

/// Reads a mesh for a study. `strict` refuses degenerate faces. `triangulate` cuts polygons.
pub fn for_study(
    path: &Path,
    files: ReadFiles,
    strict: bool,
    triangulate: bool,
) -> Result<StudyMesh, Failure> {
    let (mut study_mesh, left_out, places) = into_study_mesh(path, read_mesh(path, files)?);
    let file = shown(path);
    if !left_out.is_empty() && strict {
        let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
        let first = &left_out[0];
        return Err(Failure::usage(format!(
            "{file}: {faces}, the first at {first}: repair the file, or study it without --strict"
        )));
    }
    if study_mesh.polygons.face_count() == 0 {
        let what = match left_out.len() {
            0 => "points but no faces".to_owned(),
            n => format!(
                "no faces except {}",
                counted(n, "degenerate face", "degenerate faces")
            ),
        };
        return Err(Failure::usage(format!(
            "{file}: the file has {what}, so there is nothing to study: use `sixfold inspect` \
             instead"
        )));
    }
    print_left_out(path, &left_out);
    study_mesh.file_sha256 = file_hash(path);
    if triangulate {
        study_mesh = triangulated(study_mesh, Some(&places))?;
    }
    Ok(study_mesh)
}

/// Reads a mesh for a study as [`for_study`] does. Without a path, returns the built-in mesh.
pub fn mesh_or_built_in(
    path: Option<&Path>,
    files: ReadFiles,
    strict: bool,
    triangulate: bool,
) -> Result<StudyMesh, Failure> {
    match path {
        Some(path) => for_study(path, files, strict, triangulate),
        None => Ok(built_in()),
    }
}

/// Returns the built-in mesh.
pub fn built_in() -> StudyMesh {
    StudyMesh::new("built-in mesh", shapes::built_in_mesh())
}

/// Returns the SHA-256 of a regular file; `None` if there is no such file. A pipe can be read only
/// once, so it has no hash.
pub fn file_hash(path: &Path) -> Option<String> {
    let is_file = fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    match is_file {
        true => sha256_of(fs::File::open(path).ok()?).ok(),
        false => None,
    }
}

pub fn print_left_out(path: &Path, left_out: &[LeftOut]) {
    let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
    print_places(
        &format!("{}: left out {faces}", shown(path)),
        left_out.iter().map(ToString::to_string),
    );
}

pub fn into_study_mesh(path: &Path, mesh: FileMesh) -> (StudyMesh, Vec<LeftOut>, PolygonPlaces) {
    let facts = mesh.facts();
    let (polygons, left_out, places) = mesh.into_polygons_with_places();
    let mut changes = Vec::new();
    if !left_out.is_empty() {
        let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
        changes.push(format!("left out {faces}"));
    }
    let study_mesh = StudyMesh {
        changes,
        left_out_faces: left_out.len(),
        ..StudyMesh::with_facts(shown(path), polygons, facts)
    };
    (study_mesh, left_out, places)
}

/// Reads the meshes. Without a path, a mesh is the built-in mesh. Of several, those that cannot be read are
/// noted and returned as the second list.
///
/// # Errors
///
/// Fails if no mesh can be read.
pub fn study_meshes(
    meshes: &[Mesh],
    files: ReadFiles,
    triangulate: bool,
) -> Result<(Vec<StudyMesh>, Vec<Failed>), Failure> {
    let read = |mesh: &Mesh| match (&mesh.path, &mesh.problem) {
        (None, Some(problem)) => Err(Failure::usage(format!("{}: {problem}", mesh.name))),
        (path, _) => mesh_or_built_in(path.as_deref(), files, false, triangulate),
    };
    if let [only] = meshes {
        return Ok((vec![read(only)?], Vec::new()));
    }
    let (mut loaded, mut failed) = (Vec::new(), Vec::new());
    for mesh in meshes {
        match read(mesh) {
            Ok(study_mesh) => loaded.push(study_mesh),
            Err(failure) => {
                print_notice(&format!("note: not measured: {}", failure.message));
                failed.push(mesh.not_measured(&failure));
            }
        }
    }
    match loaded.is_empty() {
        true => Err(Failure::usage(
            "none of the meshes can be measured: correct the files that the notes above name",
        )),
        false => Ok((loaded, failed)),
    }
}
