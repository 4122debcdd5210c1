//! Arguments of `sixfold memory`.

use std::path::PathBuf;

use clap::Args;

use super::{ReadFiles, ResultFiles, backend};

const EXAMPLES: &str = "Examples:
  sixfold memory
  sixfold memory bunny.obj --backends half-edge,corner-table
  sixfold memory quads.obj --triangulate --json -

The same bytes are counted in three ways. The three counts must agree to the byte:
  formula   computed from the numbers of elements of the mesh and the layout of the tables
  tables    the size of the tables, including spare capacity
  counted   the allocated bytes after building, minus the allocated bytes before building
The peak is the maximum of the allocated bytes during building. The peak does not include the
polygons from which the structure is built. All figures leave out the overhead of the allocator for
each block, and the few dozen bytes of the structure that are not on the heap.

A word is 4 bytes: an index or a coordinate. The literature counts words per vertex of a large
closed triangle mesh, with 2 faces and 3 edges per vertex: polygon-soup 18, indexed-face-set 9,
face-vertex 16, winged-edge 30, half-edge without prev links 24, corner-table 16. In Sixfold,
face-vertex has 17 words: each list of faces also stores its length, so that the list can grow.

Exit codes: 0 success; 1 the three counts differ (a fault in Sixfold); 2 wrong usage or unusable
input; 3 none of the selected backends can hold the mesh; 4 interrupted.";

/// Count the memory of each data structure in three ways that must agree.
///
/// Builds one data structure after the other. This command measures no times.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Memory {
    /// The mesh (- for standard input); without it, a built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// Use only these data structures (backends), by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}
