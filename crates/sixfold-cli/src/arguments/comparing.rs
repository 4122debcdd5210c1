//! Arguments of `sixfold orders`, `growth`, `compare`, `history` and `rerun`.

use std::path::PathBuf;

use clap::Args;
use sixfold::shapes::Order;
use sixfold_results::CompareSettings;
use sixfold_study::GrowthSettings;

use super::{
    EffortArgs, LaunchArgs, MemoryState, OperationArgs, ReadFiles, ResultFiles, backend, seed,
};

/// Text after the options in `orders --help`; the lists of names follow it.
pub(crate) const ORDERS_EXAMPLES: &str = "Examples:
  sixfold orders                             the built-in mesh
  sixfold orders bunny.obj
  sixfold orders bunny.obj --operations vertex_vertices --backends half-edge,corner-table
  sixfold orders bunny.obj --budget 2m --json orders.json

Orders: given (as in the file), shuffled (vertices and faces in random order), morton (along a
space-filling curve), breadth-first (as a walk from face to face visits the elements).

Each round measures every backend in every order. The report first compares the four orders of each
backend. Then the report compares the backends, each in its best order. In each round, one backend
is measured twice in the order `given`. The noise is the difference between the two measurements of
this backend.

Exit codes: 0 success; 1 results differ between backends or orders (a fault in Sixfold); 2 wrong
usage or unusable input; 3 none of the selected backends can hold the mesh, or too little memory;
4 interrupted, finished results are kept.";

/// Measure how the order of vertices and faces in memory affects the times.
///
/// Measures the mesh in four orders. Shows which order is best. Shows whether the choice of the
/// order changes the times more than the choice of the backend.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, mut_arg("budget", |arg| arg.default_value("25s")))]
pub(crate) struct Orders {
    /// The mesh (- for standard input); without it, a built-in mesh of 20,000 triangles
    #[arg(value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// Use only these data structures (backends), by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    #[command(flatten)]
    pub(crate) operations: OperationArgs,
    #[command(flatten)]
    pub(crate) effort: EffortArgs,
    #[command(flatten)]
    pub(crate) launching: LaunchArgs,
    /// Seed of the order `shuffled` and of random samples
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) memory: MemoryState,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

const COMPARE_EXAMPLES: &str = "Examples:
  sixfold compare before.json after.json
  sixfold compare before.json after.json --fail-if-slower      for CI: exit code 1 or 3
  sixfold compare laptop.json server.json --relative
  sixfold compare before.json after.json --report changes      a page with figures
  sixfold compare before.json after.json --markdown -          tables for a pull request

Each file has results of any commands that measure. A measurement is the time of one operation on
one backend, by the same command, on the same mesh and in the same case (order, size or workload).
The ratio of a measurement is the time in the second file, divided by the time in the first file.

A measurement counts as slower if chance does not explain it: if the program did not change, at most
one of 200 comparisons finds anything slower. The times of the launches show what chance does: files with
one launch cannot be compared, unless a time doubled in three samples or more. The machine may be slower as a whole in one of
the files, so a measurement is compared with the others: it is slower if it changed by more than
they did. With fewer than six, only a change by more than 1.3 can be told from the machine. If all
together take 1.3 times as long, the whole program is slower. Ratios up to --noise count as equal.
If chance could explain a change by the square of --noise (10 %), the measurement cannot be told:
use fewer --operations, a longer --budget or more --launches for both files.

Report: report.html needs no network, report.md and figures have the same content, and changes.json
has all data. The folder must be new, empty, or written by --report of this command. Its file
sixfold-files.txt lists the files. Old figures are removed, and files of others stay.

Exit codes: 0 success; 1 a measurement is slower and --fail-if-slower is given; 2 wrong usage, a
file that is incomplete, has no results or has another schema version, files without a common
measurement, or files with different --heap or --caches; 3 none is slower, but some cannot be told,
and --fail-if-slower is given.";

