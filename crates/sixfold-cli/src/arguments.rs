//! The command-line arguments.

mod comparing;
mod convert;
mod distance;
mod files;
mod inspect;
mod memory;
mod neighbours;
mod new;
mod picking;
mod remeshing;
mod render;
mod repair;
mod reshaping;
mod results;
mod selection;
mod subdivision;
mod teaching;
mod why;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use sixfold::shapes::{GENERATORS, Generator, Order, generator};
use sixfold::{Relation, UnknownName};
use sixfold_results::{CacheState, Confidence, Policy};
use sixfold_study::{Effort, External, Settings};

pub(crate) use comparing::{
    ChangeArgs, Compare, GROWTH_EXAMPLES, Growth, History, ORDERS_EXAMPLES, Orders, Rerun,
};
pub(crate) use convert::Convert;
pub(crate) use distance::Distance;
pub(crate) use files::{MeshInOut, ReadFiles, ReadPolygons, ShapeCheck, WriteFiles};
pub(crate) use inspect::Inspect;
pub(crate) use memory::Memory;
pub(crate) use neighbours::Neighbours;
pub(crate) use new::New;
pub(crate) use picking::{Operations, Pick, Workloads};
pub(crate) use remeshing::{Decimate, Edits, Remesh};
pub(crate) use render::Render;
pub(crate) use repair::{ChosenSteps, Repair, joined_values, repair_options};
pub(crate) use reshaping::{Dual, Smooth, Triangulate};
pub(crate) use results::ResultFiles;
pub(crate) use selection::OperationArgs;
pub(crate) use subdivision::{Schemes, Select, Subdivide};
pub(crate) use teaching::{Explained, Explore, Lessons, Tables, Trace};
pub(crate) use why::Why;

use crate::launches;
use crate::many::{LabSelection, Shard};
use crate::text::sanitize;

const EXAMPLES: &str = "Examples:
  sixfold                                    study the built-in mesh
  sixfold study bunny.obj                    study your own mesh
  sixfold pick --workload smoothing bunny.obj
  sixfold explore bunny.obj                  see the structures at work, in a browser
  sixfold inspect bunny.obj                  facts about the mesh; structures that can hold it
  sixfold generate geodesic frequency=20 -o ball.obj
  sixfold subdivide --scheme loop --levels 2 bunny.obj -o smooth.obj
  sixfold decimate --ratio 0.1 bunny.obj -o small.obj

Exit codes: 0 success; 1 finished with a negative answer, such as results that differ;
2 wrong usage or unusable input; 3 not supported by the structure or scheme;
4 interrupted, finished results are kept.";

/// Text after the options in `study --help`; the lists of names follow it.
pub(crate) const STUDY_EXAMPLES: &str = "Examples:
  sixfold study bunny.obj
  sixfold study bunny.obj --backends half-edge,face-vertex --operations vv_smooth,build
  sixfold study quads.obj --triangulate --budget 2m
  sixfold study bunny.obj --rounds 10               the same work on every machine
  sixfold study bunny.obj --json - --csv bunny.csv
  sixfold study bunny.obj --markdown bunny.md       the answer and all tables, for a README
  sixfold study bunny.obj --external mine='./mine {mesh}'
  sixfold study bunny.obj --report bunny            a page with figures
  sixfold study scans --report results              all meshes in a folder; --resume continues
  sixfold study scans --keep-going                  exit code 0 also if a mesh cannot be read
  sixfold study bunny.obj --figures paper           figures as SVG and PDF, tables for LaTeX

Measurement: A study is several launches: fresh processes that measure one after the other. Each
round of a launch runs every operation once on every backend, in random order. The clock measures
the processor time of the thread. A launch gives the median over its rounds, and the table shows the
mean over the launches. In each round, one backend is measured twice. The difference between the two
times of this backend is the noise. A difference between backends that is smaller than the noise is
not decided. Each lab of a report has launches of its own.

Budget and rounds: With --budget, as many rounds are run as fit into the time. The structures that
can win come first. What takes too long is sampled, run once after the rounds, estimated or left
out, also if it is named; with --force, it is run. A budget below 6s has one launch (below 1.5s, if
few operations are named). With --rounds, exactly this number of rounds of everything is run in each
launch (one by default), without a time limit. Two machines then do the same work: whether a slow operation runs on a sample of the elements
depends on the number of elements, not on measured times.

