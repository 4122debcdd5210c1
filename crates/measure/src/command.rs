//! The command line of programs, and what the command `sixfold` shares with it.

pub mod answer;
pub mod arguments;
pub mod column_table;
pub mod failure;
pub mod free_memory;
pub mod launches;
pub mod load;
pub mod mesh_files;
pub mod meshes;
mod order;
pub mod output;
pub mod programs;
pub mod progress;
mod record;
pub mod run;
pub mod signs;
pub mod text;
pub mod triangulate;

use std::process::ExitCode;

use failure::Failure;

/// Prints the message of a failure, and returns the exit code.
pub fn exit_code(done: Result<ExitCode, Failure>) -> ExitCode {
    match done {
        Ok(code) => code,
        Err(Failure { code, message }) => {
            text::print_stderr(&format!("error: {message}"));
            ExitCode::from(code)
        }
    }
}
