//! Reads files of any format.

use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::Path;

use crate::byte_source::ByteSource;
use crate::error::ReadError;
use crate::file_mesh::FileMesh;
use crate::format::{DETECTION_BYTES, Format, detect, is_text, may_be_binary_stl};
#[cfg(feature = "gltf")]
use crate::gltf;
use crate::options::ReadOptions;
use crate::place::{Location, Place};
use crate::{obj, off, ply, stl};

/// Reads the mesh file at `path`, whose format is recognised by its content; O(bytes) expected.
///
/// If the content has no sign of a format, the ending of the name decides. glTF may refer to other
/// files in the same folder.
///
/// # Errors
///
/// Fails if the file cannot be read, if its format is not known, or if it is not valid
/// ([`ReadError`]). Messages name the file by `path`.
///
/// # Examples
///
/// ```no_run
/// let mesh = sixfold_io::read("scan.ply")?;
/// for notice in &mesh.notices {
///     println!("{notice}");
/// }
/// let (polygons, left_out) = mesh.into_polygons();
/// # Ok::<(), sixfold_io::ReadError>(())
/// ```
pub fn read(path: impl AsRef<Path>) -> Result<FileMesh, ReadError> {
    read_with(path, &ReadOptions::default())
}

/// Reads the mesh in the file `path` with `options`, like [`read()`].
///
/// # Errors
///
/// Fails like [`read()`].
pub fn read_with(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FileMesh, ReadError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let mut file = match open(path) {
        Ok(file) => file,
        Err(OpenError::Directory) => return Err(ReadError::Directory { file: name }),
        Err(OpenError::Failed(cause)) => return Err(ReadError::Open { file: name, cause }),
    };
    let regular = file.metadata().ok().filter(fs::Metadata::is_file);
    let mut source = ByteSource::new(&mut file, regular.map(|metadata| metadata.len()));
    read_any(&name, Some(path), &mut source, *options)
}

/// Reads a mesh from `source`, whose format is recognised by its content; O(bytes) expected.
/// Messages use `name` as the name of the file, and the ending of `name` decides if the content has
/// no sign of a format. `source` needs no buffer.
///
/// # Errors
///
/// Fails like [`read()`], and if the content refers to another file, as glTF may.
///
/// # Examples
///
/// ```
/// use sixfold_io::{Format, ReadOptions, read_from};
///
/// let text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
/// let mesh = read_from("standard input", text.as_bytes(), &ReadOptions::default())?;
/// assert_eq!((mesh.format, mesh.faces.len()), (Format::Off, 1));
///
/// let cut = read_from("cut.off", &text.as_bytes()[..22], &ReadOptions::default());
/// let message = "cut.off:4: the file ends before vertex 3 of 3: copy the file again, or correct \
///                its counts";
/// assert_eq!(cut.unwrap_err().to_string(), message);
/// # Ok::<(), sixfold_io::ReadError>(())
/// ```
pub fn read_from(
    name: &str,
    mut source: impl Read,
    options: &ReadOptions,
) -> Result<FileMesh, ReadError> {
    read_any(
        name,
        None,
        &mut ByteSource::new(&mut source, None),
        *options,
    )
}

/// Reads a mesh; `path` is the place of the file, if it has one.
#[cfg_attr(not(feature = "gltf"), expect(unused_variables))]
fn read_any(
    name: &str,
    path: Option<&Path>,
    source: &mut ByteSource<'_>,
    options: ReadOptions,
) -> Result<FileMesh, ReadError> {
    let known_size = source.size();
    let start = source
        .fill(DETECTION_BYTES)
        .map_err(|cause| ReadError::Read {
            at: Location::new(name, Place::Byte(0)),
            cause,
        })?;
    // A stream that has ended has a known size, too.
    let ended = (start.len() < DETECTION_BYTES).then_some(start.len() as u64);
    let size = known_size.or(ended);
    let by_content = || detect(start, size).or_else(|| Format::from_path(name));
    let format = match options.format {
        Some(format) => Some(format.form_of(start, size)),
        None => by_content(),
    };
    let unknown = || {
        let file = name.to_owned();
        Err(ReadError::UnknownFormat { file })
    };
    let Some(format) = format else {
        return match size.is_none() && may_be_binary_stl(start) {
            true => stl::read_binary_if_complete(name, source, options)?.map_or_else(unknown, Ok),
            false => unknown(),
        };
    };
    if format == Format::Stl && detect(start, size) != Some(Format::Stl) && is_text(start) {
        let file = name.to_owned();
        return Err(ReadError::NotStl { file });
    }
    match format {
        Format::Obj => obj::read(name, source, options),
        Format::Stl => stl::read_binary(name, source, options),
        Format::StlAscii => stl::read_ascii(name, source, options),
        Format::Ply | Format::PlyBigEndian | Format::PlyAscii => ply::read(name, source, options),
        Format::Off => off::read(name, source, options),
        #[cfg(feature = "gltf")]
        Format::Gltf | Format::Glb => gltf::read(name, path, source, options),
        #[cfg(not(feature = "gltf"))]
        Format::Gltf | Format::Glb => Err(ReadError::NoGltf {
            file: name.to_owned(),
        }),
    }
}

impl Format {
    /// Returns this format in the form that the content has: text or binary.
    fn form_of(self, start: &[u8], size: Option<u64>) -> Self {
        match (self, detect(start, size)) {
            (Self::Stl | Self::StlAscii, Some(found @ (Self::Stl | Self::StlAscii))) => found,
            (Self::Gltf | Self::Glb, Some(found @ (Self::Gltf | Self::Glb))) => found,
            _ => self,
        }
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
    Ok(BufReader::with_capacity(1 << 16, open(path)?))
}

fn open(path: &Path) -> Result<File, OpenError> {
    // Some systems allow opening a directory, and then return an unclear error.
    if fs::metadata(path)?.is_dir() {
        return Err(OpenError::Directory);
    }
    Ok(File::open(path)?)
}
