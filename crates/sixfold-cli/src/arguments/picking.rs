//! Arguments of `sixfold pick`, `workloads` and `operations`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use sixfold_results::{Need, Policy};

use super::{EffortArgs, LaunchArgs, ReadFiles, ResultFiles, backend, seed};

const PICK_EXAMPLES: &str = "Examples:
  sixfold pick bunny.obj
  sixfold pick --workload geodesic-dijkstra --max-memory 2GiB bunny.obj
  sixfold pick --workload mine.toml --needs edit,non-manifold scans/*.obj --json -
  sixfold workloads --show smoothing > mine.toml
  sixfold pick --trace mine.trace bunny.obj          the calls of a program, in their order

The mix of a workload is the list of its operations with their weights. Each round runs the whole
mix on every backend that has the required abilities. All operations of the mix run in one loop,
because operations affect each other's times through the caches. If the mix does not change the
connectivity of the mesh, flat tables of the queried relations are measured as another backend. The
ranking does not include the time to build a backend. The column `pays` shows the number of
operations after which the building time is saved, compared with an indexed face set that is already
built. The ratios of several meshes are combined by geometric means.

Needs: edit, non-manifold, polygons, mixed-orientation, isolated-vertices, coincident-vertices,
refine.

Exit codes: 0 success; 1 no backend qualifies, results differ between backends (a fault in Sixfold),
or a mesh of several cannot be read or a launch died (the other results are written; with
--keep-going, this is no error); 2 wrong usage or unusable input; 4 interrupted, finished results are kept.";

const WORKLOADS_EXAMPLES: &str = "Examples:
  sixfold workloads
  sixfold workloads --show smoothing > mine.toml     a file to edit
  sixfold workloads --operations                     operations that a workload may contain
  sixfold workloads --trace mine.trace mesh.obj > mine.toml     a recorded program as a workload

Exit codes: 0 success; 2 wrong usage.";

const OPERATIONS_EXAMPLES: &str = "Examples:
  sixfold operations
  sixfold study --operations circulate,flip_all     measure only these

Exit codes: 0 success; 2 wrong usage.";

/// Find the data structure that fits a mesh and a workload.
///
/// Runs the workload on each backend and ranks the backends. Shows reasons and confidence
/// intervals. Shows for each backend the memory, and the number of operations after which the
/// building time is saved.
#[derive(Debug, Args)]
#[command(after_help = PICK_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Pick {
    /// Meshes, or folders with meshes; without any, a built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH|DIR")]
    pub(crate) meshes: Vec<PathBuf>,
    /// A built-in workload, or your own file
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "smoothing")]
    pub(crate) workload: String,
    /// Instead of a workload, repeat the recorded calls of a program; FILE is the trace
    #[arg(long, value_name = "FILE", conflicts_with_all = ["workload", "needs"])]
    pub(crate) trace: Option<PathBuf>,
    /// Memory limit for the structure, such as 2GiB or 500MB
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) max_memory: Option<u64>,
    /// Abilities that the structure must have, from the list below
    #[arg(long, value_name = "NEED,…", value_delimiter = ',')]
    pub(crate) needs: Vec<Need>,
    /// Use only these data structures (backends), by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    #[command(flatten)]
    pub(crate) effort: EffortArgs,
    #[command(flatten)]
    pub(crate) launching: LaunchArgs,
    /// Seed of all random orders
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Freed memory: kept (by the process) or system
    #[arg(long, value_name = "POLICY", default_value = "kept")]
    pub(crate) heap: Policy,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

/// List the built-in workloads and the programs they model.
#[derive(Debug, Args)]
#[command(after_help = WORKLOADS_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Workloads {
    /// Print the file of a built-in workload
    #[arg(long, value_name = "NAME", conflicts_with_all = ["operations", "json"])]
    pub(crate) show: Option<String>,
    /// List the operations that a workload may contain
    #[arg(long, conflicts_with = "json")]
    pub(crate) operations: bool,
    /// Print the calls of this trace as a workload file; MESH is the mesh on which it was recorded
    #[arg(long, value_name = "FILE", conflicts_with_all = ["show", "operations", "json"])]
    pub(crate) trace: Option<PathBuf>,
    /// The mesh of --trace; without it, the built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH", requires = "trace")]
    pub(crate) mesh: Option<PathBuf>,
    /// With --trace: first cut every polygon into triangles
    #[arg(long, requires = "trace")]
    pub(crate) triangulate: bool,
    /// With --trace: time to measure the program's own work, such as 5s
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = super::duration, requires = "trace")]
    pub(crate) budget: Duration,
    /// Write the workloads as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

/// List the operations of a study, and what each operation does.
#[derive(Debug, Args)]
#[command(after_help = OPERATIONS_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Operations {
    /// Write the operations as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

pub(super) use sixfold_measure::command::arguments::bytes;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_without_a_unit_is_in_bytes() {
        assert_eq!(bytes("2GiB"), Ok(2 << 30));
        assert_eq!(bytes("1.5MB"), Ok(1_500_000));
        assert_eq!(bytes("17"), Ok(17));
        for text in ["", "2 gigs", "-1GiB", "0", "nanB", "1e99GB", "GiB"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }
}
