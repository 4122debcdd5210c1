//! Finds the meshes of a study in files and folders.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use sixfold::io::Format;

use crate::command::failure::Failure;
use crate::command::mesh_files::shown;
use crate::command::text::sanitize;
use sixfold_results::numbers::counted;
use sixfold_results::{Failed, FailureKind};

#[derive(Clone, Debug)]
pub struct Mesh {
    /// The name in results: the path as given.
    pub name: String,
    /// The file; `None` for the built-in mesh.
    pub path: Option<PathBuf>,
    /// Why there is no mesh at this place: a folder that cannot be listed, or has no mesh.
    pub problem: Option<String>,
}

impl Mesh {
    /// Returns the mesh with the reason why it was not measured. `failure` is that of reading or measuring it.
    pub fn not_measured(&self, failure: &Failure) -> Failed {
        let of_path = || match &self.path {
            Some(path) => without_path(&failure.message, path),
            None => failure.message.clone(),
        };
        Failed {
            mesh: self.name.clone(),
            reason: self.problem.clone().unwrap_or_else(of_path),
            kind: FailureKind::NotMeasured,
        }
    }
}

/// Removes the path from a message, because a list of failures already shows the path.
fn without_path(message: &str, path: &Path) -> String {
    let Some(rest) = message.strip_prefix(&shown(path)) else {
        return message.to_owned();
    };
    match rest.strip_prefix(": ") {
        Some(rest) => rest.to_owned(),
        None => format!("line {}", rest.trim_start_matches(':')),
    }
}

/// Endings of mesh files that are not read, but that other programs can convert.
const OTHER_FORMATS: [&str; 7] = ["3ds", "3mf", "blend", "dae", "fbx", "usd", "x3d"];

