//! What all commands that measure do: the command line of the results, and notes.

use std::path::PathBuf;

use sixfold_results::Finding;

use crate::command::text::print_notice;

/// Converts the result of a lab to a finding. Adds the command line, and whether the meshes were
/// triangulated.
pub fn with_command(finding: impl Into<Finding>, triangulate: bool) -> Finding {
    let mut finding = finding.into();
    let run = finding.run_mut();
    run.command = Some(command_line());
    run.settings.triangulate = triangulate;
    finding
}

/// Prints a note if the program was built without optimisation.
pub fn warn_of_debug_build() {
    if cfg!(debug_assertions) {
        print_notice("note: the times of a debug build are not meaningful: build with --release");
    }
}

/// Returns the command line with quotes, so that a shell can run it again.
pub fn command_line() -> String {
    let words = std::env::args_os().skip(1);
    let words = words.map(|word| word.to_string_lossy().into_owned());
    let words: Vec<String> = [executable()].into_iter().chain(words).collect();
    shlex::try_join(words.iter().map(String::as_str)).unwrap_or_else(|_| words.join(" "))
}

/// Returns the name of the running program, such as `sixfold`.
fn executable() -> String {
    let path = std::env::args_os().next().map(PathBuf::from);
    let stem = path.and_then(|path| Some(path.file_stem()?.to_string_lossy().into_owned()));
    stem.unwrap_or_else(|| "sixfold".into())
}
