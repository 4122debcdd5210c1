//! The `sixfold` command.
//!
//! Only this crate, and the command line of programs in `sixfold-measure`, handle arguments, standard output and exit
//! codes:
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
mod compare;
mod convert;
mod distance;
mod edits;
mod facts_text;
mod faults_text;
mod files;
mod generate;
mod growth;
mod help;
mod history;
mod inspect;
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
mod paper;
mod pick;
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
mod shell;
mod signs;
mod study;
mod subdivide;
mod tables;
mod teaching;
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
use sixfold_study::{AllocationCounter, Heap};

// What the command line of programs has too.
use sixfold_measure::command::{
    column_table, exit_code, failure, free_memory, launches, output, text, triangulate,
};

use arguments::{Arguments, Command};
use failure::Failure;

/// Counters of the allocator of the process.
#[doc(hidden)]
pub trait AllocatorCounters: Heap + AllocationCounter {}

impl<C: Heap + AllocationCounter> AllocatorCounters for C {}

/// Runs the command `sixfold`.
#[doc(hidden)]
pub fn sixfold(counters: &dyn AllocatorCounters) -> ExitCode {
    launches::note_start();
    sixfold_study::note_commit();
    let width =
        |size: Option<(terminal_size::Width, _)>| size.map(|(width, _)| usize::from(width.0));
    text::set_terminals([
        width(terminal_size::terminal_size_of(io::stdout())),
        width(terminal_size::terminal_size_of(io::stderr())),
    ]);
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
        let file = shell::shell_word(Path::new(word));
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
