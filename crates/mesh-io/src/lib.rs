//! Wavefront OBJ in and out: positions and polygons, with the file's own numbering.
//!
//! Start at [`read_obj`] or [`parse_obj`]; [`ObjMesh::into_polygons`] makes the mesh to build
//! structures from, and says what it left out. [`write_obj`] is the way back.
//!
//! # What is read
//!
//! `v` and `f` (also under its old name `fo`). A vertex may carry a weight or a colour, a corner
//! texture and normal numbers (`7/1/3`), an index may count backwards, and a face may stand before
//! its vertices. Lines end in LF, CRLF or CR; `\` before the end continues one; `#` starts a
//! comment, which is never continued. Everything else is passed over, counted, and told as a
//! [`Notice`]. A fault is an [`ObjError`] with file and line, never a panic.
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

mod error;
mod lines;
mod normaliser;
mod notice;
mod obj_mesh;
mod read;
mod write;

pub use error::{ObjError, Place};
pub use notice::{Notice, Passed};
pub use obj_mesh::{LeftOut, LeftOutReason, ObjMesh, ShortFace};
pub use read::{parse_obj, read_obj};
pub use write::write_obj;
