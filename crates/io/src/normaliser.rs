//! Converts a file into the form that `tobj` understands: one object of plain statements.

use std::io::{self, BufRead, Read, Write};

use sixfold_core::{MAX_ROWS, VertexId};

use crate::error::{Location, ObjError, shortened};
use crate::lines::{Lines, Start};
use crate::notice::{IgnoredKind, Notice, add_notice};
use crate::obj_mesh::ShortFace;
use crate::tags::{Tag, Tags};

/// A reader that converts a file into plain statements, one at a time.
///
/// # Invariants
///
/// - N1  The text is `v x y z` for every vertex and `f i j k …` for every face with three or more
///   corners, in file order, with indices from 1. The last statement is one polygon through all
///   vertices.
/// - N2  `fill_buf` returns one statement at a time. Therefore the parser always stops at the last
///   returned statement.
/// - N3  `vertex_lines` and `face_lines` have one entry for each returned vertex and face.
/// - N4  When the last polygon is returned, every index of every face is in range.
/// - N5  There are at most `limit` lines, vertices, and corners of faces.
pub(crate) struct Normaliser<'a, R> {
    name: &'a str,
    lines: Lines<R>,
    /// Current logical line.
    statement: Vec<u8>,
    /// First physical line of the current logical line, counted from 1.
    line: u32,
    /// The converted statement; the parser has read the first `consumed` bytes.
    text: Vec<u8>,
    consumed: usize,
    progress: Progress,
    /// Vertex numbers that a face used before the vertex was read, with the line of the face. Only
    /// a number above all earlier entries is added.
    forward_references: Vec<(u32, u32)>,
    corners: usize,
    /// Maximum number of vertices, corners and lines.
    limit: usize,
    /// The fault that ended the reading.
    pub(crate) fault: Option<ObjError>,
    pub(crate) vertex_lines: Vec<u32>,
    pub(crate) face_lines: Vec<u32>,
    pub(crate) short_faces: Vec<ShortFace>,
    pub(crate) tags: Tags,
    pub(crate) notices: Vec<Notice>,
}

#[derive(PartialEq, Eq)]
enum Progress {
    AtStart,
    Inside,
    AtEnd,
}

impl<'a, R: BufRead> Normaliser<'a, R> {
    pub(crate) fn new(name: &'a str, source: R) -> Self {
        Self {
            name,
            lines: Lines::new(source),
            statement: Vec::new(),
            line: 1,
            text: Vec::new(),
            consumed: 0,
            progress: Progress::AtStart,
            forward_references: Vec::new(),
            corners: 0,
            limit: MAX_ROWS,
            fault: None,
            vertex_lines: Vec::new(),
            face_lines: Vec::new(),
            short_faces: Vec::new(),
            tags: Tags::default(),
            notices: Vec::new(),
        }
    }

    /// Returns the fault in the last statement, at which the parser stopped.
    pub(crate) fn diagnose(&self, refusal: &tobj::LoadError) -> ObjError {
        let at = self.location(self.line);
        let text = String::from_utf8_lossy(&self.text);
        let mut words = text.split_whitespace();
        if words.next() == Some("v") {
            let vertex = self.vertex_lines.len();
            let found = words.clone().count();
            if let Some(bad) = words.find(|word| word.parse::<f32>().is_err()) {
                let text = shortened(bad);
                return ObjError::BadNumber { at, vertex, text };
            }
            if found < 3 {
                return ObjError::TooFewCoordinates { at, vertex, found };
            }
        }
        let (text, reason) = (shortened(text.trim_end()), refusal.to_string());
        ObjError::Refused { at, text, reason }
    }

    pub(crate) fn location(&self, line: u32) -> Location {
        let file = self.name.to_owned();
        Location { file, line }
    }

