//! What `sixfold why` can be asked for.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use sixfold::Relation;

use super::subdivision::named;
use super::{backend, duration};

const WHY_EXAMPLES: &str = "Examples:
  sixfold why --counts-only                                what the built-in mesh reads: no clock
  sixfold why bunny.obj --relations vertex_faces           counts, times, and a sentence for each
  sixfold why bunny.obj --backends half-edge,face-vertex --budget 1m --json why.json

Counts are exact, free of noise, and the same on every machine: each table is taken to begin at a
line of 64 bytes, and every row that a query reads is noted. Where a query looks at all faces, or
reads more than 256 rows on average, 16 elements, evenly spaced, stand for all, with a ~. Times are
those of `sixfold study`. How fast this machine reads is measured first, in buffers of growing size:
each structure is held to the largest that is no larger than what its sweep touches. Named relations
are told in sentences as well.

Relations: vertex_vertices, vertex_edges, vertex_faces, edge_vertices, edge_edges, edge_faces,
           face_vertices, face_edges, face_faces

Exit codes: 0 done; 1 backends found different results, a fault in Sixfold; 2 wrong usage or
unusable input; 3 no backend asked for can hold the mesh; 4 interrupted, finished part kept.";

/// Say what queries read, and whether that is what they take their time for.
///
/// For each relation and backend: the rows, cache lines and bytes that a query reads; what a sweep
/// over all elements has to move; and beside it the time, and what bounds it.
#[derive(Debug, Args)]
#[command(after_help = WHY_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Why {
    /// The mesh, an OBJ file; without it a built-in mesh of about 20,000 triangles
    #[arg(value_name = "FILE.obj")]
    pub(crate) mesh: Option<PathBuf>,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// Only these relations, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = relation)]
    pub(crate) relations: Vec<Relation>,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Count what is read, and measure nothing
    #[arg(long)]
    pub(crate) counts_only: bool,
    /// How long to measure: 20s, 500ms, 2m
    #[arg(long, value_name = "TIME", default_value = "20s", value_parser = duration, allow_hyphen_values = true, conflicts_with = "counts_only")]
    pub(crate) budget: Duration,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

fn relation(text: &str) -> Result<Relation, String> {
    named(&Relation::ALL, Relation::name, text)
}
