//! Arguments of the commands that answer for a workload.

use std::path::PathBuf;
use std::time::Duration;

use ::study::{Need, Policy};
use clap::Args;

use super::{backend, duration, seed};

const PICK_EXAMPLES: &str = "Examples:
  sixfold pick bunny.obj
  sixfold pick --workload geodesic-dijkstra --max-memory 2GiB bunny.obj
  sixfold pick --workload mine.toml --needs edit,non-manifold scans/*.obj --json -
  sixfold workloads --show smoothing > mine.toml

It runs the mix of the workload itself on every backend that qualifies, in its order of elements, in
interleaved rounds; no single timings are added up. Where the mix only asks, flat tables of just the
relations that it asks are one more candidate. Building is not in the ranking; the break-even table
says from when on it pays, if an indexed face set is there already. Over several meshes backends are
compared by geometric means.

Needs: edit, non-manifold, polygons, mixed-orientation, isolated-vertices, coincident-vertices,
refine.

Exit codes: 0 done; 1 no backend qualifies, or backends found different results, a fault in Sixfold;
2 wrong usage, unusable input, or a budget too small to measure anything; 4 interrupted, finished
part kept.";

const WORKLOADS_EXAMPLES: &str = "Examples:
  sixfold workloads
  sixfold workloads --show smoothing > mine.toml     a file to change
  sixfold workloads --operations                     what a mix may have

Exit codes: 0 done; 2 wrong usage.";

/// Say which backend fits a mesh and a workload.
///
/// Ranks the backends by running the workload on each, and says why, how sure it is, what each holds
/// in memory, and from how many operations on it pays for being built.
#[derive(Debug, Args)]
#[command(after_help = PICK_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Pick {
    /// The meshes, OBJ files; without any a built-in mesh of about 20,000 triangles
    #[arg(value_name = "FILE.obj")]
    pub(crate) meshes: Vec<PathBuf>,
    /// A built-in workload, or a file of one's own
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "smoothing")]
    pub(crate) workload: String,
    /// How much memory the structure may hold: 2GiB, 500MB, 1000000
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) max_memory: Option<u64>,
    /// What it has to be able to do or to hold: see below
    #[arg(long, value_name = "NEED,…", value_delimiter = ',', value_parser = need)]
    pub(crate) needs: Vec<Need>,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// How long to measure, in all: 20s, 500ms, 2m
    #[arg(long, value_name = "TIME", default_value = "20s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) budget: Duration,
    /// What decides random orders
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Freed pages: kept by this process, or system
    #[arg(long, value_name = "POLICY", default_value = "kept")]
    pub(crate) heap: Policy,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Write the answer as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// List the built-in workloads, and who does this.
#[derive(Debug, Args)]
#[command(after_help = WORKLOADS_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Workloads {
    /// Print the file of one of them, to be changed
    #[arg(long, value_name = "NAME", conflicts_with_all = ["operations", "json"])]
    pub(crate) show: Option<String>,
    /// List what a mix may have
    #[arg(long, conflicts_with = "json")]
    pub(crate) operations: bool,
    /// Write the workloads as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

fn need(name: &str) -> Result<Need, String> {
    let parsed: Result<Need, _> = name.trim().parse();
    parsed.map_err(|error| error.to_string())
}

/// `2GiB`, `500MB`, `1000000`: more than nothing.
fn bytes(text: &str) -> Result<u64, String> {
    let units = [
        ("GiB", 1 << 30),
        ("MiB", 1 << 20),
        ("KiB", 1 << 10),
        ("GB", 1_000_000_000),
        ("MB", 1_000_000),
        ("kB", 1000),
        ("B", 1),
        ("", 1_u64),
    ];
    let wrong = || format!("write memory as 2GiB, 500MB or 1000000, not `{text}`");
    let (number, unit) = units
        .into_iter()
        .find_map(|(unit, bytes)| Some((text.trim().strip_suffix(unit)?, bytes)))
        .ok_or_else(wrong)?;
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    let bytes = number * unit as f64;
    match bytes >= 1.0 && bytes <= u64::MAX as f64 {
        true => Ok(bytes as u64),
        false => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_has_a_unit_or_is_bytes() {
        assert_eq!(bytes("2GiB"), Ok(2 << 30));
        assert_eq!(bytes("1.5MB"), Ok(1_500_000));
        assert_eq!(bytes("17"), Ok(17));
        for text in ["", "2 gigs", "-1GiB", "0", "nanB", "1e99GB", "GiB"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }
}
