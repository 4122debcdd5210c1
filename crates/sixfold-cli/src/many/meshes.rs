//! Which meshes: files as they are named, and the OBJ files of folders.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::failure::Failure;

/// One of many meshes.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    /// What it is called in results: its path as given.
    pub(crate) name: String,
    /// Where it is; `None` for the one that is built in.
    pub(crate) path: Option<PathBuf>,
}

/// Every n-th mesh, from the i-th on: the share of one of n jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// Whether mesh `number`, counted from 0, is in it.
    pub(crate) fn has(self, number: usize) -> bool {
        number % self.count == self.index - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    /// `2/8`: the second of eight.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let parsed =
            parts.and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        match parsed {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err(format!(
                "write a shard as i/n, from 1/n to n/n, not `{text}`"
            )),
        }
    }
}

/// The meshes that `places` name: a file is itself, a folder its OBJ files and those of its folders, by
/// name. Each once, in that order; without any the one that is built in.
pub(crate) fn found(places: &[PathBuf]) -> Result<Vec<Mesh>, Failure> {
    let mut meshes: Vec<Mesh> = Vec::new();
    if places.is_empty() {
        let name = crate::load::built_in().name;
        meshes.push(Mesh { name, path: None });
    }
    let mut seen = BTreeSet::new();
    for place in places {
        let mut files = Vec::new();
        if place.is_dir() {
            let listed = list(place, &mut files);
            listed.map_err(|(folder, cause)| {
                Failure::usage(format!("{}: cannot be listed: {cause}", folder.display()))
            })?;
            if files.is_empty() {
                return Err(Failure::usage(format!(
                    "{}: a directory with no .obj file in it, nor in those below",
                    place.display()
                )));
            }
        } else {
            files.push(place.clone());
        }
        for path in files {
            if seen.insert(fs::canonicalize(&path).unwrap_or_else(|_| path.clone())) {
                let name = name_of(&path);
                let path = Some(path);
                meshes.push(Mesh { name, path });
            }
        }
    }
    Ok(meshes)
}

/// A path as text; bytes that are no text are escaped, so that no two paths have one name.
fn name_of(path: &Path) -> String {
    path.to_str()
        .map_or_else(|| format!("{path:?}"), ToOwned::to_owned)
}

/// All OBJ files in `folder` and below, by name, but for hidden ones: other programs leave these behind.
/// Links to folders are not followed: they may lead back.
fn list(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), (PathBuf, io::Error)> {
    let failed = |cause| (folder.to_owned(), cause);
    let entries = fs::read_dir(folder).map_err(failed)?;
    let mut paths = Vec::new();
    for entry in entries {
        let entry = entry.map_err(failed)?;
        if entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        let path = entry.path();
        let is_folder = entry.file_type().map_err(failed)?.is_dir();
        // What is no file, and no link to one, may block whoever opens it.
        if is_folder || fs::metadata(&path).is_ok_and(|there| there.is_file()) {
            paths.push((path, is_folder));
        }
    }
    paths.sort();
    for (path, is_folder) in paths {
        let ending = path.extension();
        if is_folder {
            list(&path, files)?;
        } else if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("obj")) {
            files.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_meshes_out() {
        let shards: Vec<Shard> = (1..=3)
            .map(|i| format!("{i}/3").parse().expect("a shard"))
            .collect();
        for number in 0..10 {
            let owners = shards.iter().filter(|shard| shard.has(number)).count();
            assert_eq!(owners, 1, "{number}");
        }
        for text in ["", "1", "0/3", "4/3", "1/0", "a/b", "-1/3", "1/3/3"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
