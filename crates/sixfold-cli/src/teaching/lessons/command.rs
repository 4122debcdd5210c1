//! The commands of a lesson, which run in a folder of their own.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::source::{Kind, Shown};
use crate::failure::Failure;
use crate::output::cannot_write;

/// The folder with the files of a lesson.
pub(super) struct Folder(tempfile::TempDir);

impl Folder {
    pub(super) fn new() -> Result<Self, Failure> {
        let folder = tempfile::tempdir().map_err(|cause| cannot_write("a folder", &cause))?;
        Ok(Self(folder))
    }

    pub(super) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(super) fn write(&self, name: &str, content: &str) -> Result<(), Failure> {
        write_file(self.path(), name, content)
    }

    /// Runs a command, and returns what it prints.
    pub(super) fn run(&self, command: Shown<'_>, width: usize) -> Result<String, Failure> {
        let words = shlex::split(command.line).unwrap_or_default();
        let program = std::env::current_exe().map_err(|cause| cannot_write("a lesson", &cause))?;
        let run = Command::new(program)
            .args(words.iter().skip(1))
            .current_dir(self.path())
            .env("COLUMNS", width.to_string())
            .output()
            .map_err(|cause| cannot_write("a lesson", &cause))?;
        // Progress and times are on standard error.
        let printed = match (run.status.success(), command.kind) {
            (true, Kind::Hidden) => Vec::new(),
            (true, _) => run.stdout,
            (false, _) => run.stderr,
        };
        let printed = String::from_utf8_lossy(&printed).into_owned();
        match run.status.success() == (command.kind == Kind::Failure) {
            true => Err(Failure::usage(format!("{}: {printed}", command.line))),
            false => Ok(printed),
        }
    }
}

/// Returns what a trace shows, and its counts: the heading of the trace without the name of the structure. If
/// it shows several edits, the heading is that of the last one. None if the output is no trace of one structure.
pub(super) fn trace_heading(shown: Shown<'_>, printed: &str) -> Option<(String, String)> {
    if !shown.line.starts_with("sixfold trace ") || shown.line.contains("--all") {
        return None;
    }
    let last = printed.rsplit("\n\n\n").next()?;
    let heading = last.split("\n\n").next()?.trim_end().replace('\n', " ");
    let (what, rest) = heading.split(" V − E + F").next()?.split_once(" in ")?;
    let (_, counts) = rest.split_once(": ")?;
    Some((what.to_owned(), counts.to_owned()))
}

pub(super) fn write_file(folder: &Path, name: &str, content: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    fs::write(&path, content).map_err(|cause| cannot_write(&path.display().to_string(), &cause))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heading_of_a_trace_has_its_counts() {
        let kind = Kind::Folded;
        let printed = "flip_edge v0-v2 in half-edge, cube: 7 rows change, 16 reads, 8\nwrites\nV − E + F stays 8\n\n  \
                       halves\n";
        let heading = |line| trace_heading(Shown { line, kind }, printed);
        let expected = ("flip_edge v0-v2", "7 rows change, 16 reads, 8 writes");
        let expected = (expected.0.to_owned(), expected.1.to_owned());
        assert_eq!(heading("sixfold trace --edit"), Some(expected));
        assert_eq!(heading("sixfold trace --all"), None);
        assert_eq!(heading("sixfold tables"), None);
    }
}
