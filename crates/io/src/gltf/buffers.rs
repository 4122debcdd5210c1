//! The data of the buffers of a glTF file.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

use super::document::{Document, Uri};
use super::{fault, item};
use crate::error::ReadError;
use crate::excerpt::shortened;
use crate::faults::GltfFault;

/// The data of each buffer that contains positions or indices.
pub(super) struct Buffers<'a> {
    pub(super) name: &'a str,
    /// Buffers in one file share its data.
    buffers: Vec<Option<Rc<Vec<u8>>>>,
    bytes: u64,
}

impl<'a> Buffers<'a> {
    /// Reads the buffers of the document, and takes embedded ones out of it. `binary` is the data of a binary file; `folder` contains
    /// the file, if the mesh comes from a file.
    pub(super) fn load(
        name: &'a str,
        document: &mut Document,
        mut binary: Option<Vec<u8>>,
        folder: Option<&Path>,
    ) -> Result<Self, ReadError> {
        let used = used_buffers(name, document)?;
        let mut files = Files::new(document, &used);
        let mut bytes = 0;
        let mut buffers = Vec::new();
        for (number, buffer) in document.buffers.iter_mut().enumerate() {
            if !used[number] {
                buffers.push(None);
                continue;
            }
            let failed = |cause| fault(name, "buffer", number, cause);
            let data = match buffer.uri.take() {
                None => binary.take().filter(|_| number == 0).unwrap_or_default(),
                Some(Uri::Embedded(data)) => data.ok_or_else(|| failed(GltfFault::Base64))?,
                Some(Uri::File(uri)) => {
                    let (data, new_bytes) = files.load(&uri, folder).map_err(failed)?;
                    check_length(&data, buffer.byte_length).map_err(failed)?;
                    bytes += new_bytes;
                    buffers.push(Some(data));
                    continue;
                }
            };
            check_length(&data, buffer.byte_length).map_err(failed)?;
            bytes += data.len() as u64;
            buffers.push(Some(Rc::new(data)));
        }
        Ok(Self {
            name,
            buffers,
            bytes,
        })
    }

    /// Returns the number of bytes of all buffers that were read. Data that several buffers share
    /// counts once.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns the bytes of `view`; `accessor` uses it.
    pub(super) fn view(
        &self,
        document: &Document,
        view: usize,
        accessor: usize,
    ) -> Result<&[u8], ReadError> {
        let by = ("accessor", accessor);
        let described = item(&document.buffer_views, "bufferView", view, by, self.name)?;
        let data = self
            .buffers
            .get(described.buffer)
            .and_then(Option::as_deref)
            .map(Vec::as_slice);
        let data = data.unwrap_or_default();
        let start = usize::try_from(described.byte_offset).ok();
        let length = usize::try_from(described.byte_length).ok();
        let range = start.zip(length).and_then(|(start, length)| {
            let end = start.checked_add(length)?;
            data.get(start..end)
        });
        range.ok_or_else(|| {
            let end = described.byte_offset.checked_add(described.byte_length);
            let fault_of = GltfFault::OutOfBuffer {
                end: end.map_or("2^64".to_owned(), |end| end.to_string()),
                length: data.len() as u64,
            };
            fault(self.name, "bufferView", view, fault_of)
        })
    }
}

/// Checks that a buffer has all its bytes.
fn check_length(data: &[u8], expected: u64) -> Result<(), GltfFault> {
    let found = data.len() as u64;
    match found < expected {
        true => Err(GltfFault::ShortBuffer { found, expected }),
        false => Ok(()),
    }
}

/// The files of buffers. A file is read once, however many buffers it contains.
struct Files {
    /// The bytes of each file that are needed.
    lengths: HashMap<PathBuf, u64>,
    loaded: HashMap<PathBuf, Rc<Vec<u8>>>,
}

impl Files {
    /// Prepares for the files of the `used` buffers.
    fn new(document: &Document, used: &[bool]) -> Self {
        let mut lengths: HashMap<PathBuf, u64> = HashMap::new();
        for (buffer, _) in document.buffers.iter().zip(used).filter(|(_, used)| **used) {
            if let Some(Uri::File(uri)) = &buffer.uri
                && let Some(path) = path_below(uri)
            {
                let length = lengths.entry(path).or_default();
                *length = buffer.byte_length.max(*length);
            }
        }
        Self {
            lengths,
            loaded: HashMap::new(),
        }
    }

