//! Reads the header of a PLY file.

use std::collections::HashSet;

use super::Scalar;
use crate::builder::MeshBuilder;
use crate::byte_source::{ByteSource, words};
use crate::error::ReadError;
use crate::excerpt::shortened;
use crate::faults::PlyHeaderFault;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::number::parse_whole;
use crate::place::Place;

/// The header of a file.
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    /// Number of lines of the header.
    pub(super) lines: u32,
}

/// A table of the file.
pub(super) struct Element {
    pub(super) name: String,
    /// Number of records, as the header says; it may be wrong.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    pub(super) line: u32,
}

/// A column of a table.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyKind,
    pub(super) line: u32,
}

/// The contents of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyKind {
    Number(Scalar),
    /// A list: its length and its items.
    List {
        length: Scalar,
        item: Scalar,
    },
}

impl Header {
    /// Reads up to the end of the line `end_header`.
    pub(super) fn read(
        builder: &mut MeshBuilder,
        source: &mut ByteSource<'_>,
    ) -> Result<Self, ReadError> {
        let mut parser = Parser::default();
        let mut lines;
        loop {
            let place = Place::Line(source.line_count().saturating_add(1));
            let line = source.line().map_err(|e| builder.read_error(place, e))?;
            let Some(line) = line else {
                return Err(builder.truncated(place, "`end_header`".to_owned()));
            };
            lines = line.number;
            let ends_in_cr = line.ends_in_cr;
            if line.number == 1 {
                let text = line.text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line.text);
                if text.trim_ascii_end() != b"ply" {
                    return Err(builder.unexpected(place, "ply", text));
                }
                if ends_in_cr {
                    source.end_lines_in_cr();
                }
                continue;
            }
            match parser.read_line(line.text, line.number) {
                Ok(Line::Header) => {}
                Ok(Line::Unknown(keyword)) => {
                    let notices = &mut builder.notices;
                    notices.add_named(IgnoredKind::Unknown, 1, place, &keyword);
                }
                Ok(Line::End) => break,
                Err(fault) => {
                    let at = builder.at(place);
                    return Err(ReadError::PlyHeader { at, fault });
                }
            }
        }
        let at = builder.at(Place::Line(lines));
        let fault = PlyHeaderFault::NoFormat;
        let format = parser.format.ok_or(ReadError::PlyHeader { at, fault })?;
        Ok(Self {
            format,
            elements: parser.elements,
            lines,
        })
    }
}

/// A line of a header.
enum Line {
    Header,
    /// A line that is not part of PLY, with this keyword.
    Unknown(String),
    End,
}

/// A header while it is parsed.
#[derive(Default)]
struct Parser {
    format: Option<Format>,
    elements: Vec<Element>,
    /// The names of the elements.
    names: HashSet<String>,
    /// The names of the properties of the last element.
    property_names: HashSet<String>,
}

impl Parser {
    /// Parses a line.
    fn read_line(&mut self, text: &[u8], number: u32) -> Result<Line, PlyHeaderFault> {
        let mut words = words(text);
        let keyword = words.next().unwrap_or_default();
        let words: Vec<&[u8]> = match keyword {
            b"comment" | b"obj_info" => Vec::new(),
            _ => words.take(8).collect(),
        };
        match keyword {
            b"" | b"comment" | b"obj_info" => {}
            b"end_header" => return Ok(Line::End),
            b"format" => self.format = Some(parse_form(&words)?),
            b"element" | b"property" if self.format.is_none() => {
                return Err(PlyHeaderFault::NoFormat);
            }
            b"element" => self.add_element(parse_element(&words, text, number)?)?,
            b"property" => self.add_property(parse_property(&words, text, number)?)?,
            _ => return Ok(Line::Unknown(shown(keyword))),
        }
        Ok(Line::Header)
    }

    fn add_element(&mut self, element: Element) -> Result<(), PlyHeaderFault> {
        if !self.names.insert(element.name.clone()) {
            let name = shortened(&element.name);
            return Err(PlyHeaderFault::Repeated { name });
        }
        // Clearing a set takes time for its capacity, which an earlier element may have enlarged.
        self.property_names = HashSet::new();
        self.elements.push(element);
        Ok(())
    }

    fn add_property(&mut self, property: Property) -> Result<(), PlyHeaderFault> {
        let name = || shortened(&property.name);
        let Some(element) = self.elements.last_mut() else {
            return Err(PlyHeaderFault::PropertyWithoutElement { name: name() });
        };
        if !self.property_names.insert(property.name.clone()) {
            return Err(PlyHeaderFault::Repeated { name: name() });
        }
        element.properties.push(property);
        Ok(())
    }
}

fn shown(text: &[u8]) -> String {
    shortened(String::from_utf8_lossy(text).trim())
}

fn parse_form(words: &[&[u8]]) -> Result<Format, PlyHeaderFault> {
    match words {
        [b"ascii", b"1.0"] => Ok(Format::PlyAscii),
        [b"binary_little_endian", b"1.0"] => Ok(Format::Ply),
        [b"binary_big_endian", b"1.0"] => Ok(Format::PlyBigEndian),
        _ => {
            let text = shown(&words.join(&b' '));
            Err(PlyHeaderFault::UnknownForm { text })
        }
    }
}

fn parse_element(words: &[&[u8]], text: &[u8], line: u32) -> Result<Element, PlyHeaderFault> {
    let fault = || PlyHeaderFault::Element { text: shown(text) };
    let &[name, count] = words else {
        return Err(fault());
    };
    Ok(Element {
        name: String::from_utf8_lossy(name).into_owned(),
        count: parse_whole(count).ok_or_else(fault)?,
        properties: Vec::new(),
        line,
    })
}

fn parse_property(words: &[&[u8]], text: &[u8], line: u32) -> Result<Property, PlyHeaderFault> {
    let fault = || PlyHeaderFault::Property { text: shown(text) };
    let scalar = |name| {
        let unknown = || PlyHeaderFault::Type { text: shown(name) };
        Scalar::from_name(name).ok_or_else(unknown)
    };
    let (name, kind) = match *words {
        [b"list", length, item, name] => {
            let (length, item) = (scalar(length)?, scalar(item)?);
            (name, PropertyKind::List { length, item })
        }
        [number, name] => (name, PropertyKind::Number(scalar(number)?)),
        _ => return Err(fault()),
    };
    let name = String::from_utf8_lossy(name).into_owned();
    match kind {
        PropertyKind::List { length, .. } if length.is_float() => {
            let name = shortened(&name);
            Err(PlyHeaderFault::ListLength { name })
        }
        _ => Ok(Property { name, kind, line }),
    }
}
