//! Reads mesh files.

use std::io;
use std::path::Path;

use sixfold::Point;
use sixfold::io::{
    FileMesh, Format, IgnoredKind, ReadOptions, Scene, Welding, read_from, read_with,
};
use sixfold_results::numbers::counted;

use crate::command::failure::Failure;
use crate::command::output::is_stdout;
use crate::command::text::print_notice;

/// How meshes are read.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadFiles {
    /// Vertices at equal positions are not merged.
    pub as_stored: bool,
    /// Meshes are moved to the origin before coordinates are rounded to 32 bits.
    pub recentre: bool,
    /// The scene of glTF files; `None` for the default scene.
    pub scene: Option<Scene>,
}

/// Rounding is reported if it moves a vertex by more than this part of the size of the mesh. If the
/// origin is inside the mesh or near it, rounding moves a vertex by at most 0.6e-7 of the size. So a
/// larger part means that the mesh is far from the origin.
const REPORTED_SHIFT: f64 = 1e-7;

/// Reads a mesh file of any format, or standard input for `-`, and prints a note for each part that
/// is ignored or changed.
pub fn read_mesh(path: &Path, chosen: ReadFiles) -> Result<FileMesh, Failure> {
    read_mesh_at(path, chosen, None)
}

/// Reads a mesh like [`read_mesh`]. The option --recentre moves the mesh so that `origin` is the
/// origin; if `origin` is `None`, the centre of the mesh.
pub fn read_mesh_at(
    path: &Path,
    chosen: ReadFiles,
    origin: Option<[f64; 3]>,
) -> Result<FileMesh, Failure> {
    let mut settings = ReadOptions::default();
    if chosen.as_stored {
        settings = settings.with_welding(Welding::Nothing);
    }
    if chosen.recentre {
        settings = match origin {
            Some(origin) => settings.with_origin(origin),
            None => settings.recentred(),
        };
    }
    settings = settings.with_scene(chosen.scene.unwrap_or_default());
    let name = shown(path);
    let mesh = match is_stdout(path) {
        true => read_from(&name, io::stdin().lock(), &settings),
        false => read_with(path, &settings),
    };
    let mesh = mesh.map_err(Failure::usage)?;
    let is_gltf = matches!(mesh.format, Format::Gltf | Format::Glb);
    if let (Some(Scene::Number(number)), false) = (chosen.scene, is_gltf) {
        return Err(Failure::usage(format!(
            "{name}: there is no scene {number}: only glTF has scenes; leave out --scene"
        )));
    }
    for note in notes(&mesh, chosen) {
        print_notice(&format!("note: {name}: {note}"));
    }
    Ok(mesh)
}

/// Returns the name of a file to read, for messages: `standard input` for `-`.
pub fn shown(path: &Path) -> String {
    match is_stdout(path) {
        true => "standard input".to_owned(),
        false => match path.to_str() {
            Some(path) => path.to_owned(),
            None => format!("{path:?}").trim_matches('"').to_owned(),
        },
    }
}

/// Describes what was ignored or changed.
fn notes(mesh: &FileMesh, chosen: ReadFiles) -> Vec<String> {
    let notices = mesh.notices.iter().map(|notice| match notice.kind {
        IgnoredKind::UnusedMeshes | IgnoredKind::UnusedNodes => {
            format!("{notice}: --scene all reads them")
        }
        _ => notice.to_string(),
    });
    let mut notes: Vec<String> = notices.collect();
    if mesh.welded_vertices > 0 {
        let corners = mesh.welded_vertices + mesh.positions.len();
        let corners = counted(corners, "corner", "corners");
        let vertices = counted(mesh.positions.len(), "vertex", "vertices");
        notes.push(format!(
            "joined {corners} at equal positions to {vertices}: --as-stored keeps them apart"
        ));
    }
    notes.extend(rounding_note(mesh, chosen));
    if mesh.origin != [0.0; 3] {
        let [x, y, z] = mesh.origin.map(|coordinate| 0.0 - coordinate);
        notes.push(format!(
            "moved by {x}, {y}, {z} to the origin; a written mesh is moved back"
        ));
    }
    notes
}

/// Describes what rounding to 32 bits did, if it merged vertices or if the mesh is far from the
/// origin.
fn rounding_note(mesh: &FileMesh, chosen: ReadFiles) -> Option<String> {
    let narrowing = mesh.narrowing;
    let positions = || mesh.positions.iter().copied();
    let low = positions().reduce(Point::min).unwrap_or_default();
    let high = positions().reduce(Point::max).unwrap_or_default();
    let size = (high.as_dvec3() - low.as_dvec3()).length();
    if narrowing.merged_vertices == 0 && narrowing.largest_shift <= REPORTED_SHIFT * size {
        return None;
    }
    let part = match size > 0.0 {
        true => format!(
            " ({:.0e} of the size of the mesh)",
            narrowing.largest_shift / size
        ),
        false => String::new(),
    };
    // Moving helps where coordinates are large beside the mesh, and not where they are tiny.
    let far = low
        .as_dvec3()
        .abs()
        .max(high.as_dvec3().abs())
        .max_element();
    let way_out = match chosen.recentre || far <= size {
        true => "",
        false => ": --recentre moves the mesh to the origin first",
    };
    Some(format!("{narrowing}{part}{way_out}"))
}
