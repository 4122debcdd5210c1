//! Collects vertices and faces of a file, with the checks that all formats share.

use std::io;

use sixfold_core::{FaceId, FaceList, MAX_ROWS, Point, PolygonCutter, VertexId, row};

use crate::byte_source::{ByteSource, MAX_LINE_LENGTH};
use crate::error::ReadError;
use crate::face_rules::{repeated_vertex, without_repeats};
use crate::file_mesh::{FileMesh, ShortFace};
use crate::format::Format;
use crate::narrowing::{Finished, Origin, Positions};
use crate::notice::{IgnoredKind, Notices};
use crate::number::Coordinate;
use crate::options::{ReadOptions, Welding};
use crate::place::{FacePlaces, Location, Place, VertexPlaces};
use crate::welder::Welder;

/// The mesh of a file while it is read.
///
/// # Invariants
///
/// - B1  All positions are finite.
/// - B2  `places` has a place for each face.
/// - B3  There are at most [`MAX_ROWS`] vertices and corners.
pub(crate) struct MeshBuilder<'a> {
    name: &'a str,
    format: Format,
    options: ReadOptions,
    positions: Positions,
    faces: FaceList,
    places: FacePlaces,
    vertex_places: VertexPlaces,
    short_faces: Vec<ShortFace>,
    pub(crate) notices: Notices,
}

impl<'a> MeshBuilder<'a> {
    /// Creates an empty mesh of the file `name`. `places` is the kind of places that its faces have.
    pub(crate) fn new(
        name: &'a str,
        format: Format,
        options: ReadOptions,
        places: FacePlaces,
    ) -> Self {
        Self {
            name,
            format,
            options,
            positions: Positions::new(options.origin != Origin::Stored),
            faces: FaceList::default(),
            places,
            vertex_places: VertexPlaces::default(),
            short_faces: Vec::new(),
            notices: Notices::default(),
        }
    }

