//! Reads meshes and results from files.

use std::fs;
use std::path::{Path, PathBuf};

use sixfold::io::{LeftOut, ObjMesh, read_obj};
use sixfold::{Creases, PolygonMesh, shapes};
use sixfold_study::{ReadError, StudyMesh};

use crate::failure::Failure;
use crate::output::is_stdout;
use crate::text::print_stderr;
use crate::triangulate::triangulated;
use sixfold_study::numbers::counted;

/// Maximum number of omitted faces that are listed with their line.
const SHOWN: usize = 5;

/// Reads an OBJ file, and prints a note for each part that is ignored.
pub(crate) fn read(path: &Path) -> Result<ObjMesh, Failure> {
    // `-` means standard output for other arguments; here it would name a file.
    if is_stdout(path) {
        return Err(Failure::usage(
            "-: standard input is not read: write the mesh to a file and name the file",
        ));
    }
    let mesh = read_obj(path).map_err(Failure::usage)?;
    for notice in &mesh.notices {
        print_stderr(&format!("note: {}: {notice}", path.display()));
    }
    Ok(mesh)
}

/// Returns the mesh in the file at `path` without its degenerate faces, and lists these.
pub(crate) fn study_mesh(path: &Path) -> Result<StudyMesh, Failure> {
    let (study_mesh, left_out) = from_file(path)?;
    print_left_out(path, &left_out);
    Ok(study_mesh)
}

/// Returns the mesh for a study. Refuses degenerate faces if `strict`; cuts polygons if
/// `triangulate`.
pub(crate) fn for_study(
    path: &Path,
    strict: bool,
    triangulate: bool,
) -> Result<StudyMesh, Failure> {
    let (mut study_mesh, left_out) = from_file(path)?;
    let file = path.display();
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
    if triangulate {
        study_mesh = triangulated(study_mesh)?;
    }
    Ok(study_mesh)
}

/// Returns the mesh in the file at `path` without its degenerate faces, and the creases in the
/// file.
pub(crate) fn with_creases(path: &Path) -> Result<(PolygonMesh, Creases), Failure> {
    let mesh = read(path)?;
    let (creases, unused) = mesh.creases();
    for crease in &unused {
        print_stderr(&format!("note: {}: {crease}", path.display()));
    }
    let (polygons, left_out) = mesh.into_polygons();
    print_left_out(path, &left_out);
    Ok((polygons, creases))
}

/// Returns the mesh for a command that drops creases, and prints a note if there are any.
pub(crate) fn without_creases(path: &Path) -> Result<PolygonMesh, Failure> {
    let (polygons, creases) = with_creases(path)?;
    if !creases.is_empty() {
        let file = path.display();
        print_stderr(&format!(
            "note: {file}: the result does not keep sharp edges and vertices"
        ));
    }
    Ok(polygons)
}

/// Returns the file of results: `results.json` if `place` is the folder of a report, else `place`.
pub(crate) fn results_path(place: &Path) -> PathBuf {
    match place.is_dir() {
        true => place.join("results.json"),
        false => place.to_owned(),
    }
}

/// Reads the file at `path` and parses its results with `parse`.
pub(crate) fn read_results<T>(
    path: &Path,
    parse: impl Fn(&str) -> Result<T, ReadError>,
) -> Result<T, Failure> {
    let file = path.display();
    let text = fs::read_to_string(path).map_err(|cause| {
        Failure::usage(format!(
            "{file}: cannot be read ({cause}): name a file from --json, or a folder from --report"
        ))
    })?;
    parse(&text).map_err(|error| Failure::usage(format!("{file}: {error}")))
}

/// Returns the built-in mesh.
pub(crate) fn built_in() -> StudyMesh {
    StudyMesh::new("default study (built in)", shapes::default_study())
}

/// Prints which faces of the file were left out, with their lines.
fn print_left_out(path: &Path, left_out: &[LeftOut]) {
    if left_out.is_empty() {
        return;
    }
    let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
    print_stderr(&format!("note: {}: left out {faces}:", path.display()));
    for left_out in left_out.iter().take(SHOWN) {
        print_stderr(&format!("note:   {left_out}"));
    }
    if left_out.len() > SHOWN {
        print_stderr(&format!("note:   and {} more", left_out.len() - SHOWN));
    }
}

fn from_file(path: &Path) -> Result<(StudyMesh, Vec<LeftOut>), Failure> {
    let mesh = read(path)?;
    let facts = mesh.facts();
    let (polygons, left_out) = mesh.into_polygons();
    let mut changes = Vec::new();
    if !left_out.is_empty() {
        let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
        changes.push(format!("left out {faces}"));
    }
    let study_mesh = StudyMesh {
        name: path.display().to_string(),
        facts,
        polygons,
        changes,
    };
    Ok((study_mesh, left_out))
}
