//! What `sixfold orders`, `growth` and `compare` can be asked for.

use std::path::PathBuf;
use std::time::Duration;

use ::study::{GrowthSettings, Operation};
use clap::Args;
use sixfold::shapes::Order;

use super::{MemoryState, backend, duration, operation, seed};

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
    #[command(flatten)]
    pub(crate) memory: MemoryState,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

const COMPARE_EXAMPLES: &str = "Examples:
  sixfold compare before.json after.json
  sixfold compare before.json after.json --fail-if-slower      for CI: exit code 1
  sixfold compare laptop.json server.json --relative

Both are what `sixfold study --json` wrote. A figure is faster or slower if the 95 % interval of the
ratio of the medians leaves 1 out, and the ratio is beyond --noise and beyond what the control of
either study shows for that operation. With fewer than three samples it takes a factor of 2. The
default of --noise is for virtual machines with neighbours, which drift from study to study; a
machine of your own allows less (compare two studies of one program to see).

Exit codes: 0 done; 1 something is slower, with --fail-if-slower; 2 wrong usage, or a file that
is no study, was cut off, or has another schema.";

/// Say what changed between two studies, beyond noise.
///
/// Studies of one mesh on two machines, by two compilers or of two commits: which figures are faster
/// or slower, who wins now, and in what machines and programs differ.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, after_help = COMPARE_EXAMPLES)]
pub(crate) struct Compare {
    /// The first study, as JSON
    #[arg(value_name = "BEFORE.json")]
    pub(crate) before: PathBuf,
    /// The second
    #[arg(value_name = "AFTER.json")]
    pub(crate) after: PathBuf,
    /// Judge each figure by what is left when the median change of all is taken out
    #[arg(long)]
    pub(crate) relative: bool,
    /// Ratios up to this are none, whatever the samples say
    #[arg(long, value_name = "RATIO", default_value_t = ::study::DRIFT, value_parser = noise)]
    pub(crate) noise: f64,
    /// Show all figures, not only those that changed
    #[arg(long)]
    pub(crate) all: bool,
    /// End with exit code 1 if some figure is slower
    #[arg(long)]
    pub(crate) fail_if_slower: bool,
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
    #[command(flatten)]
    pub(crate) memory: MemoryState,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

fn count(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| "a whole number is wanted, such as 100000".into())
}

fn noise(text: &str) -> Result<f64, String> {
    let parsed: Option<f64> = text.trim().parse().ok();
    let fine = parsed.filter(|ratio| (1.0..=100.0).contains(ratio));
    fine.ok_or_else(|| "write a ratio from 1 to 100, as in 1.05".into())
}
