//! Converts a file into the form that `tobj` understands: blocks of plain vertices.

use std::io::{self, BufRead, Read, Write};

use sixfold_core::MAX_ROWS;

use crate::builder::MeshBuilder;
use crate::error::ReadError;
use crate::excerpt::shortened;
use crate::lines::{Lines, Start};
use crate::notice::IgnoredKind;
use crate::number::Coordinate;
use crate::place::{Location, Place};
use crate::tags::{Tag, Tags};

/// Number of vertices that are passed to the parser at once. It bounds the memory of the parser.
const BLOCK: usize = 1 << 14;

/// A reader that converts the vertices of a file into plain text, block by block, and takes the
/// faces and tags itself.
///
/// # Invariants
///
/// - N1  The text of a block is `v x y z` for each vertex, in file order, and then one polygon
///   through all vertices of the block, with indices from 1.
/// - N2  `fill_buf` returns one vertex at a time, so the parser always stops at the last vertex
///   that was returned.
/// - N3  `block` has the vertices of the block.
/// - N4  There are at most `limit` lines, vertices, and corners of faces.
pub(crate) struct Normaliser<'a, R> {
    lines: Lines<R>,
    /// Current logical line.
    statement: Vec<u8>,
    /// First physical line of the current logical line, counted from 1.
    line: u32,
    /// The converted statement; the parser has read the first `consumed` bytes.
    text: Vec<u8>,
    consumed: usize,
    progress: Progress,
    /// Number of vertices that were read.
    vertices: usize,
    corners: usize,
    /// Vertices of the current face, as rows.
    face: Vec<u32>,
    /// The vertices of the block.
    block: Vec<Vertex>,
    /// Maximum number of vertices, corners and lines.
    limit: usize,
    /// The fault at which reading stopped.
    pub(super) fault: Option<ReadError>,
    pub(super) tags: Tags,
    pub(super) builder: MeshBuilder<'a>,
}

/// A vertex before the parser has read it.
struct Vertex {
    line: u32,
    /// Position in 64 bits.
    wide: [f64; 3],
}

#[derive(PartialEq, Eq)]
enum Progress {
    AtStart,
    Inside,
    /// The block has all its vertices; its polygon follows.
    BlockIsFull,
    /// The polygon of the block was passed on.
    AtEndOfBlock,
    AtEnd,
}

impl<'a, R: BufRead> Normaliser<'a, R> {
    /// Creates a reader of `source`, which adds faces to `builder`.
    pub(super) fn new(builder: MeshBuilder<'a>, source: R) -> Self {
        Self {
            lines: Lines::new(source),
            statement: Vec::new(),
            line: 1,
            text: Vec::new(),
            consumed: 0,
            progress: Progress::AtStart,
            vertices: 0,
            corners: 0,
            face: Vec::new(),
            block: Vec::with_capacity(BLOCK),
            limit: MAX_ROWS,
            fault: None,
            tags: Tags::default(),
            builder,
        }
    }

    /// Adds the vertices of the block, which have these coordinates, and starts the next block.
    /// Returns whether there is one.
    pub(super) fn finish_block(&mut self, coordinates: &[f32]) -> Result<bool, ReadError> {
        let narrow = coordinates.as_chunks::<3>().0.iter();
        for (narrow, &Vertex { line, wide }) in narrow.zip(&self.block) {
            let coordinate = |i: usize| Coordinate {
                wide: wide[i],
                narrow: narrow[i],
            };
            let position = [0, 1, 2].map(coordinate);
            self.builder.push_vertex(position, Place::Line(line))?;
        }
        self.block.clear();
        if self.progress == Progress::AtEnd {
            return Ok(false);
        }
        self.progress = Progress::Inside;
        Ok(true)
    }

