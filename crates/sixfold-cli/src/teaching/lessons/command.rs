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

/// Returns the first paragraph of what a command prints. If it shows several edits, of the last one.
pub(super) fn summary(printed: &str) -> &str {
    let last = printed.rsplit("\n\n\n").next().unwrap_or(printed);
    last.split("\n\n").next().unwrap_or(last).trim_end()
}

pub(super) fn write_file(folder: &Path, name: &str, content: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    fs::write(&path, content).map_err(|cause| cannot_write(&path.display().to_string(), &cause))
}
