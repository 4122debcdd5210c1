//! What `sixfold memory` can be asked for.

use std::path::PathBuf;

use clap::Args;

use super::backend;

const EXAMPLES: &str = "Examples:
  sixfold memory
  sixfold memory bunny.obj --backends half-edge,corner-table
  sixfold memory quads.obj --triangulate --json -

Three ways to one number. formula: what the layout takes, by the sizes of the mesh alone. tables:
what the tables of the structure hold, room to spare included. counted: the bytes that the program's
allocator has handed out after building, less those before. They must be equal, to the byte. The
peak is the most that building takes at once; the polygons it builds from are not in it. What an
allocator adds to each block, and the structure's own few dozen bytes outside the heap, are in none.

A word is 4 bytes, an index or a coordinate. The literature counts words for each vertex of a large
closed mesh of triangles, with 2 faces and 3 edges a vertex: 18 for a polygon soup, 9 for an indexed
face set, 16 for face-vertex (here 17: each list of faces has its length beside its start, so that
it can grow), 30 for winged-edge, 24 for half-edge without links back, 16 for a corner table.

Exit codes: 0 done; 1 the three differ, a fault in Sixfold; 2 wrong usage or unusable input;
3 no backend asked for can hold the mesh; 4 interrupted.";

/// Say what each backend takes in memory, counted in three ways that must agree.
///
/// Builds one backend after the other and measures no times.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Memory {
    /// The mesh, an OBJ file; without it a built-in mesh of about 20,000 triangles
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