    /// Returns the fault at which the parser stopped, in the last statement.
    pub(super) fn diagnose(&self, refusal: &tobj::LoadError) -> ReadError {
        let at = self.location(self.line);
        let text = String::from_utf8_lossy(&self.text);
        let mut words = text.split_whitespace();
        if words.next() == Some("v") {
            let vertex = self.vertices;
            let found = words.clone().count();
            if let Some(bad) = words.find(|word| word.parse::<f32>().is_err()) {
                let text = shortened(bad);
                return ReadError::BadNumber { at, vertex, text };
            }
            if found < 3 {
                return ReadError::TooFewCoordinates {
                    at,
                    vertex,
                    found,
                    needed: 3,
                };
            }
        }
        let (text, reason) = (shortened(text.trim_end()), refusal.to_string());
        ReadError::Refused { at, text, reason }
    }

    /// Returns the location of line `line` in this file.
    pub(super) fn location(&self, line: u32) -> Location {
        self.builder.at(Place::Line(line))
    }

    /// Writes the next statement into `text`; at the end of the file, `text` is empty.
    fn advance(&mut self) -> Result<(), ReadError> {
        self.text.clear();
        self.consumed = 0;
        if self.progress == Progress::AtStart {
            self.progress = Progress::Inside;
            if let Start::Utf16 = self.lines.start().map_err(|e| self.read_error(e))? {
                return Err(ReadError::Utf16 {
                    at: self.location(1),
                });
            }
        }
        while self.text.is_empty() && self.progress == Progress::Inside {
            let mut statement = std::mem::take(&mut self.statement);
            let line = self.lines.read(&mut statement);
            match line.map_err(|e| self.read_error(e))? {
                Some(line) => {
                    self.check_limit("lines", usize::try_from(line).unwrap_or(usize::MAX))?;
                    self.line = u32::try_from(line).expect("the limit is below 2³²");
                    self.read(&statement)?;
                }
                None => {
                    self.progress = Progress::AtEnd;
                    self.write_polygon();
                }
            }
            self.statement = statement;
        }
        if self.text.is_empty() && self.progress == Progress::BlockIsFull {
            self.progress = Progress::AtEndOfBlock;
            self.write_polygon();
        }
        Ok(())
    }

    fn read_error(&self, cause: io::Error) -> ReadError {
        let line = u32::try_from(self.lines.count() + 1).unwrap_or(u32::MAX);
        let at = self.location(line);
        ReadError::Read { at, cause }
    }

    /// Parses one logical line.
    fn read(&mut self, statement: &[u8]) -> Result<(), ReadError> {
        let statement = statement.trim_ascii_start();
        let end = statement.iter().position(u8::is_ascii_whitespace);
        let (keyword, rest) = statement.split_at(end.unwrap_or(statement.len()));
        match keyword {
            b"" => Ok(()),
            b"v" => self.read_vertex(self.decode(rest)?),
            b"f" | b"fo" => self.read_face(self.decode(rest)?),
            b"t" => self.read_tag(rest),
            _ => {
                self.ignore(IgnoredKind::from_keyword(keyword));
                Ok(())
            }
        }
    }

    /// Parses `crease` and `corner` tags; other tags are ignored.
    fn read_tag(&mut self, tag: &[u8]) -> Result<(), ReadError> {
        let tag = tag.trim_ascii_start();
        let end = tag.iter().position(u8::is_ascii_whitespace);
        let (name, values) = tag.split_at(end.unwrap_or(tag.len()));
        let Some(tag) = Tag::from_name(name) else {
            self.ignore(IgnoredKind::from_tag(name));
            return Ok(());
        };
        let values = self.decode(values)?;
        let read = self.tags.read(tag, values, self.line);
        read.map_err(|fault| ReadError::Tag {
            at: self.location(self.line),
            fault,
        })?;
        self.check_limit("sharp edges and vertices", self.tags.len())
    }

