//! A folder with a list of the files of this program: `--figures`, and the report of a comparison.
//!
//! The list, `sixfold-files.txt`, shows which files belong to this program. Only these files are
//! replaced, and those that are no longer written are removed.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use sixfold_report::PaperFile;

use crate::failure::Failure;
use crate::output::{Output, cannot_write};

/// The file with the names of the files of this program, one in each line.
const LIST: &str = "sixfold-files.txt";

pub(crate) struct ListedFolder {
    path: PathBuf,
    /// The names of the files of an earlier run.
    old: Vec<String>,
}

impl ListedFolder {
    /// Opens or creates the folder. Returns an error if the folder has files, but no list of files of
    /// this program.
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let failed = |cause: io::Error| cannot_write(&shown, &cause);
        fs::create_dir_all(path).map_err(failed)?;
        let old = match fs::read_to_string(path.join(LIST)) {
            Ok(list) => list.lines().map(str::to_owned).collect(),
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
                if fs::read_dir(path).map_err(failed)?.next().is_some() {
                    return Err(Failure::usage(format!(
                        "{shown} has files of others (there is no {LIST}): name a new or an empty folder"
                    )));
                }
                Vec::new()
            }
            Err(cause) => return Err(failed(cause)),
        };
        Ok(Self {
            path: path.into(),
            old,
        })
    }

    pub(crate) fn open_if(path: Option<&PathBuf>) -> Result<Option<Self>, Failure> {
        path.map(|path| Self::open(path)).transpose()
    }

    /// Removes the folder if it is empty.
    pub(crate) fn remove_if_empty(&self) {
        fs::remove_dir(&self.path).ok();
    }

    /// Writes `files`, and removes the files of the earlier run that are no longer written. Names can
    /// have a folder, such as `figures/changes.svg`. Writes nothing if a file of another program would
    /// be replaced.
    pub(crate) fn write(&self, files: Vec<PaperFile>) -> Result<(), Failure> {
        let new: Vec<String> = files.iter().map(|file| file.name.clone()).collect();
        let foreign = new.iter().filter(|name| !self.old.contains(name));
        for name in foreign {
            let path = self.path.join(name);
            if path.exists() {
                return Err(Failure::usage(format!(
                    "{} exists already, but {LIST} does not name it: move the file, or name another folder",
                    path.display()
                )));
            }
        }
        // If writing stops early, the list has the names of all files that may exist.
        let stale = self.old.iter().filter(|name| !new.contains(name));
        let stale: Vec<String> = stale.filter(|name| is_inside(name)).cloned().collect();
        self.write_list(&[&new[..], &stale].concat())?;
        for file in files {
            let path = self.path.join(&file.name);
            if let Some(folder) = path.parent() {
                let failed = |cause: io::Error| cannot_write(&folder.display().to_string(), &cause);
                fs::create_dir_all(folder).map_err(failed)?;
            }
            let output = Output::open(&path)?;
            output.finish(|writer| writer.write_all(&file.bytes))?;
        }
        for name in stale {
            remove(&self.path.join(name))?;
        }
        self.write_list(&new)
    }

    fn write_list(&self, names: &[String]) -> Result<(), Failure> {
        let output = Output::open(&self.path.join(LIST))?;
        output.finish(|writer| names.iter().try_for_each(|name| writeln!(writer, "{name}")))
    }
}

/// Removes a file of this program. It is not an error if the file does not exist.
pub(crate) fn remove(path: &Path) -> Result<(), Failure> {
    match fs::remove_file(path) {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(Failure::usage(format!(
            "{}: cannot be removed ({cause}): check the permissions",
            path.display()
        ))),
        _ => Ok(()),
    }
}

/// Returns whether `name` is a path to a file in this folder or in a folder inside it.
fn is_inside(name: &str) -> bool {
    let mut parts = Path::new(name).components().peekable();
    parts.peek().is_some() && parts.all(|part| matches!(part, Component::Normal(_)))
}
