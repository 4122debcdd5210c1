//! Arguments of `sixfold neighbours`.

use std::path::PathBuf;

use clap::Args;
use sixfold::UnknownName;
use sixfold_results::QueryPoints;
use sixfold_study::neighbour_indices;

use super::{EffortArgs, LaunchArgs, ReadFiles, ResultFiles, seed};

const EXAMPLES: &str = "Examples:
  sixfold neighbours                             the built-in mesh
  sixfold neighbours scan.ply
  sixfold neighbours scan.ply --points box --budget 30s
  sixfold neighbours scan.ply --indices kd-tree,bvh --json neighbours.json

Indices: list (no index: each query visits all elements), grid (equal cubes), octree, kd-tree, and
bvh (bounding volume hierarchy). Each index is built twice: on the vertices, and on the triangles.

Tasks:
  build_vertices    build the index of the vertices
  nearest_vertex    the nearest vertex of a point
  vertices_within   all vertices within a radius: twice the mean length of an edge
  nearest_eight     the eight nearest vertices of a point
  build_triangles   build the index of the triangles
  closest_point     the point of the surface that is closest to a point
  first_hit         where a ray first hits the surface

All indices must give the same answers. Up to 10,000 points are searched for. On a large mesh, the
list answers only some of the queries, and its time is scaled; so does an index whose queries would
take longer than --budget allows.

Exit codes: 0 success; 1 the answers of two indices differ (a fault in Sixfold); 2 wrong usage or
unusable input; 4 interrupted, finished results are kept.";

/// Measure searches for neighbours in space with five spatial indices.
///
/// Shows the time of each kind of query, and which index takes the least time for a number of
/// queries, building included.
#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    verbatim_doc_comment,
    mut_arg("budget", |arg| arg.default_value("10s"))
)]
pub(crate) struct Neighbours {
    /// The mesh (- for standard input); without it, a built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// Measure only these indices, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = index)]
    pub(crate) indices: Vec<String>,
    /// Query points: near (the surface), or box (anywhere in the bounding box)
    #[arg(long, value_name = "WHERE", default_value = "near")]
    pub(crate) points: QueryPoints,
    #[command(flatten)]
    pub(crate) effort: EffortArgs,
    #[command(flatten)]
    pub(crate) launching: LaunchArgs,
    /// Seed of the query points and of the order of measurements
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

fn index(name: &str) -> Result<String, UnknownName> {
    let given = name.to_owned();
    UnknownName::check("index", std::slice::from_ref(&given), neighbour_indices())?;
    Ok(given)
}
