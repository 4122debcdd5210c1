//! Data for machines: whole files or none, or standard output.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// A place for data, opened before the work begins so that nobody waits for a failure.
///
/// A file is written under another name beside it and takes its own when it is complete; if that
/// never comes, what was there before is still there.
pub(crate) struct Output {
    shown: String,
    target: Target,
}

enum Target {
    Stdout,
    /// A device or pipe: nothing that could be kept.
    Stream(File),
    File {
        file: File,
        draft: PathBuf,
        path: PathBuf,
    },
}

/// Whether `path` means standard output.
pub(crate) fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

impl Output {
    /// Opens `path`, or standard output for `-`.
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let failed = |cause: io::Error| {
            Failure::usage(format!(
                "{shown}: cannot be written ({cause}): choose another place"
            ))
        };
        if is_stdout(path) {
            let target = Target::Stdout;
            return Ok(Self { shown, target });
        }
        // A link stays a link: what it points at is replaced.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let target = match fs::metadata(&path) {
            Ok(there) if there.is_dir() => {
                let message = format!("{shown}: is a directory: name a file in it");
                return Err(Failure::usage(message));
            }
            Ok(there) if !there.is_file() => {
                Target::Stream(File::options().write(true).open(&path).map_err(failed)?)
            }
            _ => {
                let draft = draft_of(&path);
                let file = File::create(&draft).map_err(failed)?;
                Target::File { file, draft, path }
            }
        };
        Ok(Self { shown, target })
    }

    /// Opens `path` if there is one.
    pub(crate) fn open_if(path: Option<&PathBuf>) -> Result<Option<Self>, Failure> {
        path.map(|path| Self::open(path)).transpose()
    }

    /// Writes it all with `write`, and gives the file its name.
    pub(crate) fn finish(
        mut self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let done = match &mut self.target {
            Target::Stdout => written(io::stdout().lock(), write),
            Target::Stream(file) => written(file, write),
            Target::File { file, draft, path } => {
                written(file, write).and_then(|()| fs::rename(draft, path))
            }
        };
        match done {
            // Whoever read standard output has seen enough.
            Err(cause) if cause.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            Err(cause) => {
                let shown = &self.shown;
                let message = format!("{shown}: cannot be written ({cause}): choose another place");
                Err(Failure::usage(message))
            }
            Ok(()) => Ok(()),
        }
    }
}

impl Drop for Output {
    /// Clears the draft away, unless it has become the file.
    fn drop(&mut self) {
        if let Target::File { draft, .. } = &self.target {
            let _ = fs::remove_file(draft);
        }
    }
}

fn written(to: impl Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut to = BufWriter::new(to);
    write(&mut to)?;
    to.flush()
}

/// A name beside `path` that no other run uses.
fn draft_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.draft", std::process::id()));
    path.with_file_name(name)
}
