//! Reads STL.

mod ascii;
mod binary;

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::file_mesh::FileMesh;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::number::Coordinate;
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Place};

/// Number of facets whose corners are numbered together.
const BATCH: usize = 256;

/// Reads the binary form; O(bytes) expected.
pub(crate) fn read_binary(
    name: &str,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let builder = MeshBuilder::new(name, Format::Stl, options, binary::PLACES);
    let facets = binary::read(Facets::new(builder), source)?;
    facets.builder.finish()
}

/// Reads the binary form of a stream whose format is not known; `None` if its number of facets is
/// not that of the facets that follow, so that it is not STL. O(bytes) expected.
pub(crate) fn read_binary_if_complete(
    name: &str,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<Option<FileMesh>, ReadError> {
    match read_binary(name, source, options) {
        Ok(mesh) => {
            let mut kinds = mesh.notices.iter().map(|notice| notice.kind);
            let differs =
                |kind| matches!(kind, IgnoredKind::Trailing | IgnoredKind::SmallFacetCount);
            Ok((!kinds.any(differs)).then_some(mesh))
        }
        Err(
            ReadError::Truncated { .. }
            | ReadError::NonFinite { .. }
            | ReadError::NotANumber { .. },
        ) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Reads the text form; O(bytes) expected.
pub(crate) fn read_ascii(
    name: &str,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let places = FacePlaces::Lines(Vec::new());
    let builder = MeshBuilder::new(name, Format::StlAscii, options, places);
    let facets = ascii::read(Facets::new(builder), source)?;
    facets.builder.finish()
}

/// A builder that takes facets: triangles with coordinates instead of vertex numbers.
struct Facets<'a> {
    builder: MeshBuilder<'a>,
    /// The corners of facets that are not numbered yet, and the places of these facets.
    corners: Vec<[Coordinate; 3]>,
    places: Vec<Place>,
    numbers: Vec<u32>,
}

impl<'a> Facets<'a> {
    fn new(builder: MeshBuilder<'a>) -> Self {
        Self {
            builder,
            corners: Vec::with_capacity(3 * BATCH),
            places: Vec::with_capacity(BATCH),
            numbers: Vec::with_capacity(3 * BATCH),
        }
    }

    /// Prepares for `facets` facets, of which the caller is sure.
    fn reserve(&mut self, facets: usize) {
        self.builder.reserve_corners(3 * facets);
        if self.builder.welds_facets() {
            // A closed mesh has half as many vertices as facets. If there are more, the table grows.
            self.builder.weld(facets / 2 + facets / 64);
        } else {
            self.builder.reserve_vertices(3 * facets);
        }
    }

    /// Adds a facet; its coordinates must be finite.
    #[inline]
    fn push(&mut self, corners: [[Coordinate; 3]; 3], place: Place) -> Result<(), ReadError> {
        self.corners.extend_from_slice(&corners);
        self.places.push(place);
        if self.places.len() == BATCH {
            self.flush()?;
        }
        Ok(())
    }

    /// Numbers the corners of all facets that were added.
    fn flush(&mut self) -> Result<(), ReadError> {
        let Some(&last) = self.places.last() else {
            return Ok(());
        };
        self.numbers.clear();
        self.builder
            .push_vertices(&self.corners, &mut self.numbers, last)?;
        let triangles = self.numbers.as_chunks::<3>().0.iter();
        for (triangle, &place) in triangles.zip(&self.places) {
            self.builder.push_face(triangle, place)?;
        }
        self.corners.clear();
        self.places.clear();
        Ok(())
    }
}
