//! Reads OFF.

use crate::builder::MeshBuilder;
use crate::byte_source::{ByteSource, words};
use crate::error::ReadError;
use crate::excerpt::shortened;
use crate::file_mesh::FileMesh;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::number::{Coordinate, parse_coordinate, parse_whole};
use crate::off_keyword::OffKeyword;
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Place};

/// The smallest number of bytes of a line with three numbers.
const MIN_LINE: u64 = 6;

/// Reads OFF; O(bytes) expected.
pub(crate) fn read(
    name: &str,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let places = FacePlaces::Lines(Vec::new());
    let builder = MeshBuilder::new(name, Format::Off, options, places);
    let mut reader = Reader {
        builder,
        source,
        line: Vec::new(),
        number: 1,
        is_pending: false,
    };
    let header = reader.read_header()?;
    let Header {
        vertices, faces, ..
    } = header;
    let plausible = reader.source.plausible(vertices, MIN_LINE);
    reader.builder.reserve_vertices(plausible);
    for vertex in 0..vertices {
        reader.read_vertex(&header, vertex)?;
    }
    let plausible = reader.source.plausible(faces, MIN_LINE);
    reader.builder.reserve_corners(3 * plausible);
    let mut corners = Vec::new();
    for face in 0..faces {
        reader.read_face(&mut corners, face, faces)?;
    }
    let Reader {
        mut builder,
        source,
        ..
    } = reader;
    builder.note_trailing(source)?;
    builder.finish()
}

/// The header of a file.
struct Header {
    keyword: OffKeyword,
    vertices: u64,
    faces: u64,
}

/// Reads lines without comments and blank lines.
struct Reader<'a, 'b, 's> {
    builder: MeshBuilder<'b>,
    source: &'a mut ByteSource<'s>,
    /// The current line without its comment.
    line: Vec<u8>,
    /// The number of the current line.
    number: u32,
    /// Whether [`next_line`](Self::next_line) returns the current line once more.
    is_pending: bool,
}

