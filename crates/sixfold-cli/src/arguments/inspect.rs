//! Arguments of `sixfold inspect`.

use std::path::PathBuf;

use clap::Args;

use super::ReadFiles;

const EXAMPLES: &str = "Examples:
  sixfold inspect bunny.obj
  sixfold inspect scans part.stl             all meshes in a folder, and one more
  sixfold inspect bunny.obj --json -         machine-readable

For each kind of fault it prints the first elements, the line or byte of a face with this element,
the structures that refuse the mesh for it, and the options of `sixfold repair` that repair it.

Exit codes: 0 success; 2 wrong usage or unusable input; 4 interrupted.";

/// Show facts about meshes, and which data structures can hold them.
///
/// Measures no times. Counts the faces that repeat a vertex or have fewer than three corners.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Inspect {
    /// Meshes, or folders with meshes (- for standard input)
    #[arg(value_name = "MESH|DIR", required = true)]
    pub(crate) meshes: Vec<PathBuf>,
    /// Cut every polygon into triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Write the facts, verdicts and faults as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}
