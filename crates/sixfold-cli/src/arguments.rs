//! What can be asked for.

mod comparing;
mod memory;
mod picking;
mod remeshing;
mod render;
mod reshaping;
mod subdivision;
mod why;

use std::path::PathBuf;
use std::time::Duration;

use ::study::{CacheState, External, Operation, Policy};
use clap::{Args, Parser, Subcommand};
use sixfold::shapes::Order;

pub(crate) use comparing::{Compare, GROWTH_EXAMPLES, Growth, ORDERS_EXAMPLES, Orders};
pub(crate) use memory::Memory;
pub(crate) use picking::{Pick, Workloads};
pub(crate) use remeshing::{Decimate, Edits, Remesh};
pub(crate) use render::Render;
pub(crate) use reshaping::{Dual, Smooth, Triangulate};
pub(crate) use subdivision::{Schemes, Select, Subdivide};
pub(crate) use why::Why;

use crate::many::{Chosen, Shard};

const EXAMPLES: &str = "Examples:
  sixfold                                    study the built-in mesh
  sixfold study bunny.obj                    study your own
  sixfold pick --workload smoothing bunny.obj
  sixfold inspect bunny.obj                  what it is, and which backends can hold it
  sixfold generate geodesic frequency=20 -o ball.obj
  sixfold subdivide --scheme loop --levels 2 bunny.obj -o smooth.obj
  sixfold decimate --ratio 0.1 bunny.obj -o small.obj

Exit codes: 0 done; 1 done, and the answer is no; 2 wrong usage or unusable input;
3 not supported by this backend or scheme; 4 interrupted, finished part kept.";

/// What help on `study` says before the names.
pub(crate) const STUDY_EXAMPLES: &str = "Examples:
  sixfold study bunny.obj
  sixfold study bunny.obj --backends half-edge,face-vertex --operations vv_smooth,build
  sixfold study quads.obj --triangulate --budget 2m
  sixfold study bunny.obj --json - --csv bunny.csv
  sixfold study bunny.obj --external mine='./mine {mesh}'
  sixfold study bunny.obj --report bunny            a page with figures
  sixfold study scans --report results              all OBJ files in a folder; --resume goes on

How it measures: every round runs each operation on each backend, one after the other, in random
order, on the processor time of the thread; the table shows medians. The seed decides that order
and which elements are sampled; how many is decided by the clock. One backend is entered twice: what
its two columns differ by is the noise, and no more than that is a tie. Ctrl-C ends it between two
samples and keeps what is finished. A second Ctrl-C ends it at once, with code 130.

Memory: --heap kept makes freed pages stay with the process, so that no sample pays for fresh ones;
what operations take on fresh pages is shown as `first time`. --heap system leaves that to the
platform's allocator: times of what allocates then depend on what ran before. With --caches cold
each sample is one run, after the caches were filled with other data. `compare` and `merge` refuse
to mix results of different heaps or caches.

Exit codes: 0 done; 1 backends found different results, a fault in Sixfold, or another program
did; 2 wrong usage or unusable input; 3 no backend asked for can hold the mesh; 4 interrupted,
finished part kept.";

const MERGE_EXAMPLES: &str = "Examples:
  sixfold study scans --shard 1/2 --report one      on one machine
  sixfold study scans --shard 2/2 --report two      on another
  sixfold merge one two --report all

Shards are of the same meshes, by name, and were made with the same settings; a mesh that several
have is taken from the first.

Exit codes: 0 done; 1 backends found different results, a fault in Sixfold; 2 wrong usage, or
shards that do not belong together.";

const REPORT_EXAMPLES: &str = "Examples:
  sixfold growth --to 4000000 --budget 5m --json growth.json
  sixfold report growth.json --to growth
  sixfold report results pick.json orders.json --to all

Exit codes: 0 done; 2 wrong usage, or a file that is no result, was cut off, or has another schema.";

const INSPECT_EXAMPLES: &str = "Examples:
  sixfold inspect bunny.obj
  sixfold inspect bunny.obj --json -         for machines

Exit codes: 0 done; 2 wrong usage or unusable input; 4 interrupted.";

