//! Refuses glTF files with extensions that change a mesh and are not read.

use std::collections::BTreeSet;

use super::document::{Buffer, Document, Primitive, Uri};
use crate::builder::MeshBuilder;
use crate::error::ReadError;
use crate::place::Place;

const DRACO: &str = "KHR_draco_mesh_compression";
const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Extensions that a file may require although they are not read, because they do not change
/// positions or faces; and the extension for positions of fewer bits, which is read.
const HARMLESS: [&str; 15] = [
    "ADOBE_materials_thin_transparency",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_techniques_webgl",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Checks that the positions and faces of the document can be read: no compressed data without a
/// plain copy, and no required extension that is not known. `binary` is the number of bytes of the
/// data in a binary file.
///
/// Whether data is compressed depends on the primitives and buffer views, and not only on the list
/// of required extensions, which some programs leave out.
pub(super) fn check(
    document: &Document,
    binary: usize,
    builder: &MeshBuilder,
) -> Result<(), ReadError> {
    let refused = |kind, number, feature: String, way_out| ReadError::Unsupported {
        at: builder.at(Place::Item { kind, number }),
        feature,
        way_out,
    };
    let compressed = |kind, number, extension: &str| {
        let feature = format!("the mesh is compressed with {extension}");
        refused(kind, number, feature, "export it without compression")
    };
    let required: BTreeSet<&str> = document
        .extensions_required
        .iter()
        .map(String::as_str)
        .collect();
    // The compression that the file says it uses, for data that is in no buffer.
    let is_compression = |name: &&String| *name == DRACO || MESHOPT.contains(&name.as_str());
    let listed = document.extensions_used.iter().find(is_compression);
    let compression = |primitive: &Primitive| {
        if primitive.extensions.contains_key(DRACO) {
            let is_plain = !required.contains(DRACO) && has_plain_data(primitive, document);
            return (!is_plain).then_some(DRACO);
        }
        let extension = listed.map(String::as_str)?;
        (!has_any_data(primitive, document)).then_some(extension)
    };
    for (number, mesh) in document.meshes.iter().enumerate() {
        if let Some(extension) = mesh.primitives.iter().find_map(compression) {
            return Err(compressed("mesh", number, extension));
        }
    }
    let used = used_views(document);
    for (number, view) in document.buffer_views.iter().enumerate() {
        for extension in MESHOPT {
            let is_missing = || {
                let buffer = document.buffers.get(view.buffer);
                let length = buffer.map_or(0, |buffer| available(buffer, view.buffer, binary));
                used[number] && view.byte_offset.saturating_add(view.byte_length) > length
            };
            let is_compressed = view.extensions.contains_key(extension);
            if is_compressed && (required.contains(extension) || is_missing()) {
                return Err(compressed("bufferView", number, extension));
            }
        }
    }
    for (number, name) in document.extensions_required.iter().enumerate() {
        if !is_known(name) {
            let name = crate::excerpt::shortened(name);
            let feature = format!("the file requires the extension {name}");
            let way_out = "export it without this extension";
            return Err(refused("required extension", number, feature, way_out));
        }
    }
    Ok(())
}

/// Returns whether an extension may be required. Compression is checked where it is used.
fn is_known(name: &str) -> bool {
    name == DRACO
        || MESHOPT.contains(&name)
        || HARMLESS.contains(&name)
        || name.starts_with("KHR_materials_")
}

/// Returns whether a primitive with compressed data has its positions and indices in buffers, too.
fn has_plain_data(primitive: &Primitive, document: &Document) -> bool {
    let mut accessors = primitive.accessors();
    primitive.attributes.contains_key("POSITION")
        && accessors.all(|number| {
            // An accessor that does not exist is reported when its mesh is read.
            let accessor = document.accessors.get(number);
            accessor.is_none_or(|accessor| accessor.buffer_view.is_some())
        })
}

/// Returns whether the positions and indices of a primitive are in buffers, or some of them are:
/// without a buffer, all numbers are zero.
fn has_any_data(primitive: &Primitive, document: &Document) -> bool {
    primitive.accessors().all(|number| {
        let accessor = document.accessors.get(number);
        accessor.is_none_or(|accessor| accessor.views().next().is_some())
    })
}

/// Returns for each buffer view whether positions or indices are in it.
fn used_views(document: &Document) -> Vec<bool> {
    let mut used = vec![false; document.buffer_views.len()];
    for number in document.accessors() {
        let Some(accessor) = document.accessors.get(number) else {
            continue;
        };
        for view in accessor.views() {
            if let Some(is_used) = used.get_mut(view) {
                *is_used = true;
            }
        }
    }
    used
}

/// Returns the number of bytes that buffer `number` has, without opening its file.
fn available(buffer: &Buffer, number: usize, binary: usize) -> u64 {
    match &buffer.uri {
        Some(Uri::Embedded(Some(data))) => data.len() as u64,
        // Invalid text is reported when the buffer is read.
        Some(Uri::Embedded(None) | Uri::File(_)) => buffer.byte_length,
        None if number == 0 => binary as u64,
        None => 0,
    }
}