    /// Writes the next statement into `text`; at the end of the file, `text` is empty.
    fn advance(&mut self) -> Result<(), ObjError> {
        self.text.clear();
        self.consumed = 0;
        if self.progress == Progress::AtStart {
            self.progress = Progress::Inside;
            if let Start::Utf16 = self.lines.start().map_err(|e| self.read_error(e))? {
                return Err(ObjError::Utf16 {
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
                None => self.finish()?,
            }
            self.statement = statement;
        }
        Ok(())
    }

    fn read_error(&self, cause: io::Error) -> ObjError {
        let line = u32::try_from(self.lines.count() + 1).unwrap_or(u32::MAX);
        let at = self.location(line);
        ObjError::Read { at, cause }
    }

    /// Parses one logical line.
    fn read(&mut self, statement: &[u8]) -> Result<(), ObjError> {
        let statement = statement.trim_ascii_start();
        let end = statement.iter().position(u8::is_ascii_whitespace);
        let (keyword, rest) = statement.split_at(end.unwrap_or(statement.len()));
        match keyword {
            b"" => Ok(()),
            b"v" => self.read_vertex(self.decode(rest)?),
            b"f" | b"fo" => self.read_face(self.decode(rest)?),
            b"t" => self.read_tag(rest),
            _ => {
                add_notice(
                    &mut self.notices,
                    IgnoredKind::from_keyword(keyword),
                    self.line,
                );
                Ok(())
            }
        }
    }

    /// Parses `crease` and `corner` tags; other tags are ignored.
    fn read_tag(&mut self, tag: &[u8]) -> Result<(), ObjError> {
        let tag = tag.trim_ascii_start();
        let end = tag.iter().position(u8::is_ascii_whitespace);
        let (name, values) = tag.split_at(end.unwrap_or(tag.len()));
        let Some(tag) = Tag::from_name(name) else {
            add_notice(&mut self.notices, IgnoredKind::from_tag(name), self.line);
            return Ok(());
        };
        let values = self.decode(values)?;
        let read = self.tags.read(tag, values, self.line);
        read.map_err(|fault| ObjError::Tag {
            at: self.location(self.line),
            fault,
        })?;
        self.check_limit("sharp edges and vertices", self.tags.len())
    }

    fn decode<'b>(&self, bytes: &'b [u8]) -> Result<&'b str, ObjError> {
        str::from_utf8(bytes).map_err(|_| ObjError::NotUtf8 {
            at: self.location(self.line),
        })
    }

    /// Writes the coordinates into `text`. The parser checks whether there are three numbers.
    fn read_vertex(&mut self, values: &str) -> Result<(), ObjError> {
        self.vertex_lines.push(self.line);
        self.check_limit("vertices", self.vertex_lines.len())?;
        // The parser splits the values in the same way, also at white space outside ASCII.
        let mut words = values.split_whitespace();
        self.text.push(b'v');
        for word in words.by_ref().take(3) {
            self.text.push(b' ');
            self.text.extend_from_slice(word.as_bytes());
        }
        self.text.push(b'\n');
        if words.next().is_some() {
            add_notice(&mut self.notices, IgnoredKind::ExtraValues, self.line);
        }
        Ok(())
    }

    /// Writes the corners into `text`, or into `short_faces` if there are fewer than three corners.
    fn read_face(&mut self, corners: &str) -> Result<(), ObjError> {
        let mut count = 0;
        let mut first_two = [0; 2];
        self.text.push(b'f');
        for word in corners.split_whitespace() {
            let number = self.read_corner(word)?;
            write!(self.text, " {number}").expect("writing to memory does not fail");
            if let Some(first) = first_two.get_mut(count) {
                *first = number;
            }
            count += 1;
        }
        self.text.push(b'\n');
        self.corners += count;
        self.check_limit("corners", self.corners)?;
        if count < 3 {
            self.text.clear();
            let corners = first_two[..count].iter().map(|n| VertexId::new(n - 1));
            self.short_faces.push(ShortFace {
                line: self.line,
                corners: corners.collect(),
            });
        } else {
            self.face_lines.push(self.line);
        }
        Ok(())
    }

