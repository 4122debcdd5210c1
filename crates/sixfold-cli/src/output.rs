//! Data for machines: whole files or none, or standard output.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::failure::Failure;

/// Drafts that are neither files yet nor cleared away. Whoever holds the lock decides about them.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

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

/// Refuses an output in the place of an input, which is `what`.
pub(crate) fn check_kept(
    what: &str,
    input: &Path,
    outputs: &[(&str, Option<&PathBuf>)],
) -> Result<(), Failure> {
    let kept = place(input);
    for &(option, path) in outputs {
        let Some(path) = path else { continue };
        if place(path) == kept && !is_stdout(path) {
            return Err(Failure::usage(format!(
                "{option} would overwrite {what} {}: name another place",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Refuses two outputs to one place, and an output in the place of the mesh.
pub(crate) fn check_places(
    mesh: Option<&Path>,
    outputs: &[(&str, Option<&PathBuf>)],
) -> Result<(), Failure> {
    if let Some(mesh) = mesh {
        check_kept("the mesh", mesh, outputs)?;
    }
    let asked = outputs
        .iter()
        .filter_map(|&(option, path)| Some((option, path?)));
    let mut taken: Vec<(&str, PathBuf)> = Vec::new();
    for (option, path) in asked {
        let (place, shown) = (place(path), path.display());
        if let Some((other, _)) = taken.iter().find(|(_, there)| *there == place) {
            return Err(Failure::usage(format!(
                "{other} and {option} both write to {shown}: name two places"
            )));
        }
        taken.push((option, place));
    }
    Ok(())
}

/// One name for a file, however it is written, and whether or not it is there.
fn place(path: &Path) -> PathBuf {
    let known = || {
        if is_stdout(path) {
            return None;
        }
        if let Ok(there) = fs::canonicalize(path) {
            return Some(there);
        }
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let folder = fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
        Some(folder.join(path.file_name()?))
    };
    known().unwrap_or_else(|| path.to_owned())
}

/// Clears all drafts away and ends the program: what a signal may call while others write.
pub(crate) fn exit_without_drafts(code: i32) -> ! {
    // Held to the end, so that no draft becomes a file or begins meanwhile.
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
    /// Opens `path`, or standard output for `-`.
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        if is_stdout(path) {
            return Ok(Self {
                shown: "standard output".into(),
                target: Target::Stdout,
            });
        }
        let failed = |cause: io::Error| cannot_write(&shown, &cause);
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
            old => {
                if old.is_ok() {
                    // A file that may not be written may not be replaced either.
                    File::options().write(true).open(&path).map_err(failed)?;
                }
                let draft = draft_of(&path);
                let mut drafts = drafts();
                let file = File::create(&draft).map_err(failed)?;
                drafts.push(draft.clone());
                drop(drafts);
                let target = Target::File { file, draft, path };
                let output = Self { shown, target };
                if let (Ok(old), Target::File { file, .. }) = (old, &output.target) {
                    // Before there is anything to read: who might not read the old may not read this.
                    let kept = file.set_permissions(old.permissions());
                    kept.map_err(|cause| output.failure(&cause))?;
                }
                return Ok(output);
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
            Target::File { file, draft, path } => written(file, write).and_then(|()| {
                let _held = drafts();
                fs::rename(draft, path)
            }),
        };
        match done {
            // Whoever read standard output has seen enough.
            Err(cause) if cause.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            // No fault of the place, but of the mesh; what the system refuses has its own number.
            Err(cause)
                if cause.kind() == io::ErrorKind::InvalidInput
                    && cause.raw_os_error().is_none() =>
            {
                Err(Failure::usage(format!(
                    "{}: not written, {cause}: scale the mesh down, coordinates are 32 bits",
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
    /// Clears the draft away, unless it has become the file.
    fn drop(&mut self) {
        if let Target::File { draft, .. } = &self.target {
            let mut drafts = drafts();
            let _ = fs::remove_file(draft);
            drafts.retain(|other| other != draft);
        }
    }
}

/// The failure of writing to the place `shown`.
pub(crate) fn cannot_write(shown: &str, cause: &io::Error) -> Failure {
    Failure::usage(format!(
        "{shown}: cannot be written ({cause}): choose another place"
    ))
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
