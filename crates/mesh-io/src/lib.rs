//! Wavefront OBJ in and out: positions, polygons and creases, with the file's own numbering.
//!
//! Start at [`read_obj`] or [`parse_obj`]; [`ObjMesh::into_polygons`] makes the mesh to build
//! structures from, and says what it left out; [`ObjMesh::creases`] says how sharp its edges and
//! vertices are. [`write_obj`] is the way back. Creases may also stand in a file of their own:
//! [`read_creases`] and [`write_creases`].
//!
//! # What is read
//!
//! `v` and `f` (also under its old name `fo`). A vertex may carry a weight or a colour, a corner
//! texture and normal numbers (`7/1/3`), an index may count backwards, and a face may stand before
//! its vertices. Lines end in LF, CRLF or CR; `\` before the end continues one; `#` starts a
//! comment, which is never continued. The tags `t crease` and `t corner` of OpenSubdiv's shapes are
//! read too; their vertices count from 0, where faces count from 1:
//!
//! ```text
//! t crease 2/1/0 5 9 4.7          the edge between vertices 5 and 9; 2 vertices, 1 sharpness, 0 words
//! t crease 4/3/0 7 2 5 9 1 0.5 4  three edges in a row, each with its own
//! t corner 2/1/0 5 9 inf          two vertices that stay for ever
//! ```
//!
//! Everything else is passed over, counted, and told as a [`Notice`]; other tags are too, since the
//! boundary rule and the like are options here and no part of a mesh. A fault is an [`ObjError`] with
//! file and line, never a panic.
//!
//! # Crease files
//!
//! One entry a line, `edge a b sharpness` or `corner v sharpness`; vertices count from 0. Sharpness
//! is the number of levels for which the edge or vertex is kept: from 0, not always whole, and `inf`
//! is for ever. [`parse_creases`] has the rules. A fault is a [`CreaseFileError`] with file and line.
//!
//! # Why a normaliser in front of `tobj`
//!
//! ```text
//! bytes ──► lines ──────► normaliser ───────────► tobj ─────────► parse_obj
//!           BOM, CR,      one `v x y z` or        numbers,        the file's numbering
//!           `\`, `#`      `f i j k` at a time     index checks    again, finite or not
//! ```
//!
//! `tobj` parses well what it takes for OBJ. But alone it drops vertices that no face names, and
//! with them the file's numbering; splits a mesh at every `o`, `g` and `usemtl` and gives each part
//! its own copy of a shared vertex; divides by a fourth value and refuses a fifth; takes lone CR,
//! continued lines and byte order marks for other statements; and its errors name no line.
//!
//! So the normaliser is a `BufRead` that hands it one object in plain statements, one at a time.
//! When `tobj` refuses, the statement last handed out is the culprit, and its line is known. The last
//! statement is a polygon through all vertices in file order: where its corners point is where
//! each vertex of the file has gone, used or not. The text is never held as a whole. A scanner of our
//! own beside `tobj` would have read every file twice and needed the same rules for lines, and the
//! two could have disagreed about the numbering.

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
pub use error::{ObjError, Place};
pub use notice::{Notice, Passed};
pub use obj_mesh::{LeftOut, LeftOutReason, ObjMesh, ShortFace};
pub use read::{parse_obj, read_obj};
pub use tags::{CornerTag, CreaseTag, LooseCrease, Tag, TagFault};
pub use write::{write_obj, write_obj_with_normals};