/// Which mesh data structure fits this mesh and this workload? Measured, with evidence.
///
/// Builds every backend from the same mesh, runs the same operations on each and compares.
/// Without a command it studies a built-in mesh of about 20,000 triangles for about 20 seconds.
#[derive(Debug, Parser)]
#[command(name = "sixfold", version, after_help = EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Measure what each backend costs for a mesh
    Study(Study),
    /// Say which backend fits a mesh and a workload
    Pick(Pick),
    /// List the built-in workloads, and who does this
    Workloads(Workloads),
    /// Say what queries read, and whether that is what they take their time for
    Why(Why),
    /// Measure what the order of a mesh in memory costs each backend
    Orders(Orders),
    /// Measure how the cost of each backend grows with the mesh
    Growth(Growth),
    /// Put the shards of a study of many meshes together
    Merge(Merge),
    /// Draw results that were written before, on one page
    Report(Draw),
    /// Say what changed between two studies, beyond noise
    Compare(Compare),
    /// Say what a mesh is, and which backends can hold it
    Inspect(Inspect),
    /// Say what each backend takes in memory, counted in three ways that must agree
    Memory(Memory),
    /// Write a built-in shape
    Generate(Generate),
    /// Say what subdivision schemes there are, and what runs on which backend
    Schemes(Schemes),
    /// Refine a mesh by a subdivision scheme
    Subdivide(Subdivide),
    /// Move vertices towards their neighbours
    Smooth(Smooth),
    /// Make a vertex of each face, and a face of each vertex
    Dual(Dual),
    /// Cut polygons into triangles
    Triangulate(Triangulate),
    /// Say what edits each backend offers, and how much of the mesh they look at
    Edits(Edits),
    /// Make a mesh coarser: collapse edges, the least harmful first
    Decimate(Decimate),
    /// Make all edges about as long as asked, and all triangles about regular
    Remesh(Remesh),
    /// Draw meshes with their edges and creases, as PNG or SVG
    Render(Render),
}

/// Measure what each backend costs for a mesh.
///
/// Prints the mesh in facts, who can hold it, and for each backend the time of every operation and
/// the bytes for each vertex.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Study {
    /// The mesh, an OBJ file; or several, or folders; without any a built-in one
    #[arg(value_name = "FILE.obj|DIR")]
    pub(crate) meshes: Vec<PathBuf>,
    /// Only these backends, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = backend)]
    pub(crate) backends: Vec<String>,
    /// Only these operations, by name
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = operation)]
    pub(crate) operations: Vec<Operation>,
    /// How long to measure each mesh: 20s, 500ms, 2m
    #[arg(long, value_name = "TIME", default_value = "20s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) budget: Duration,
    /// What decides the order, and which elements are sampled
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    #[command(flatten)]
    pub(crate) memory: MemoryState,
    /// Another program as one more column; may be given again
    #[arg(long = "external", value_name = "NAME=COMMAND")]
    pub(crate) externals: Vec<External>,
    /// How long such a program may take for one answer
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = duration, allow_hyphen_values = true)]
    pub(crate) patience: Duration,
    /// Cut every polygon into a fan of triangles first
    #[arg(long)]
    pub(crate) triangulate: bool,
    /// Refuse a file with degenerate faces instead of leaving them out
    #[arg(long)]
    pub(crate) strict: bool,
    /// Write everything as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Write one line for each result as CSV (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Write report.html, report.md, results.json and results.csv there
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Of one mesh: orders,growth,why, or none, or all (if not given)
    #[arg(long, value_name = "NAME,…", requires = "report")]
    pub(crate) labs: Option<Chosen>,
    /// Go on with what --report has in its folder
    #[arg(long, requires = "report")]
    pub(crate) resume: bool,
    /// Only every n-th mesh, from the i-th on: for `sixfold merge`
    #[arg(long, value_name = "i/n", requires = "report")]
    pub(crate) shard: Option<Shard>,
}

/// What is done to freed pages and to the caches while times are measured.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct MemoryState {
    /// Freed pages: kept by this process, or system
    #[arg(long, value_name = "POLICY", default_value = "kept")]
    pub(crate) heap: Policy,
    /// Caches before each sample: warm or cold
    #[arg(long, value_name = "STATE", default_value = "warm", value_parser = cache_state)]
    pub(crate) caches: CacheState,
}

fn cache_state(name: &str) -> Result<CacheState, String> {
    let mut all = CacheState::ALL.into_iter();
    all.find(|state| state.name() == name)
        .ok_or_else(|| format!("there is no cache state `{name}`: choose `warm` or `cold`"))
}

