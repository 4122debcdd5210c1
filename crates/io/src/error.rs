//! Errors in mesh files.

use std::io;

use crate::faults::{GltfFault, PlyHeaderFault, TagFault};
use crate::format::Format;
use crate::place::Location;

/// The reason why an OBJ file cannot be read, with the line and a way to correct the file.
///
/// The first fault of the file is reported. Some faults can be detected only at the end of the
/// file. They are reported in this order: vertex numbers of faces that are too high, and, in OBJ,
/// tags of missing vertices and edges. Messages number vertices as the format does: OBJ from 1, the
/// others from 0.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum ReadError {
    /// The file cannot be opened.
    #[error("{file}: cannot be opened ({cause}): check the path")]
    Open { file: String, cause: io::Error },
    /// The path is a directory.
    #[error("{file}: is a directory: choose a file in it")]
    Directory { file: String },
    /// Reading fails before the end of the file.
    #[error("{at}: cannot be read further ({cause}): copy the file again")]
    Read { at: Location, cause: io::Error },
    /// Neither the content nor the name shows the format.
    #[error(
        "{file}: the format is not recognised: use a file in STL, PLY, OFF, glTF or OBJ, whose name ends in its format"
    )]
    UnknownFormat { file: String },
    /// The file is glTF, and this crate was built without its feature `gltf`.
    #[error(
        "{file}: glTF is not read, because sixfold-io was built without its feature gltf: enable it"
    )]
    NoGltf { file: String },
    /// The name or the options say STL, but the content is another text.
    #[error(
        "{file}: neither ASCII STL, which begins with `solid`, nor binary STL, whose size follows from its number of facets: export the file again, or rename it if it has another format"
    )]
    NotStl { file: String },
    /// The text has a byte order mark of UTF-16.
    #[error("{at}: the text is UTF-16: save it as UTF-8")]
    Utf16 { at: Location },
    /// A vertex, face or tag is not valid UTF-8 text.
    #[error("{at}: the statement is not UTF-8 text: save the file as UTF-8, or correct the line")]
    NotUtf8 { at: Location },
    /// A line is too long.
    #[error("{at}: the line is longer than {limit} bytes: check that it is {format}", format = .format.with_article())]
    LongLine {
        at: Location,
        limit: usize,
        format: Format,
    },
    /// The file has no vertices and no faces.
    #[error("{file}: no vertex and no face: check that it is {format}", format = .format.with_article())]
    Empty { file: String, format: Format },
    /// There are more elements or lines than can be counted.
    #[error("{at}: more than {limit} {elements}: split the mesh, because handles have 32 bits")]
    TooMany {
        at: Location,
        elements: &'static str,
        limit: usize,
    },
    /// The file ends before everything that its format or its header promises.
    #[error("{at}: the file ends before {missing}: copy the file again, or {way_out}")]
    Truncated {
        at: Location,
        missing: String,
        way_out: &'static str,
    },
    /// A text does not have the expected form.
    #[error("{at}: expected {expected}, found {found:?}: correct the line")]
    Unexpected {
        at: Location,
        expected: String,
        found: String,
    },
    /// A part of the format that is not read.
    #[error("{at}: {feature}, which is not read: {way_out}")]
    Unsupported {
        at: Location,
        feature: String,
        way_out: &'static str,
    },
    /// The header of a PLY file is invalid.
    #[error("{at}: {fault}")]
    PlyHeader { at: Location, fault: PlyHeaderFault },
    /// A glTF file is invalid.
    #[error("{at}: {fault}")]
    Gltf { at: Location, fault: GltfFault },
    /// A vertex has fewer coordinates than it needs: three, or four in an OFF file with the prefix `4`.
    #[error("{at}: vertex {vertex} has {found} of {needed} coordinates: add the missing ones")]
    TooFewCoordinates {
        at: Location,
        vertex: usize,
        found: usize,
        needed: usize,
    },
    /// A coordinate is not a number.
    #[error(
        "{at}: coordinate {text:?} of vertex {vertex} is not a number: write it like 0.5 or -2e-3"
    )]
    BadNumber {
        at: Location,
        vertex: usize,
        text: String,
    },
    /// A coordinate is infinite or too large for 32 bits.
    #[error(
        "{at}: coordinate {coordinate} of vertex {vertex} is not finite: keep coordinates below 3.4e38"
    )]
    NonFinite {
        at: Location,
        vertex: usize,
        coordinate: char,
    },
    /// A coordinate is NaN.
    #[error(
        "{at}: coordinate {coordinate} of vertex {vertex} is not a number (NaN): correct it, or export the file again"
    )]
    NotANumber {
        at: Location,
        vertex: usize,
        coordinate: char,
    },
    /// A corner is not a valid vertex number.
    #[error(
        "{at}: face corner {text:?} is not a vertex number: use whole numbers that count from 1, or backwards from -1"
    )]
    BadCorner { at: Location, text: String },
    /// A corner has vertex number 0.
    #[error("{at}: face names vertex 0, but OBJ counts from 1: add 1 to the indices of the file")]
    IndexZero { at: Location },
    /// The vertex number of a face is too high.
    #[error("{at}: face names vertex {index}, but there {count}: correct the index", count = vertices_phrase(*vertices))]
    IndexOutOfRange {
        at: Location,
        index: i64,
        vertices: usize,
    },
    /// A number of corners or an index of a face is not a number.
    #[error("{at}: {text:?} is not {what}: write a whole number")]
    BadWhole {
        at: Location,
        what: &'static str,
        text: String,
    },
    /// A negative vertex number of a face is too low.
    #[error("{at}: face names vertex {index}, but before this line there {count}: correct the \
             index", count = vertices_phrase(*before))]
    RelativeIndexOutOfRange {
        at: Location,
        index: i64,
        before: usize,
    },
    /// A `t crease` or `t corner` tag is invalid.
    #[error("{at}: {fault}")]
    Tag { at: Location, fault: TagFault },
    /// `tobj` refused a statement for another reason.
    #[error("{at}: the parser rejects {text:?} ({reason}): write the line in a simpler form")]
    Refused {
        at: Location,
        text: String,
        reason: String,
    },
}

/// Returns `is 1 vertex` or `are 12 vertices`, for the given number.
fn vertices_phrase(vertices: usize) -> String {
    match vertices {
        0 => "is no vertex".to_owned(),
        1 => "is 1 vertex".to_owned(),
        _ => format!("are {vertices} vertices"),
    }
}
