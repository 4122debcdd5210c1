//! The caches of the processor.
//!
//! Linux describes the caches in files under `/sys`. On other platforms, [`caches`] returns an
//! empty list.

use std::fs;
use std::path::Path;

use sixfold_results::Cache;

/// Bytes of one cache line.
pub const LINE_BYTES: usize = 64;

/// The folder in which Linux describes the caches of the first processor.
const CACHE_FOLDER: &str = "/sys/devices/system/cpu/cpu0/cache";

/// Reads one cache. `file` returns the content of the file with the given name.
fn read_cache(file: impl Fn(&str) -> Option<String>) -> Option<Cache> {
    Some(Cache {
        level: file("level")?.trim().parse().ok()?,
        kind: file("type")?.trim().to_lowercase(),
        bytes: parse_size(file("size")?.trim()).filter(|&bytes| bytes > 0)?,
        shared_by: file("shared_cpu_list").and_then(|list| list_length(list.trim())),
    })
}

/// Returns the caches of the first processor, sorted by level, then by kind. Returns an empty list
/// if the caches are unknown.
pub fn caches() -> Vec<Cache> {
    let Ok(entries) = fs::read_dir(CACHE_FOLDER) else {
        return Vec::new();
    };
    let cache = |folder: &Path| read_cache(|name| fs::read_to_string(folder.join(name)).ok());
    let mut caches: Vec<Cache> = entries
        .flatten()
        .filter_map(|entry| cache(&entry.path()))
        .collect();
    caches.sort_by(|a, b| (a.level, &a.kind).cmp(&(b.level, &b.kind)));
    caches
}

/// Returns the size of the data cache of `level` in bytes, if known.
pub(crate) fn level_bytes(caches: &[Cache], level: u8) -> Option<u64> {
    let data = caches.iter().filter(|cache| cache.holds_data());
    data.filter(|cache| cache.level == level)
        .map(|cache| cache.bytes)
        .next()
}

/// Parses a size such as `32K` or `1M` into bytes. K is 1024, M is 1024².
fn parse_size(text: &str) -> Option<u64> {
    let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit());
    let unit = match &text[digits.len()..] {
        "" => 1,
        "K" => 1 << 10,
        "M" => 1 << 20,
        "G" => 1 << 30,
        _ => return None,
    };
    digits.parse::<u64>().ok()?.checked_mul(unit)
}

/// Returns how many numbers a list such as `0-3,8` contains.
fn list_length(text: &str) -> Option<usize> {
    let part = |part: &str| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let (first, last): (usize, usize) = (first.parse().ok()?, last.parse().ok()?);
        last.checked_sub(first)?.checked_add(1)
    };
    text.split(',').map(part).sum()
}

#[cfg(test)]
mod tests {
    use sixfold_results::last_level_bytes;

    use super::*;

    fn cache(files: &[(&str, &str)]) -> Option<Cache> {
        let file = |name: &str| files.iter().find(|(n, _)| *n == name);
        read_cache(|name| file(name).map(|(_, text)| format!("{text}\n")))
    }

    #[test]
    fn a_cache_is_read_from_its_files() {
        let files = [("level", "3"), ("type", "Unified"), ("size", "32768K")];
        let expected = Cache {
            level: 3,
            kind: "unified".into(),
            bytes: 32 << 20,
            shared_by: None,
        };
        assert_eq!(cache(&files), Some(expected.clone()));
        let shared = [&files[..], &[("shared_cpu_list", "0-3,8,10-11")]].concat();
        assert_eq!(cache(&shared).and_then(|c| c.shared_by), Some(7));
        assert_eq!(cache(&files[..2]), None);
        for wrong in ["", "K", "12Q", "0K", "many"] {
            let files = [files[0], files[1], ("size", wrong)];
            assert_eq!(cache(&files), None, "{wrong}");
        }
        let all = [
            expected.clone(),
            Cache {
                level: 1,
                ..expected
            },
        ];
        assert_eq!(last_level_bytes(&all), Some(32 << 20));
        assert_eq!(last_level_bytes(&[]), None);
    }

    #[test]
    fn lists_and_sizes_are_parsed() {
        assert_eq!(
            ["0", "0-1", "0,4"].map(list_length),
            [Some(1), Some(2), Some(2)]
        );
        assert_eq!(["", "x", "3-1"].map(list_length), [None; 3]);
        assert_eq!(
            ["64", "48K", "2M"].map(parse_size),
            [Some(64), Some(49_152), Some(2 << 20)]
        );
    }

    #[test]
    fn instruction_caches_are_ignored() {
        let level = |level: u8, kind: &str, bytes: u64| Cache {
            level,
            kind: kind.into(),
            bytes,
            shared_by: Some(1),
        };
        let caches = [level(1, "data", 32), level(2, "instruction", 64)];
        assert_eq!(last_level_bytes(&caches), Some(32));
    }

    #[test]
    fn caches_of_this_machine_are_sorted_by_level() {
        let caches = caches();
        assert!(caches.is_sorted_by_key(|cache| cache.level), "{caches:?}");
        assert!(caches.iter().all(|cache| cache.bytes > 0));
    }
}