Seed: The seed determines the random order of the runs, and which elements are in a sample.

Interruption: Ctrl-C stops after the current timed run and keeps the finished results. A second
Ctrl-C stops at once, with exit code 130.

Progress: A terminal shows a bar. With SIXFOLD_PROGRESS=lines in the environment, each step is a line
on standard error, also without a terminal.

Memory: With --heap kept, the process keeps freed memory pages, and timed runs use these pages
again. The row `first time` of the table shows the time to build on new pages; documents have the
first times of all operations. With --heap system, the
allocator decides which freed pages it keeps. The time of an operation that allocates memory then
depends on the previous operations. With --caches cold, the caches are filled with other data before
each timed run. `compare` and `merge` refuse results that differ in --heap or --caches.

Exit codes: 0 success; 1 results differ between backends (a fault in Sixfold), the results of an
external program differ, or a part is missing: a mesh that cannot be read, an external program that
failed, or a launch that died (the other results are written; with --keep-going, a missing part is
no error); 2 wrong usage or unusable input; 3 none of the selected backends can hold the mesh;
4 interrupted, finished results are kept.";

const MERGE_EXAMPLES: &str = "Examples:
  sixfold study scans --shard 1/2 --report one      part 1, on one machine
  sixfold study scans --shard 2/2 --report two      part 2, on another machine
  sixfold merge one two --report all
  sixfold merge --repeat a.json b.json --json all.json       further launches of one study

A shard is the result of one part of a study. All studies must have the same settings. A copy of a
result is used once. Two different studies of one mesh are refused.

Exit codes: 0 success; 1 results differ between backends (a fault in Sixfold), or the results of an
external program differ; 2 wrong usage, an invalid file, or studies that cannot be merged.";

const REPORT_EXAMPLES: &str = "Examples:
  sixfold growth --to 4000000 --budget 5m --json growth.json
  sixfold report growth.json --to growth
  sixfold report results pick.json orders.json --to all
  sixfold report results --figures paper            for a paper: SVG, PDF, CSV, LaTeX

Figures: --figures writes four files for each figure: ID.svg, ID.pdf, ID.csv (the data, one row for
each mark) and ID.txt (the caption). Letters are outlines in SVG files and an embedded font in PDF
files, so both look the same on every machine. results.tex (with the package booktabs) and
results.md have the tables, and methods.md states how the results were measured. The folder must be
new, empty, or written by --figures; sixfold-files.txt lists the files, and old figures are removed.

Exit codes: 0 success; 2 wrong usage, a file that is incomplete, has no results or has another
schema version, or studies that cannot be merged.";

const COMPLETIONS_EXAMPLES: &str = "Examples:
  sixfold completions bash > ~/.local/share/bash-completion/completions/sixfold
  sixfold completions fish > ~/.config/fish/completions/sixfold.fish

Exit codes: 0 success; 2 wrong usage.";

const MANUAL_EXAMPLES: &str = "Examples:
  sixfold manual | man -l -
  sixfold manual --to ~/.local/share/man/man1

Exit codes: 0 success; 2 wrong usage, or a file that cannot be written.";

