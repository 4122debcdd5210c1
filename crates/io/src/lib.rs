//! Reads and writes Wavefront OBJ: positions, polygons and creases, with the numbering of the file.
//!
//! Start with [`read_obj`] or [`parse_obj`]. [`ObjMesh::into_polygons`] returns the mesh from which
//! structures are built, and the faces that it left out. [`ObjMesh::creases`] returns the sharpness
//! of edges and vertices. [`write_obj`] writes a mesh. Creases can also be stored in a separate
//! file: [`read_creases`] and [`write_creases`].
//!
//! # What is read
//!
//! The reader uses the statements `v` and `f`; `fo` is an old name of `f`. A vertex may have a
//! weight or a colour. A corner may have indices of a texture coordinate and of a normal
//! (`7/1/3`). An index may count
//! backwards. A face may come before its vertices. Lines end in LF, CRLF or CR; `\` at the end of a
//! line continues the line. `#` starts a comment; a comment cannot be continued. The reader also
//! uses the tags `t crease` and `t corner` of OpenSubdiv. Vertices of tags count from 0, but
//! vertices of faces count from 1:
//!
//! ```text
//! t crease 2/1/0 5 9 4.7          the edge between vertices 5 and 9; 2 vertices, 1 sharpness, 0 words
//! t crease 4/3/0 7 2 5 9 1 0.5 4  three edges in a row, each with its own sharpness
//! t corner 2/1/0 5 9 inf          two vertices that stay sharp at all levels
//! ```
//!
//! Everything else is ignored, counted, and reported as a [`Notice`]. Other tags are ignored too,
//! for example the boundary rule. Such settings are options of the command, not part of a mesh. A
//! fault is returned as an [`ObjError`] with file and line; the reader never panics.
//!
//! # Crease files
//!
//! A crease file has one entry per line, `edge a b sharpness` or `corner v sharpness`. Vertices
//! count from 0. Sharpness is the number of levels for which the edge or vertex stays sharp: a
//! number that is 0 or greater, or `inf` for all levels. Sharpness may have a fraction.
//! [`parse_creases`] documents the rules. A fault is returned as a [`CreaseFileError`] with file
//! and line.
//!
//! # Why there is a normaliser in front of `tobj`
//!
//! ```text
//! bytes ──► lines ──────► normaliser ───────────► tobj ─────────► parse_obj
//!           BOM, CR,      one `v x y z` or        numbers,        numbering of the file,
//!           `\`, `#`      `f i j k` at a time     index checks    check for finite values
//! ```
//!
//! `tobj` alone changes the mesh in these ways:
//!
//! - It drops vertices without a face, so the numbering of the file is lost.
//! - It splits a mesh at every `o`, `g` and `usemtl`, and copies the shared vertices.
//! - It divides the coordinates of a vertex by a fourth value and rejects a fifth value.
//! - It misreads lone CR, continued lines and byte order marks.
//! - Its errors contain no line number.
//!
//! Therefore the normaliser is a `BufRead` that passes one object in plain statements to `tobj`,
//! one statement at a time. If `tobj` returns an error, the last statement caused the error, and
//! the line of this statement is known. The final statement is a polygon through all vertices in
//! file order. Its corners show which number `tobj` gave to each vertex of the file. The whole text
//! is never in memory. A separate scanner would read every file a second time, and its rules for
//! lines could differ from the rules of `tobj`.

mod crease_file;
mod error;
mod lines;
mod normaliser;
mod notice;
mod obj_mesh;
mod read;
mod sharpness;
mod tags;
mod write;

pub use crease_file::{CreaseFileError, parse_creases, read_creases, write_creases};
pub use error::{Location, ObjError};
pub use notice::{IgnoredKind, Notice};
pub use obj_mesh::{LeftOut, LeftOutReason, ObjMesh, ShortFace};
pub use read::{parse_obj, read_obj};
pub use tags::{CornerTag, CreaseTag, Tag, TagFault, UnusedCrease};
pub use write::{write_obj, write_obj_with_normals};
