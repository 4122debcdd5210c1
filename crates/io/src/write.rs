//! Writes meshes in any format.

#[cfg(feature = "gltf")]
mod gltf;
mod loss;
mod obj;
mod off;
mod ply;
mod stl;

pub use loss::Loss;
pub(crate) use obj::ShortestDecimal;

use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use loss::losses;
use sixfold_core::glam::DVec3;
use sixfold_core::{Creases, Point, PolygonError, PolygonMesh, VertexId};

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
    #[error(
        "the number of normals is {normals}, and that of vertices {vertices}: give one normal for each vertex"
    )]
    NormalCount { normals: usize, vertices: usize },
    /// The format cannot store a file of this size.
    #[error("{format} stores at most {limit} bytes, the mesh needs {bytes}: use ply")]
    TooLarge {
        format: Format,
        bytes: u64,
        limit: u64,
    },
    /// The format is glTF, and this crate was built without its feature `gltf`.
    #[error(
        "glTF is not written, because sixfold-io was built without its feature gltf: enable it"
    )]
    NoGltf,
    /// The ending of the name is not that of a format.
    #[error(
        "{file}: the ending names no format for meshes: use stl, ply, off, gltf, glb or obj, or set a format"
    )]
    UnknownEnding { file: String },
    /// The file cannot be created.
    #[error("{file}: {cause}")]
    Create { file: String, cause: io::Error },
    /// The triangles have more corners than 32-bit indices can number.
    #[error(transparent)]
    Triangles(#[from] PolygonError),
    /// The destination returned an error.
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl From<WriteError> for io::Error {
    /// Returns the error of the destination, or an error of kind
    /// [`InvalidInput`](io::ErrorKind::InvalidInput) if the mesh is the cause.
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Io(error) | WriteError::Create { cause: error, .. } => error,
            error => Self::new(io::ErrorKind::InvalidInput, error),
        }
    }
}

/// Writes `polygons` to the file `path`, in the format of the ending of `path`; O(corners). Returns
/// what the format cannot keep. Reading the file gives the same mesh, bit for bit, except for this
/// and for the numbers of vertices in STL ([`write_to`] says more).
///
/// # Errors
///
/// Fails if the ending names no format, if a coordinate is not finite, if the file would be too large
/// for the format, or if the file cannot be written ([`WriteError`]). An old file is replaced only if
/// the format can represent the mesh.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh};
///
/// let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
/// let square = PolygonMesh::new(corners, [[0, 1, 2, 3]])?;
/// let folder = tempfile::tempdir()?;
/// let losses = sixfold_io::write(folder.path().join("square.stl"), &square)?;
/// let losses: Vec<String> = losses.iter().map(ToString::to_string).collect();
/// assert_eq!(losses, ["1 polygon is cut into triangles"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(path: impl AsRef<Path>, polygons: &PolygonMesh) -> Result<Vec<Loss>, WriteError> {
    write_with(path, polygons, &WriteOptions::default())
}

/// Writes `polygons` and the data in `options` to the file `path`, like [`write()`].
///
/// # Errors
///
/// Fails like [`write()`], and if the numbers of normals and vertices differ.
pub fn write_with(
    path: impl AsRef<Path>,
    polygons: &PolygonMesh,
    options: &WriteOptions<'_>,
) -> Result<Vec<Loss>, WriteError> {
    let path = path.as_ref();
    let file = || path.display().to_string();
    let format = options.format.or_else(|| Format::from_path(path));
    let format = format.ok_or_else(|| WriteError::UnknownEnding { file: file() })?;
    // A mesh that cannot be written must not empty a file.
    options.check(polygons, format)?;
    let create = |cause| WriteError::Create {
        file: file(),
        cause,
    };
    write_to(
        polygons,
        format,
        options,
        File::create(path).map_err(create)?,
    )
}

