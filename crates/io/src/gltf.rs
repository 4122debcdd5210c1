//! Reads glTF 2.0.

mod accessor;
mod buffers;
mod container;
mod document;
mod extensions;
mod scene;

use std::io::Read;
use std::path::Path;

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::file_mesh::FileMesh;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Location, Place};

use buffers::Buffers;
use document::Document;
use scene::SceneReader;

/// A fault in a glTF file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum GltfFault {
    /// The JSON text is invalid, or a member has another type than glTF says.
    #[error(
        "the JSON text is not glTF ({}): export the file again",
        shown_cause(cause)
    )]
    Json { cause: serde_json::Error },
    /// The version is not 2.
    #[error("the file has glTF version {version:?}: export it as version 2.0")]
    Version { version: String },
    /// A chunk of a binary file has an unknown kind, or the first one is not JSON.
    #[error("the first chunk of the file is not JSON: export the file again")]
    NoJson,
    /// An index names an item that does not exist.
    #[error("it names {kind} {number}, but the file has {count} of them: export the file again")]
    NoItem {
        kind: &'static str,
        number: usize,
        count: usize,
    },
    /// An accessor has the wrong type for its use.
    #[error("it has type {found:?}, but {expected}: export the file again")]
    Type {
        found: String,
        expected: &'static str,
    },
    /// The elements of an accessor are not inside its buffer.
    #[error("its data ends at byte {end} of {length}: copy the file again, or export it again")]
    OutOfBuffer { end: String, length: u64 },
    /// The replaced elements of a sparse accessor are not in ascending order.
    #[error("its sparse index {index} is not above the one before and below {count}: export again")]
    SparseIndex { index: u64, count: u64 },
    /// A buffer is shorter than it should be.
    #[error("it has {found} bytes, expected {expected}: copy the file again, with its .bin files")]
    ShortBuffer { found: u64, expected: u64 },
    /// A buffer is in a place that is not read.
    #[error("its data is at {uri:?}: only files in the folder of the file, or below it, are read")]
    Uri { uri: String },
    /// A buffer is in another file, but the mesh does not come from a file.
    #[error("its data is in the file {uri:?}: name the glTF file instead of passing its content")]
    NeedsFolder { uri: String },
    /// A file with the data of a buffer cannot be read.
    #[error("its data cannot be read from {path} ({cause}): keep the .bin files beside the file")]
    BufferFile { path: String, cause: std::io::Error },
    /// The text of an embedded buffer is invalid.
    #[error("its embedded data is not base64 text: export the file again")]
    Base64,
    /// A node is reached twice.
    #[error("it has several parents, or is its own ancestor: export the file again")]
    NodeRepeated,
    /// The nodes repeat their meshes so often that the result is much larger than the file.
    #[error(
        "the scene has more than {limit} vertices, corners and primitives, many times the size of the file: split it, or join its copies"
    )]
    TooLarge { limit: u64 },
}

/// Returns the message of an error, without the middle of long values that it quotes.
fn shown_cause(cause: &serde_json::Error) -> String {
    const MAX_CHARS: usize = 80;
    let message = cause.to_string();
    let chars: Vec<char> = message.chars().collect();
    if chars.len() <= 2 * MAX_CHARS {
        return message;
    }
    let (start, end) = (&chars[..MAX_CHARS], &chars[chars.len() - MAX_CHARS..]);
    format!("{}…{}", String::from_iter(start), String::from_iter(end))
}

/// Reads glTF in either form; O(bytes + size of the scene). `path` is the place of the file, if it
/// has one. The memory is the size of the buffers and the mesh.
pub(crate) fn read(
    name: &str,
    path: Option<&Path>,
    source: &mut ByteSource<impl Read>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let mut builder = MeshBuilder::new(name, Format::Gltf, options, FacePlaces::Numbers);
    let container::Container { json, binary } = container::read(&mut builder, source)?;
    let mut document = Document::parse(&json, &builder)?;
    drop(json);
    note_ignored(&mut builder, &document);
    extensions::check(&document, binary.as_ref().map_or(0, Vec::len), &builder)?;
    let bytes = source.offset();
    let folder = path.map(|path| path.parent().unwrap_or(Path::new("")));
    let buffers = Buffers::load(name, &mut document, binary, folder)?;
    let mut reader = SceneReader::new(&document, &buffers, &mut builder, bytes);
    reader.read()?;
    builder.finish()
}

/// Returns the error of item `number` of the list `kind`.
fn fault(name: &str, kind: &'static str, number: usize, fault: GltfFault) -> ReadError {
    let at = Location::new(name, Place::Item { kind, number });
    ReadError::Gltf { at, fault }
}

/// Returns item `number` of a list; `by` is the place that names it.
fn item<'a, T>(
    items: &'a [T],
    kind: &'static str,
    number: usize,
    by: (&'static str, usize),
    name: &str,
) -> Result<&'a T, ReadError> {
    items.get(number).ok_or_else(|| {
        let count = items.len();
        let missing = GltfFault::NoItem {
            kind,
            number,
            count,
        };
        fault(name, by.0, by.1, missing)
    })
}

/// Counts the parts of the document that are not read.
fn note_ignored(builder: &mut MeshBuilder, document: &Document) {
    let first = |kind| Place::Item { kind, number: 0 };
    let notices = &mut builder.notices;
    let animations = document.animations.len() as u64;
    notices.add_many(IgnoredKind::Deformations, animations, first("animation"));
    let skins = document.skins.len() as u64;
    notices.add_many(IgnoredKind::Deformations, skins, first("skin"));
    for (number, extension) in document.extensions_used.iter().enumerate() {
        if extension != "KHR_mesh_quantization" {
            let place = Place::Item {
                kind: "extension",
                number,
            };
            notices.add_named(IgnoredKind::Extensions, 1, place, extension);
        }
    }
}