/// Compare two files of results, and show what became slower or faster beyond chance.
///
/// Compares measurements on two machines, with two compilers or of two commits. Shows which
/// times are shorter or longer, which backend is now the fastest, and how machines and programs
/// differ.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, after_help = COMPARE_EXAMPLES)]
pub(crate) struct Compare {
    /// The first results: a file of --json, or a folder of --report
    #[arg(value_name = "BEFORE.json|DIR")]
    pub(crate) before: PathBuf,
    /// The second results
    #[arg(value_name = "AFTER.json|DIR")]
    pub(crate) after: PathBuf,
    /// End with exit code 1 if a measurement is slower, 3 if one cannot be told
    #[arg(long)]
    pub(crate) fail_if_slower: bool,
    #[command(flatten)]
    pub(crate) changes: ChangeArgs,
}

// How changes are judged and shown.
#[derive(Clone, Debug, Args)]
pub(crate) struct ChangeArgs {
    /// First divide each ratio by the median of all ratios
    #[arg(long)]
    pub(crate) relative: bool,
    /// Count ratios up to this as equal
    #[arg(long, value_name = "RATIO", default_value_t = sixfold_results::ranking::EQUAL, value_parser = noise)]
    pub(crate) noise: f64,
    /// Show all measurements, including unchanged ones
    #[arg(long)]
    pub(crate) all: bool,
    /// Write a page of the changes, largest first, and its figures to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Write each figure as SVG, PDF and CSV to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
    /// Write all results as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write the answer and all tables as Markdown (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) markdown: Option<PathBuf>,
}

impl ChangeArgs {
    pub(crate) fn settings(&self) -> CompareSettings {
        CompareSettings {
            relative: self.relative,
            noise: self.noise,
            ..CompareSettings::default()
        }
    }

    /// Returns the options that write, with their paths.
    pub(crate) fn outputs(&self) -> [(&'static str, Option<&PathBuf>); 4] {
        [
            ("--json", self.json.as_ref()),
            ("--report", self.report.as_ref()),
            ("--figures", self.figures.as_ref()),
            ("--markdown", self.markdown.as_ref()),
        ]
    }
}

const HISTORY_EXAMPLES: &str = "Examples:
  sixfold study bunny.obj --save-baseline $(git rev-parse --short HEAD)      after each commit
  sixfold history .sixfold
  sixfold history .sixfold --report history         a page with curves
  sixfold history nightly --all --csv history.csv

A folder has results of any commands that measure: files of --json, and folders of --report. Other
files in it are named and left out. The results are shown in the order in which they were measured,
because they name their commits, but not the times of these commits: measure older commits first.

Each document is compared with the first one, as `compare` does: a measurement counts as slower if
chance does not explain it. All comparisons together find anything slower with a probability of at
most one in 200 if the program did not change. Results of one launch cannot be compared. A document of other
meshes, or with other --heap or --caches, is compared with documents of its kind; differences of
machine, program and settings are shown.

Report: report.html needs no network, report.md and figures have the same content, and history.json
has all data. The folder must be new, empty, or written by --report.

Exit codes: 0 success; 2 wrong usage, no file that can be read, or no two documents that have a
measurement in common.";

/// Show how times went over saved results, such as one file for each commit.
///
/// Reads all results of a folder, and shows which times became longer or shorter beyond chance, and
/// since when.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, after_help = HISTORY_EXAMPLES)]
pub(crate) struct History {
    /// Folders of results, such as .sixfold, or single results
    #[arg(value_name = "DIR|FILE.json", required = true)]
    pub(crate) results: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) changes: ChangeArgs,
    /// Write each time in each document as CSV (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
}

const RERUN_EXAMPLES: &str = "Examples:
  sixfold rerun results.json                        on this machine, with this program
  sixfold rerun paper/results.json --meshes scans   the meshes are in another folder

