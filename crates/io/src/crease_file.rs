//! Reads and writes crease files.

use std::cell::Cell;
use std::io::{self, BufRead, BufWriter, Write};
use std::path::Path;

use sixfold_core::{CreaseError, Creases, MAX_ROWS, PolygonMesh, VertexId};

use crate::excerpt::shortened;
use crate::lines::{Lines, Start};
use crate::place::Location;
use crate::read::{OpenError, open_file};
use crate::sharpness::sharpness;
use crate::write::ShortestDecimal;

/// Maximum length of a line in bytes.
const MAX_LINE_LENGTH: u64 = 1 << 20;

/// The reason why a crease file cannot be read, with the line and a way to correct the file.
///
/// The first invalid line is reported. If all lines are valid, the first entry with a missing
/// vertex or edge is reported. Edges are checked before corners.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum CreaseFileError {
    /// The file cannot be opened.
    #[error("{file}: cannot be opened ({cause}): check the path")]
    Open { file: String, cause: io::Error },
    /// The path is a directory.
    #[error("{file}: is a directory: choose a file in it")]
    Directory { file: String },
    /// Reading fails before the end of the file.
    #[error("{at}: cannot be read further ({cause}): copy the file again")]
    Read { at: Location, cause: io::Error },
    /// The text has a byte order mark of UTF-16.
    #[error("{at}: the text is UTF-16: save it as UTF-8")]
    Utf16 { at: Location },
    /// A line is not valid UTF-8 text.
    #[error(
        "{at}: the line is not UTF-8 text: a crease file has lines `edge a b sharpness` and `corner v sharpness`"
    )]
    NotUtf8 { at: Location },
    /// A line is too long.
    #[error("{at}: the line is longer than {limit} bytes: end each entry with a line feed")]
    LongLine { at: Location, limit: u64 },
    /// There are more lines than can be counted.
    #[error("{at}: more than {limit} lines: write each edge and corner only once")]
    TooMany { at: Location, limit: usize },
    /// A line does not start with `edge` or `corner`.
    #[error("{at}: {text:?} is not an entry: write `edge a b sharpness` or `corner v sharpness`")]
    UnknownEntry { at: Location, text: String },
    /// An entry has too few or too many fields.
    #[error("{at}: expected {wanted} fields, found {found}: write `{form}`", wanted = .form.split(' ').count())]
    Fields {
        at: Location,
        found: usize,
        form: &'static str,
    },
    /// A field is not a vertex number of the mesh.
    #[error(
        "{at}: {text:?} is not a vertex number: use whole numbers that count from 0; the number of vertices is {vertices}"
    )]
    BadVertex {
        at: Location,
        text: String,
        vertices: usize,
    },
    /// A field is not a sharpness.
    #[error("{at}: sharpness {text:?} is not a number from 0 to inf: write it like 2, 0.5 or inf")]
    BadSharpness { at: Location, text: String },
    /// The mesh does not have this vertex or edge.
    #[error("{at}: {cause}")]
    Mesh { at: Location, cause: CreaseError },
}

/// Reads the crease file of `polygons` at `path`; O(bytes + corners) expected.
///
/// # Errors
///
/// Fails if the file cannot be read, or if [`parse_creases`] fails. Error messages name the file by
/// `path`.
pub fn read_creases(
    path: impl AsRef<Path>,
    polygons: &PolygonMesh,
) -> Result<Creases, CreaseFileError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    match open_file(path) {
        Ok(source) => parse_creases(&file, source, polygons),
        Err(OpenError::Directory) => Err(CreaseFileError::Directory { file }),
        Err(OpenError::Failed(cause)) => Err(CreaseFileError::Open { file, cause }),
    }
}

/// Reads the creases of `polygons` from `source`; O(bytes + corners) expected. Error messages use
/// `name` as the name of the file.
///
/// ```text
/// edge 0 4 2.5       # the edge between vertices 0 and 4, counted from 0
/// corner 7 inf       # vertex 7, sharp at all levels
/// ```
///
/// Each line has at most one entry. Entries may have any order. `#` starts a comment, and empty
/// lines are ignored. Sharpness is a number that is 0 or greater, or `inf`. If an edge or vertex
/// has several entries, the last entry is used; a sharpness of 0 cancels an earlier entry. Lines
/// end in LF, CRLF or CR. A byte order mark is skipped.
///
/// # Errors
///
/// Returns the first fault, in the order documented at [`CreaseFileError`].
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh, VertexId};
///
/// let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
/// let square = PolygonMesh::new(corners, [[0, 1, 2, 3]])?;
/// let text = "edge 1 0 2.5  # below\ncorner 3 inf\n";
/// let creases = sixfold_io::parse_creases("square.creases", text.as_bytes(), &square)?;
/// assert_eq!(creases.edge(VertexId::new(0), VertexId::new(1)), 2.5);
///
/// let error = sixfold_io::parse_creases("a.creases", &b"\nedge 0 2 1"[..], &square).unwrap_err();
/// let message = "a.creases:2: v0 and v2 are not the ends of an edge: \
///                name two vertices that follow each other in a face";
/// assert_eq!(error.to_string(), message);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn parse_creases(
    name: &str,
    source: impl BufRead,
    polygons: &PolygonMesh,
) -> Result<Creases, CreaseFileError> {
    let entries = Entries::read(name, source, polygons.vertex_count())?;
    // `Creases::new` takes the entries one by one. If it fails, the last entry that it took is
    // wrong.
    let line = Cell::new(0);
    let edges = entries.edges.iter().inspect(|entry| line.set(entry.0));
    let corners = entries.corners.iter().inspect(|entry| line.set(entry.0));
    let edges = edges.map(|&(_, ends, sharpness)| (ends, sharpness));
    let corners = corners.map(|&(_, vertex, sharpness)| (vertex, sharpness));
    Creases::new(polygons, edges, corners).map_err(|cause| CreaseFileError::Mesh {
        at: Location::line(name, line.get()),
        cause,
    })
}