/// Measure which mesh data structure fits a mesh and a workload.
///
/// Builds six data structures from the same mesh, runs the same operations on each of them, and
/// compares the times. A backend is what is measured: one of these structures, an external program,
/// or, in `pick`, flat tables of relations. Without a command, sixfold studies a built-in mesh of
/// about 20,000 triangles for about 20 seconds.
#[derive(Debug, Parser)]
#[command(name = "sixfold", version, after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Measure the time and memory of each mesh data structure
    Study(Study),
    /// Find the data structure that fits a mesh and a workload
    Pick(Pick),
    /// List the built-in workloads and the programs they model
    Workloads(Workloads),
    /// List the operations of a study, and what each operation does
    Operations(Operations),
    /// Write a package that measures your own program on every data structure
    New(New),
    /// Explain the time of queries by the memory that the queries read
    Why(Why),
    /// Show the tables of a data structure, row by row
    Tables(Tables),
    /// Step through a query or an edit: what it reads and writes, and why
    Trace(Trace),
    /// Learn how the structures work: short lessons with questions
    Lessons(Lessons),
    /// Open a page that shows the structures at work, in the browser
    Explore(Explore),
    /// Measure how the order of vertices and faces in memory affects the times
    Orders(Orders),
    /// Measure how the times grow with the size of the mesh
    Growth(Growth),
    /// Merge results, such as the parts of a study of many meshes
    Merge(Merge),
    /// Draw saved results on one page
    Report(Draw),
    /// Compare two files of results, and show what became slower or faster beyond chance
    Compare(Compare),
    /// Show how times went over saved results, such as one file for each commit
    History(History),
    /// Measure saved results again, and say which conclusions stand
    Rerun(Rerun),
    /// Show facts about meshes, and which data structures can hold them
    Inspect(Inspect),
    /// Measure the distance between the surfaces of two meshes
    Distance(Distance),
    /// Measure searches for neighbours in space with five spatial indices
    Neighbours(Neighbours),
    /// Count the memory of each data structure in three ways that must agree
    Memory(Memory),
    /// Write a built-in shape
    Generate(Generate),
    /// List the subdivision schemes, and the data structures that support each scheme
    Schemes(Schemes),
    /// Refine a mesh with a subdivision scheme
    Subdivide(Subdivide),
    /// Move vertices towards their neighbours
    Smooth(Smooth),
    /// Turn each face into a vertex, and each vertex into a face
    Dual(Dual),
    /// Cut polygons into triangles
    Triangulate(Triangulate),
    /// List the edits of each data structure, and how much of the mesh each edit visits
    Edits(Edits),
    /// Make a mesh coarser: collapse the edges with the least error first
    Decimate(Decimate),
    /// Replace the triangles of a mesh by nearly equilateral triangles of one size
    Remesh(Remesh),
    /// Write a mesh in another format
    Convert(Convert),
    /// Repair a mesh: weld, orient, cut, fill holes
    Repair(Repair),
    /// Draw meshes with their edges and creases, as PNG or SVG
    Render(Render),
    /// Print a script that completes commands and options in a shell
    Completions(Completions),
    /// Print or write manual pages
    Manual(Manual),
}

/// Print a script that completes commands and options in a shell.
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub(crate) shell: Shell,
}

/// Print or write manual pages.
///
/// Without --to, prints the manual page of sixfold. With --to, writes this page and one page for
/// each command.
#[derive(Debug, Args)]
#[command(after_help = MANUAL_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Manual {
    /// Write all pages to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) to: Option<PathBuf>,
}

/// Measure the time and memory of each mesh data structure.
///
/// Prints facts about the mesh, and which backends (data structures) can hold the mesh. Prints for
/// each backend the time of every operation and the bytes per vertex.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Study {
    /// Meshes, or folders with meshes [default: a built-in mesh]
    #[arg(value_name = "MESH|DIR")]
    pub(crate) meshes: Vec<PathBuf>,
    /// Use only these data structures (backends), by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    #[command(flatten)]
    pub(crate) operations: OperationArgs,
    /// List the selected operations, and measure nothing
    #[arg(long)]
    pub(crate) list: bool,
    /// Total time of all meshes and labs [default: 20s each]
    #[arg(long, value_name = "TIME", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) budget: Option<Duration>,
    /// Measure exactly N rounds of everything, without a time limit
    #[arg(long, value_name = "N", conflicts_with = "budget", value_parser = rounds, allow_hyphen_values = true)]
    pub(crate) rounds: Option<NonZeroU32>,
    /// Untimed runs before each sample [default: as many as fill the caches]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    pub(crate) warmup: Option<u32>,
    /// Run every operation on every backend, whatever it takes; replace a
    /// report.html that is not a report of Sixfold
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) launching: LaunchArgs,
    /// Seed of the random order and of random samples
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) memory: MemoryState,
    /// Also measure another program; may be repeated
    #[arg(long = "external", value_name = "NAME=COMMAND")]
    pub(crate) externals: Vec<External>,
    /// Time limit for one answer of an external program
    #[arg(long = "patience", value_name = "TIME", default_value = "60s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) external_timeout: Duration,
    /// First cut every polygon into triangles
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Refuse a file with degenerate faces instead of leaving them out
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
    /// Write a page, its figures, and all results as JSON and CSV to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Write each figure as SVG, PDF and CSV, and tables for a paper, to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
    /// More labs in the report: orders,growth,why or none [default: all]
    #[arg(long, value_name = "NAME,…", requires = "report")]
    pub(crate) labs: Option<LabSelection>,
    /// Continue the study in the folder of --report
    #[arg(long, requires = "report")]
    pub(crate) resume: bool,
    /// Study part i of n of the meshes; `sixfold merge` joins the parts
    #[arg(long, value_name = "i/n", requires = "report")]
    pub(crate) shard: Option<Shard>,
    #[command(flatten)]
    pub(crate) read: ReadFiles,
}