Runs the commands that measured the results again, with their settings and on the same meshes, and
says which conclusions stand. A conclusion is that one backend alone is the fastest: for an
operation of a study, or for the workload of a pick. It stands if the backend is the fastest again,
and it is reversed if another one is, beyond chance. Otherwise it cannot be told. A mesh is looked
for at its path, beside RESULTS.json, and under --meshes; its content must be that of the results.

Exit codes: 0 no conclusion is reversed; 1 a conclusion is reversed, or results differ between
backends or are missing; 2 wrong usage, a file without results, a command that cannot be repeated, or a mesh that
is missing or has changed; 4 interrupted.";

/// Measure saved results again, and say which conclusions stand.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, after_help = RERUN_EXAMPLES)]
pub(crate) struct Rerun {
    /// The results: a file of --json, or a folder of --report
    #[arg(value_name = "RESULTS.json|DIR")]
    pub(crate) results: PathBuf,
    /// Look for the meshes in DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) meshes: Option<PathBuf>,
    /// Write the new results as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// Text after the options in `growth --help`; the lists of names follow it.
pub(crate) const GROWTH_EXAMPLES: &str = "Examples:
  sixfold growth
  sixfold growth --backends half-edge,face-vertex --operations vertex_normal
  sixfold growth --shape blobs --order shuffled --to 4000000 --budget 5m
  sixfold growth --shape grid --from 500 --to 50000 --steps 5 --json growth.json

At each size, every round measures all backends. The time of a run is nearly proportional to F^p,
where F is the number of faces. The table shows the power p with its standard error. The power p is
the slope of a straight line through the logarithms of F and of the time. If p is 1, the time per
element does not depend on the size. If p is 2, each element takes a scan of all faces. Two more
lines of the table show p for two ranges of sizes: the sizes at which the structure fits into the
last cache, and the larger sizes. Operations that scan all faces are measured on a sample of the
elements.

Exit codes: 0 success; 1 results differ between backends (a fault in Sixfold); 2 wrong usage;
3 none of the selected backends can hold the shape, or too little memory; 4 interrupted, finished
sizes are kept.";

/// Measure how the times grow with the size of the mesh.
///
/// Measures one shape in sizes that grow by a constant factor. Shows the nanoseconds per element,
/// and how the time grows with the number of faces. Shows the sizes at which the structures become
/// larger than each cache of this machine.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, mut_arg("budget", |arg| arg.default_value("60s")))]
pub(crate) struct Growth {
    /// The shape, from the list below
    #[arg(long, value_name = "SHAPE", default_value_t = GrowthSettings::default().shape)]
    pub(crate) shape: String,
    /// Approximate number of faces of the smallest size
    #[arg(long, value_name = "N", default_value_t = GrowthSettings::default().from, value_parser = count, allow_hyphen_values = true)]
    pub(crate) from: usize,
    /// Approximate number of faces of the largest size
    #[arg(long, value_name = "N", default_value_t = GrowthSettings::default().to, value_parser = count, allow_hyphen_values = true)]
    pub(crate) to: usize,
    /// Number of sizes
    #[arg(long, value_name = "N", default_value_t = GrowthSettings::default().steps, value_parser = count, allow_hyphen_values = true)]
    pub(crate) steps: usize,
    /// Use only these data structures (backends), by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    #[command(flatten)]
    pub(crate) operations: OperationArgs,
    /// Order: given, shuffled, morton, breadth-first
    #[arg(long, value_name = "ORDER", default_value = "given")]
    pub(crate) order: Order,
    #[command(flatten)]
    pub(crate) effort: EffortArgs,
    #[command(flatten)]
    pub(crate) launching: LaunchArgs,
    /// Seed of the order `shuffled` and of random samples
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) memory: MemoryState,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
}

fn count(text: &str) -> Result<usize, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| "write a whole number, such as 100000".into())
}

fn noise(text: &str) -> Result<f64, String> {
    let parsed: Option<f64> = text.trim().parse().ok();
    let valid = parsed.filter(|ratio| (1.0..=100.0).contains(ratio));
    valid.ok_or_else(|| "write a ratio from 1 to 100, such as 1.05".into())
}
