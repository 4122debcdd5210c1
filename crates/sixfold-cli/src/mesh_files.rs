//! Reads and writes mesh files as the options for all commands say.

use std::io;
use std::path::Path;
use std::sync::OnceLock;

use sixfold::io::{FileMesh, Format, MeshWriter, ReadOptions, Welding, read, read_from};
use sixfold::{Point, PolygonMesh};

use crate::arguments::FileOptions;
use crate::failure::Failure;
use crate::output::{Output, is_stdout};
use crate::text::print_stderr;
use crate::triangulate::triangulated;
use sixfold_study::StudyMesh;
use sixfold_study::numbers::counted;

/// Rounding is reported if it moves a vertex by more than this part of the size of the mesh.
const REPORTED_SHIFT: f64 = 1e-5;

/// The options, which are the same for all files of a run.
static OPTIONS: OnceLock<FileOptions> = OnceLock::new();

/// Sets the options. They must be set before the first file is read or written.
pub(crate) fn set_options(options: FileOptions) {
    OPTIONS.get_or_init(|| options);
}

fn options() -> FileOptions {
    OPTIONS.get().copied().unwrap_or_default()
}

/// Reads a mesh file of any format, or standard input for `-`, and prints a note for each part that
/// is ignored or changed.
pub(crate) fn read_mesh(path: &Path) -> Result<FileMesh, Failure> {
    let mut settings = ReadOptions::default();
    let chosen = options().read;
    if chosen.as_stored {
        settings = settings.with_welding(Welding::Nothing);
    }
    if chosen.recentre {
        settings = settings.recentred();
    }
    let mesh = match is_stdout(path) {
        true => read_from("standard input", io::stdin().lock(), &settings),
        false => read(path, &settings),
    };
    let mesh = mesh.map_err(Failure::usage)?;
    for note in notes(&mesh) {
        print_stderr(&format!("note: {}: {note}", path.display()));
    }
    Ok(mesh)
}

/// Describes what was ignored or changed.
fn notes(mesh: &FileMesh) -> Vec<String> {
    let mut notes: Vec<String> = mesh.notices.iter().map(ToString::to_string).collect();
    if mesh.welded_vertices > 0 {
        let corners = mesh.welded_vertices + mesh.positions.len();
        let corners = counted(corners, "corner", "corners");
        let vertices = counted(mesh.positions.len(), "vertex", "vertices");
        notes.push(format!(
            "joined {corners} at equal positions to {vertices}: --as-stored keeps them apart"
        ));
    }
    let low = mesh
        .positions
        .iter()
        .copied()
        .reduce(Point::min)
        .unwrap_or_default();
    let high = mesh
        .positions
        .iter()
        .copied()
        .reduce(Point::max)
        .unwrap_or_default();
    let size = (high.as_dvec3() - low.as_dvec3()).length();
    let narrowing = mesh.narrowing;
    if narrowing.merged_vertices > 0 || narrowing.largest_shift > REPORTED_SHIFT * size {
        let way_out = match options().read.recentre {
            true => "",
            false => ": --recentre moves the mesh to the origin first",
        };
        notes.push(format!("{narrowing}{way_out}"));
    }
    if mesh.origin != [0.0; 3] {
        let [x, y, z] = mesh.origin.map(|coordinate| 0.0 - coordinate);
        notes.push(format!("moved by {x}, {y}, {z} to the origin"));
    }
    notes
}

/// Cuts the polygons of the mesh in the file at `path`, if the option --triangulate is set.
pub(crate) fn cut_polygons(path: &Path, polygons: PolygonMesh) -> Result<PolygonMesh, Failure> {
    if !options().cut.triangulate || polygons.first_polygon().is_none() {
        return Ok(polygons);
    }
    let study_mesh = StudyMesh::new(path.display().to_string(), polygons);
    triangulated(study_mesh).map(|study_mesh| study_mesh.polygons)
}

/// Writes a mesh to `output`, which was opened at `path`. The format is that of --format, or of the
/// ending of `path`; otherwise it is OBJ. Prints a note for everything that the format cannot keep.
/// `normals` is empty, or has an entry for each vertex.
pub(crate) fn write_mesh(
    output: Output,
    path: &Path,
    polygons: &PolygonMesh,
    normals: &[Option<Point>],
) -> Result<(), Failure> {
    let by_name = || Format::from_path(path).unwrap_or(Format::Obj);
    let format = options().write.format.unwrap_or_else(by_name);
    let mut writer = MeshWriter::new(polygons);
    if !normals.is_empty() {
        writer = writer.with_normals(normals).map_err(Failure::usage)?;
    }
    output.finish(|to| Ok(writer.write(format, to)?))?;
    for loss in writer.losses(format) {
        print_stderr(&format!(
            "note: {}: {loss}, because {format} cannot keep more",
            path.display()
        ));
    }
    Ok(())
}
