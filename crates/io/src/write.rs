//! Writes meshes in any format.

mod gltf;
mod loss;
mod obj;
mod off;
mod ply;
mod stl;

pub use loss::Loss;
pub(crate) use obj::ShortestDecimal;
pub use obj::{write_obj, write_obj_with_normals};

use std::fmt;
use std::io::{self, BufWriter, Write};

use sixfold_core::{Creases, Point, PolygonMesh, VertexId};

use crate::format::Format;

/// The reason why a mesh was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum WriteError {
    /// A position is infinite or NaN.
    #[error(
        "the position of vertex {vertex} is not finite, so {format} cannot store it: correct the position"
    )]
    NotFinite { vertex: VertexId, format: Format },
    /// There must be one normal, possibly a missing one, for each vertex.
    #[error("{normals} normals do not fit {vertices} vertices: give one normal for each vertex")]
    NormalCount { normals: usize, vertices: usize },
    /// The format cannot store a file of this size.
    #[error("{format} stores at most {limit} bytes, the mesh needs {bytes}: use ply")]
    TooLarge {
        format: Format,
        bytes: u64,
        limit: u64,
    },
    /// The destination returned an error.
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl From<WriteError> for io::Error {
    /// Returns the error of the destination, or an error of kind
    /// [`InvalidInput`](io::ErrorKind::InvalidInput) if the mesh is the cause.
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Io(error) => error,
            error => Self::new(io::ErrorKind::InvalidInput, error),
        }
    }
}

/// Writes `polygons` in a format; O(corners). Reading the output gives the same mesh, bit for bit,
/// except for what [`MeshWriter::losses`] lists.
///
/// This function buffers the output. If the format cannot represent the mesh, nothing is written.
///
/// # Errors
///
/// Returns any error of `out`, and an error if a coordinate is not finite, or if the file would be
/// too large for the format.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh};
/// use sixfold_io::{Format, ReadOptions, read_from, write};
///
/// let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
/// let square = PolygonMesh::new(corners, [[0, 1, 2, 3]])?;
/// let mut bytes = Vec::new();
/// write(&square, Format::Ply, &mut bytes)?;
/// let (again, _) = read_from("square.ply", bytes.as_slice(), &ReadOptions::default())?.into_polygons();
/// assert_eq!(again, square);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(polygons: &PolygonMesh, format: Format, out: impl Write) -> Result<(), WriteError> {
    MeshWriter::new(polygons).write(format, out)
}

/// A mesh to be written, with the data of its vertices.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh};
/// use sixfold_io::{Format, MeshWriter};
///
/// let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
/// let square = PolygonMesh::new(corners, [[0, 1, 2, 3]])?;
/// let losses = MeshWriter::new(&square).losses(Format::Stl);
/// let messages: Vec<String> = losses.iter().map(ToString::to_string).collect();
/// assert_eq!(
///     messages,
///     [
///         "vertices are not shared: a reader has to join equal positions",
///         "1 polygon is cut into triangles",
///     ]
/// );
/// # Ok::<(), sixfold_core::PolygonError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MeshWriter<'a> {
    polygons: &'a PolygonMesh,
    /// One entry for each vertex, or none at all.
    normals: &'a [Option<Point>],
    creases: Option<&'a Creases>,
}

impl<'a> MeshWriter<'a> {
    /// Creates a writer of the positions and faces of `polygons`.
    pub fn new(polygons: &'a PolygonMesh) -> Self {
        Self {
            polygons,
            normals: &[],
            creases: None,
        }
    }

    /// Adds normals of unit length, one entry for each vertex. OBJ stores the normals that exist;
    /// PLY and glTF store them if none is missing.
    ///
    /// # Errors
    ///
    /// [`WriteError::NormalCount`] if the numbers of vertices and normals differ.
    pub fn with_normals(self, normals: &'a [Option<Point>]) -> Result<Self, WriteError> {
        let vertices = self.polygons.vertex_count();
        if normals.len() != vertices {
            let normals = normals.len();
            return Err(WriteError::NormalCount { normals, vertices });
        }
        Ok(Self { normals, ..self })
    }

    /// Adds sharp edges and vertices, which must be those of the mesh. Only OBJ stores them, as the
    /// tags `t crease` and `t corner`.
    ///
    /// # Examples
    ///
    /// ```
    /// use sixfold_core::{Creases, Point, PolygonMesh};
    /// use sixfold_io::{Format, MeshWriter, parse_obj};
    ///
    /// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
    /// let creases = Creases::new(&triangle, [([0, 1], 2.5)], [(2, f32::INFINITY)])?;
    /// let mut text = Vec::new();
    /// let writer = MeshWriter::new(&triangle).with_creases(&creases);
    /// writer.write(Format::Obj, &mut text)?;
    /// assert_eq!(parse_obj("triangle.obj", text.as_slice())?.creases().0, creases);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_creases(self, creases: &'a Creases) -> Self {
        let creases = Some(creases);
        Self { creases, ..self }
    }

    /// Writes the mesh; see [`write`](crate::write()).
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`write`](crate::write()).
    pub fn write(&self, format: Format, out: impl Write) -> Result<(), WriteError> {
        let positions = self.polygons.positions();
        if let Some(v) = positions.iter().position(|p| !p.is_finite()) {
            let vertex = VertexId::new(sixfold_core::row(v));
            return Err(WriteError::NotFinite { vertex, format });
        }
        let mut out = BufWriter::with_capacity(1 << 16, out);
        match format {
            Format::Obj => {
                obj::write_text(self.polygons, self.normals, &mut out)?;
                if let Some(creases) = self.creases {
                    obj::write_tags(creases, &mut out)?;
                }
            }
            Format::Stl => stl::write_binary(self.polygons, &mut out)?,
            Format::StlAscii => stl::write_ascii(self.polygons, &mut out)?,
            Format::Ply | Format::PlyBigEndian | Format::PlyAscii => {
                ply::write(self.polygons, self.complete_normals(), format, &mut out)?;
            }
            Format::Off => off::write(self.polygons, &mut out)?,
            Format::Gltf | Format::Glb => {
                gltf::write(self.polygons, self.complete_normals(), format, &mut out)?;
            }
        }
        Ok(out.flush()?)
    }

    /// Returns the normals if no vertex lacks one, otherwise an empty list.
    fn complete_normals(&self) -> &'a [Option<Point>] {
        match self.normals.iter().all(|normal| normal.is_some()) {
            true => self.normals,
            false => &[],
        }
    }
}

/// Three numbers separated by blanks.
struct Numbers(Point);

impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.to_array().map(ShortestDecimal);
        write!(f, "{x} {y} {z}")
    }
}

/// Returns the triangles of `polygons`; each polygon is cut into a fan from its first corner.
fn triangles(polygons: &PolygonMesh) -> impl Iterator<Item = [VertexId; 3]> {
    let faces = polygons.faces().iter();
    faces.flat_map(|(_, face)| {
        face[1..]
            .windows(2)
            .map(move |pair| [face[0], pair[0], pair[1]])
    })
}

/// Returns the number of triangles.
fn triangle_count(polygons: &PolygonMesh) -> usize {
    polygons.corner_count() - 2 * polygons.face_count()
}