impl Reader<'_, '_, '_> {
    fn place(&self) -> Place {
        Place::Line(self.number)
    }

    /// Reads the next line with a word; returns whether there is one.
    fn next_line(&mut self) -> Result<bool, ReadError> {
        if std::mem::take(&mut self.is_pending) {
            return Ok(true);
        }
        loop {
            let place = Place::Line(self.source.line_count().saturating_add(1));
            let line = self
                .source
                .line()
                .map_err(|e| self.builder.read_error(place, e))?;
            let Some(line) = line else {
                return Ok(false);
            };
            self.number = line.number;
            let text = match line.number {
                1 => line.text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line.text),
                _ => line.text,
            };
            let end = text
                .iter()
                .position(|&byte| byte == b'#')
                .unwrap_or(text.len());
            let text = text[..end].trim_ascii();
            if !text.is_empty() {
                self.line.clear();
                self.line.extend_from_slice(text);
                return Ok(true);
            }
        }
    }

    /// Reads the keyword, if there is one, and the counts, which may be on lines of their own.
    fn read_header(&mut self) -> Result<Header, ReadError> {
        if !self.next_line()? {
            let file = self.builder.name().to_owned();
            let format = Format::Off;
            return Err(ReadError::Empty { file, format });
        }
        let mut words = self.words();
        let parsed = words.first().and_then(|word| OffKeyword::parse(word));
        let parsed = parsed.map(|(keyword, digits)| (keyword, digits.to_vec()));
        let keyword = parsed.map_or_else(OffKeyword::default, |(keyword, digits)| {
            match digits.is_empty() {
                true => drop(words.remove(0)),
                false => words[0] = digits,
            }
            keyword
        });
        let is_binary = |word: &Vec<u8>| word.eq_ignore_ascii_case(b"binary");
        if words.first().is_some_and(is_binary) {
            let feature = "the file is binary OFF".to_owned();
            return Err(self.unsupported(feature, "save it as text, or as PLY"));
        }
        if keyword.any_dimension {
            self.check_dimension(&mut words)?;
        }
        let [vertices, faces] = self.read_counts(words)?;
        Ok(Header {
            keyword,
            vertices,
            faces,
        })
    }

    /// Returns the words of the current line.
    fn words(&self) -> Vec<Vec<u8>> {
        words(&self.line).map(<[u8]>::to_vec).collect()
    }

    /// Removes the number of coordinates, which must be 3, from `words` or from the next line.
    fn check_dimension(&mut self, words: &mut Vec<Vec<u8>>) -> Result<(), ReadError> {
        if words.is_empty() {
            if !self.next_line()? {
                let missing = "the number of coordinates".to_owned();
                return Err(self.builder.truncated(self.place(), missing));
            }
            *words = self.words();
        }
        let word = words.remove(0);
        match parse_whole::<u64>(&word) {
            Some(3) => Ok(()),
            Some(dimension) => {
                let feature = format!("points have {dimension} coordinates");
                Err(self.unsupported(feature, "write three coordinates"))
            }
            None => {
                let expected = "the number of coordinates";
                Err(self.builder.unexpected(self.place(), expected, &word))
            }
        }
    }

    /// Parses the numbers of vertices, faces and edges, of which `words` are the first ones. The
    /// number of edges is not used and may be missing.
    fn read_counts(&mut self, mut words: Vec<Vec<u8>>) -> Result<[u64; 2], ReadError> {
        let mut counts: Vec<u64> = Vec::new();
        loop {
            for word in &words {
                match parse_whole::<u64>(word) {
                    Some(count) if counts.len() < 3 => counts.push(count),
                    _ => {
                        let expected = "OFF, or the numbers of vertices, faces and edges";
                        let found = words.join(&b' ');
                        return Err(self.builder.unexpected(self.place(), expected, &found));
                    }
                }
            }
            if counts.len() == 3 {
                break;
            }
            if !self.next_line()? {
                if counts.len() == 2 {
                    break;
                }
                let missing = match counts.len() {
                    0 => "the numbers of vertices and faces",
                    _ => "the number of faces",
                };
                return Err(self.builder.truncated(self.place(), missing.to_owned()));
            }
            words = self.words();
            // A line with one number cannot be a vertex: it is the number of edges.
            if counts.len() == 2 && words.len() > 1 {
                self.is_pending = true;
                break;
            }
        }
        Ok([counts[0], counts[1]])
    }

    fn unsupported(&self, feature: String, way_out: &'static str) -> ReadError {
        ReadError::Unsupported {
            at: self.builder.at(self.place()),
            feature,
            way_out,
        }
    }

    /// Reads the line of a vertex.
    fn read_vertex(&mut self, header: &Header, number: u64) -> Result<(), ReadError> {
        if !self.next_line()? {
            let count = header.vertices;
            let error = self
                .builder
                .record_missing(self.place(), "vertex", number, count);
            return Err(error);
        }
        let mut words = words(&self.line);
        let mut values = [Coordinate::from(0.0_f32); 4];
        let wanted = if header.keyword.homogeneous { 4 } else { 3 };
        for (i, value) in values[..wanted].iter_mut().enumerate() {
            let at = || self.builder.at(Place::Line(self.number));
            let vertex = self.builder.next_vertex();
            let word = words.next().ok_or_else(|| ReadError::TooFewCoordinates {
                at: at(),
                vertex,
                found: i,
                needed: wanted,
            })?;
            *value = parse_coordinate(word).ok_or_else(|| ReadError::BadNumber {
                at: at(),
                vertex,
                text: shortened(&String::from_utf8_lossy(word)),
            })?;
        }
        let rest = words.count();
        let place = Place::Line(self.number);
        self.note_rest(header.keyword, rest, place);
        let [x, y, z, w] = values;
        let position = match header.keyword.homogeneous {
            true => [x, y, z].map(|c| Coordinate::from(c.wide / w.wide)),
            false => [x, y, z],
        };
        self.builder.push_vertex(position, place)
    }

    /// Counts the values after the coordinates of a vertex.
    fn note_rest(&mut self, keyword: OffKeyword, mut rest: usize, place: Place) {
        let notices = &mut self.builder.notices;
        let mut take = |is_there: bool, values: usize, kind: IgnoredKind| {
            if is_there && rest > 0 {
                rest = rest.saturating_sub(values);
                notices.add(kind, place);
            }
        };
        take(keyword.normal, 3, IgnoredKind::Normals);
        // Colours have three or four values, so what follows them cannot be told apart.
        take(keyword.colour, usize::MAX, IgnoredKind::Colours);
        take(keyword.texture, 2, IgnoredKind::TextureCoordinates);
        take(true, usize::MAX, IgnoredKind::ExtraValues);
        if keyword.colour && keyword.texture {
            notices.add(IgnoredKind::TextureCoordinates, place);
        }
    }

    /// Reads a face. Its vertices may continue on further lines; what follows them is a colour.
    fn read_face(
        &mut self,
        corners: &mut Vec<u32>,
        number: u64,
        faces: u64,
    ) -> Result<(), ReadError> {
        if !self.next_line()? {
            let error = self
                .builder
                .record_missing(self.place(), "face", number, faces);
            return Err(error);
        }
        let place = Place::Line(self.number);
        let word = words(&self.line).next().unwrap_or_default();
        let degree: u64 = parse_whole(word).ok_or_else(|| self.bad("a number of corners", word))?;
        corners.clear();
        let mut has_rest = self.read_corners(corners, degree, 1)?;
        while (corners.len() as u64) < degree {
            let missing = degree - corners.len() as u64;
            // A line with more numbers than are missing is the next face.
            if !self.next_line()? || words(&self.line).count() as u64 > missing {
                let expected = format!("{degree} vertices of a face");
                let found = format!("{} of them", corners.len());
                return Err(self.builder.unexpected(place, &expected, found.as_bytes()));
            }
            has_rest = self.read_corners(corners, degree, 0)?;
        }
        if has_rest {
            self.builder.notices.add(IgnoredKind::Colours, place);
        }
        self.builder.push_face(corners, place)
    }

    /// Adds the vertices in the current line after its first `skipped` words, until the face has
    /// `degree` of them; returns whether further words follow.
    fn read_corners(
        &self,
        corners: &mut Vec<u32>,
        degree: u64,
        skipped: usize,
    ) -> Result<bool, ReadError> {
        let mut words = words(&self.line).skip(skipped);
        while (corners.len() as u64) < degree {
            let Some(word) = words.next() else {
                return Ok(false);
            };
            let index = parse_whole(word).ok_or_else(|| self.bad("a vertex number", word))?;
            corners.push(self.builder.vertex_row(index, || self.place())?);
        }
        Ok(words.next().is_some())
    }

    /// Returns the error of a word of the current line that is not a whole number.
    fn bad(&self, what: &'static str, word: &[u8]) -> ReadError {
        ReadError::BadWhole {
            at: self.builder.at(self.place()),
            what,
            text: shortened(&String::from_utf8_lossy(word)),
        }
    }
}
