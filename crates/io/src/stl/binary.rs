//! Reads binary STL: 80 bytes of text, the number of facets, and 50 bytes per facet.

use super::Facets;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::format::{STL_FACET, STL_HEADER, has_plausible_corners, is_text};
use crate::notice::IgnoredKind;
use crate::number::Coordinate;
use crate::place::{FacePlaces, Place};

/// The places of facets.
pub(super) const PLACES: FacePlaces = FacePlaces::Records {
    first: STL_HEADER as u64,
    per_face: STL_FACET as u64,
    per_corner: 0,
};

/// Reads all facets.
pub(super) fn read<'a>(
    mut facets: Facets<'a>,
    source: &mut ByteSource<'_>,
) -> Result<Facets<'a>, ReadError> {
    let count = read_count(&facets, source)?;
    facets.reserve(source.plausible(count, STL_FACET as u64));
    let mut left = count;
    while left > 0 {
        let offset = source.offset();
        let filled = source.fill(STL_FACET);
        let bytes = filled.map_err(|e| facets.builder.read_error(Place::Byte(offset), e))?;
        let records = bytes.as_chunks::<STL_FACET>().0;
        let taken = usize::try_from(left).map_or(records.len(), |left| left.min(records.len()));
        if taken == 0 {
            let place = Place::Byte(offset);
            let error = facets
                .builder
                .record_missing(place, "facet", count - left, count);
            return Err(error);
        }
        read_records(&mut facets, &records[..taken], offset)?;
        source.advance(taken * STL_FACET);
        left -= taken as u64;
    }
    read_uncounted(&mut facets, source)?;
    facets.flush()?;
    facets.builder.note_trailing(source)?;
    Ok(facets)
}

/// Reads the facets after those that the header counts: some programs write the header first, with
/// the number 0. The facets end where a record cannot be one.
fn read_uncounted(facets: &mut Facets, source: &mut ByteSource<'_>) -> Result<(), ReadError> {
    let mut is_first = true;
    loop {
        let offset = source.offset();
        let filled = source.fill(STL_FACET);
        let bytes = filled.map_err(|e| facets.builder.read_error(Place::Byte(offset), e))?;
        let records = bytes.as_chunks::<STL_FACET>().0;
        let taken = records.iter().take_while(|record| is_facet(record)).count();
        if taken == 0 {
            return Ok(());
        }
        if std::mem::take(&mut is_first) {
            let place = Place::Byte(STL_HEADER as u64 - 4);
            facets
                .builder
                .notices
                .add(IgnoredKind::SmallFacetCount, place);
        }
        read_records(facets, &records[..taken], offset)?;
        source.advance(taken * STL_FACET);
    }
}

/// Returns whether bytes after the facets of the header can be a facet, and not padding, text or
/// other data.
fn is_facet(record: &[u8; STL_FACET]) -> bool {
    record.iter().any(|&byte| byte != 0) && !is_text(record) && has_plausible_corners(record)
}

/// Reads the number of facets.
fn read_count(facets: &Facets, source: &mut ByteSource<'_>) -> Result<u64, ReadError> {
    let header = source.fill(STL_HEADER);
    let header = header.map_err(|e| facets.builder.read_error(Place::Byte(0), e))?;
    let Some(&[a, b, c, d]) = header.get(STL_HEADER - 4..STL_HEADER) else {
        let end = Place::Byte(header.len() as u64);
        let missing = "the number of facets".to_owned();
        return Err(facets.builder.truncated(end, missing));
    };
    source.advance(STL_HEADER);
    Ok(u64::from(u32::from_le_bytes([a, b, c, d])))
}

/// Adds the facets of `records`, which start at byte `offset`.
fn read_records(
    facets: &mut Facets,
    records: &[[u8; STL_FACET]],
    offset: u64,
) -> Result<(), ReadError> {
    let mut place = offset;
    for record in records {
        let numbers = record.as_chunks::<4>().0;
        let number = |i: usize| f32::from_le_bytes(numbers[i]);
        let corner = |i: usize| [3 * i, 3 * i + 1, 3 * i + 2].map(number);
        let corners = [corner(1), corner(2), corner(3)];
        let is_finite = |corner: &[f32; 3]| corner.iter().all(|x| x.is_finite());
        let corners = if corners.iter().all(is_finite) {
            corners.map(|corner| corner.map(Coordinate::from))
        } else {
            let wrong = corners
                .iter()
                .position(|corner| !is_finite(corner))
                .unwrap_or(0);
            return Err(infinite(facets, corners[wrong], place, wrong));
        };
        facets.push(corners, Place::Byte(place))?;
        if record[48..] != [0, 0] {
            facets
                .builder
                .notices
                .add(IgnoredKind::Colours, Place::Byte(place + 48));
        }
        place += STL_FACET as u64;
    }
    Ok(())
}

#[cold]
fn infinite(facets: &Facets, corner: [f32; 3], facet: u64, number: usize) -> ReadError {
    let place = Place::Byte(facet + 12 + 12 * number as u64);
    facets
        .builder
        .infinite(corner.map(Coordinate::from), place, number + 1)
}
