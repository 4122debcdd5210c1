//! Arguments of `sixfold distance`.

use std::path::PathBuf;

use clap::Args;

use super::{ReadPolygons, seed};

const EXAMPLES: &str = "Examples:
  sixfold distance scan.obj small.obj
  sixfold distance scan.obj small.obj --samples 1000000 --json -

Each surface is sampled evenly by area; the closest point of the other surface is exact. `mean` and
`root mean square` are estimates for the whole surface. `largest` also looks at all vertices; it is
a lower bound of the Hausdorff distance. Polygons are cut into triangles first.

Exit codes: 0 success; 2 wrong usage or unusable input; 4 interrupted.";

/// Measure the distance between the surfaces of two meshes.
///
/// Measures from the first mesh to the second, and back.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Distance {
    /// The first mesh (- for standard input)
    #[arg(value_name = "FIRST")]
    pub(crate) first: PathBuf,
    /// The second mesh
    #[arg(value_name = "SECOND")]
    pub(crate) second: PathBuf,
    /// Number of sample points on each surface
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = samples, allow_hyphen_values = true)]
    pub(crate) samples: usize,
    /// Seed of the sample points
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Write the distances as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadPolygons,
}

fn samples(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse::<u32>();
    let samples = parsed.ok().filter(|&samples| samples > 0);
    samples
        .map(|samples| samples as usize)
        .ok_or_else(|| format!("the number of samples must be from 1 to {}", u32::MAX))
}
