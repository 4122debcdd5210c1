//! Separates the JSON text of a file from its binary data.

use std::io::Read;

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::faults::GltfFault;
use crate::format::Format;
use crate::place::Place;

/// The parts of a file.
pub(super) struct Container {
    pub(super) json: Vec<u8>,
    /// The data of the first buffer, in a binary file.
    pub(super) binary: Option<Vec<u8>>,
}

/// Reads the file.
pub(super) fn read(
    builder: &mut MeshBuilder,
    source: &mut ByteSource<'_>,
) -> Result<Container, ReadError> {
    let start = source
        .fill(12)
        .map_err(|e| builder.read_error(Place::Byte(0), e))?;
    if !start.starts_with(b"glTF") {
        let json = read_bytes(builder, source, u64::MAX)?;
        let binary = None;
        return Ok(Container { json, binary });
    }
    builder.set_format(Format::Glb);
    let version = start.get(4..8).map(u32_from);
    if start.len() < 12 {
        let place = Place::Byte(start.len() as u64);
        return Err(builder.truncated(place, "the length of the file".to_owned()));
    }
    if version != Some(2) {
        let version = version.unwrap_or(0).to_string();
        let at = builder.at(Place::Byte(4));
        let fault = GltfFault::Version { version };
        return Err(ReadError::Gltf { at, fault });
    }
    // The length of the file is repeated by the chunks.
    source.advance(12);
    let Some(Chunk { kind, bytes: json }) = read_chunk(builder, source)? else {
        let place = Place::Byte(source.offset());
        return Err(builder.truncated(place, "the JSON chunk".to_owned()));
    };
    if kind != *b"JSON" {
        let at = builder.at(Place::Byte(16));
        let fault = GltfFault::NoJson;
        return Err(ReadError::Gltf { at, fault });
    }
    let mut binary = None;
    while let Some(Chunk { kind, bytes }) = read_chunk(builder, source)? {
        // Chunks of other kinds are extensions.
        if kind == *b"BIN\0" && binary.is_none() {
            binary = Some(bytes);
        }
    }
    Ok(Container { json, binary })
}

/// A part of a binary file.
struct Chunk {
    kind: [u8; 4],
    bytes: Vec<u8>,
}

/// Reads a chunk; returns `None` at the end of the file.
fn read_chunk(
    builder: &MeshBuilder,
    source: &mut ByteSource<'_>,
) -> Result<Option<Chunk>, ReadError> {
    let place = Place::Byte(source.offset());
    let header = source.fill(8).map_err(|e| builder.read_error(place, e))?;
    let Some(&[a, b, c, d, ref kind @ ..]) = header.first_chunk::<8>() else {
        // Some writers pad the file.
        return Ok(None);
    };
    let (length, kind) = (u64::from(u32::from_le_bytes([a, b, c, d])), *kind);
    source.advance(8);
    let bytes = read_bytes(builder, source, length)?;
    if (bytes.len() as u64) < length {
        let place = Place::Byte(source.offset());
        let missing = format!("byte {length} of a chunk");
        return Err(builder.truncated(place, missing));
    }
    Ok(Some(Chunk { kind, bytes }))
}

/// Reads up to `length` bytes. The memory grows with the bytes that exist.
fn read_bytes(
    builder: &MeshBuilder,
    source: &mut ByteSource<'_>,
    length: u64,
) -> Result<Vec<u8>, ReadError> {
    let place = Place::Byte(source.offset());
    let mut bytes = Vec::with_capacity(source.plausible(length, 1));
    let read = source.take(length).read_to_end(&mut bytes);
    read.map_err(|e| builder.read_error(place, e))?;
    Ok(bytes)
}

fn u32_from(bytes: &[u8]) -> u32 {
    bytes
        .first_chunk()
        .map_or(0, |&bytes| u32::from_le_bytes(bytes))
}
