//! Finds the meshes of a study in files and folders.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::failure::Failure;

#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    /// The name in results: the path as given.
    pub(crate) name: String,
    /// The file; `None` for the built-in mesh.
    pub(crate) path: Option<PathBuf>,
}

/// The part of a study that one of n jobs does: every n-th mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// Returns whether mesh `number` is in the shard. Meshes are numbered from 0.
    pub(crate) fn contains(self, number: usize) -> bool {
        number % self.count == self.index - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    /// Parses a text such as `2/8`, the second of eight shards.
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

/// Returns the meshes in `places`, without duplicates and sorted by name. Searches folders and
/// their subfolders for OBJ files. If `places` is empty, returns the built-in mesh.
pub(crate) fn find_meshes(places: &[PathBuf]) -> Result<Vec<Mesh>, Failure> {
    let mut meshes: Vec<Mesh> = Vec::new();
    if places.is_empty() {
        let name = crate::load::built_in().name;
        meshes.push(Mesh { name, path: None });
    }
    let mut seen = BTreeSet::new();
    for place in places {
        let mut files = Vec::new();
        if place.is_dir() {
            let listed = list_obj_files(place, &mut files);
            listed.map_err(|(folder, cause)| {
                Failure::usage(format!(
                    "{}: cannot be listed ({cause}): check the permissions of this directory",
                    folder.display()
                ))
            })?;
            if files.is_empty() {
                return Err(Failure::usage(format!(
                    "{}: no .obj file in this directory or its subdirectories: name another \
                     directory",
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

/// Returns a path as text. Bytes that are not UTF-8 are escaped, so that different paths have
/// different names.
fn name_of(path: &Path) -> String {
    path.to_str()
        .map_or_else(|| format!("{path:?}"), ToOwned::to_owned)
}

/// Lists all OBJ files in `folder` and its subfolders, sorted by name. Skips hidden files. Does not
/// follow links to folders, because they may form a cycle.
fn list_obj_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), (PathBuf, io::Error)> {
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
        // List only files and links to files. Opening a pipe may block.
        if is_folder || fs::metadata(&path).is_ok_and(|metadata| metadata.is_file()) {
            paths.push((path, is_folder));
        }
    }
    paths.sort();
    for (path, is_folder) in paths {
        let ending = path.extension();
        if is_folder {
            list_obj_files(&path, files)?;
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
    fn each_mesh_is_in_exactly_one_shard() {
        let shards: Vec<Shard> = (1..=3)
            .map(|i| format!("{i}/3").parse().expect("a shard"))
            .collect();
        for number in 0..10 {
            let containing = shards.iter().filter(|shard| shard.contains(number)).count();
            assert_eq!(containing, 1, "{number}");
        }
        for text in ["", "1", "0/3", "4/3", "1/0", "a/b", "-1/3", "1/3/3"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
