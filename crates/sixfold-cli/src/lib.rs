//! The `sixfold` command, and a command line for programs of users.
//!
//! [`main`] makes a command line from programs that are generic over the mesh type. The command
//! line measures the programs on every structure that can hold the mesh, and ranks the structures:
//!
//! ```no_run
//! use std::process::ExitCode;
//!
//! use sixfold::MeshQuery;
//! use sixfold_study::{Outcome, Program};
//!
//! /// Adds up the lengths of all edges.
//! struct TotalLength;
//!
//! impl Program for TotalLength {
//!     type Scratch<M: MeshQuery> = ();
//!
//!     fn name(&self) -> &str {
//!         "total-length"
//!     }
//!
//!     fn set_up<M: MeshQuery>(&self, _: &M) -> Result<(), String> {
//!         Ok(())
//!     }
//!
//!     fn run<M: MeshQuery>(&self, mesh: &M, (): &mut ()) -> Outcome {
//!         let length = |e| {
//!             let [a, b] = mesh.edge_vertices(e).map(|v| mesh.position(v));
//!             f64::from(a.distance(b))
//!         };
//!         let total = mesh.edges().map(length).sum();
//!         Outcome::new(total, mesh.edge_count() as u64)
//!     }
//! }
//!
//! fn main() -> ExitCode {
//!     sixfold_cli::main(TotalLength)
//! }
//! ```
//!
//! Only this crate handles arguments, standard output and exit codes:
//!
//! | code | means |
//! |---|---|
//! | 0 | success |
//! | 1 | negative answer: no backend qualifies, a figure is slower, results differ, a part cannot be measured (see `--keep-going`), or a file does not keep a repair |
//! | 2 | wrong usage or unusable input |
//! | 3 | not supported: none of the selected backends can hold the mesh |
//! | 4 | interrupted; finished results are kept |

mod arguments;
mod baselines;
mod column_table;
mod compare;
mod convert;
mod distance;
mod edits;
mod facts_text;
mod failure;
mod faults_text;
mod files;
mod free_memory;
mod generate;
mod growth;
mod help;
mod history;
mod inspect;
mod launches;
mod left_out;
mod listed_folder;
mod load;
mod many;
mod measure;
mod memory;
mod mesh_files;
mod mesh_picture;
mod neighbours;
mod new;
mod operations;
mod orders;
mod output;
mod paper;
mod pick;
mod programs;
mod progress;
mod remesh;
mod render;
mod repair;
mod rerun;
mod reshape;
mod results_table;
mod schemes;
mod seams;
mod shape_check;
mod signs;
mod study;
mod subdivide;
mod tables;
mod teaching;
mod text;
mod triangulate;
mod why;
mod why_text;
mod workloads;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::FromArgMatches;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use sixfold::io::Format;
use sixfold_study::{AllocationCounter, Heap, Suite};

use arguments::{Arguments, Command};
use failure::Failure;

/// Runs the command line of `programs`: a [`Program`](sixfold_study::Program), or a [`Suite`] of
/// several programs.
///
/// The command line measures each program on each structure that can hold the meshes of the
/// arguments. The option `--help` describes the arguments.
pub fn main(programs: impl Into<Suite>) -> ExitCode {
    launches::note_start();
    exit_code(programs::run(programs.into()))
}

/// Counters of the allocator of the process.
#[doc(hidden)]
pub trait AllocatorCounters: Heap + AllocationCounter {}

impl<C: Heap + AllocationCounter> AllocatorCounters for C {}

