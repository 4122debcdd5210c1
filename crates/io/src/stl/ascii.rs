//! Reads STL as text.

use super::Facets;
use crate::byte_source::{ByteSource, words};
use crate::error::ReadError;
use crate::excerpt::shortened;
use crate::format::is_stl_comment;
use crate::notice::IgnoredKind;
use crate::number::{Coordinate, parse_coordinate};
use crate::place::Place;

/// What the parser expects next. Line ends have no meaning, except after `solid` and `endsolid`, and
/// outside of solids.
enum Expect {
    Solid,
    FacetOrEnd,
    /// This many words of a normal, or `outer`.
    Normal(usize),
    /// Further numbers of a normal, or `outer`.
    Outer,
    Loop,
    VertexOrEnd,
    /// A coordinate of this number.
    Coordinate(usize),
    EndFacet,
}

/// The state of the parser.
struct Parser<'a> {
    facets: Facets<'a>,
    expect: Expect,
    /// Line of the current facet.
    facet_line: u32,
    /// The corners of the current facet.
    corners: [[Coordinate; 3]; 3],
    corner_count: usize,
    solids: u32,
    /// Whether the numbers of a colour may follow.
    in_colour: bool,
    /// Whether the last word was `end`: `end loop` is `endloop`.
    after_end: bool,
}

/// Reads all solids.
pub(super) fn read<'a>(
    mut facets: Facets<'a>,
    source: &mut ByteSource<'_>,
) -> Result<Facets<'a>, ReadError> {
    facets.reserve(0);
    let mut parser = Parser {
        facets,
        expect: Expect::Solid,
        facet_line: 0,
        corners: [[Coordinate::from(0.0_f32); 3]; 3],
        corner_count: 0,
        solids: 0,
        in_colour: false,
        after_end: false,
    };
    loop {
        let next = Place::Line(source.line_count().saturating_add(1));
        let line = source.line();
        let line = line.map_err(|e| parser.facets.builder.read_error(next, e))?;
        let Some(line) = line else { break };
        let bom = if line.number == 1 {
            &b"\xEF\xBB\xBF"[..]
        } else {
            b""
        };
        let text = line.text.strip_prefix(bom).unwrap_or(line.text);
        let mut rest = words(text);
        while let Some(word) = rest.next() {
            if parser.read(word, line.number)? {
                let next = after_name(&parser.expect, rest.clone());
                let Some(next) = next.filter(|_| !is_stl_comment(word)) else {
                    break;
                };
                rest = next;
            }
        }
    }
    parser.finish(source.line_count())
}

impl<'a> Parser<'a> {
    /// Parses the next word; returns whether the rest of the line is a name or a comment.
    fn read(&mut self, word: &[u8], line: u32) -> Result<bool, ReadError> {
        if self.skips_colour(word, line) {
            return Ok(false);
        }
        if is_stl_comment(word) && !matches!(self.expect, Expect::Coordinate(_) | Expect::Normal(_))
        {
            return Ok(true);
        }
        let joined;
        let word = match std::mem::take(&mut self.after_end) {
            true => {
                joined = [b"end", word].concat();
                joined.as_slice()
            }
            false => word,
        };
        let is = |keyword: &str| word.eq_ignore_ascii_case(keyword.as_bytes());
        let may_end = matches!(
            self.expect,
            Expect::FacetOrEnd | Expect::VertexOrEnd | Expect::EndFacet
        );
        if may_end && is("end") {
            self.after_end = true;
            return Ok(false);
        }
        self.expect = match self.expect {
            Expect::Coordinate(number) => self.read_coordinate(word, number, line)?,
            Expect::VertexOrEnd if is("vertex") => self.start_vertex(line)?,
            Expect::VertexOrEnd if is("endloop") && self.corner_count == 3 => Expect::EndFacet,
            Expect::VertexOrEnd if is("endloop") => {
                let found = format!("endloop after {} of them", self.corner_count);
                return Err(self.unexpected(line, "three vertices in a facet", found.as_bytes()));
            }
            Expect::VertexOrEnd => return Err(self.unexpected(line, "vertex or endloop", word)),
            Expect::EndFacet if is("endfacet") => {
                self.facets
                    .push(self.corners, Place::Line(self.facet_line))?;
                Expect::FacetOrEnd
            }
            Expect::EndFacet => return Err(self.unexpected(line, "endfacet", word)),
            Expect::FacetOrEnd if is("facet") => {
                self.facet_line = line;
                self.corner_count = 0;
                Expect::Outer
            }
            Expect::FacetOrEnd if starts_with(word, "endsolid") => {
                self.expect = Expect::Solid;
                return Ok(true);
            }
            Expect::FacetOrEnd if is("solid") => {
                self.note_missing_end(line);
                self.start_solid(line);
                return Ok(true);
            }
            Expect::FacetOrEnd => return Err(self.unexpected(line, "facet or endsolid", word)),
            Expect::Outer | Expect::Normal(_) if is("outer") => Expect::Loop,
            Expect::Outer if is("normal") => Expect::Normal(3),
            // Normals are not used, so they need not be numbers.
            Expect::Normal(1) => Expect::Outer,
            Expect::Normal(words) => Expect::Normal(words - 1),
            Expect::Outer if is_like_number(word) => Expect::Outer,
            Expect::Outer => return Err(self.unexpected(line, "outer loop", word)),
            Expect::Loop if is("loop") => Expect::VertexOrEnd,
            Expect::Loop => return Err(self.unexpected(line, "loop", word)),
            Expect::Solid if is("solid") => {
                self.start_solid(line);
                return Ok(true);
            }
            Expect::Solid if is_part_of_solid(word) => {
                return Err(self.unexpected(line, "solid", word));
            }
            Expect::Solid => {
                let notices = &mut self.facets.builder.notices;
                notices.add(IgnoredKind::Unknown, Place::Line(line));
                return Ok(true);
            }
        };
        Ok(false)
    }

