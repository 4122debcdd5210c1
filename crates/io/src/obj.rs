//! Reads OBJ text.

mod normaliser;

use std::io::BufRead;
use std::path::Path;

use crate::builder::MeshBuilder;
use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::file_mesh::FileMesh;
use crate::format::Format;
use crate::notice::IgnoredKind;
use crate::options::ReadOptions;
use crate::place::{FacePlaces, Location, Place};
use normaliser::Normaliser;

/// Options that keep faces as they are, use only vertex numbers, and ignore nothing.
const LOAD_OPTIONS: tobj::LoadOptions = tobj::LoadOptions {
    single_index: false,
    triangulate: false,
    ignore_points: false,
    ignore_lines: false,
};

/// Reads OBJ text from `source`; O(bytes). Error messages use `name` as the name of the file.
///
/// # Errors
///
/// Returns the first fault, in the order documented at [`ReadError`]. A file with vertices and
/// without faces is valid; a file without vertices and faces is an error.
///
/// # Examples
///
/// ```
/// let text = "v 0 0 0\nv 1 0 0\nv 9 9 9\nv 0 1 0\nvn 0 0 1\nf -4//1 2//1 4//1\n";
/// let obj = sixfold_io::parse_obj("triangle.obj", text.as_bytes())?;
/// assert_eq!(obj.notices[0].to_string(), "ignored 1 normal (line 5)");
/// assert_eq!(obj.facts().isolated_vertices, 1);
/// let (polygons, left_out) = obj.into_polygons();
/// assert_eq!((polygons.face_count(), left_out.len()), (1, 0));
///
/// let error = sixfold_io::parse_obj("bunny.obj", &b"v 0 0 0\nf 1 2 3\n"[..]).unwrap_err();
/// let message = "bunny.obj:2: face names vertex 2, but there is 1 vertex: correct the index";
/// assert_eq!(error.to_string(), message);
/// # Ok::<(), sixfold_io::ReadError>(())
/// ```
pub fn parse_obj(name: &str, mut source: impl BufRead) -> Result<FileMesh, ReadError> {
    read(
        name,
        &mut ByteSource::new(&mut source, None),
        ReadOptions::default(),
    )
}

/// Reads OBJ text from `source`; O(bytes).
pub(crate) fn read(
    name: &str,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let places = FacePlaces::Lines(Vec::new());
    let builder = MeshBuilder::new(name, Format::Obj, options, places);
    let mut text = Normaliser::new(builder, source);
    while read_block(&mut text)? {}
    let (tags, mut builder) = (text.tags, text.builder);
    for line in tags.replaced() {
        let place = Place::Line(line);
        builder.notices.add(IgnoredKind::ReplacedSharpness, place);
    }
    let mut mesh = builder.finish()?;
    let checked = tags.check(mesh.positions.len(), &mesh.faces, &mesh.short_faces);
    checked.map_err(|(line, fault)| ReadError::Tag {
        at: Location::line(name, line),
        fault,
    })?;
    mesh.crease_tags = tags.creases;
    mesh.corner_tags = tags.corners;
    Ok(mesh)
}

/// Parses one block of vertices; returns whether there may be another one.
fn read_block<R: BufRead>(text: &mut Normaliser<'_, R>) -> Result<bool, ReadError> {
    // The text for the parser never contains a material library, so this function is not called.
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let loaded = tobj::load_obj_buf(text, &LOAD_OPTIONS, no_library);
    if let Some(fault) = text.fault.take() {
        return Err(fault);
    }
    let (models, _) = loaded.map_err(|refusal| text.diagnose(&refusal))?;
    // The polygon of the block names all vertices in order, so their order is that of the file.
    let coordinates = models.first().map(|model| model.mesh.positions.as_slice());
    text.finish_block(coordinates.unwrap_or_default())
}
