//! Arguments of `sixfold new`.

use std::path::PathBuf;

use clap::Args;

const NEW_EXAMPLES: &str = "Examples:
  sixfold new my-program
  sixfold new my-program --checkout ~/sixfold
  sixfold new my-collapses --edits
  cd my-program && cargo run --release -- mesh.obj --budget 20s

Exit codes: 0 success; 2 wrong usage, or DIR exists and is not empty.";

/// Write a package that measures your own program on every data structure.
///
/// The package has a program to replace by your own, a test, and a README. It builds and runs as it
/// is.
#[derive(Debug, Args)]
#[command(after_help = NEW_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct New {
    /// The folder of the package; its last part is the name
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// The repository of Sixfold [default: the current folder, one above it, or `sixfold` in one of them]
    #[arg(long, value_name = "DIR")]
    pub(crate) checkout: Option<PathBuf>,
    /// Write a program that edits the mesh
    #[arg(long)]
    pub(crate) edits: bool,
}