/// Writes `creases` as a crease file; O(creases). Reading the file gives the same creases, bit for
/// bit.
///
/// This function buffers the output.
///
/// # Errors
///
/// Returns any error of `out`.
pub fn write_creases(creases: &Creases, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    let (edges, corners) = (creases.edges(), creases.corners());
    writeln!(out, "# edges: {}, corners: {}", edges.len(), corners.len())?;
    for &(edge, sharpness) in edges {
        let [a, b] = edge.ends().map(VertexId::index);
        writeln!(out, "edge {a} {b} {}", ShortestDecimal(sharpness))?;
    }
    for &(vertex, sharpness) in corners {
        let (v, sharpness) = (vertex.index(), ShortestDecimal(sharpness));
        writeln!(out, "corner {v} {sharpness}")?;
    }
    out.flush()
}

/// The entries of a file, each with its line number.
#[derive(Default)]
struct Entries {
    edges: Vec<(u32, [u32; 2], f32)>,
    corners: Vec<(u32, u32, f32)>,
}

impl Entries {
    fn read(name: &str, source: impl BufRead, vertices: usize) -> Result<Self, CreaseFileError> {
        let mut lines = Lines::new(source).with_max_length(MAX_LINE_LENGTH);
        let read_error = |cause: io::Error, line| {
            let at = Location::line(name, u32::try_from(line).unwrap_or(u32::MAX));
            match cause.kind() {
                io::ErrorKind::FileTooLarge => CreaseFileError::LongLine {
                    at,
                    limit: MAX_LINE_LENGTH,
                },
                _ => CreaseFileError::Read { at, cause },
            }
        };
        if let Start::Utf16 = lines.start().map_err(|cause| read_error(cause, 1))? {
            let at = Location::line(name, 1);
            return Err(CreaseFileError::Utf16 { at });
        }
        let mut entries = Self::default();
        let mut text = Vec::new();
        loop {
            let next = lines.count() + 1;
            let line = lines.read(&mut text);
            let Some(line) = line.map_err(|cause| read_error(cause, next))? else {
                return Ok(entries);
            };
            let row = u32::try_from(line)
                .ok()
                .filter(|&n| (n as usize) < MAX_ROWS);
            let Some(line) = row else {
                let (at, limit) = (Location::line(name, u32::MAX), MAX_ROWS);
                return Err(CreaseFileError::TooMany { at, limit });
            };
            let at = || Location::line(name, line);
            let text = str::from_utf8(&text).map_err(|_| CreaseFileError::NotUtf8 { at: at() })?;
            let vertex = |text: &str| {
                text.parse::<u32>().map_err(|_| CreaseFileError::BadVertex {
                    at: at(),
                    text: shortened(text),
                    vertices,
                })
            };
            let sharpness = |text: &str| {
                sharpness(text).ok_or_else(|| CreaseFileError::BadSharpness {
                    at: at(),
                    text: shortened(text),
                })
            };
            let mut words = text.split_whitespace();
            match words.next() {
                None => {}
                Some("edge") => {
                    let [a, b, s] = fields(words, EDGE, at)?;
                    let ends = [vertex(a)?, vertex(b)?];
                    entries.edges.push((line, ends, sharpness(s)?));
                }
                Some("corner") => {
                    let [v, s] = fields(words, CORNER, at)?;
                    let (vertex, sharpness) = (vertex(v)?, sharpness(s)?);
                    entries.corners.push((line, vertex, sharpness));
                }
                Some(word) => {
                    let (at, text) = (at(), shortened(word));
                    return Err(CreaseFileError::UnknownEntry { at, text });
                }
            }
        }
    }
}

const EDGE: &str = "edge a b sharpness";
const CORNER: &str = "corner v sharpness";

/// Returns the `N` fields after the first word of an entry. Fails if there are more or fewer
/// fields.
fn fields<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
    form: &'static str,
    at: impl Fn() -> Location,
) -> Result<[&'a str; N], CreaseFileError> {
    let mut fields = [""; N];
    let mut found = 0;
    for (field, word) in fields.iter_mut().zip(words.by_ref()) {
        *field = word;
        found += 1;
    }
    found += words.count();
    if found != N {
        let (at, found) = (at(), found + 1);
        return Err(CreaseFileError::Fields { at, found, form });
    }
    Ok(fields)
}
