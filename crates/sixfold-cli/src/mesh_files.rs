//! Reads and writes mesh files.

use std::path::Path;

use sixfold::io::{FileMesh, Format, Loss, WriteOptions, write_to};
use sixfold::{FaceId, PolygonMesh};

use crate::arguments::{ReadFiles, WriteFiles};
use crate::failure::Failure;
use crate::output::Output;
use crate::text::print_notice;
use crate::triangulate::print_crossing;
use sixfold_measure::command::mesh_files as files;
pub(crate) use sixfold_measure::command::mesh_files::shown;

/// Reads a mesh file of any format, or standard input for `-`, and prints a note for each part that
/// is ignored or changed.
pub(crate) fn read_mesh(path: &Path, chosen: ReadFiles) -> Result<FileMesh, Failure> {
    files::read_mesh(path, chosen.into())
}

/// Reads a mesh like [`read_mesh`]. The option --recentre moves the mesh so that `origin` is the
/// origin; if `origin` is `None`, the centre of the mesh.
pub(crate) fn read_mesh_at(
    path: &Path,
    chosen: ReadFiles,
    origin: Option<[f64; 3]>,
) -> Result<FileMesh, Failure> {
    files::read_mesh_at(path, chosen.into(), origin)
}

/// A mesh file that is open for writing.
pub(crate) struct MeshOutput {
    output: Output,
    name: String,
    /// The format of --format, or of the ending of the name; otherwise OBJ.
    pub(crate) format: Format,
    /// The place of the origin in the file.
    origin: [f64; 3],
}

impl MeshOutput {
    /// Opens a mesh file. The mesh is written with its origin at `origin`. An ending that is not that of
    /// a format is an error, unless --format chooses the format.
    pub(crate) fn open(path: &Path, chosen: WriteFiles, origin: [f64; 3]) -> Result<Self, Failure> {
        let format = chosen.format.or_else(|| Format::from_path(path));
        if let (None, Some(ending)) = (format, path.extension()) {
            let endings = Format::EXTENSIONS.map(|ending| format!(".{ending}"));
            return Err(Failure::usage(format!(
                "{}: .{} is not the ending of a format that can be written: use one of {}, or \
                 choose the format with --format",
                path.display(),
                ending.display(),
                endings.join(", ")
            )));
        }
        Ok(Self {
            output: Output::open(path)?,
            name: path.display().to_string(),
            format: format.unwrap_or(Format::Obj),
            origin,
        })
    }

    /// Writes a mesh with the data in `options`. Prints a note for everything that the format cannot
    /// keep, and returns it. Also prints which faces cross themselves.
    pub(crate) fn write(
        self,
        polygons: &PolygonMesh,
        options: &WriteOptions<'_>,
    ) -> Result<Vec<Loss>, Failure> {
        self.write_placed(polygons, options, |face| format!("face {face}"))
    }

    /// Writes a mesh like [`write`](Self::write). `place` describes where a face is, for messages.
    pub(crate) fn write_placed(
        self,
        polygons: &PolygonMesh,
        options: &WriteOptions<'_>,
        place: impl Fn(FaceId) -> String,
    ) -> Result<Vec<Loss>, Failure> {
        let Self {
            output,
            name,
            format,
            origin,
        } = self;
        let options = &options.with_origin(origin);
        let mut losses = Vec::new();
        output.finish(|to| {
            losses = write_to(polygons, format, options, to)?;
            Ok(())
        })?;
        print_crossing(&name, &polygons.crossing_faces(), place);
        for loss in &losses {
            let notice = match loss {
                Loss::CrossingPolygons { .. } => continue, // these have just been printed
                Loss::Precision { .. } => format!(
                    "warning: {name}: {loss}, because {format} has 32 bits: PLY, OBJ, OFF, glTF and \
                     ASCII STL keep the positions at their place"
                ),
                _ => format!("note: {name}: {loss}, because {format} cannot keep more"),
            };
            print_notice(&notice);
        }
        Ok(losses)
    }
}
