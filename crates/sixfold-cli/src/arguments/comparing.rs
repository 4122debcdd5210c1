//! What `sixfold orders` and `growth` can be asked for.

use std::path::PathBuf;
use std::time::Duration;

use ::study::{GrowthSettings, Operation};
use clap::Args;
use sixfold::shapes::Order;

use super::{backend, duration, operation, seed};

/// What help on `orders` says before the names.
pub(crate) const ORDERS_EXAMPLES: &str = "Examples:
  sixfold orders                             the built-in mesh
  sixfold orders bunny.obj
  sixfold orders bunny.obj --operations vertex_vertices --backends half-edge,corner-table
  sixfold orders bunny.obj --budget 2m --json orders.json

Orders: given, as the file has it; shuffled, vertices and faces at random; morton, along a curve
that fills space; breadth-first, as a walk over the faces meets them. All pairs of a backend and
an order are measured in one interleaved run, as `study` does; each backend in its four orders
is compared with itself, and then the backends in their best orders with each other. One backend
in the order given is entered twice: what its two columns differ by is the noise.

Exit codes: 0 done; 1 backends or orders found different results, a fault in Sixfold; 2 wrong
usage or unusable input; 3 no backend asked for can hold the mesh, or too little memory; 4
interrupted, finished part kept.";

/// Measure what the order of a mesh in memory costs each backend.
///
/// The same mesh as given, shuffled, along a space-filling curve and as a walk meets it: which order
/// is best, how much that matters, and whether it matters more than the backend does.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Orders {
    /// The mesh, an OBJ file; without it a built-in mesh of about 20,000 triangles
    #[arg(value_name = "MESH.obj")]
    pub(crate) mesh: Option<PathBuf>,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// These operations, by name, instead of a few that show most
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = operation)]
    pub(crate) operations: Vec<Operation>,
    /// How long to measure: 20s, 500ms, 2m
    #[arg(long, value_name = "TIME", default_value = "25s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) budget: Duration,
    /// What decides the order `shuffled`, and what is sampled
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// What help on `growth` says before the names.
pub(crate) const GROWTH_EXAMPLES: &str = "Examples:
  sixfold growth
  sixfold growth --backends half-edge,face-vertex --operations vertex_normal
  sixfold growth --shape blobs --order shuffled --to 4000000 --budget 5m
  sixfold growth --shape grid --from 500 --to 50000 --steps 5 --json growth.json

At each size all backends are measured in interleaved rounds, as `study` does. The power is the
slope of a straight line through the logarithms of faces and time, with its standard error: 1 is
a price for each element that does not depend on the size, 2 is a look at all faces for each.
Sizes that fit into the last cache and those beyond have lines of their own. What looks at all
faces is sampled.

Exit codes: 0 done; 1 backends found different results, a fault in Sixfold; 2 wrong usage; 3 no
backend asked for can hold the shape, or too little memory; 4 interrupted, finished sizes kept.";

/// Measure how the cost of each backend grows with the mesh.
///
/// One shape in sizes that grow by a factor: nanoseconds for each element, the power by which time
/// goes with the number of faces, and where each cache of this machine ends.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Growth {
    /// The shape: see the list below
    #[arg(long, value_name = "SHAPE", default_value_t = GrowthSettings::default().shape)]
    pub(crate) shape: String,
    /// About how many faces the smallest has
    #[arg(long, value_name = "N", default_value_t = GrowthSettings::default().from, value_parser = count, allow_hyphen_values = true)]
    pub(crate) from: usize,
    /// About how many faces the largest has
    #[arg(long, value_name = "N", default_value_t = GrowthSettings::default().to, value_parser = count, allow_hyphen_values = true)]
    pub(crate) to: usize,
    /// How many sizes
    #[arg(long, value_name = "N", default_value_t = GrowthSettings::default().steps, value_parser = count, allow_hyphen_values = true)]
    pub(crate) steps: usize,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// These operations, by name, instead of a few that show most
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = operation)]
    pub(crate) operations: Vec<Operation>,
    /// given, shuffled, morton or breadth-first
    #[arg(long, value_name = "ORDER", default_value = "given")]
    pub(crate) order: Order,
    /// How long all of it may take: 60s, 500ms, 2m
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) budget: Duration,
    /// What decides the order `shuffled`, and what is sampled
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

fn count(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| "a whole number is wanted, such as 100000".into())
}
