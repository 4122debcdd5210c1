//! `--limit`: the result where endless levels would take it.

use std::collections::BTreeMap;
use std::path::Path;

use sixfold::mesh_io::write_obj_with_normals;
use sixfold::subdivision::{LimitPoint, NoLimit, Step, Subdivision};
use sixfold::{FaceVertexMesh, MeshQuery, Point, PolygonMesh, Representation};

use crate::failure::Failure;
use crate::numbers::counted;
use crate::output::Output;
use crate::text::tame;

/// Writes `step` at its limit positions and with its limit normals; yields what there is to say.
pub(super) fn write(
    subdivision: &Subdivision,
    step: &Step,
    levels: u32,
    output: Output,
    path: &Path,
) -> Result<Vec<String>, Failure> {
    // Face-vertex meshes hold everything, and keep the numbers.
    let mesh = FaceVertexMesh::from_polygons(&step.polygons).map_err(Failure::unsupported)?;
    let creases = match levels {
        0 => subdivision.control(&mesh, &step.polygons, &step.creases),
        _ => Ok(step.creases.clone()),
    };
    let creases = creases.map_err(Failure::unsupported)?;
    let limits = subdivision
        .limit(&mesh, &creases)
        .map_err(Failure::unsupported)?;
    let mut positions = Vec::new();
    let mut normals: Vec<Option<Point>> = Vec::new();
    let mut undefined: BTreeMap<&str, usize> = BTreeMap::new();
    for v in mesh.vertices() {
        let limit = limits[v];
        positions.push(limit.position().unwrap_or_else(|| mesh.position(v)));
        normals.push(limit.normal());
        if let LimitPoint::Undefined(reason) = limit {
            *undefined.entry(because(reason)).or_default() += 1;
        }
    }
    let faces = step.polygons.faces().clone();
    let moved = PolygonMesh::from_faces(positions, faces).map_err(Failure::usage)?;
    output.finish(|writer| write_obj_with_normals(&moved, &normals, writer))?;
    let place = tame(&path.display().to_string());
    let with = normals.iter().flatten().count();
    let normals = counted(with, "normal", "normals");
    let mut lines = vec![format!("{place}: limit positions, {normals}")];
    for (because, number) in undefined {
        let vertices = counted(number, "vertex stays", "vertices stay");
        lines.push(format!("{place}: {vertices}, {because}"));
    }
    Ok(lines)
}

fn because(reason: NoLimit) -> &'static str {
    match reason {
        NoLimit::SemiSharp => "sharp for some levels yet: take more levels",
        NoLimit::NotAllQuads => "beside a face that is no quad: take one level more",
        NoLimit::Dart => "where a crease ends: the rules have no limit for a dart",
        _ => "for which the rules have no limit",
    }
}
