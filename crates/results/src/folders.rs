//! Documents without the folders of the machine that measured them.

use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::{Finding, Results};

impl Results {
    /// Returns the document without the folders in which its meshes are on this machine: in all texts, an absolute path
    /// of a mesh begins after the last folder that all of them share, and other absolute paths in commands are the names
    /// of their files. Relative paths stay. O(n) for n bytes of JSON, if there is an absolute path.
    ///
    /// ```
    /// use sixfold_results::Results;
    ///
    /// let planned = ["/home/ada/scans/bunny/a.obj", "/home/ada/scans/b.ply", "c.stl"];
    /// let results = Results::new(planned.map(String::from).to_vec());
    /// assert_eq!(results.without_folders().planned, ["bunny/a.obj", "b.ply", "c.stl"]);
    /// ```
    pub fn without_folders(&self) -> Cow<'_, Self> {
        let findings = self.findings.iter();
        let meshes = findings.clone().flat_map(Finding::meshes);
        let names = meshes.map(|mesh| mesh.name.as_str());
        let failed = self.failures.iter().map(|failed| failed.mesh.as_str());
        let planned = self.planned.iter().map(String::as_str);
        let meshes = shared_folder(names.chain(failed).chain(planned));
        let commands = findings.filter_map(|finding| finding.run().command.as_deref());
        let words = commands.flat_map(str::split_whitespace);
        let words = words.map(|word| word.trim_matches(['"', '\'']));
        let others: BTreeSet<&str> = words.filter_map(folder).collect();
        // The longest first, which begin with the others. The folder of the meshes is a part of some.
        let mut folders: Vec<&str> = others.into_iter().collect();
        folders.sort_by_key(|folder| std::cmp::Reverse(folder.len()));
        let folders: Vec<&str> = meshes.into_iter().chain(folders).collect();
        if folders.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut text = Vec::new();
        let shortened = self.write_json(&mut text).ok().and_then(|()| {
            let mut text = String::from_utf8(text).ok()?;
            for folder in folders {
                // As JSON writes it, without its quotes.
                let quoted = serde_json::to_string(folder).ok()?;
                text = text.replace(quoted.trim_matches('"'), "");
            }
            Self::read_json(&text).ok()
        });
        shortened.map_or(Cow::Borrowed(self), Cow::Owned)
    }
}

/// Returns the folder of an absolute path with the sign at its end: `/home/ada/`, `C:\scans\`. `None` for a relative path,
/// and for a file in the root.
fn folder(path: &str) -> Option<&str> {
    let drive = path
        .get(1..3)
        .filter(|colon| matches!(*colon, ":\\" | ":/"));
    if !path.starts_with(['/', '\\']) && drive.is_none() {
        return None;
    }
    let root = drive.map_or(1, |_| 3);
    let end = path.rfind(['/', '\\'])? + 1;
    (end > root).then(|| &path[..end])
}

/// Returns the last folder that all absolute paths of `names` share; `None` if that is the root.
fn shared_folder<'n>(names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let mut folders = names.filter_map(folder);
    let first = folders.next()?;
    let shared = folders.fold(first, |shared, other| {
        let same = shared.bytes().zip(other.bytes());
        let count = same.take_while(|(a, b)| a == b).count();
        let end = shared.as_bytes()[..count]
            .iter()
            .rposition(|&b| b == b'/' || b == b'\\');
        end.map_or("", |end| &shared[..=end])
    });
    folder(shared)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_absolute_paths_end_with_their_sign() {
        assert_eq!(folder("/a/b/c.obj"), Some("/a/b/"));
        assert_eq!(folder("C:\\a\\c.obj"), Some("C:\\a\\"));
        assert_eq!(folder("C:/c.obj"), None);
        assert_eq!(folder("/c.obj"), None);
        assert_eq!(folder("a/c.obj"), None);
        assert_eq!(folder(""), None);
    }

    #[test]
    fn the_shared_folder_is_no_part_of_a_name() {
        let shared = |names: &[&'static str]| shared_folder(names.iter().copied());
        assert_eq!(shared(&["/a/bc/x", "/a/bd/y"]), Some("/a/"));
        assert_eq!(shared(&["/a/b/x", "b/y"]), Some("/a/b/"));
        assert_eq!(shared(&["/é/x", "/è/y"]), None);
        assert_eq!(shared(&["/a/x", "/b/y"]), None);
        assert_eq!(shared(&["x", "y"]), None);
    }

    #[test]
    fn documents_without_absolute_paths_are_the_same() {
        let results = Results::new(vec!["a/b.obj".into(), "/c.obj".into()]);
        assert!(matches!(results.without_folders(), Cow::Borrowed(_)));
    }
}