    /// Returns the data of a file, and the number of bytes that were read for it now.
    fn load(&mut self, uri: &str, folder: Option<&Path>) -> Result<(Rc<Vec<u8>>, u64), GltfFault> {
        let shown = || shortened(uri);
        let path = path_below(uri).ok_or_else(|| GltfFault::Uri { uri: shown() })?;
        if let Some(data) = self.loaded.get(&path) {
            return Ok((Rc::clone(data), 0));
        }
        let folder = folder.ok_or_else(|| GltfFault::NeedsFolder { uri: shown() })?;
        let length = self.lengths.get(&path).copied().unwrap_or_default();
        let read = read_below(folder, &path, length).map_err(|cause| GltfFault::BufferFile {
            path: folder.join(&path).display().to_string(),
            cause,
        })?;
        let data = Rc::new(read.ok_or_else(|| GltfFault::Uri { uri: shown() })?);
        let bytes = data.len() as u64;
        self.loaded.insert(path, Rc::clone(&data));
        Ok((data, bytes))
    }
}

/// Returns for each buffer whether it contains positions or indices.
fn used_buffers(name: &str, document: &Document) -> Result<Vec<bool>, ReadError> {
    let mut used = vec![false; document.buffers.len()];
    for number in document.accessors() {
        // An accessor that does not exist is reported when its mesh is read.
        let Some(accessor) = document.accessors.get(number) else {
            continue;
        };
        for view in accessor.views() {
            let by = ("accessor", number);
            let view_item = item(&document.buffer_views, "bufferView", view, by, name)?;
            let by = ("bufferView", view);
            item(&document.buffers, "buffer", view_item.buffer, by, name)?;
            used[view_item.buffer] = true;
        }
    }
    Ok(used)
}

/// Returns the path of the file that `uri` names, relative to the folder of the glTF file and without
/// `.` and `..`; `None` if it is not below this folder.
fn path_below(uri: &str) -> Option<PathBuf> {
    let mut path = PathBuf::new();
    for part in Path::new(&percent_decoded(uri)).components() {
        match part {
            Component::Normal(name) => path.push(name),
            Component::CurDir => {}
            Component::ParentDir if path.pop() => {}
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    let has_scheme = uri.contains(':');
    (!has_scheme && path.file_name().is_some()).then_some(path)
}

/// Returns the first `length` bytes of the file at `path` in `folder`; `None` if links lead out of the
/// folder.
fn read_below(folder: &Path, path: &Path, length: u64) -> io::Result<Option<Vec<u8>>> {
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let path = folder.join(path).canonicalize()?;
    if !path.starts_with(folder.canonicalize()?) {
        return Ok(None);
    }
    if !std::fs::metadata(&path)?.is_file() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "not a regular file",
        ));
    }
    let mut data = Vec::new();
    File::open(path)?.take(length).read_to_end(&mut data)?;
    Ok(Some(data))
}

/// Replaces `%20` and similar sequences by the bytes that they mean.
fn percent_decoded(uri: &str) -> String {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [byte, after @ ..] = rest {
        let code = after.get(..2).and_then(|code| str::from_utf8(code).ok());
        let code = code.filter(|_| *byte == b'%');
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(value) => {
                decoded.push(value);
                rest = &after[2..];
            }
            None => {
                decoded.push(*byte);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_below_the_folder_are_accepted() {
        for uri in [
            "../a.bin",
            "..",
            ".",
            "a/..",
            "/etc/passwd",
            "a/../../b",
            "a/../../a/b",
            "./../a",
            "http://a/b.bin",
            "file:///a.bin",
            "file:a.bin",
            "%2e%2e/a",
            "%2E%2e%2Fa",
            ".%2e/a",
            "%2fetc/passwd",
            "a/%2e%2e/%2e%2e/b",
            "",
        ] {
            assert_eq!(path_below(uri), None, "{uri}");
        }
        for (uri, path) in [
            ("a.bin", "a.bin"),
            ("./a.bin", "a.bin"),
            ("./sub/./a.bin", "sub/a.bin"),
            ("sub//a.bin", "sub/a.bin"),
            ("sub/../a.bin", "a.bin"),
            ("a/b/../../c/d.bin", "c/d.bin"),
            ("my%20data/%61.bin", "my data/a.bin"),
            ("sub%2Fa.bin", "sub/a.bin"),
            ("sub/%2e%2e/a.bin", "a.bin"),
            ("..a/...bin", "..a/...bin"),
            ("%252e%252e/a", "%2e%2e/a"),
            ("100%.bin", "100%.bin"),
        ] {
            assert_eq!(path_below(uri), Some(PathBuf::from(path)), "{uri}");
        }
    }
}