    /// Returns whether `word` is part of a colour, which some programs write between other words:
    /// `color` and its numbers.
    fn skips_colour(&mut self, word: &[u8], line: u32) -> bool {
        let starts = ["color", "colour"]
            .iter()
            .any(|keyword| word.eq_ignore_ascii_case(keyword.as_bytes()));
        if starts && !matches!(self.expect, Expect::Coordinate(_)) {
            self.in_colour = true;
            let notices = &mut self.facets.builder.notices;
            notices.add(IgnoredKind::Colours, Place::Line(line));
            return true;
        }
        self.in_colour = self.in_colour && parse_coordinate(word).is_some();
        self.in_colour
    }

    fn note_missing_end(&mut self, line: u32) {
        let notices = &mut self.facets.builder.notices;
        notices.add(IgnoredKind::MissingEnds, Place::Line(line));
    }

    fn start_solid(&mut self, line: u32) {
        self.solids += 1;
        self.expect = Expect::FacetOrEnd;
        if self.solids > 1 {
            let notices = &mut self.facets.builder.notices;
            notices.add(IgnoredKind::Objects, Place::Line(line));
        }
    }

    fn start_vertex(&self, line: u32) -> Result<Expect, ReadError> {
        if self.corner_count == 3 {
            return Err(self.unexpected(line, "endloop after three vertices", b"vertex"));
        }
        Ok(Expect::Coordinate(0))
    }

    fn read_coordinate(
        &mut self,
        word: &[u8],
        number: usize,
        line: u32,
    ) -> Result<Expect, ReadError> {
        let builder = &self.facets.builder;
        let Some(value) = parse_coordinate(word) else {
            return Err(ReadError::BadNumber {
                at: builder.at(Place::Line(line)),
                vertex: self.corner_count + 1,
                text: shortened(&String::from_utf8_lossy(word)),
            });
        };
        let corner = &mut self.corners[self.corner_count];
        corner[number] = value;
        if !value.narrow.is_finite() {
            let mut wrong = [Coordinate::from(0.0_f32); 3];
            wrong[number] = value;
            return Err(builder.infinite(wrong, Place::Line(line), self.corner_count + 1));
        }
        if number < 2 {
            return Ok(Expect::Coordinate(number + 1));
        }
        self.corner_count += 1;
        Ok(Expect::VertexOrEnd)
    }

    fn unexpected(&self, line: u32, expected: &str, found: &[u8]) -> ReadError {
        self.facets
            .builder
            .unexpected(Place::Line(line), expected, found)
    }

    /// Checks that the file is complete.
    fn finish(mut self, lines: u32) -> Result<Facets<'a>, ReadError> {
        let last = lines.max(1);
        match self.expect {
            Expect::Solid => {}
            Expect::FacetOrEnd => self.note_missing_end(last),
            _ => {
                let missing = "endfacet".to_owned();
                let builder = &self.facets.builder;
                return Err(builder.truncated(Place::Line(last), missing));
            }
        }
        self.facets.flush()?;
        Ok(self.facets)
    }
}

/// Returns the words of a line after the name of a solid, if facets follow on the same line, as in files
/// without line ends; `None` if all words are the name.
fn after_name<'a, W: Iterator<Item = &'a [u8]> + Clone>(expect: &Expect, mut rest: W) -> Option<W> {
    let is = |word: &[u8], keyword: &str| word.eq_ignore_ascii_case(keyword.as_bytes());
    loop {
        let here = rest.clone();
        let word = rest.next()?;
        let is_in_solid = matches!(expect, Expect::FacetOrEnd);
        if !is_in_solid && is(word, "solid") {
            // If no facet follows this `solid`, none follows the later ones.
            return after_name(&Expect::FacetOrEnd, rest).map(|_| here);
        }
        let mut next = rest.clone();
        if is_in_solid && is(word, "facet") && next.next().is_some_and(|next| is(next, "normal")) {
            return Some(here);
        }
    }
}

/// Returns whether `word` is part of a solid, so that it must not precede `solid`. Lines with other
/// words are passed over there.
fn is_part_of_solid(word: &[u8]) -> bool {
    let keywords = ["facet", "outer", "vertex", "endloop", "endfacet"];
    let mut keywords = keywords.iter();
    keywords.any(|keyword| word.eq_ignore_ascii_case(keyword.as_bytes()))
}

/// Returns whether `word` begins with `keyword`, in upper or lower case.
fn starts_with(word: &[u8], keyword: &str) -> bool {
    let start = word.get(..keyword.len());
    start.is_some_and(|start| start.eq_ignore_ascii_case(keyword.as_bytes()))
}

/// Returns whether `word` is a number, or a text that programs write for a number that is not finite:
/// `nan(ind)`, `-1.#IND`, `inf`.
fn is_like_number(word: &[u8]) -> bool {
    let first = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'-' | b'+' | b'.');
    word.first().is_some_and(first) || starts_with(word, "nan") || starts_with(word, "inf")
}
