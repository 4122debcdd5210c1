//! Finds the meshes of a study in files and folders.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use sixfold::io::Format;
use sixfold_study::numbers::counted;

use crate::failure::Failure;
use crate::text::print_stderr;

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
/// their subfolders for mesh files, and prints a note about other files. If `places` is empty,
/// returns the built-in mesh.
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
            let mut skipped = BTreeMap::new();
            let listed = list_mesh_files(place, &mut files, &mut skipped);
            listed.map_err(|(folder, cause)| {
                Failure::usage(format!(
                    "{}: cannot be listed ({cause}): check the permissions of this directory",
                    folder.display()
                ))
            })?;
            print_skipped(place, &skipped);
            if files.is_empty() {
                return Err(Failure::usage(format!(
                    "{}: no mesh file in this directory or its subdirectories ({}): name \
                     another directory",
                    place.display(),
                    Format::EXTENSIONS
                        .map(|ending| format!(".{ending}"))
                        .join(", ")
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

/// Prints how many files of a folder were skipped, by the endings of their names.
fn print_skipped(folder: &Path, skipped: &BTreeMap<String, usize>) {
    let count: usize = skipped.values().sum();
    if count > 0 {
        let endings: Vec<String> = skipped
            .iter()
            .map(|(ending, count)| format!("{count} {ending}"))
            .collect();
        print_stderr(&format!(
            "note: {}: skipped {}, whose names do not end in a mesh format: {}",
            folder.display(),
            counted(count, "file", "files"),
            endings.join(", ")
        ));
    }
}

/// Lists all mesh files in `folder` and its subfolders, sorted by name, and counts other files by
/// the endings of their names. Ignores hidden files, which other programs leave behind. Does not
/// follow links to folders, because they may form a cycle.
fn list_mesh_files(
    folder: &Path,
    files: &mut Vec<PathBuf>,
    skipped: &mut BTreeMap<String, usize>,
) -> Result<(), (PathBuf, io::Error)> {
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
        if is_folder {
            list_mesh_files(&path, files, skipped)?;
        } else if Format::from_path(&path).is_some() {
            files.push(path);
        } else {
            let ending = path
                .extension()
                .map(|ending| format!(".{}", ending.to_string_lossy()));
            *skipped
                .entry(ending.unwrap_or_else(|| "without an ending".into()))
                .or_insert(0) += 1;
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
