//! From a file to a mesh that can be looked into.

use std::fs;
use std::path::{Path, PathBuf};

use ::study::{ReadError, Specimen};
use sixfold::mesh_io::{LeftOut, ObjMesh, read_obj};
use sixfold::{Creases, PolygonMesh, shapes};

use crate::failure::Failure;
use crate::output::is_stdout;
use crate::text::complain;
use crate::triangulate::triangulated;
use ::study::numbers::counted;

/// How many of the faces that were left out are shown with their place.
const SHOWN: usize = 5;

/// Reads an OBJ file, and says what of it is passed over.
pub(crate) fn read(path: &Path) -> Result<ObjMesh, Failure> {
    // What means standard output elsewhere would be a file called `-` here.
    if is_stdout(path) {
        return Err(Failure::usage(
            "-: standard input is not read: write the mesh to a file and name that",
        ));
    }
    let mesh = read_obj(path).map_err(Failure::usage)?;
    for notice in &mesh.notices {
        complain(&format!("note: {}: {notice}", path.display()));
    }
    Ok(mesh)
}

/// The mesh of the file at `path`, without its degenerate faces; these are named.
pub(crate) fn specimen(path: &Path) -> Result<Specimen, Failure> {
    let (specimen, left_out) = from_file(path)?;
    tell(path, &left_out);
    Ok(specimen)
}

/// The same for a study: nothing is left out if `strict`, and polygons are cut up on demand.
pub(crate) fn for_study(path: &Path, strict: bool, triangulate: bool) -> Result<Specimen, Failure> {
    let (mut specimen, left_out) = from_file(path)?;
    let file = path.display();
    if !left_out.is_empty() && strict {
        let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
        let first = &left_out[0];
        return Err(Failure::usage(format!(
            "{file}: {faces}, the first at {first}: mend the file, or study it without --strict"
        )));
    }
    if specimen.polygons.face_count() == 0 {
        let what = match left_out.len() {
            0 => "points and no faces".to_owned(),
            n => format!(
                "no faces but {}",
                counted(n, "degenerate one", "degenerate ones")
            ),
        };
        return Err(Failure::usage(format!(
            "{file}: {what}, so there is nothing to study: try `sixfold inspect`"
        )));
    }
    tell(path, &left_out);
    if triangulate {
        specimen = triangulated(specimen)?;
    }
    Ok(specimen)
}

/// The mesh of the file at `path`, without its degenerate faces, and the sharpness that the file
/// tells.
pub(crate) fn with_creases(path: &Path) -> Result<(PolygonMesh, Creases), Failure> {
    let mesh = read(path)?;
    let (creases, loose) = mesh.creases();
    for crease in &loose {
        complain(&format!("note: {}: {crease}", path.display()));
    }
    let (polygons, left_out) = mesh.into_polygons();
    tell(path, &left_out);
    Ok((polygons, creases))
}

/// The same for a command that carries no sharpness over: if there is any, that is said.
pub(crate) fn without_creases(path: &Path) -> Result<PolygonMesh, Failure> {
    let (polygons, creases) = with_creases(path)?;
    if !creases.is_empty() {
        let file = path.display();
        complain(&format!(
            "note: {file}: sharp edges and vertices are not carried over"
        ));
    }
    Ok(polygons)
}

/// The file of results that `place` means: of the folder of a report the one with all of them.
pub(crate) fn results_in(place: &Path) -> PathBuf {
    match place.is_dir() {
        true => place.join("results.json"),
        false => place.to_owned(),
    }
}

/// The results in the file at `path`, which `parse` makes sense of.
pub(crate) fn results<T>(
    path: &Path,
    parse: impl Fn(&str) -> Result<T, ReadError>,
) -> Result<T, Failure> {
    let file = path.display();
    let text = fs::read_to_string(path)
        .map_err(|cause| Failure::usage(format!("{file}: cannot be read: {cause}")))?;
    parse(&text).map_err(|error| Failure::usage(format!("{file}: {error}")))
}

/// The built-in mesh.
pub(crate) fn built_in() -> Specimen {
    Specimen::new("default study (built in)", shapes::default_study())
}

/// Says which faces were left out of the file, and where they are.
fn tell(path: &Path, left_out: &[LeftOut]) {
    if left_out.is_empty() {
        return;
    }
    let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
    complain(&format!("note: {}: left out {faces}:", path.display()));
    for left_out in left_out.iter().take(SHOWN) {
        complain(&format!("note:   {left_out}"));
    }
    if left_out.len() > SHOWN {
        complain(&format!("note:   and {} more", left_out.len() - SHOWN));
    }
}

fn from_file(path: &Path) -> Result<(Specimen, Vec<LeftOut>), Failure> {
    let mesh = read(path)?;
    let facts = mesh.facts();
    let (polygons, left_out) = mesh.into_polygons();
    let mut changes = Vec::new();
    if !left_out.is_empty() {
        let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
        changes.push(format!("left out {faces}"));
    }
    let specimen = Specimen {
        name: path.display().to_string(),
        facts,
        polygons,
        changes,
    };
    Ok((specimen, left_out))
}