    /// Returns the name of the file.
    pub(crate) fn name(&self) -> &'a str {
        self.name
    }

    /// Sets the format, if the content decides between two forms.
    pub(crate) fn set_format(&mut self, format: Format) {
        self.format = format;
    }

    /// Returns the location of `place` in this file.
    pub(crate) fn at(&self, place: Place) -> Location {
        Location::new(self.name, place)
    }

    /// Sets the kind of places of faces in a binary file. If there are faces already, their kind
    /// stays.
    pub(crate) fn start_records(&mut self, places: FacePlaces) {
        if self.faces.is_empty() {
            self.places = places;
        }
    }

    /// Returns whether vertices with equal positions become one vertex, if the format has no
    /// numbers of vertices.
    pub(crate) fn welds_facets(&self) -> bool {
        self.options.welding != Welding::Nothing
    }

    /// Merges equal positions from now on; `vertices` is the expected number of different ones.
    pub(crate) fn weld(&mut self, vertices: usize) {
        self.positions.weld(vertices);
    }

    /// Adds vertices that may be equal to others, and appends their rows to `rows`. All
    /// coordinates must be finite.
    pub(crate) fn push_vertices(
        &mut self,
        vertices: &[[Coordinate; 3]],
        rows: &mut Vec<u32>,
        place: Place,
    ) -> Result<(), ReadError> {
        if self.positions.len() + vertices.len() > MAX_ROWS {
            return Err(self.too_many("vertices", place));
        }
        self.positions.push_all(vertices, rows);
        Ok(())
    }

    /// Reserves memory for `vertices` vertices, of which the caller is sure.
    pub(crate) fn reserve_vertices(&mut self, vertices: usize) {
        self.positions.reserve(vertices);
    }

    /// Returns the number of vertices.
    #[cfg(feature = "gltf")]
    pub(crate) fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Reserves memory for `corners` corners, of which the caller is sure. Does nothing if there
    /// are faces already.
    pub(crate) fn reserve_corners(&mut self, corners: usize) {
        if self.faces.is_empty() {
            self.faces = FaceList::with_capacity(corners);
        }
    }

    /// Returns the error of reading at `place`.
    pub(crate) fn read_error(&self, place: Place, cause: io::Error) -> ReadError {
        let at = self.at(place);
        match cause.kind() {
            io::ErrorKind::FileTooLarge => ReadError::LongLine {
                at,
                limit: MAX_LINE_LENGTH,
                format: self.format,
            },
            _ => ReadError::Read { at, cause },
        }
    }

    /// Returns the error of a text that is not as expected.
    pub(crate) fn unexpected(&self, place: Place, expected: &str, found: &[u8]) -> ReadError {
        ReadError::Unexpected {
            at: self.at(place),
            expected: expected.to_owned(),
            found: crate::excerpt::shortened(&String::from_utf8_lossy(found)),
        }
    }

    /// Returns the error of a file that ends before `missing`.
    pub(crate) fn truncated(&self, place: Place, missing: String) -> ReadError {
        let at = self.at(place);
        ReadError::Truncated {
            at,
            missing,
            way_out: "export it again",
        }
    }

    /// Returns the error of a file that ends before record `number`, counted from 0, of the `count`
    /// records of the kind `kind` that its header promises.
    pub(crate) fn record_missing(
        &self,
        place: Place,
        kind: &str,
        number: u64,
        count: u64,
    ) -> ReadError {
        ReadError::Truncated {
            at: self.at(place),
            missing: format!("{kind} {} of {count}", number + 1),
            // Only the header of a text can be corrected.
            way_out: match self.format.is_text() {
                true => "correct its counts",
                false => "export it again",
            },
        }
    }

    /// Returns the number that the next vertex has in the file.
    pub(crate) fn next_vertex(&self) -> usize {
        self.positions.len() + self.format.first_vertex()
    }

    /// Adds a vertex.
    #[inline]
    pub(crate) fn push_vertex(
        &mut self,
        coordinates: [Coordinate; 3],
        place: Place,
    ) -> Result<(), ReadError> {
        // The product of a number that is not finite with 0 is not 0.
        let zero = coordinates.map(|c| c.narrow * 0.0);
        if zero != [0.0; 3] || self.positions.len() >= MAX_ROWS {
            return Err(self.vertex_error(coordinates, place));
        }
        self.vertex_places.push(place);
        self.positions.push(coordinates);
        Ok(())
    }

    #[cold]
    pub(crate) fn vertex_error(&self, coordinates: [Coordinate; 3], place: Place) -> ReadError {
        if coordinates.iter().all(|c| c.narrow.is_finite()) {
            return self.too_many("vertices", place);
        }
        self.infinite(coordinates, place, self.next_vertex())
    }

    /// Returns the error of a coordinate that is not finite. `vertex` is the number of the vertex
    /// in the message; in STL that of the corner of its facet, from 1.
    #[cold]
    pub(crate) fn infinite(
        &self,
        coordinates: [Coordinate; 3],
        place: Place,
        vertex: usize,
    ) -> ReadError {
        not_finite(self.at(place), vertex, coordinates.map(|c| c.narrow))
    }

    fn too_many(&self, elements: &'static str, place: Place) -> ReadError {
        ReadError::TooMany {
            at: self.at(place),
            elements,
            limit: MAX_ROWS,
        }
    }

    /// Returns the row of the vertex that a face names with `index`, counted from 0. Whether the
    /// vertex exists is checked at the end, because it may follow.
    #[inline]
    pub(crate) fn vertex_row(
        &self,
        index: i64,
        place: impl Fn() -> Place,
    ) -> Result<u32, ReadError> {
        match u32::try_from(index) {
            Ok(row) if row < u32::MAX => Ok(row),
            _ => Err(self.index_error(index, place())),
        }
    }

    #[cold]
    fn index_error(&self, index: i64, place: Place) -> ReadError {
        ReadError::IndexOutOfRange {
            at: self.at(place),
            index,
            vertices: self.positions.len(),
        }
    }

    /// Adds a face without the corners that repeat their neighbours; if it has fewer than three
    /// corners, it is kept apart.
    #[inline]
    pub(crate) fn push_face(&mut self, corners: &[u32], place: Place) -> Result<(), ReadError> {
        if corners.len() < 3 {
            let corners = corners.iter().copied().map(VertexId::new).collect();
            self.short_faces.push(ShortFace { place, corners });
            return Ok(());
        }
        let kept = without_repeats(corners);
        if let Some(kept) = &kept {
            let repeats = (corners.len() - kept.len()) as u64;
            self.notices
                .add_many(IgnoredKind::RepeatedCorners, repeats, place);
        }
        let corners = kept.as_deref().unwrap_or(corners);
        match (place, &mut self.places) {
            (Place::Line(line), FacePlaces::Lines(lines)) => lines.push(line),
            (Place::Byte(byte), places) => places.push_byte(&self.faces, byte),
            _ => {}
        }
        let pushed = match *corners {
            [a, b, c] => self.faces.push([a, b, c].map(VertexId::new)),
            _ => self.faces.push(corners.iter().copied().map(VertexId::new)),
        };
        pushed.map_err(|_| self.too_many("corners", place))
    }

    /// Counts what follows the mesh: the bytes, or in a text file the lines, except white space and
    /// comments.
    pub(crate) fn note_trailing(&mut self, source: &mut ByteSource<'_>) -> Result<(), ReadError> {
        let is_text = self.format.is_text();
        let is_comment = |byte| byte == b'#' && self.format == Format::Off;
        let mut line = source.line_count().saturating_add(1);
        let mut is_blank = true;
        let mut before = 0;
        loop {
            let offset = source.offset();
            let bytes = source
                .fill(1)
                .map_err(|e| self.read_error(Place::Byte(offset), e))?;
            let length = bytes.len();
            if length == 0 {
                return Ok(());
            }
            for (&byte, offset) in bytes.iter().zip(offset..) {
                match std::mem::replace(&mut before, byte) {
                    b'\r' if byte == b'\n' => continue,
                    _ if matches!(byte, b'\n' | b'\r') => {
                        line = line.saturating_add(1);
                        is_blank = true;
                    }
                    _ if byte.is_ascii_whitespace() => {}
                    _ if !is_text => {
                        let place = Place::Byte(offset);
                        self.notices.add(IgnoredKind::Trailing, place);
                    }
                    _ => {
                        if is_blank && !is_comment(byte) {
                            let place = Place::Line(line);
                            self.notices.add(IgnoredKind::TrailingLines, place);
                        }
                        is_blank = false;
                    }
                }
            }
            source.advance(length);
        }
    }

    /// Checks the numbers of vertices, merges vertices with equal positions if the options say so,
    /// and returns the mesh.
    pub(crate) fn finish(self) -> Result<FileMesh, ReadError> {
        if self.positions.len() == 0 && self.faces.is_empty() && self.short_faces.is_empty() {
            return Err(ReadError::Empty {
                file: self.name.to_owned(),
                format: self.format,
            });
        }
        self.check_range()?;
        let welded_vertices = self.positions.welded();
        let is_welded_stl = self.welds_facets() && self.format.is_stl();
        let is_moved = self.options.origin != Origin::Stored;
        let Finished {
            points: positions,
            origin,
            narrowing,
        } = self.positions.finish(self.options.origin);
        // Only a mesh that is moved to a given origin can exceed 32 bits here (invariant B1).
        if let Some(v) = positions.iter().position(|p| !p.is_finite()) {
            let place = self.vertex_places.place(VertexId::new(row(v)));
            let at = Location::new(self.name, place.unwrap_or(Place::Byte(0)));
            let vertex = v + self.format.first_vertex();
            return Err(not_finite(at, vertex, positions[v].to_array()));
        }
        // Facets were welded before they were moved; rounding can make further positions equal.
        let weld_now = match is_welded_stl {
            true => is_moved && narrowing.merged_vertices > 0,
            false => self.options.welding == Welding::All,
        };
        let mut mesh = FileMesh {
            format: self.format,
            positions,
            faces: self.faces,
            face_places: self.places,
            vertex_places: self.vertex_places,
            short_faces: self.short_faces,
            crease_tags: Vec::new(),
            corner_tags: Vec::new(),
            notices: self.notices.0,
            welded_vertices,
            narrowing,
            origin,
        };
        if weld_now {
            mesh.weld();
        }
        mesh.cut_repeats();
        Ok(mesh)
    }

    /// Returns the first face with a vertex that does not exist, in the order of the file.
    fn check_range(&self) -> Result<(), ReadError> {
        let vertices = self.positions.len();
        let beyond = |v: &&VertexId| v.index() >= vertices;
        let index = |v: &VertexId| (v.index() + self.format.first_vertex()) as i64;
        let mut wrong = None;
        // Almost always no number is too high, and then the faces need not be told apart.
        if self.faces.corners().iter().any(|v| v.index() >= vertices) {
            let mut faces = self.faces.iter();
            wrong = faces.find_map(|(f, face)| {
                let v = face.iter().find(beyond)?;
                Some((self.places.place(f, &self.faces), index(v)))
            });
        }
        for short in &self.short_faces {
            if let Some(v) = short.corners.iter().find(beyond) {
                let other = (short.place, index(v));
                wrong = Some(wrong.map_or(other, |wrong| wrong.min(other)));
                break;
            }
        }
        match wrong {
            Some((place, index)) => Err(self.index_error(index, place)),
            None => Ok(()),
        }
    }
}

