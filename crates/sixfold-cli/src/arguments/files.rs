//! Options of mesh files, for the commands that read or write meshes.

use clap::Args;
use sixfold::io::Format;

// The comments of these structs are not doc comments, because clap would print them as the help of
// each command.

// How meshes are read.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Mesh files")]
pub(crate) struct ReadFiles {
    /// Do not merge vertices of STL files: each facet has three vertices of its own
    #[arg(long)]
    pub(crate) as_stored: bool,
    /// Move meshes to the origin before coordinates are rounded to 32 bits
    #[arg(long)]
    pub(crate) recentre: bool,
}

// How meshes are read by commands that can cut polygons first.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Mesh files")]
pub(crate) struct ReadPolygons {
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    #[command(flatten)]
    pub(crate) files: ReadFiles,
}

// How meshes are written.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Mesh files")]
pub(crate) struct WriteFiles {
    /// Format of written meshes: obj, stl, stl-ascii, ply, ply-ascii, off, gltf, glb
    /// [default: from the file name, or obj]
    #[arg(long, value_name = "NAME", verbatim_doc_comment)]
    pub(crate) format: Option<Format>,
}
