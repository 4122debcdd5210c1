//! Reads glTF 2.0.

mod accessor;
mod buffers;
mod container;
mod document;
mod extensions;
mod scene;

use std::path::Path;

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::faults::GltfFault;
use crate::file_mesh::FileMesh;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Location, Place};

use buffers::Buffers;
use document::Document;
use scene::SceneReader;

/// Reads glTF in either form; O(bytes + size of the scene). `path` is the place of the file, if it
/// has one. The memory is the size of the buffers and the mesh.
pub(crate) fn read(
    name: &str,
    path: Option<&Path>,
    source: &mut ByteSource<'_>,
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
    reader.read(options.scene)?;
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
    let notices = &mut builder.notices;
    let animations = document.animations.len() as u64;
    let first = Place::Item {
        kind: "animation",
        number: 0,
    };
    notices.add_many(IgnoredKind::Deformations, animations, first);
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
