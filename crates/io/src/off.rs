//! Reads OFF.

use std::io::Read;

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::{ReadError, shortened};
use crate::file_mesh::FileMesh;
use crate::format::{Format, off_prefixes};
use crate::notice::IgnoredKind;
use crate::number::{Coordinate, parse_coordinate, parse_whole};
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Place};

/// The smallest number of bytes of a line with three numbers.
const MIN_LINE: u64 = 6;

/// Reads OFF; O(bytes) expected.
pub(crate) fn read(
    name: &str,
    source: &mut ByteSource<impl Read>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let places = FacePlaces::Lines(Vec::new());
    let builder = MeshBuilder::new(name, Format::Off, options, places);
    let mut reader = Reader {
        builder,
        source,
        line: Vec::new(),
        number: 1,
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
    /// Whether a vertex has texture coordinates, a colour, a normal, and a fourth coordinate.
    texture: bool,
    colour: bool,
    normal: bool,
    homogeneous: bool,
    vertices: u64,
    faces: u64,
}

/// Reads lines without comments and blank lines.
struct Reader<'a, 'b, R> {
    builder: MeshBuilder<'b>,
    source: &'a mut ByteSource<R>,
    /// The current line without its comment.
    line: Vec<u8>,
    /// The number of the current line.
    number: u32,
}

impl<R: Read> Reader<'_, '_, R> {
    fn place(&self) -> Place {
        Place::Line(self.number)
    }

    /// Reads the next line with a word; returns whether there is one.
    fn next_line(&mut self) -> Result<bool, ReadError> {
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

    /// Reads the keyword and the counts, which may be on one line. The keyword may be missing.
    fn read_header(&mut self) -> Result<Header, ReadError> {
        if !self.next_line()? {
            let file = self.builder.name().to_owned();
            let format = Format::Off;
            return Err(ReadError::Empty { file, format });
        }
        let line = std::mem::take(&mut self.line);
        let mut words = crate::byte_source::words(&line).peekable();
        let keyword = words.next_if(|word| word.ends_with(b"OFF"));
        let prefixes = keyword.map_or(Some(&b""[..]), off_prefixes);
        let Some(prefixes) = prefixes else {
            let found = keyword.unwrap_or_default();
            return Err(self.builder.unexpected(self.place(), "OFF", found));
        };
        let has = |letter: u8| prefixes.contains(&letter);
        if has(b'n') {
            return Err(self.unsupported("points of n dimensions", "write three coordinates"));
        }
        if words
            .peek()
            .is_some_and(|word| word.eq_ignore_ascii_case(b"binary"))
        {
            return Err(self.unsupported("the file is binary OFF", "save it as text, or as PLY"));
        }
        let rest: Vec<&[u8]> = words.collect();
        let [vertices, faces] = if rest.is_empty() {
            if !self.next_line()? {
                let missing = "the numbers of vertices and faces".to_owned();
                return Err(self.builder.truncated(self.place(), missing));
            }
            let line = std::mem::take(&mut self.line);
            let words: Vec<&[u8]> = crate::byte_source::words(&line).collect();
            self.parse_counts(&words)?
        } else {
            self.parse_counts(&rest)?
        };
        Ok(Header {
            texture: has(b'T'),
            colour: has(b'C'),
            normal: has(b'N'),
            homogeneous: has(b'4'),
            vertices,
            faces,
        })
    }

    /// Parses the numbers of vertices, faces and edges; the last one is not used.
    fn parse_counts(&self, words: &[&[u8]]) -> Result<[u64; 2], ReadError> {
        let count = |word: Option<&&[u8]>| word.and_then(|word| parse_whole::<u64>(word));
        let counts = count(words.first()).zip(count(words.get(1)));
        let Some((vertices, faces)) = counts.filter(|_| words.len() <= 3) else {
            let expected = "OFF, or the numbers of vertices, faces and edges";
            let found = words.join(&b' ');
            return Err(self.builder.unexpected(self.place(), expected, &found));
        };
        Ok([vertices, faces])
    }

    fn unsupported(&self, feature: &str, way_out: &'static str) -> ReadError {
        ReadError::Unsupported {
            at: self.builder.at(self.place()),
            feature: feature.to_owned(),
            way_out,
        }
    }

    /// Reads the line of a vertex.
    fn read_vertex(&mut self, header: &Header, number: u64) -> Result<(), ReadError> {
        if !self.next_line()? {
            let missing = format!("vertex {} of {}", number + 1, header.vertices);
            return Err(self.builder.truncated(self.place(), missing));
        }
        let mut words = crate::byte_source::words(&self.line);
        let mut values = [Coordinate::from(0.0_f32); 4];
        let wanted = if header.homogeneous { 4 } else { 3 };
        for (i, value) in values[..wanted].iter_mut().enumerate() {
            let at = || self.builder.at(Place::Line(self.number));
            let vertex = self.builder.next_vertex();
            let word = words.next().ok_or_else(|| ReadError::TooFewCoordinates {
                at: at(),
                vertex,
                found: i,
            })?;
            *value = parse_coordinate(word).ok_or_else(|| ReadError::BadNumber {
                at: at(),
                vertex,
                text: shortened(&String::from_utf8_lossy(word)),
            })?;
        }
        let rest = words.count();
        let place = Place::Line(self.number);
        self.note_rest(header, rest, place);
        let [x, y, z, w] = values;
        let position = match header.homogeneous {
            true => [x, y, z].map(|c| Coordinate::from(c.wide / w.wide)),
            false => [x, y, z],
        };
        self.builder.push_vertex(position, || place)
    }

    /// Counts the values after the coordinates of a vertex.
    fn note_rest(&mut self, header: &Header, mut rest: usize, place: Place) {
        let notices = &mut self.builder.notices;
        let mut take = |is_there: bool, values: usize, kind: IgnoredKind| {
            if is_there && rest > 0 {
                rest = rest.saturating_sub(values);
                notices.add(kind, place);
            }
        };
        take(header.normal, 3, IgnoredKind::Normals);
        // Colours have three or four values, so what follows them cannot be told apart.
        take(header.colour, usize::MAX, IgnoredKind::Colours);
        take(header.texture, 2, IgnoredKind::TextureCoordinates);
        take(true, usize::MAX, IgnoredKind::ExtraValues);
        if header.colour && header.texture {
            notices.add(IgnoredKind::TextureCoordinates, place);
        }
    }

    /// Reads the line of a face. What follows its vertices is a colour.
    fn read_face(
        &mut self,
        corners: &mut Vec<u32>,
        number: u64,
        faces: u64,
    ) -> Result<(), ReadError> {
        if !self.next_line()? {
            let missing = format!("face {} of {faces}", number + 1);
            return Err(self.builder.truncated(self.place(), missing));
        }
        let place = Place::Line(self.number);
        let mut words = crate::byte_source::words(&self.line);
        let bad = |what, word: &[u8]| ReadError::BadWhole {
            at: self.builder.at(place),
            what,
            text: shortened(&String::from_utf8_lossy(word)),
        };
        let word = words.next().unwrap_or_default();
        let degree = parse_whole::<u64>(word).ok_or_else(|| bad("a number of corners", word))?;
        corners.clear();
        for found in 0..degree {
            let Some(word) = words.next() else {
                let expected = format!("{degree} vertices of a face");
                let found = format!("{found} of them");
                return Err(self.builder.unexpected(place, &expected, found.as_bytes()));
            };
            let index = parse_whole(word).ok_or_else(|| bad("a vertex number", word))?;
            corners.push(self.builder.vertex_row(index, || place)?);
        }
        if words.next().is_some() {
            self.builder.notices.add(IgnoredKind::Colours, place);
        }
        self.builder.push_face(corners, place)
    }
}
