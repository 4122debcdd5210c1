//! Reads the records of a binary PLY file.

use super::layout::{Role, Step};
use super::{ByteOrder, Reading, Scalar};
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::number::Coordinate;
use crate::place::{FacePlaces, Place};

/// Reads all records of an element.
pub(super) fn read(
    mut reading: Reading,
    source: &mut ByteSource<'_>,
    order: ByteOrder,
) -> Result<(), ReadError> {
    let count = reading.element.count;
    let min_size: usize = reading.steps.iter().map(|step| step.min_size()).sum();
    if min_size == 0 {
        return Ok(()); // records without content, however many
    }
    prepare(&mut reading, source, min_size);
    let mut done = 0;
    while done < count {
        let offset = source.offset();
        let buffered = source.fill(1).map(<[u8]>::len);
        let buffered = buffered.map_err(|e| reading.builder.read_error(Place::Byte(offset), e))?;
        let taken = read_buffered(&mut reading, source, order, &mut done)?;
        source.advance(taken);
        // What is left in the buffer is the beginning of a record.
        let left = buffered - taken;
        if done < count {
            let filled = source.fill(left + 1).map(<[u8]>::len);
            let place = Place::Byte(offset + taken as u64);
            if filled.map_err(|e| reading.builder.read_error(place, e))? == left {
                return Err(reading.truncated(place, done));
            }
        }
    }
    Ok(())
}

/// Reserves memory, as far as the size of the file justifies it.
fn prepare(reading: &mut Reading, source: &ByteSource<'_>, min_size: usize) {
    let count = reading.element.count;
    match reading.role {
        Role::Vertices(_) => {
            let vertices = source.plausible(count, min_size as u64);
            reading.builder.reserve_vertices(vertices);
        }
        Role::Faces => {
            let item = reading.steps.iter().find_map(|step| match step {
                Step::Indices { item, .. } => Some(item.size()),
                _ => None,
            });
            let item = item.unwrap_or(1);
            let triangles = source.plausible(count, (min_size + 3 * item) as u64);
            reading.builder.reserve_corners(3 * triangles);
            reading.builder.start_records(FacePlaces::Records {
                first: source.offset(),
                per_face: min_size as u64,
                per_corner: item as u64,
            });
        }
        Role::Strips => reading.builder.start_records(FacePlaces::Bytes(Vec::new())),
        Role::Other => {}
    }
}

/// Reads the complete records in the buffer, adds their number to `done`, and returns their bytes.
fn read_buffered(
    reading: &mut Reading,
    source: &mut ByteSource<'_>,
    order: ByteOrder,
    done: &mut u64,
) -> Result<usize, ReadError> {
    let offset = source.offset();
    let filled = source.fill(1);
    let bytes = filled.map_err(|e| reading.builder.read_error(Place::Byte(offset), e))?;
    let mut taken = 0;
    while *done < reading.element.count {
        let place = offset + taken as u64;
        let Some(size) = read_record(reading, &bytes[taken..], order, place)? else {
            break;
        };
        taken += size;
        *done += 1;
    }
    Ok(taken)
}

/// Reads the record that `bytes` begins with and returns its size; `None` if it is not complete.
#[inline]
fn read_record(
    reading: &mut Reading,
    bytes: &[u8],
    order: ByteOrder,
    offset: u64,
) -> Result<Option<usize>, ReadError> {
    let mut at = 0;
    let mut position = [Coordinate::from(0.0_f32); 3];
    let place = Place::Byte(offset);
    for number in 0..reading.steps.len() {
        let rest = bytes.get(at..).unwrap_or_default();
        let size = match reading.steps[number] {
            Step::IgnoredNumber(scalar) => Some(scalar.size()),
            Step::Coordinate(coordinate, scalar) => {
                let Some(value) = scalar.coordinate(rest, order) else {
                    return Ok(None);
                };
                position[coordinate] = value;
                Some(scalar.size())
            }
            Step::IgnoredList { length, item } => {
                list_size(reading, rest, [length, item], order, place)?
            }
            Step::Indices { length, item } => {
                read_indices(reading, rest, [length, item], order, place)?
            }
        };
        let Some(size) = size else {
            return Ok(None);
        };
        at += size;
    }
    if at > bytes.len() {
        return Ok(None);
    }
    match reading.role {
        Role::Vertices(_) => reading.builder.push_vertex(position, place)?,
        Role::Faces | Role::Strips => reading.add_corners(place)?,
        Role::Other => {}
    }
    Ok(Some(at))
}

/// Returns the size of the list that `bytes` begins with; `None` if its length is not complete.
#[inline]
fn list_size(
    reading: &Reading,
    bytes: &[u8],
    [length, item]: [Scalar; 2],
    order: ByteOrder,
    place: Place,
) -> Result<Option<usize>, ReadError> {
    let Some(value) = length.whole(bytes, order) else {
        return Ok(None);
    };
    let items = value.and_then(|value| usize::try_from(value).ok());
    let size = items.and_then(|items| items.checked_mul(item.size())?.checked_add(length.size()));
    match size {
        Some(size) => Ok(Some(size)),
        None => {
            let text = value.map_or("2^63 or more".to_owned(), |value| value.to_string());
            Err(reading.bad_whole(place, "the length of a list", text))
        }
    }
}

/// Reads the indices of a face into `corners`.
#[inline]
fn read_indices(
    reading: &mut Reading,
    bytes: &[u8],
    [length, item]: [Scalar; 2],
    order: ByteOrder,
    place: Place,
) -> Result<Option<usize>, ReadError> {
    let Some(size) = list_size(reading, bytes, [length, item], order, place)? else {
        return Ok(None);
    };
    let Some(items) = bytes.get(length.size()..size) else {
        return Ok(None);
    };
    reading.corners.clear();
    for bytes in items.chunks_exact(item.size()) {
        match item.whole(bytes, order).flatten() {
            Some(index) => reading.corners.push(index),
            None => {
                let value = item
                    .coordinate(bytes, order)
                    .map_or(0.0, |value| value.wide);
                return Err(reading.bad_whole(place, "a vertex number", value.to_string()));
            }
        }
    }
    Ok(Some(size))
}