/// Writes `polygons` and the data in `options` to `out`; O(corners). Returns what `format` cannot keep.
///
/// This function buffers the output. If the format cannot represent the mesh, nothing is written.
///
/// # Errors
///
/// Returns any error of `out`, and an error if a coordinate is not finite, if the file would be too
/// large for the format, or if the numbers of normals and vertices differ.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Point, PolygonMesh};
/// use sixfold_io::{Format, ReadOptions, WriteOptions, read_from, write_to};
///
/// let corners = [Point::ZERO, Point::X, Point::ONE, Point::Y];
/// let square = PolygonMesh::new(corners, [[0, 1, 2, 3]])?;
/// let mut bytes = Vec::new();
/// write_to(&square, Format::Ply, &WriteOptions::default(), &mut bytes)?;
/// let (again, _) = read_from("square.ply", bytes.as_slice(), &ReadOptions::default())?.into_polygons();
/// assert_eq!(again, square);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_to(
    polygons: &PolygonMesh,
    format: Format,
    options: &WriteOptions<'_>,
    mut out: impl Write,
) -> Result<Vec<Loss>, WriteError> {
    write_buffered(
        polygons,
        format,
        options,
        BufWriter::with_capacity(1 << 16, &mut out),
    )
}

/// A writer whose type does not depend on the caller, so that what writes is compiled in this crate.
type Out<'o> = BufWriter<&'o mut dyn Write>;

fn write_buffered(
    polygons: &PolygonMesh,
    format: Format,
    options: &WriteOptions<'_>,
    mut out: Out<'_>,
) -> Result<Vec<Loss>, WriteError> {
    options.check(polygons, format)?;
    let cut = match format.holds_polygons() || polygons.first_polygon().is_none() {
        true => None,
        false => Some(polygons.triangulated()?),
    };
    let triangles = cut.as_ref().map_or(polygons, |cut| &cut.polygons);
    match format {
        Format::Obj => {
            obj::write_text(polygons, options, &mut out)?;
            if let Some(creases) = options.creases {
                obj::write_tags(creases, &mut out)?;
            }
        }
        Format::Stl => stl::write_binary(triangles, options, &mut out)?,
        Format::StlAscii => stl::write_ascii(triangles, options, &mut out)?,
        Format::Ply | Format::PlyBigEndian | Format::PlyAscii => {
            ply::write(polygons, options, format, &mut out)?;
        }
        Format::Off => off::write(polygons, options, &mut out)?,
        #[cfg(feature = "gltf")]
        Format::Gltf | Format::Glb => {
            gltf::write(triangles, options, format, &mut out)?;
        }
        #[cfg(not(feature = "gltf"))]
        Format::Gltf | Format::Glb => return Err(WriteError::NoGltf),
    }
    out.flush()?;
    let crossing = cut.map_or_else(Vec::new, |cut| cut.crossing);
    Ok(losses(polygons, format, options, &crossing))
}

/// Options of writing; the default writes positions and faces.
///
/// # Examples
///
/// ```
/// use sixfold_core::{Creases, Point, PolygonMesh};
/// use sixfold_io::{Format, WriteOptions, parse_obj, write_to};
///
/// let triangle = PolygonMesh::new([Point::ZERO, Point::X, Point::Y], [[0, 1, 2]])?;
/// let creases = Creases::new(&triangle, [([0, 1], 2.5)], [(2, f32::INFINITY)])?;
/// let mut text = Vec::new();
/// let options = WriteOptions::default().with_creases(&creases);
/// write_to(&triangle, Format::Obj, &options, &mut text)?;
/// assert_eq!(parse_obj("triangle.obj", text.as_slice())?.creases().0, creases);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct WriteOptions<'a> {
    format: Option<Format>,
    /// One entry for each vertex, or none at all.
    normals: &'a [Option<Point>],
    creases: Option<&'a Creases>,
    origin: [f64; 3],
}

impl<'a> WriteOptions<'a> {
    /// Writes a file as `format`, whatever its name is.
    #[must_use]
    pub fn with_format(self, format: Format) -> Self {
        let format = Some(format);
        Self { format, ..self }
    }

