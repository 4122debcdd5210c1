//! The commands of a lesson, which run in a folder of their own.

use std::fs;
use std::path::Path;
use std::process::{Command, Output as Ran};

use serde_json::Value;

use super::answers::Asked;
use super::source::{Ask, Expected, Kind, Shown};
use crate::failure::Failure;
use crate::output::cannot_write;
use crate::text::WIDTH;

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
        let run = self.start(command.line, &[], width)?;
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

    fn start(&self, line: &str, more: &[&str], width: usize) -> Result<Ran, Failure> {
        let words = shlex::split(line).unwrap_or_default();
        let program = std::env::current_exe().map_err(|cause| cannot_write("a lesson", &cause))?;
        Command::new(program)
            .args(words.iter().skip(1))
            .args(more)
            .current_dir(self.path())
            .env("COLUMNS", width.to_string())
            .output()
            .map_err(|cause| cannot_write("a lesson", &cause))
    }

    /// Works out the right value of what a question asks for.
    pub(super) fn asked(&self, ask: &Ask<'_>) -> Result<Asked, Failure> {
        let label = ask.label.to_owned();
        let (line, path) = match ask.expected {
            Expected::Choice(options) => return Ok(Asked::choice(label, options)),
            Expected::Computed { line, path } => (line, path),
        };
        let ran = self.start(line, &["--json", "-"], WIDTH)?;
        let document: Value = serde_json::from_slice(&ran.stdout).map_err(|_| {
            let error = String::from_utf8_lossy(&ran.stderr);
            Failure::usage(format!("{line}: {error}"))
        })?;
        Asked::computed(label, &document, path)
            .ok_or_else(|| Failure::usage(format!("{line}: it has no value at {path}")))
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
