//! Reads the records of a PLY file in text form: one record per line.

use super::Reading;
use super::layout::{Role, Step};
use crate::byte_source::{ByteSource, words};
use crate::error::ReadError;
use crate::excerpt::shortened;
use crate::notice::IgnoredKind;
use crate::number::{Coordinate, parse_coordinate, parse_whole};
use crate::place::Place;

/// The smallest number of bytes of a line with three numbers.
const MIN_LINE: u64 = 6;

/// Reads all records of an element.
pub(super) fn read(mut reading: Reading, source: &mut ByteSource<'_>) -> Result<(), ReadError> {
    let count = reading.element.count;
    if reading.steps.is_empty() {
        return Ok(()); // records without content, however many
    }
    let plausible = source.plausible(count, MIN_LINE);
    match reading.role {
        Role::Vertices(_) => reading.builder.reserve_vertices(plausible),
        Role::Faces => reading.builder.reserve_corners(3 * plausible),
        _ => {}
    }
    let mut done = 0;
    while done < count {
        let place = Place::Line(source.line_count().saturating_add(1));
        let line = source
            .line()
            .map_err(|e| reading.builder.read_error(place, e))?;
        let Some(line) = line else {
            return Err(reading.truncated(place, done));
        };
        if line.text.trim_ascii().is_empty() {
            continue;
        }
        read_record(&mut reading, line.text, place)?;
        done += 1;
    }
    Ok(())
}

/// Reads the record in a line.
fn read_record(reading: &mut Reading, text: &[u8], place: Place) -> Result<(), ReadError> {
    let mut words = words(text);
    let mut position = [Coordinate::from(0.0_f32); 3];
    for number in 0..reading.steps.len() {
        match reading.steps[number] {
            Step::Coordinate(coordinate, _) => {
                let word = value(reading, &mut words, number, place)?;
                position[coordinate] =
                    parse_coordinate(word).ok_or_else(|| ReadError::BadNumber {
                        at: reading.builder.at(place),
                        vertex: reading.builder.next_vertex(),
                        text: shown(word),
                    })?;
            }
            Step::IgnoredNumber(_) => {
                value(reading, &mut words, number, place)?;
            }
            Step::IgnoredList { .. } => {
                for _ in 0..list_length(reading, &mut words, number, place)? {
                    value(reading, &mut words, number, place)?;
                }
            }
            Step::Indices { .. } => {
                reading.corners.clear();
                for _ in 0..list_length(reading, &mut words, number, place)? {
                    let word = value(reading, &mut words, number, place)?;
                    let index = whole(reading, word, "a vertex number", place)?;
                    reading.corners.push(index);
                }
            }
        }
    }
    if words.next().is_some() {
        reading.builder.notices.add(IgnoredKind::ExtraValues, place);
    }
    match reading.role {
        Role::Vertices(_) => reading.builder.push_vertex(position, place),
        Role::Faces | Role::Strips => reading.add_corners(place),
        Role::Other => Ok(()),
    }
}

/// Returns the next value of property `number`.
fn value<'a>(
    reading: &Reading,
    words: &mut impl Iterator<Item = &'a [u8]>,
    number: usize,
    place: Place,
) -> Result<&'a [u8], ReadError> {
    words.next().ok_or_else(|| {
        let property = &reading.element.properties[number].name;
        let expected = format!("a value of {:?}", shortened(property));
        reading
            .builder
            .unexpected(place, &expected, b"the end of the line")
    })
}

/// Returns the length of list `number`.
fn list_length<'a>(
    reading: &Reading,
    words: &mut impl Iterator<Item = &'a [u8]>,
    number: usize,
    place: Place,
) -> Result<i64, ReadError> {
    let word = value(reading, words, number, place)?;
    let what = "the length of a list";
    let length = whole(reading, word, what, place)?;
    match length {
        0.. => Ok(length),
        _ => Err(reading.bad_whole(place, what, shown(word))),
    }
}

/// Parses a whole number; it may be written like a number with a fraction.
fn whole(
    reading: &Reading,
    word: &[u8],
    what: &'static str,
    place: Place,
) -> Result<i64, ReadError> {
    let as_float = || {
        let value = parse_coordinate(word)?.wide;
        let whole = value as i64;
        (whole as f64 == value).then_some(whole)
    };
    let whole = parse_whole(word).or_else(as_float);
    whole.ok_or_else(|| reading.bad_whole(place, what, shown(word)))
}

fn shown(word: &[u8]) -> String {
    shortened(&String::from_utf8_lossy(word))
}
