//! Arguments of `sixfold convert`.

use clap::Args;

use super::{MeshInOut, ReadFiles};

const EXAMPLES: &str = "Examples:
  sixfold convert scan.stl -o scan.ply
  sixfold convert part.obj --format stl-ascii -o - | less

The output has the vertices, the faces and the sharp edges of the input, as far as its format holds
them. Notes name what is left out.

Exit codes: 0 success; 1 the result has no faces; 2 wrong usage or unusable input; 4 interrupted,
nothing written.";

/// Write a mesh in another format.
///
/// The format of the input is recognised by its content. The format of the output is that of the
/// ending of its name.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Convert {
    #[command(flatten)]
    pub(crate) files: MeshInOut,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}