    fn decode<'b>(&self, bytes: &'b [u8]) -> Result<&'b str, ReadError> {
        str::from_utf8(bytes).map_err(|_| ReadError::NotUtf8 {
            at: self.location(self.line),
        })
    }

    fn ignore(&mut self, kind: IgnoredKind) {
        self.builder.notices.add(kind, Place::Line(self.line));
    }

    /// Passes on the coordinates. The parser checks whether they are three numbers.
    fn read_vertex(&mut self, values: &str) -> Result<(), ReadError> {
        self.vertices += 1;
        self.check_limit("vertices", self.vertices)?;
        // Splits the values in the same way as the parser, also at white space outside ASCII.
        let mut words = values.split_whitespace();
        let mut wide = [0.0; 3];
        let mut are_numbers = true;
        self.text.push(b'v');
        for (word, wide) in words.by_ref().take(3).zip(&mut wide) {
            self.text.push(b' ');
            self.text.extend_from_slice(word.as_bytes());
            match word.parse() {
                Ok(number) => *wide = number,
                Err(_) => are_numbers = false, // the parser stops here
            }
        }
        self.text.push(b'\n');
        if words.clone().next().is_some() {
            const STATEMENTS: [&str; 7] = ["v", "vt", "vn", "f", "l", "g", "o"];
            let mut extra = words.take_while(|word| !word.starts_with('#'));
            if let Some(statement) = extra.find(|word| STATEMENTS.contains(word)) {
                let place = Place::Line(self.line);
                let expected = "a vertex alone on its line";
                return Err(self
                    .builder
                    .unexpected(place, expected, statement.as_bytes()));
            }
            self.ignore(IgnoredKind::ExtraValues);
        }
        if are_numbers && wide.iter().any(|x| !(*x as f32).is_finite()) {
            let place = Place::Line(self.line);
            return Err(self
                .builder
                .infinite(wide.map(Coordinate::from), place, self.vertices));
        }
        let line = self.line;
        self.block.push(Vertex { line, wide });
        if self.block.len() == BLOCK {
            self.progress = Progress::BlockIsFull;
        }
        Ok(())
    }

    /// Adds a face.
    fn read_face(&mut self, corners: &str) -> Result<(), ReadError> {
        let mut face = std::mem::take(&mut self.face);
        face.clear();
        for word in corners.split_whitespace() {
            face.push(self.read_corner(word)? - 1);
        }
        self.corners += face.len();
        self.check_limit("corners", self.corners)?;
        self.builder.push_face(&face, Place::Line(self.line))?;
        self.face = face;
        Ok(())
    }

    /// Returns the vertex number, counted from 1, of a corner such as `7`, `-1` or `7/1/3`. Whether
    /// the vertex exists is checked at the end, because it may follow.
    fn read_corner(&self, word: &str) -> Result<u32, ReadError> {
        let (index, _) = word.split_once('/').unwrap_or((word, ""));
        let before = self.vertices;
        let bad = || ReadError::BadCorner {
            at: self.location(self.line),
            text: shortened(word),
        };
        let index: i64 = index.parse().map_err(|_| bad())?;
        if index == 0 {
            let at = self.location(self.line);
            return Err(ReadError::IndexZero { at });
        }
        if index < 0 {
            let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
            return match before.checked_sub(back).map(u32::try_from) {
                Some(Ok(row)) => Ok(row + 1),
                _ => Err(ReadError::RelativeIndexOutOfRange {
                    at: self.location(self.line),
                    index,
                    before,
                }),
            };
        }
        u32::try_from(index).map_err(|_| bad())
    }

    /// Passes on the polygon through all vertices of the block. It keeps `tobj` from removing
    /// vertices, and from numbering them in another order.
    fn write_polygon(&mut self) {
        if !self.block.is_empty() {
            self.text.push(b'f');
            for number in 1..=self.block.len() {
                write!(self.text, " {number}").expect("writing to memory does not fail");
            }
            self.text.push(b'\n');
        }
    }

    fn check_limit(&self, elements: &'static str, count: usize) -> Result<(), ReadError> {
        if count > self.limit {
            return Err(ReadError::TooMany {
                at: self.location(self.line),
                elements,
                limit: self.limit,
            });
        }
        Ok(())
    }
}

impl<R: BufRead> BufRead for Normaliser<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.consumed == self.text.len()
            && let Err(fault) = self.advance()
        {
            self.fault = Some(fault);
            return Err(io::ErrorKind::InvalidData.into());
        }
        Ok(&self.text[self.consumed..])
    }

    fn consume(&mut self, bytes: usize) {
        self.consumed += bytes;
    }
}

impl<R: BufRead> Read for Normaliser<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(buffer)?;
        self.consume(read);
        Ok(read)
    }
}

#[cfg(test)]
mod tests;
