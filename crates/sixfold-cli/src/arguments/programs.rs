//! Arguments of a command line that measures programs of a user.

use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use sixfold_results::Policy;

use super::picking::bytes;
use super::{EffortArgs, ReadFiles, ResultFiles, duration, seed};

/// Measures programs on every mesh data structure, and ranks the structures.
///
/// Each program runs on each structure that can hold the mesh. The structures take turns in rounds.
/// The output names the fastest structure, and shows confidence intervals, the memory, and the
/// number of runs after which the time to build the structure is saved.
#[derive(Debug, Parser)]
#[command(verbatim_doc_comment)]
pub(crate) struct Programs {
    /// Meshes, or folders with meshes; without any, a built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH|DIR")]
    pub(crate) meshes: Vec<PathBuf>,
    /// Measure only these programs, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) programs: Vec<String>,
    /// Use only these structures, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) backends: Vec<String>,
    /// Number of runs of a program on one mesh, to weigh the time to build a structure
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) runs: u64,
    /// Memory limit for the structure, such as 2GiB or 500MB
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) max_memory: Option<u64>,
    #[command(flatten)]
    pub(crate) effort: EffortArgs,
    /// Seed of the random order of the measurements
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Freed memory: kept (by the process) or system
    #[arg(long, value_name = "POLICY", default_value = "kept")]
    pub(crate) heap: Policy,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Exit code 0 also if a mesh cannot be read; a note names it
    #[arg(long)]
    pub(crate) keep_going: bool,
    /// Run each structure in a process of its own: if the program crashes, does not end or uses too
    /// much memory on one structure, the others are still measured
    #[arg(long, conflicts_with = "record")]
    pub(crate) isolate: bool,
    /// Time limit for each sample [default with --isolate: a quarter of the budget; otherwise the
    /// command ends after three times the budget and 30 s]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub(crate) time_limit: Option<Duration>,
    /// Memory limit for the process, with --isolate for each process, such as 4GiB [default: nine
    /// tenths of the free memory]
    #[arg(long, value_name = "BYTES", value_parser = bytes)]
    pub(crate) memory_limit: Option<u64>,
    /// What a child process runs, as JSON
    #[arg(long, value_name = "JSON", hide = true)]
    pub(crate) child: Option<String>,
    /// Write what each program asks to DIR/PROGRAM.toml, a workload for `sixfold pick --workload`;
    /// measures only the time of the program's own work
    #[arg(long, value_name = "DIR", conflicts_with_all = ["json", "csv"])]
    pub(crate) record: Option<PathBuf>,
    /// With --record, also write all calls to DIR/PROGRAM.trace, for `sixfold pick --trace`
    #[arg(long, requires = "record")]
    pub(crate) traces: bool,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}