/// Returns the error of the first of three coordinates that is not finite.
fn not_finite(at: Location, vertex: usize, coordinates: [f32; 3]) -> ReadError {
    let named = ['x', 'y', 'z'].into_iter().zip(coordinates);
    let first = named.into_iter().find(|(_, value)| !value.is_finite());
    match first.unwrap_or(('x', f32::INFINITY)) {
        (coordinate, value) if value.is_nan() => ReadError::NotANumber {
            at,
            vertex,
            coordinate,
        },
        (coordinate, _) => ReadError::NonFinite {
            at,
            vertex,
            coordinate,
        },
    }
}

impl FileMesh {
    /// Cuts polygons that name a vertex twice into triangles that do not. Polygons that cross
    /// themselves, or have no area, stay as they are. O(corners) expected for faces without repeats.
    fn cut_repeats(&mut self) {
        let is_wanted = |face: &[VertexId]| face.len() > 3 && repeated_vertex(face).is_some();
        if !self.faces.iter().any(|(_, face)| is_wanted(face)) {
            return;
        }
        self.face_places.store(&self.faces);
        let mut faces = FaceList::with_capacity(self.faces.corners().len());
        let mut origins = Vec::with_capacity(self.faces.len());
        let mut notices = Notices(std::mem::take(&mut self.notices));
        let mut cutter = PolygonCutter::default();
        let mut push = |face: &mut dyn Iterator<Item = VertexId>, f: FaceId| {
            origins.push(f.index());
            faces.push(face).is_ok()
        };
        for (f, face) in self.faces.iter() {
            let is_wanted = is_wanted(face);
            let parts = is_wanted.then(|| {
                let position = |i: usize| self.positions[face[i].index()].as_dvec3();
                cutter.parts(face, position)
            });
            let parts = parts.filter(|parts| !parts.is_crossing && parts.iter().len() > 0);
            let Some(parts) = parts else {
                push(&mut face.iter().copied(), f);
                continue;
            };
            let place = self.face_places.place(f, &self.faces);
            notices.add(IgnoredKind::CutFaces, place);
            for part in parts.iter() {
                push(&mut part.iter().map(|&i| face[i]), f);
            }
        }
        self.notices = notices.0;
        self.face_places.select(&origins);
        self.faces = faces;
    }

