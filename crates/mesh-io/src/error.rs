//! What can be wrong with an OBJ file.

use std::fmt;
use std::io;

use crate::tags::TagFault;

/// A line of a file; prints as `bunny.obj:17`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file as the caller names it.
    pub file: String,
    /// The line, counted from 1; of a continued statement the first.
    pub line: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}

/// Why a file is no mesh, where, and what to do.
///
/// The first fault of the file is reported; only what cannot be known before the end waits for it,
/// first faces that name a vertex beyond the last, then coordinates that are not finite, then tags of
/// vertices and edges that are not there.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ObjError {
    /// The file cannot be opened.
    #[error("{file}: cannot be opened ({cause}): check the path")]
    Open { file: String, cause: io::Error },
    /// A directory stands where a file should.
    #[error("{file}: is a directory: name a file in it")]
    Directory { file: String },
    /// Reading fails half-way.
    #[error("{at}: cannot be read further ({cause}): copy the file anew")]
    Read { at: Place, cause: io::Error },
    /// Two bytes for each letter.
    #[error("{at}: the text is UTF-16: save it as UTF-8")]
    Utf16 { at: Place },
    /// A vertex or face that is no text.
    #[error("{at}: the statement is not UTF-8 text: save the file as UTF-8, or mend the line")]
    NotUtf8 { at: Place },
    /// No vertex and no face.
    #[error("{file}: no vertex and no face: check that it is an OBJ file")]
    Empty { file: String },
    /// More elements than a handle can name, or more lines than we can count.
    #[error("{at}: more than {limit} {elements}: split the mesh, handles are 32 bits")]
    TooMany {
        at: Place,
        elements: &'static str,
        limit: usize,
    },
    /// A vertex with fewer than three coordinates.
    #[error("{at}: vertex {vertex} has {found} of its three coordinates: add what is missing")]
    TooFewCoordinates {
        at: Place,
        vertex: usize,
        found: usize,
    },
    /// A coordinate that is no number.
    #[error(
        "{at}: coordinate {text:?} of vertex {vertex} is no number: write it like 0.5 or -2e-3"
    )]
    BadNumber {
        at: Place,
        vertex: usize,
        text: String,
    },
    /// A coordinate that is infinite or no number, or too large for 32 bits.
    #[error(
        "{at}: coordinate {coordinate} of vertex {vertex} is not finite: keep coordinates below 3.4e38"
    )]
    NonFinite {
        at: Place,
        vertex: usize,
        coordinate: char,
    },
    /// A corner that is no vertex number, or beyond all numbers that a vertex can have.
    #[error(
        "{at}: face corner {text:?} is no vertex number: count from 1, or backwards from -1, in whole numbers"
    )]
    BadCorner { at: Place, text: String },
    /// A corner that names vertex 0.
    #[error("{at}: face names vertex 0, but OBJ counts from 1: add 1 to the indices of the file")]
    IndexZero { at: Place },
    /// A face names a vertex that the file does not have.
    #[error("{at}: face names vertex {index}, but there {count}: mend the index", count = there_are(*vertices))]
    IndexOutOfRange {
        at: Place,
        index: u32,
        vertices: usize,
    },
    /// A face counts backwards beyond the first vertex.
    #[error("{at}: face names vertex {index}, but before it there {count}: mend the index", count = there_are(*before))]
    RelativeIndexOutOfRange {
        at: Place,
        index: i64,
        before: usize,
    },
    /// A `t crease` or `t corner` tag is not what it should be.
    #[error("{at}: {fault}")]
    Tag { at: Place, fault: TagFault },
    /// The parser refuses a statement that we find nothing wrong with.
    #[error("{at}: the parser refuses {text:?} ({reason}): rewrite the line in plain form")]
    Refused {
        at: Place,
        text: String,
        reason: String,
    },
}

/// `is 1 vertex`, `are 12 vertices`.
fn there_are(vertices: usize) -> String {
    match vertices {
        0 => "is no vertex".to_owned(),
        1 => "is 1 vertex".to_owned(),
        _ => format!("are {vertices} vertices"),
    }
}

/// As much of `text` as a message can bear.
pub(crate) fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
