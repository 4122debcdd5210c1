//! Arguments of `sixfold memory`.

use std::path::PathBuf;

use clap::Args;

use super::backend;

const EXAMPLES: &str = "Examples:
  sixfold memory
  sixfold memory bunny.obj --backends half-edge,corner-table
  sixfold memory quads.obj --triangulate --json -

The same bytes are counted in three ways, which must agree to the byte. formula: computed from the
counts of the mesh and the layout. tables: the size of the tables, including spare capacity.
counted: bytes allocated after building, minus bytes allocated before. The peak is the maximum while
building, without the polygons from which the structure is built. The figures do not include the
overhead of the allocator for each block, or the few dozen bytes of the structure outside the heap.

A word is 4 bytes: an index or a coordinate. The literature counts words per vertex of a large
closed triangle mesh, with 2 faces and 3 edges per vertex: 18 for a polygon soup, 9 for an indexed
face set, 16 for face-vertex (here 17: each list of faces stores its length beside its start, so
that it can grow), 30 for winged-edge, 24 for half-edge without prev links, 16 for a corner table.

Exit codes: 0 success; 1 the three counts differ (a fault in Sixfold); 2 wrong usage or unusable
input; 3 none of the selected backends can hold the mesh; 4 interrupted.";

/// Show the memory of each backend, counted in three ways that must agree.
///
/// Builds one backend after the other and measures no times.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Memory {
    /// The mesh, an OBJ file; without it, a built-in mesh of 20,000 triangles
    #[arg(value_name = "FILE.obj")]
    pub(crate) mesh: Option<PathBuf>,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}
