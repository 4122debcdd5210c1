//! Output of data to files or to standard output. A file is written completely or not at all.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use crate::command::failure::Failure;

/// Drafts that are not renamed or deleted yet. A thread must hold the lock to rename or delete a
/// draft.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file or standard output. It is opened before the work begins, so that an unusable path gives
/// an error at once.
///
/// Data is written to a draft, which is a file with a temporary name in the same folder. The draft
/// is renamed when it is complete. If the program ends earlier, the old file is unchanged.
pub struct Output {
    shown: String,
    target: Target,
}

enum Target {
    Stdout,
    /// A device or pipe. It is written without a draft.
    Stream(File),
    File {
        file: File,
        draft: PathBuf,
        path: PathBuf,
    },
}

pub fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Returns whether an option writes to standard output.
pub fn uses_stdout(outputs: &[(&str, Option<&PathBuf>)]) -> bool {
    let mut paths = outputs.iter().filter_map(|(_, path)| *path);
    paths.any(|path| is_stdout(path))
}

/// Returns an error if an output would overwrite `input`. `what` describes the input.
pub fn check_not_overwritten(
    what: &str,
    input: &Path,
    outputs: &[(&str, Option<&PathBuf>)],
) -> Result<(), Failure> {
    let input_path = canonical_path(input);
    for &(option, path) in outputs {
        let Some(path) = path else { continue };
        if canonical_path(path) == input_path && !is_stdout(path) {
            return Err(Failure::usage(format!(
                "{option} would overwrite {what} {}: choose another file",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Returns an error if two outputs have the same path, or if an output would overwrite the mesh.
pub fn check_outputs(
    mesh: Option<&Path>,
    outputs: &[(&str, Option<&PathBuf>)],
) -> Result<(), Failure> {
    if let Some(mesh) = mesh {
        check_not_overwritten("the mesh", mesh, outputs)?;
    }
    let given = outputs
        .iter()
        .filter_map(|&(option, path)| Some((option, path?)));
    let mut taken: Vec<(&str, PathBuf)> = Vec::new();
    for (option, path) in given {
        let (place, shown) = (canonical_path(path), path.display());
        if let Some((other, _)) = taken.iter().find(|(_, taken)| *taken == place) {
            return Err(Failure::usage(format!(
                "{other} and {option} both write to {shown}: choose two different files"
            )));
        }
        taken.push((option, place));
    }
    Ok(())
}

/// Returns the same path for all spellings of the path of a file. The file need not exist.
fn canonical_path(path: &Path) -> PathBuf {
    let canonical = || {
        if is_stdout(path) {
            return None;
        }
        if let Ok(existing) = fs::canonicalize(path) {
            return Some(existing);
        }
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let folder = fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
        Some(folder.join(path.file_name()?))
    };
    canonical().unwrap_or_else(|| path.to_owned())
}

/// Deletes all drafts and ends the program. A signal handler can call this function.
pub fn exit_without_drafts(code: i32) -> ! {
    // Hold the lock to the end, so that no draft is renamed or created.
    let drafts = drafts();
    for draft in drafts.iter() {
        let _ = fs::remove_file(draft);
    }
    exit(code)
}

fn drafts() -> MutexGuard<'static, Vec<PathBuf>> {
    DRAFTS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Output {
    /// Opens `path`. The path `-` is standard output.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        if is_stdout(path) {
            return Ok(Self {
                shown: "standard output".into(),
                target: Target::Stdout,
            });
        }
        let failed = |cause: io::Error| cannot_write(&shown, &cause);
        // If `path` is a link, replace its target, not the link.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let target = match fs::metadata(&path) {
            Ok(metadata) if metadata.is_dir() => {
                let message = format!("{shown}: is a directory: name a file inside it");
                return Err(Failure::usage(message));
            }
            Ok(metadata) if !metadata.is_file() => {
                Target::Stream(File::options().write(true).open(&path).map_err(failed)?)
            }
            old => {
                if old.is_ok() {
                    // A file without write permission must not be replaced.
                    File::options().write(true).open(&path).map_err(failed)?;
                }
                let draft = draft_path(&path);
                let mut drafts = drafts();
                let file = File::create(&draft).map_err(failed)?;
                drafts.push(draft.clone());
                drop(drafts);
                let target = Target::File { file, draft, path };
                let output = Self { shown, target };
                if let (Ok(old), Target::File { file, .. }) = (old, &output.target) {
                    // Set the permissions before writing, so that only users with access to the old
                    // file can read the new file.
                    let set = file.set_permissions(old.permissions());
                    set.map_err(|cause| output.failure(&cause))?;
                }
                return Ok(output);
            }
        };
        Ok(Self { shown, target })
    }

    pub fn open_if(path: Option<&PathBuf>) -> Result<Option<Self>, Failure> {
        path.map(|path| Self::open(path)).transpose()
    }

    /// Writes `value` as JSON, with a line break at the end.
    pub fn write_json(self, value: &impl Serialize) -> Result<(), Failure> {
        self.finish(|writer| {
            serde_json::to_writer_pretty(&mut *writer, value)?;
            writeln!(writer)
        })
    }

    /// Writes the data with `write`, then renames the draft.
    pub fn finish(
        mut self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let done = match &mut self.target {
            Target::Stdout => written(io::stdout().lock(), write),
            Target::Stream(file) => written(file, write),
            Target::File { file, draft, path } => written(file, write).and_then(|()| {
                let _lock = drafts();
                fs::rename(draft, path)
            }),
        };
        match done {
            // It is not an error if the reader of standard output closes it early.
            Err(cause) if cause.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            // An error of the system has an error number. An error without a number is a fault of
            // the mesh, not of the path.
            Err(cause)
                if cause.kind() == io::ErrorKind::InvalidInput
                    && cause.raw_os_error().is_none() =>
            {
                Err(Failure::usage(format!(
                    "{}: not written, {cause}: scale the mesh down, because coordinates have 32 bits",
                    self.shown
                )))
            }
            Err(cause) => Err(self.failure(&cause)),
            Ok(()) => Ok(()),
        }
    }

    fn failure(&self, cause: &io::Error) -> Failure {
        cannot_write(&self.shown, cause)
    }
}

impl Drop for Output {
    /// Deletes a draft that was not renamed.
    fn drop(&mut self) {
        if let Target::File { draft, .. } = &self.target {
            let mut drafts = drafts();
            let _ = fs::remove_file(draft);
            drafts.retain(|other| other != draft);
        }
    }
}

/// Returns the failure for an output that cannot be written.
pub fn cannot_write(shown: &str, cause: &io::Error) -> Failure {
    Failure::usage(format!(
        "{shown}: cannot be written ({cause}): choose another file"
    ))
}

fn written(to: impl Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut to = BufWriter::new(to);
    write(&mut to)?;
    to.flush()
}

/// Returns a name in the folder of `path` that no other run uses.
fn draft_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.draft", std::process::id()));
    path.with_file_name(name)
}
