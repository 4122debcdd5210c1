//! Options of mesh files, for all commands that read or write meshes.

use clap::{Arg, ArgMatches, Args};
use sixfold::io::Format;

// How meshes are read. Not a doc comment, because clap would print it as the help of each command.
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

// How polygons are read, for commands without an option of this name.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Mesh files")]
pub(crate) struct CutPolygons {
    /// Cut every polygon into a fan of triangles first
    #[arg(id = "cut_polygons", long = "triangulate")]
    pub(crate) triangulate: bool,
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

/// Adds the options of mesh files to a subcommand that reads or writes meshes: the names and value
/// names of its arguments show whether it does.
pub(crate) fn with_file_options(mut command: clap::Command) -> clap::Command {
    let is_mesh =
        |argument: &Arg| ["mesh", "meshes", "first"].contains(&argument.get_id().as_str());
    let is_written = |argument: &Arg| {
        let names = argument.get_value_names().unwrap_or_default();
        names.iter().any(|name| name == "OUT")
    };
    let reads = command.get_arguments().any(is_mesh);
    let has_own = command
        .get_arguments()
        .any(|argument| argument.get_id() == "triangulate");
    let triangulates = command.get_name() == "triangulate";
    if command.get_arguments().any(is_written) {
        command = WriteFiles::augment_args(command);
    }
    if reads && !has_own && !triangulates {
        command = CutPolygons::augment_args(command);
    }
    match reads {
        true => ReadFiles::augment_args(command),
        false => command,
    }
}

/// The options of mesh files of a subcommand.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FileOptions {
    pub(crate) read: ReadFiles,
    pub(crate) write: WriteFiles,
    pub(crate) cut: CutPolygons,
}

/// Returns the options of mesh files of a subcommand; the defaults if it does not have them.
pub(crate) fn file_options(matches: &ArgMatches) -> FileOptions {
    let mut options = FileOptions::default();
    if let Some((_, matches)) = matches.subcommand() {
        let is_set = |name| matches.try_get_one(name).ok().flatten() == Some(&true);
        options.read.as_stored = is_set("as_stored");
        options.read.recentre = is_set("recentre");
        options.write.format = matches.try_get_one("format").ok().flatten().copied();
        options.cut.triangulate = is_set("cut_polygons");
    }
    options
}