    /// Adds normals of unit length, one entry for each vertex. OBJ stores the normals that exist; a
    /// face is written without normals if one of its corners has none. PLY and glTF store normals if
    /// none is missing.
    #[must_use]
    pub fn with_normals(self, normals: &'a [Option<Point>]) -> Self {
        Self { normals, ..self }
    }

    /// Adds sharp edges and vertices, which must be those of the mesh. Only OBJ stores them, as the
    /// tags `t crease` and `t corner`.
    #[must_use]
    pub fn with_creases(self, creases: &'a Creases) -> Self {
        let creases = Some(creases);
        Self { creases, ..self }
    }

    /// Moves the mesh: the origin is written at `origin`. So a mesh that was read with
    /// [`ReadOptions::recentred`](crate::ReadOptions::recentred) gets its place back, with
    /// [`FileMesh::origin`](crate::FileMesh::origin). Coordinates are written in 64 bits if `origin`
    /// is not zero; in glTF, the origin is the translation of the node. Binary STL stores 32 bits:
    /// [`Loss::Precision`].
    ///
    /// ```
    /// use sixfold_io::{Format, ReadOptions, WriteOptions, read_from, write_to};
    ///
    /// let text = "OFF\n3 1 0\n500000.001 0 0\n500001 0 0\n500000 1 0\n3 0 1 2\n";
    /// let mesh = read_from("a.off", text.as_bytes(), &ReadOptions::default().recentred())?;
    /// let options = WriteOptions::default().with_origin(mesh.origin);
    /// let mut bytes = Vec::new();
    /// write_to(&mesh.into_polygons().0, Format::Off, &options, &mut bytes)?;
    /// let first = std::str::from_utf8(&bytes)?.lines().nth(2).ok_or("no vertex")?;
    /// let x: f64 = first.split(' ').next().ok_or("no number")?.parse()?;
    /// assert!((x - 500000.001).abs() < 1e-7);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_origin(self, origin: [f64; 3]) -> Self {
        Self { origin, ..self }
    }

    /// Returns a position as it is written: in 64 bits if the mesh is moved.
    fn placed(&self, point: Point) -> Placed {
        match self.origin == [0.0; 3] {
            true => Placed::Narrow(point),
            false => Placed::Wide(DVec3::from(self.origin) + point.as_dvec3()),
        }
    }

    /// Checks that `format` can represent the mesh.
    fn check(&self, polygons: &PolygonMesh, format: Format) -> Result<(), WriteError> {
        let (normals, vertices) = (self.normals.len(), polygons.vertex_count());
        if normals != 0 && normals != vertices {
            return Err(WriteError::NormalCount { normals, vertices });
        }
        let positions = polygons.positions();
        let is_finite = |&p: &Point| match self.placed(p) {
            Placed::Wide(p) if format == Format::Stl => p.as_vec3().is_finite(),
            Placed::Wide(p) => p.is_finite(),
            Placed::Narrow(p) => p.is_finite(),
        };
        if let Some(v) = positions.iter().position(|p| !is_finite(p)) {
            let vertex = VertexId::new(sixfold_core::row(v));
            return Err(WriteError::NotFinite { vertex, format });
        }
        match format {
            #[cfg(feature = "gltf")]
            Format::Glb => gltf::check_size(polygons, self),
            #[cfg(not(feature = "gltf"))]
            Format::Gltf | Format::Glb => Err(WriteError::NoGltf),
            _ => Ok(()),
        }
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

/// A position as it is written; printed as three numbers separated by blanks.
enum Placed {
    Narrow(Point),
    /// The position of a mesh that is moved.
    Wide(DVec3),
}

impl fmt::Display for Placed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Narrow(point) => Numbers(*point).fmt(f),
            Self::Wide(point) => write!(f, "{} {} {}", point.x, point.y, point.z),
        }
    }
}