// How much to measure. The commands differ in the default of `budget`.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct EffortArgs {
    /// Total time to measure, such as 20s, 500ms or 2m
    #[arg(long, value_name = "TIME", default_value = "20s", value_parser = duration, allow_hyphen_values = true)]
    budget: Duration,
    /// Measure exactly N rounds of everything, without a time limit
    #[arg(long, value_name = "N", conflicts_with = "budget", value_parser = rounds, allow_hyphen_values = true)]
    rounds: Option<NonZeroU32>,
}

// In how many processes to measure, how sure intervals are, and what it means if a part fails.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct LaunchArgs {
    /// Measure in N fresh processes [default: by the budget and the work]
    #[arg(long, value_name = "N", value_parser = launch_count, allow_hyphen_values = true)]
    pub(crate) launches: Option<NonZeroU32>,
    /// Confidence of all intervals, such as 99% or 0.99
    #[arg(
        long,
        value_name = "LEVEL",
        default_value = "95%",
        allow_hyphen_values = true
    )]
    pub(crate) confidence: Confidence,
    /// Exit code 0 also if a part cannot be measured; a note names it
    #[arg(long)]
    pub(crate) keep_going: bool,
}

impl EffortArgs {
    /// Returns the number of rounds, or else the time, of this process, which may be one of several launches.
    pub(crate) fn effort(self) -> Effort {
        let whole = self
            .rounds
            .map_or(Effort::Budget(self.budget), Effort::Rounds);
        launches::effort(whole)
    }
}

/// How freed pages and the caches are treated while times are measured.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct MemoryState {
    /// Freed memory: kept (by the process) or system
    #[arg(long, value_name = "POLICY", default_value = "kept")]
    pub(crate) heap: Policy,
    /// Caches before each timed run: warm or cold
    #[arg(long, value_name = "STATE", default_value = "warm")]
    pub(crate) caches: CacheState,
}

/// Merge results into one file or report.
///
/// Merges the parts of a study of many meshes, and results of any command that measures. Studies
/// must have the same settings.
#[derive(Debug, Args)]
#[command(after_help = MERGE_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Merge {
    /// Files written by --json, or folders written by --report
    #[arg(value_name = "DIR|FILE.json", required = true)]
    pub(crate) results: Vec<PathBuf>,
    /// Pool studies that repeat one measurement, as further launches
    #[arg(long)]
    pub(crate) repeat: bool,
    /// Write a page, its figures, and all results as JSON and CSV to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Write each figure as SVG, PDF and CSV, and tables for a paper, to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
    /// Replace a report.html that is not a report of Sixfold
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) files: ResultFiles,
}

/// Draw saved results on one page.
///
/// Reads results of any command that measures, also of several meshes. Studies must have the same
/// settings. This command makes no new measurements.
#[derive(Debug, Args)]
#[command(after_help = REPORT_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Draw {
    /// Files written by --json, or folders written by --report
    #[arg(value_name = "FILE.json|DIR", required = true)]
    pub(crate) results: Vec<PathBuf>,
    /// Write report.html, report.md and figures to DIR
    #[arg(long, value_name = "DIR", required_unless_present = "figures")]
    pub(crate) to: Option<PathBuf>,
    /// Write each figure as SVG, PDF and CSV, and tables for a paper, to DIR
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
    /// Width of the files of --figures, such as 85mm (a column) or 178mm (a page);
    /// no letter is smaller than 7 points
    #[arg(long, value_name = "WIDTH", requires = "figures", value_parser = millimetres)]
    pub(crate) width: Option<f64>,
    /// Replace a report.html that is not a report of Sixfold
    #[arg(long)]
    pub(crate) force: bool,
}

