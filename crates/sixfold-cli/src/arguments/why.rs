//! Arguments of `sixfold why`.

use std::path::PathBuf;

use clap::Args;
use sixfold::Relation;

use super::{EffortArgs, LaunchArgs, ReadFiles, ResultFiles, backend, relation};

const WHY_EXAMPLES: &str = "Examples:
  sixfold why --counts-only                                counts on the built-in mesh, no times
  sixfold why bunny.obj --relations vertex_faces           counts and times, and the reads of each table
  sixfold why bunny.obj --backends half-edge,face-vertex --budget 1m --json why.json

Counts are exact and the same on every machine. Every table row that a query reads is counted. The
counts assume that each table begins at the start of a cache line of 64 bytes. If the queries of a
relation scan all faces, or read more than 256 table rows per query on average, only 16 evenly
spaced elements are queried. In the output, the sign ~ marks counts from only 16 elements.

Times are measured as in `sixfold study`, in several launches (fresh processes); the counts are the
same in each launch. A sweep queries all elements once, in order. Each launch first measures the
speed of memory, in buffers of growing size; the medians over the launches are shown. The time of a sweep is compared with the speed
of the largest buffer that is not larger than the memory that the sweep touches. With --relations,
the command also shows the reads of each table.

Relations: vertex_vertices, vertex_edges, vertex_faces, edge_vertices, edge_edges, edge_faces,
face_vertices, face_edges, face_faces.

Exit codes: 0 success; 1 results differ between backends (a fault in Sixfold), or a launch died;
2 wrong usage or unusable input; 3 none of the selected backends can hold the mesh; 4 interrupted,
finished results are kept.";

/// Explain the time of queries by the memory that the queries read.
///
/// Shows for each relation and backend how many table rows, cache lines and bytes a query reads.
/// Shows how many bytes a pass over all elements moves from memory. Shows the measured time of each
/// relation, and the factor that limits the speed.
#[derive(Debug, Args)]
#[command(
    after_help = WHY_EXAMPLES,
    verbatim_doc_comment,
    mut_arg("launches", |arg| arg.help("Measure in N fresh processes [default: by the budget, 3 for 20s]")),
)]
pub(crate) struct Why {
    /// The mesh (- for standard input); without it, a built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// Use only these data structures (backends), by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// Query only these relations, by name (also VV, VE and so on)
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = relation)]
    pub(crate) relations: Vec<Relation>,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Count the reads only, and measure no times
    #[arg(long, conflicts_with_all = ["budget", "rounds", "launches", "confidence"])]
    pub(crate) counts_only: bool,
    #[command(flatten)]
    pub(crate) effort: EffortArgs,
    #[command(flatten)]
    pub(crate) launching: LaunchArgs,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}
