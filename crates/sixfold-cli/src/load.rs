//! From a file to a mesh that can be looked into.

use std::path::Path;

use ::study::Specimen;
use sixfold::mesh_io::{LeftOut, ObjMesh, read_obj};
use sixfold::{Facts, shapes};

use crate::failure::Failure;
use crate::numbers::counted;
use crate::text::complain;

/// How many of the faces that were left out are shown with their place.
const SHOWN: usize = 5;

/// Reads an OBJ file, and says what of it is passed over.
pub(crate) fn read(path: &Path) -> Result<ObjMesh, Failure> {
    let mesh = read_obj(path).map_err(Failure::usage)?;
    for notice in &mesh.notices {
        complain(&format!("note: {}: {notice}", path.display()));
    }
    Ok(mesh)
}

/// The mesh of the file at `path`, without its degenerate faces; these are named.
pub(crate) fn specimen(path: &Path) -> Result<Specimen, Failure> {
    Ok(from_file(path)?.0)
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
    if !left_out.is_empty() {
        let faces = counted(left_out.len(), "degenerate face", "degenerate faces");
        complain(&format!("note: {file}: left out {faces}:"));
        for left_out in left_out.iter().take(SHOWN) {
            complain(&format!("note:   {left_out}"));
        }
        if left_out.len() > SHOWN {
            complain(&format!("note:   and {} more", left_out.len() - SHOWN));
        }
    }
    if triangulate {
        specimen = triangulated(specimen)?;
    }
    Ok(specimen)
}

/// The built-in mesh.
pub(crate) fn built_in() -> Specimen {
    Specimen::new("default study (built in)", shapes::default_study())
}

/// The mesh with every polygon cut into a fan.
pub(crate) fn triangulated(specimen: Specimen) -> Result<Specimen, Failure> {
    let before = specimen.polygons.face_count();
    let polygons = specimen.polygons.fan_triangulated();
    let polygons =
        polygons.map_err(|error| Failure::usage(format!("{}: {error}", specimen.name)))?;
    let after = polygons.face_count();
    if after == before {
        return Ok(specimen);
    }
    let cut = counted(before, "face", "faces");
    let triangles = counted(after, "triangle", "triangles");
    let mut changes = specimen.changes;
    changes.push(format!("cut {cut} into {triangles}"));
    // The facts are those of the mesh that is studied; what was left out stays on record.
    let degenerate_faces = specimen.facts.degenerate_faces;
    let facts = Facts {
        degenerate_faces,
        ..Facts::of(&polygons)
    };
    Ok(Specimen {
        name: specimen.name,
        facts,
        polygons,
        changes,
    })
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
