//! Reads OBJ files.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use sixfold_core::{FaceList, Point, VertexId, row};

use crate::error::ObjError;
use crate::normaliser::Normaliser;
use crate::obj_mesh::ObjMesh;

/// Options for `tobj`: do not change faces, and read only vertex numbers.
const LOAD_OPTIONS: tobj::LoadOptions = tobj::LoadOptions {
    single_index: false,
    triangulate: false,
    ignore_points: false,
    ignore_lines: false,
};

/// Reads the OBJ file at `path`; O(bytes).
///
/// # Errors
///
/// Fails if the file cannot be read, or if [`parse_obj`] fails. Error messages name the file by
/// `path`.
pub fn read_obj(path: impl AsRef<Path>) -> Result<ObjMesh, ObjError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    match open_file(path) {
        Ok(source) => parse_obj(&file, source),
        Err(OpenError::Directory) => Err(ObjError::Directory { file }),
        Err(OpenError::Failed(cause)) => Err(ObjError::Open { file, cause }),
    }
}

pub(crate) enum OpenError {
    /// The path is a directory.
    Directory,
    /// The system returned an error.
    Failed(io::Error),
}

impl From<io::Error> for OpenError {
    fn from(cause: io::Error) -> Self {
        Self::Failed(cause)
    }
}

pub(crate) fn open_file(path: &Path) -> Result<BufReader<File>, OpenError> {
    // Some systems allow opening a directory, and then return an unclear error.
    if fs::metadata(path)?.is_dir() {
        return Err(OpenError::Directory);
    }
    Ok(BufReader::with_capacity(1 << 16, File::open(path)?))
}

/// Reads OBJ text from `source`; O(bytes). Error messages use `name` as the name of the file.
///
/// # Errors
///
/// Returns the first fault, in the order documented at [`ObjError`]. A file may have vertices
/// without faces. A file without vertices and faces is an error.
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
/// # Ok::<(), sixfold_io::ObjError>(())
/// ```
pub fn parse_obj(name: &str, source: impl BufRead) -> Result<ObjMesh, ObjError> {
    let mut text = Normaliser::new(name, source);
    // Never called: the text contains no material library.
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let loaded = tobj::load_obj_buf(&mut text, &LOAD_OPTIONS, no_library);
    if let Some(fault) = text.fault.take() {
        return Err(fault);
    }
    let (models, _) = loaded.map_err(|refusal| text.diagnose(&refusal))?;
    if text.vertex_lines.is_empty() && text.short_faces.is_empty() {
        let file = name.to_owned();
        return Err(ObjError::Empty { file });
    }
    let (positions, faces) = restore_numbering(models, text.vertex_lines.len());
    check_finite(&text, &positions)?;
    let tags = text.tags.check(positions.len(), &faces, &text.short_faces);
    tags.map_err(|(line, fault)| ObjError::Tag {
        at: text.location(line),
        fault,
    })?;
    Ok(ObjMesh {
        positions,
        faces,
        face_lines: text.face_lines,
        short_faces: text.short_faces,
        crease_tags: text.tags.creases,
        corner_tags: text.tags.corners,
        notices: text.notices,
    })
}

/// Restores the numbering of the file. `tobj` numbers vertices in the order of their first use.
///
/// The last `vertices` corners are a polygon through all vertices in file order.
fn restore_numbering(models: Vec<tobj::Model>, vertices: usize) -> (Vec<Point>, FaceList) {
    let [model] = <[_; 1]>::try_from(models).expect("N1: one object");
    let tobj::Mesh {
        positions: coordinates,
        mut indices,
        mut face_arities,
        ..
    } = model.mesh;
    let tobj_numbers = indices.split_off(indices.len() - vertices);
    let mut numbers = vec![VertexId::new(0); vertices];
    for (number, &tobj_number) in tobj_numbers.iter().enumerate() {
        numbers[tobj_number as usize] = VertexId::new(row(number));
    }
    let position = |&tobj_number: &u32| Point::from_slice(&coordinates[3 * tobj_number as usize..]);
    let positions = tobj_numbers.iter().map(position).collect();

    let corners: Vec<VertexId> = indices
        .iter()
        .map(|&tobj_number| numbers[tobj_number as usize])
        .collect();
    // The list is empty if all polygons have three corners.
    face_arities.pop();
    let degree = face_arities.first().map_or(3, |&degree| degree as usize);
    let faces = if face_arities.iter().all(|&other| other as usize == degree) {
        FaceList::uniform(degree, corners).expect("N5 limits the corners")
    } else {
        let mut faces = FaceList::with_capacity(corners.len());
        let mut rest = corners.as_slice();
        for &degree in &face_arities {
            let (face, after) = rest.split_at(degree as usize);
            faces
                .push(face.iter().copied())
                .expect("N5 limits the corners");
            rest = after;
        }
        faces
    };
    (positions, faces)
}

fn check_finite<R: BufRead>(text: &Normaliser<'_, R>, positions: &[Point]) -> Result<(), ObjError> {
    let Some(v) = positions.iter().position(|p| !p.is_finite()) else {
        return Ok(());
    };
    let coordinates = ['x', 'y', 'z'].into_iter().zip(positions[v].to_array());
    let mut infinite = coordinates.filter(|(_, value)| !value.is_finite());
    Err(ObjError::NonFinite {
        at: text.location(text.vertex_lines[v]),
        vertex: v + 1,
        coordinate: infinite.next().map_or('x', |(name, _)| name),
    })
}