/// Reads a width on paper: `85mm` or `17.8cm`.
fn millimetres(text: &str) -> Result<f64, String> {
    let number = |unit: &str| text.strip_suffix(unit)?.trim().parse::<f64>().ok();
    let mm = number("mm").or_else(|| Some(10.0 * number("cm")?));
    match mm {
        Some(mm) if (20.0..=1000.0).contains(&mm) => Ok(mm),
        Some(_) => Err("a width is from 20mm to 1000mm".into()),
        None => Err("a width has a unit: write 85mm or 17.8cm".into()),
    }
}

impl Study {
    /// Returns how much to measure in one of `parts` equal parts: a mesh or a lab. A shard takes its
    /// part of the meshes and of the time.
    pub(crate) fn effort(&self, parts: usize) -> Effort {
        match (self.rounds, self.budget) {
            (Some(rounds), _) => Effort::Rounds(rounds),
            (None, Some(total)) => Effort::Budget(total.div_f64(parts.max(1) as f64)),
            (None, None) => Settings::default().effort,
        }
    }
}

impl Default for Study {
    /// Returns the arguments of `sixfold study` without options.
    fn default() -> Self {
        let arguments = Arguments::parse_from(["sixfold", "study"]);
        match arguments.command {
            Some(Command::Study(study)) => study,
            _ => unreachable!("the command is `study`"),
        }
    }
}

/// Write a built-in shape.
#[derive(Debug, Args)]
pub(crate) struct Generate {
    /// The shape, from the list below
    #[arg(value_name = "SHAPE", value_parser = shape)]
    pub(crate) shape: &'static Generator,
    /// Parameters of the shape
    #[arg(value_name = "name=value", value_parser = setting)]
    pub(crate) settings: Vec<(String, f64)>,
    /// Order: given, shuffled, morton, breadth-first
    #[arg(long, value_name = "ORDER", default_value = "given")]
    pub(crate) order: Order,
    /// Seed of the order `shuffled`
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// The file to write (- for standard output)
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) write: WriteFiles,
}

/// Parses the name of a shape.
fn shape(name: &str) -> Result<&'static Generator, UnknownName> {
    generator(name).ok_or_else(|| {
        let names = GENERATORS.iter().map(|generator| generator.name);
        let meanings = GENERATORS.iter().map(|generator| generator.summary);
        UnknownName::new("shape", &sanitize(name), names).with_meanings(meanings)
    })
}

/// Parses the name of a relation, such as `vertex_faces` or VF.
pub(crate) fn relation(name: &str) -> Result<Relation, UnknownName> {
    let short = |relation: &Relation| {
        let words = relation.name().split('_');
        let initials: String = words.filter_map(|word| word.chars().next()).collect();
        initials.to_uppercase() == name
    };
    let found = Relation::ALL.into_iter().find(short);
    found.map_or_else(|| name.parse(), Ok)
}

fn backend(name: &str) -> Result<String, String> {
    let settings = sixfold_study::Settings {
        backends: vec![name.trim().into()],
        ..Default::default()
    };
    match settings.chosen_backends() {
        Ok(_) => Ok(name.trim().into()),
        Err(error) => Err(error.to_string()),
    }
}

use sixfold_measure::command::arguments::duration;

/// Parses a number of launches.
fn launch_count(text: &str) -> Result<NonZeroU32, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| "write a whole number of launches, at least 1".to_owned())
}

/// Parses a number of rounds.
fn rounds(text: &str) -> Result<NonZeroU32, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("write a whole number of rounds from 1 to {}", u32::MAX))
}

fn seed(text: &str) -> Result<u64, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("the seed must be a whole number from 0 to {}", u64::MAX))
}

fn setting(text: &str) -> Result<(String, f64), String> {
    let wrong = || format!("write a parameter as name=number, not `{text}`");
    let (name, value) = text.split_once('=').ok_or_else(wrong)?;
    let value = value.trim().parse().map_err(|_| wrong())?;
    Ok((name.trim().into(), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_of_the_command_line_is_valid() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn times_have_a_unit_and_are_positive() {
        for (text, milliseconds) in [
            ("20s", 20_000),
            ("500ms", 500),
            ("2m", 120_000),
            ("1.5s", 1500),
        ] {
            assert_eq!(duration(text), Ok(Duration::from_millis(milliseconds)));
        }
        for text in [
            "",
            "20",
            "s",
            "-1s",
            "0s",
            "nans",
            "infs",
            "1e300m",
            "20 minutes",
        ] {
            assert!(duration(text).is_err(), "{text}");
        }
    }
}
