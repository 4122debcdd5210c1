//! Options of mesh files, for the commands that read or write meshes.

use std::path::PathBuf;

use clap::Args;
use sixfold::io::{Format, Scene};

// The comments of these structs are not doc comments, because clap would print them as the help of
// each command.

// How meshes are read.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Mesh files")]
pub(crate) struct ReadFiles {
    /// Do not merge vertices at equal positions: neither those of STL files nor those at seams
    #[arg(long)]
    pub(crate) as_stored: bool,
    /// Move meshes to the origin before coordinates are rounded to 32 bits, and written meshes back
    #[arg(long)]
    pub(crate) recentre: bool,
    /// Scene of glTF files to read: its number, or all for every node and mesh
    /// [default: the default scene of the file]
    #[arg(long, value_name = "N|all", value_parser = scene, verbatim_doc_comment)]
    pub(crate) scene: Option<Scene>,
}

impl ReadFiles {
    /// Returns the options that were given, as they are written on the command line.
    pub(crate) fn given(self) -> Vec<String> {
        let scene = match self.scene {
            Some(Scene::Number(number)) => Some(format!("--scene {number}")),
            Some(Scene::All) => Some("--scene all".to_owned()),
            _ => None,
        };
        let as_stored = self.as_stored.then(|| "--as-stored".to_owned());
        let recentre = self.recentre.then(|| "--recentre".to_owned());
        [as_stored, recentre, scene].into_iter().flatten().collect()
    }
}

impl From<ReadFiles> for sixfold_measure::command::mesh_files::ReadFiles {
    fn from(given: ReadFiles) -> Self {
        Self {
            as_stored: given.as_stored,
            recentre: given.recentre,
            scene: given.scene,
        }
    }
}

use sixfold_measure::command::arguments::scene;

// How meshes are read by commands that can cut polygons first.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Mesh files")]
pub(crate) struct ReadPolygons {
    /// Cut every polygon into triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    #[command(flatten)]
    pub(crate) files: ReadFiles,
}

// The mesh to read and the file to write.
#[derive(Clone, Debug, Args)]
pub(crate) struct MeshInOut {
    /// The mesh (- for standard input)
    #[arg(value_name = "MESH")]
    pub(crate) mesh: PathBuf,
    /// The file to write (- for standard output)
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) write: WriteFiles,
}

// Whether a change of the shape is an error.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct ShapeCheck {
    /// Exit code 1 if the area, the volume or the box changes by more than 5 %, or if faces are
    /// turned over or flat
    #[arg(long, verbatim_doc_comment)]
    pub(crate) check: bool,
}

// How meshes are written. The heading is that of one option: a heading for the next options would
// also be that of the options after a [`MeshInOut`].
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct WriteFiles {
    /// Format of written meshes: obj, stl, stl-ascii, ply, ply-ascii, off, gltf, glb
    /// [default: from the file name, or obj]
    #[arg(
        long,
        value_name = "NAME",
        verbatim_doc_comment,
        help_heading = "Mesh files"
    )]
    pub(crate) format: Option<Format>,
}