    /// Returns the vertex number of a corner such as `7`, `-1` or `7/1/3`, counted from 1.
    fn read_corner(&mut self, word: &str) -> Result<u32, ObjError> {
        let (index, _) = word.split_once('/').unwrap_or((word, ""));
        let before = self.vertex_lines.len();
        let bad = || ObjError::BadCorner {
            at: self.location(self.line),
            text: shortened(word),
        };
        let index: i64 = index.parse().map_err(|_| bad())?;
        if index == 0 {
            let at = self.location(self.line);
            return Err(ObjError::IndexZero { at });
        }
        if index < 0 {
            let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
            return match before.checked_sub(back).map(u32::try_from) {
                Some(Ok(row)) => Ok(row + 1),
                _ => Err(ObjError::RelativeIndexOutOfRange {
                    at: self.location(self.line),
                    index,
                    before,
                }),
            };
        }
        let number = u32::try_from(index).map_err(|_| bad())?;
        let highest = self
            .forward_references
            .last()
            .map_or(0, |&(number, _)| number);
        if number > highest && number as usize > before {
            self.forward_references.push((number, self.line));
        }
        Ok(number)
    }

    /// Checks faces that come before their vertices, and writes the polygon through all vertices.
    fn finish(&mut self) -> Result<(), ObjError> {
        self.progress = Progress::AtEnd;
        let vertices = self.vertex_lines.len();
        let beyond = |&&(number, _): &&(u32, u32)| number as usize > vertices;
        if let Some(&(index, line)) = self.forward_references.iter().find(beyond) {
            return Err(ObjError::IndexOutOfRange {
                at: self.location(line),
                index,
                vertices,
            });
        }
        if vertices > 0 {
            self.text.push(b'f');
            for number in 1..=vertices {
                write!(self.text, " {number}").expect("writing to memory does not fail");
            }
            self.text.push(b'\n');
        }
        Ok(())
    }

    fn check_limit(&self, elements: &'static str, count: usize) -> Result<(), ObjError> {
        if count > self.limit {
            return Err(ObjError::TooMany {
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
mod tests {
    use super::*;

    #[test]
    fn the_text_is_plain_and_ends_in_a_polygon_through_all_vertices() {
        let source = "g a\nf 1/2/3 2//3 3 3#c\nv 0\t1. 2 0.5 # w\n v -0 \\\n .5 1E+00 9 9 9\nvn\n\
                      f\nf -1\nv 1 1 1\nfo -3 -2 -1";
        let mut text = String::new();
        let mut normaliser = Normaliser::new("a.obj", source.as_bytes());
        normaliser.read_to_string(&mut text).expect("valid");
        let expected = "f 1 2 3 3\nv 0 1. 2\nv -0 .5 1E+00\nv 1 1 1\nf 1 2 3\nf 1 2 3\n";
        assert_eq!(text, expected);
        assert_eq!(normaliser.vertex_lines, [3, 4, 9]);
        assert_eq!(normaliser.face_lines, [2, 10]);
    }

    #[test]
    fn an_unexplained_error_of_the_parser_is_reported_with_its_reason() {
        let mut normaliser = Normaliser::new("a.obj", &b"v 0 0 0\n\nf 1 1 1\n"[..]);
        normaliser.advance().expect("a vertex");
        normaliser.advance().expect("a face");
        assert_eq!(
            normaliser
                .diagnose(&tobj::LoadError::FaceParseError)
                .to_string(),
            "a.obj:3: the parser rejects \"f 1 1 1\" (face parse error): write the line in a simpler form"
        );
    }

    #[test]
    fn lines_corners_and_vertices_are_limited() {
        let fault = |text: &str| {
            let mut normaliser = Normaliser::new("a.obj", text.as_bytes());
            normaliser.limit = 4;
            io::copy(&mut normaliser, &mut io::sink()).expect_err("too many");
            normaliser.fault.expect("kept").to_string()
        };
        let rest = "split the mesh, because handles have 32 bits";
        assert_eq!(
            fault("\n\n\n\nv 0 0 0"),
            format!("a.obj:4: more than 4 lines: {rest}")
        );
        assert_eq!(
            fault("v 0 0 0\nf 1 1 1 1 1"),
            format!("a.obj:2: more than 4 corners: {rest}")
        );
        let mut normaliser = Normaliser::new("a.obj", &b""[..]);
        normaliser.limit = 1;
        normaliser
            .read_vertex("0 0 0")
            .expect("one vertex is within the limit");
        let fault = normaliser.read_vertex("0 0 0").expect_err("too many");
        assert_eq!(
            fault.to_string(),
            format!("a.obj:1: more than 1 vertices: {rest}")
        );
    }
}
