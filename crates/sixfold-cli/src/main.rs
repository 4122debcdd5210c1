//! The `sixfold` command: which mesh data structure fits this mesh and this workload?
//!
//! Only this crate knows arguments, standard output and exit codes:
//!
//! | code | means |
//! |---|---|
//! | 0 | done |
//! | 1 | done, and the answer is no: backends found different results, a fault in Sixfold |
//! | 2 | wrong usage, or unusable input |
//! | 3 | not supported: no backend asked for can hold the mesh |
//! | 4 | interrupted; the finished part is kept |

mod arguments;
mod facts_text;
mod failure;
mod generate;
mod inspect;
mod load;
mod numbers;
mod output;
mod progress;
mod results_table;
mod study;
mod text;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};

use arguments::{Arguments, Command};
use failure::Failure;

fn main() -> ExitCode {
    // Help lists shapes, backends and operations as the registries have them.
    let command = Arguments::command()
        .mut_subcommand("study", |study| study.after_help(study::help()))
        .mut_subcommand("generate", |generate| generate.after_help(generate::help()));
    let arguments = Arguments::from_arg_matches(&command.get_matches());
    let arguments = arguments.unwrap_or_else(|error| error.exit());
    let done = match arguments.command {
        None => study::run(&arguments::Study::default()),
        Some(Command::Study(arguments)) => study::run(&arguments),
        Some(Command::Inspect(arguments)) => inspect::run(&arguments),
        Some(Command::Generate(arguments)) => generate::run(&arguments),
    };
    match done {
        Ok(code) => code,
        Err(Failure { code, message }) => {
            text::complain(&format!("error: {message}"));
            ExitCode::from(code)
        }
    }
}