    /// Merges vertices with equal positions; vertices are numbered by first occurrence.
    fn weld(&mut self) {
        let mut welder = Welder::with_capacity(0);
        let mut numbers = Vec::with_capacity(self.positions.len());
        let positions: Vec<Point> = std::mem::take(&mut self.positions);
        welder.number_all(&positions, &mut numbers);
        self.positions = welder.into_points();
        self.welded_vertices += positions.len() - self.positions.len();
        if self.positions.len() == positions.len() {
            return;
        }
        let all_places = std::mem::take(&mut self.vertex_places);
        let mut next = 0;
        for (v, &number) in (0..).map(VertexId::new).zip(&numbers) {
            if number == next {
                next += 1;
                all_places
                    .place(v)
                    .into_iter()
                    .for_each(|place| self.vertex_places.push(place));
            }
        }
        let renumber = |v: VertexId| VertexId::new(numbers[v.index()]);
        let mut faces = FaceList::with_capacity(self.faces.corners().len());
        let mut notices = Notices(std::mem::take(&mut self.notices));
        let mut welded = Vec::new();
        for (f, face) in self.faces.iter() {
            welded.clear();
            welded.extend(face.iter().copied().map(renumber));
            let kept = without_repeats(&welded);
            if let Some(kept) = &kept {
                self.face_places.store(&self.faces);
                let place = self.face_places.place(f, &self.faces);
                let repeats = (welded.len() - kept.len()) as u64;
                notices.add_many(IgnoredKind::RepeatedCorners, repeats, place);
            }
            let pushed = faces.push(kept.as_deref().unwrap_or(&welded).iter().copied());
            pushed.expect("at most as many corners as before");
        }
        self.notices = notices.0;
        self.faces = faces;
        let corners = self
            .short_faces
            .iter_mut()
            .flat_map(|face| &mut face.corners);
        corners.for_each(|v| *v = renumber(*v));
        let ends = self.crease_tags.iter_mut().flat_map(|tag| &mut tag.ends);
        ends.for_each(|v| *v = renumber(*v));
        self.corner_tags
            .iter_mut()
            .for_each(|tag| tag.vertex = renumber(tag.vertex));
    }
}