/// Runs the command `sixfold`.
#[doc(hidden)]
pub fn sixfold(counters: &dyn AllocatorCounters) -> ExitCode {
    launches::note_start();
    let matches = help::definition().try_get_matches_from(words());
    let arguments = matches.and_then(|matches| Arguments::from_arg_matches(&matches));
    let done = match arguments.map(|arguments| arguments.command) {
        Err(error) => print_clap_message(error),
        Ok(None) => study::run(&arguments::Study::default()),
        Ok(Some(Command::Study(arguments))) => study::run(&arguments),
        Ok(Some(Command::Pick(arguments))) => pick::run(&arguments),
        Ok(Some(Command::Workloads(arguments))) => workloads::run(&arguments),
        Ok(Some(Command::Operations(arguments))) => operations::run(&arguments),
        Ok(Some(Command::Why(arguments))) => why::run(&arguments),
        Ok(Some(Command::Tables(arguments))) => teaching::tables::run(&arguments),
        Ok(Some(Command::Lessons(arguments))) => teaching::lessons::run(&arguments),
        Ok(Some(Command::Explore(arguments))) => teaching::explore::run(&arguments),
        Ok(Some(Command::Trace(arguments))) => teaching::trace::run(&arguments),
        Ok(Some(Command::Orders(arguments))) => orders::run(&arguments),
        Ok(Some(Command::Growth(arguments))) => growth::run(&arguments),
        Ok(Some(Command::Merge(arguments))) => many::merge(&arguments),
        Ok(Some(Command::Report(arguments))) => many::draw(&arguments),
        Ok(Some(Command::Compare(arguments))) => compare::run(&arguments),
        Ok(Some(Command::History(arguments))) => history::run(&arguments),
        Ok(Some(Command::Rerun(arguments))) => rerun::run(&arguments),
        Ok(Some(Command::Inspect(arguments))) => inspect::run(&arguments),
        Ok(Some(Command::Distance(arguments))) => distance::run(&arguments),
        Ok(Some(Command::Neighbours(arguments))) => neighbours::run(&arguments),
        Ok(Some(Command::Memory(arguments))) => memory::run(&arguments, counters),
        Ok(Some(Command::Generate(arguments))) => generate::run(&arguments),
        Ok(Some(Command::Schemes(arguments))) => schemes::run(&arguments),
        Ok(Some(Command::Subdivide(arguments))) => subdivide::run(&arguments),
        Ok(Some(Command::Smooth(arguments))) => reshape::smooth(&arguments),
        Ok(Some(Command::Dual(arguments))) => reshape::make_dual(&arguments),
        Ok(Some(Command::Triangulate(arguments))) => reshape::triangulate(&arguments),
        Ok(Some(Command::Edits(arguments))) => edits::run(&arguments),
        Ok(Some(Command::Decimate(arguments))) => remesh::decimate(&arguments),
        Ok(Some(Command::Remesh(arguments))) => remesh::remesh(&arguments),
        Ok(Some(Command::Convert(arguments))) => convert::run(&arguments),
        Ok(Some(Command::Repair(arguments))) => repair::run(&arguments),
        Ok(Some(Command::Render(arguments))) => render::run(&arguments),
        Ok(Some(Command::New(arguments))) => new::run(&arguments),
        Ok(Some(Command::Completions(arguments))) => help::completions(&arguments),
        Ok(Some(Command::Manual(arguments))) => help::manual(&arguments),
    };
    exit_code(done)
}

/// Prints the message of a failure, and returns the exit code.
fn exit_code(done: Result<ExitCode, Failure>) -> ExitCode {
    match done {
        Ok(code) => code,
        Err(Failure { code, message }) => {
            text::print_stderr(&format!("error: {message}"));
            ExitCode::from(code)
        }
    }
}

/// Returns the words of the command line. `help --help` means `help`, which clap does not know.
fn words() -> Vec<OsString> {
    let mut words: Vec<OsString> = std::env::args_os().collect();
    if words.get(1).is_some_and(|word| word == "help") {
        words.retain(|word| word != "--help" && word != "-h");
    }
    arguments::joined_values(words)
}

/// Prints the message of clap: the help, the version, or an error in the arguments.
fn print_clap_message(mut error: clap::Error) -> Result<ExitCode, Failure> {
    if let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(word))) =
        (error.kind(), error.get(ContextKind::InvalidSubcommand))
    {
        if Format::from_path(word).is_none() {
            return Err(help::unknown_command(word));
        }
        let file = text::shell_word(Path::new(word));
        return Err(Failure::usage(format!(
            "`{word}` is a file, not a command: did you mean `sixfold study {file}`?"
        )));
    }
    let words = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
    let words: Vec<String> = words.collect();
    if let (ErrorKind::UnknownArgument, Some(ContextValue::String(option))) =
        (error.kind(), error.get(ContextKind::InvalidArg))
        && let Some(failure) = help::option_of_others(option, &words)
    {
        return Err(failure);
    }
    if error.use_stderr() && words.iter().any(|word| text::sanitize(word) != *word) {
        // The message repeats the arguments. Escape control characters, so that arguments cannot
        // control the terminal.
        if let Some(ContextValue::String(value)) = error.get(ContextKind::InvalidValue) {
            let value = ContextValue::String(text::sanitize(value));
            error.insert(ContextKind::InvalidValue, value);
        }
        let plain = error.render().to_string();
        plain.lines().for_each(text::print_stderr);
        return Ok(ExitCode::from(2));
    }
    let printed = error.print().and_then(|()| io::stdout().flush());
    match error.exit_code() {
        0 => text::ignore_closed_pipe(printed).map(|()| ExitCode::SUCCESS),
        _ => Ok(ExitCode::from(2)),
    }
}

/// The examples of the README, which are compiled and run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct ReadmeExamples;

#[cfg(doctest)]
#[doc = include_str!("../../../reports/guide/your-own-program.md")]
struct GuideExamples;