/// A shard: every n-th mesh, starting with the i-th mesh. One of n jobs studies the shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// Returns whether mesh `number` is in the shard. Meshes are numbered from 0.
    pub fn contains(self, number: usize) -> bool {
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

/// Returns the path of the mesh called `name` in `places`; `None` for the built-in mesh.
///
/// # Errors
///
/// Returns an error if there is no such mesh.
pub fn find_mesh(places: &[PathBuf], name: &str) -> Result<Option<PathBuf>, Failure> {
    let meshes = find_meshes(places, &mut |_| ())?;
    let found = meshes.into_iter().find(|mesh| mesh.name == name);
    let found = found.ok_or_else(|| Failure::usage(format!("{name}: no longer found")))?;
    Ok(found.path)
}

/// Returns the meshes in `places`: files, and all meshes in folders and their subfolders, sorted
/// by name. Each file occurs once. Without any place, returns the built-in mesh. Calls `note` with a
/// message on the other files in folders.
///
/// # Errors
///
/// Returns an error if no place has a mesh.
pub fn find_meshes(places: &[PathBuf], note: &mut dyn FnMut(&str)) -> Result<Vec<Mesh>, Failure> {
    let mut meshes: Vec<Mesh> = Vec::new();
    if places.is_empty() {
        meshes.push(Mesh {
            name: crate::command::load::built_in().name,
            path: None,
            problem: None,
        });
    }
    let mut seen = BTreeSet::new();
    for place in places {
        let files = match place.is_dir() {
            true => files_in_folder(place, note),
            false => Ok(vec![place.clone()]),
        };
        match files {
            Ok(files) => {
                for path in files {
                    if seen.insert(fs::canonicalize(&path).unwrap_or_else(|_| path.clone())) {
                        meshes.push(Mesh {
                            name: shown(&path),
                            path: Some(path),
                            problem: None,
                        });
                    }
                }
            }
            Err(problem) => meshes.push(Mesh {
                name: shown(place),
                path: None,
                problem: Some(problem),
            }),
        }
    }
    match &meshes[..] {
        [first, others @ ..] if others.iter().all(|mesh| mesh.problem.is_some()) => {
            match &first.problem {
                Some(problem) => Err(Failure::usage(format!("{}: {problem}", first.name))),
                None => Ok(meshes),
            }
        }
        _ => Ok(meshes),
    }
}

/// Returns the mesh files in a folder and its subfolders. A folder without mesh files is an error.
fn files_in_folder(folder: &Path, note: &mut dyn FnMut(&str)) -> Result<Vec<PathBuf>, String> {
    let mut found = Found::default();
    list_files(folder, &mut found).map_err(|(at, cause)| match at == folder {
        true => format!("cannot be listed: {cause}"),
        false => format!("{} cannot be listed: {cause}", at.display()),
    })?;
    if found.files.is_empty() {
        let but = match found.has_all() {
            true => String::new(),
            false => format!(", but {}", found.skipped_text()),
        };
        return Err(format!(
            "no mesh file in this directory or its subdirectories{but}"
        ));
    }
    if !found.has_all() {
        note(&format!(
            "note: {}: other files are left out: {}",
            folder.display(),
            found.skipped_text()
        ));
    }
    Ok(found.files)
}

/// The files of a folder.
#[derive(Default)]
struct Found {
    /// The mesh files.
    files: Vec<PathBuf>,
    /// Number of other files, by ending.
    skipped: BTreeMap<String, usize>,
    /// Number of hidden files and folders.
    hidden: usize,
    /// Number of links to folders, of broken links, and of pipes and devices.
    not_files: usize,
}

impl Found {
    /// Returns whether every entry is a mesh file or a folder.
    fn has_all(&self) -> bool {
        self.skipped.is_empty() && self.hidden + self.not_files == 0
    }

    /// Describes the skipped files by their endings, and says which of them can be converted.
    fn skipped_text(&self) -> String {
        let counts = self.skipped.iter().map(|(ending, count)| {
            let ending = sanitize(ending);
            match ending.is_empty() {
                true => format!("{count} without an ending"),
                false => format!("{count} .{ending}"),
            }
        });
        let mut counts: Vec<String> = counts.collect();
        if self.hidden > 0 {
            counts.push(format!("{} hidden", self.hidden));
        }
        if self.not_files > 0 {
            let entries = counted(self.not_files, "link or device", "links or devices");
            counts.push(entries);
        }
        let mut text = counts.join(", ");
        let convertible = OTHER_FORMATS
            .iter()
            .filter(|ending| self.skipped.contains_key(**ending));
        let convertible: Vec<String> = convertible.map(|ending| format!(".{ending}")).collect();
        if !convertible.is_empty() {
            text += &format!("; convert {} to OBJ or PLY", convertible.join(" and "));
        }
        text
    }
}

/// Lists all mesh files in `folder` and its subfolders, sorted by name, and counts all other
/// entries. Skips hidden files and folders, which other programs leave behind. Does not follow links
/// to folders, because they may form a cycle.
fn list_files(folder: &Path, found: &mut Found) -> Result<(), (PathBuf, io::Error)> {
    let failed = |cause| (folder.to_owned(), cause);
    let entries = fs::read_dir(folder).map_err(failed)?;
    let mut paths = Vec::new();
    for entry in entries {
        let entry = entry.map_err(failed)?;
        if entry.file_name().to_string_lossy().starts_with('.') {
            found.hidden += 1;
            continue;
        }
        let path = entry.path();
        let is_folder = entry.file_type().map_err(failed)?.is_dir();
        // List only files and links to files. Opening a pipe may block.
        if is_folder || fs::metadata(&path).is_ok_and(|metadata| metadata.is_file()) {
            paths.push((path, is_folder));
        } else {
            found.not_files += 1;
        }
    }
    paths.sort();
    for (path, is_folder) in paths {
        if is_folder {
            list_files(&path, found)?;
            continue;
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or_default().to_ascii_lowercase();
        if Format::from_path(&path).is_some() {
            found.files.push(path);
        } else {
            *found.skipped.entry(ending).or_default() += 1;
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