/// Put the shards of a study of many meshes together.
#[derive(Debug, Args)]
#[command(after_help = MERGE_EXAMPLES)]
pub(crate) struct Merge {
    /// What `sixfold study --shard i/n --report DIR` wrote
    #[arg(value_name = "DIR|FILE.json", required = true)]
    pub(crate) shards: Vec<PathBuf>,
    /// Write report.html, report.md, results.json and results.csv there
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Write results.json as this file (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// Draw results that were written before, on one page.
///
/// Results of `study`, `orders`, `growth`, `why` and `pick`, of one or of all of them; one study at
/// most. Measures nothing.
#[derive(Debug, Args)]
#[command(after_help = REPORT_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Draw {
    /// What --json wrote, or the folder of --report
    #[arg(value_name = "FILE.json|DIR", required = true)]
    pub(crate) results: Vec<PathBuf>,
    /// Write report.html, report.md and figures there
    #[arg(long, value_name = "DIR")]
    pub(crate) to: PathBuf,
}

impl Default for Study {
    fn default() -> Self {
        let settings = ::study::Settings::default();
        Self {
            meshes: Vec::new(),
            backends: Vec::new(),
            operations: Vec::new(),
            budget: settings.budget,
            seed: settings.seed,
            memory: MemoryState::default(),
            externals: Vec::new(),
            patience: settings.patience,
            triangulate: false,
            strict: false,
            json: None,
            csv: None,
            report: None,
            labs: None,
            resume: false,
            shard: None,
        }
    }
}

/// Say what a mesh is, and which backends can hold it.
///
/// Measures nothing. Faces that name a vertex twice, or have fewer than three corners, are counted.
#[derive(Debug, Args)]
#[command(after_help = INSPECT_EXAMPLES, verbatim_doc_comment)]
pub(crate) struct Inspect {
    /// The mesh, an OBJ file
    #[arg(value_name = "FILE.obj")]
    pub(crate) mesh: PathBuf,
    /// Write the facts and verdicts as JSON (- for standard output)
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

/// Write a built-in shape.
#[derive(Debug, Args)]
pub(crate) struct Generate {
    /// The shape: see the list below
    #[arg(value_name = "SHAPE")]
    pub(crate) shape: String,
    /// Its parameters
    #[arg(value_name = "name=value", value_parser = setting)]
    pub(crate) settings: Vec<(String, f64)>,
    /// Its order: given, shuffled, morton, breadth-first
    #[arg(long, value_name = "ORDER", default_value = "given")]
    pub(crate) order: Order,
    /// What decides the order `shuffled`
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Where to write it (- for standard output)
    #[arg(short, long, value_name = "FILE.obj")]
    pub(crate) output: PathBuf,
}

fn backend(name: &str) -> Result<String, String> {
    let settings = ::study::Settings {
        backends: vec![name.trim().into()],
        ..Default::default()
    };
    match settings.chosen_backends() {
        Ok(_) => Ok(name.trim().into()),
        Err(error) => Err(error.to_string()),
    }
}

fn operation(name: &str) -> Result<Operation, String> {
    let parsed: Result<Operation, _> = name.trim().parse();
    parsed.map_err(|error| error.to_string())
}

/// `20s`, `500ms`, `2m`: more than nothing, and at most a week.
fn duration(text: &str) -> Result<Duration, String> {
    const LONGEST_S: f64 = 7.0 * 24.0 * 3600.0;
    let units = [("ms", 1e-3), ("s", 1.0), ("m", 60.0)];
    let parsed = units.into_iter().find_map(|(unit, seconds)| {
        let number: f64 = text.strip_suffix(unit)?.parse().ok()?;
        Some(number * seconds)
    });
    match parsed {
        Some(seconds) if seconds > 0.0 && seconds <= LONGEST_S => {
            Ok(Duration::from_secs_f64(seconds))
        }
        Some(_) => Err("a budget is more than nothing and at most a week".into()),
        None => Err("write a budget as 20s, 500ms or 2m".into()),
    }
}

fn seed(text: &str) -> Result<u64, String> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| format!("a seed is a whole number from 0 to {}", u64::MAX))
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
    fn the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn budgets_have_a_unit_and_are_more_than_nothing() {
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
