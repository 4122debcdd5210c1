//! Reads and writes meshes: STL, PLY, OFF, glTF and Wavefront OBJ, with the numbering of the file.
//!
//! [`load`] reads a file into a structure, and [`save`] writes a structure to a file. With more control:
//! [`read()`] and [`read_from`] recognise the format by the content.
//! [`FileMesh::into_polygons`] returns the mesh from which structures are built, and the faces that
//! it left out. [`write()`] writes a mesh and returns what the format cannot keep.
//! Sharp edges are read from OBJ ([`FileMesh::creases`]) or from a file of their own:
//! [`read_creases`] and [`write_creases`].
//!
//! # What is read
//!
//! | format | read | refused |
//! |---|---|---|
//! | STL | text and binary; several solids; normals that are not numbers; lines before and after solids, comments, `end loop`, a missing `endsolid`; facets beyond the count of a binary header; equal corners become one vertex ([`Welding`]) | facets without exactly three vertices, a count of facets larger than the file |
//! | PLY | text and both byte orders; every type of numbers and lists, also `int64` and `uint64`; unknown lines of the header; properties and elements in any order; `vertex_index`, `vertex_indices`; triangle strips | other types of numbers, as `long` |
//! | OFF | prefixes `ST`, `C`, `N`, `4`, `n` in any order; upper and lower case; comments and blank lines anywhere; counts beside or below the keyword, also `OFF3 1 0`; faces on several lines; trailing colours | binary OFF, other than three dimensions |
//! | glTF | JSON and binary; triangles, strips, fans; the default scene, or that of [`Scene`], with its transforms, and morph targets with their default weights; 8, 16 and 32-bit indices; sparse, quantised and embedded data; buffers in files below the folder of the file; the mesh of a skin as it is stored, without its joints | Draco and meshopt without plain data; other required extensions that change a mesh, as instances |
//! | OBJ | see below | |
//!
//! glTF needs the feature `gltf`, which is on by default. The others need neither `serde` nor JSON.
//!
//! The content decides the format, and the ending of the name only if the content has no sign of
//! one. A binary STL has no such sign but its size, which is 84 bytes and 50 for each facet. On a
//! stream, whose size is not known, and in a file of another size, the normal of the first facet is the
//! sign, whose coordinates are from −1 to 1 or not numbers; without it, the stream is a binary STL if
//! its corners are plausible and exactly as many facets follow as byte 80 says. Then a stream that is
//! cut off is not recognised.
//!
//! Everything else is ignored, counted, and reported as a [`Notice`], once for each kind. This
//! includes normals, colours and texture coordinates. Coordinates of 64 bits and decimal numbers
//! are rounded to 32 bits; [`FileMesh::narrowing`] says what this changed, and
//! [`ReadOptions::recentred`] moves the mesh to the origin first. A fault is returned as a
//! [`ReadError`] with file and line or byte.
//!
//! # Which vertices become one
//!
//! By default, only the corners of STL facets are joined, if their positions are exactly equal (−0 is
//! 0): STL stores three positions for each facet and no vertex numbers, so without joining no facet
//! would have a neighbour. The other formats have vertex numbers, and vertices with equal positions
//! but different numbers stay apart, because a program may have cut the mesh there on purpose. So a
//! mesh of glTF or OBJ can have open seams, for example where texture coordinates or normals differ
//! on the two sides of an edge. In glTF, primitives of a mesh share vertices if they use the same
//! accessor of positions; others do not, and each node has vertices of its own.
//!
//! [`Welding::All`] joins equal positions in every format, and [`Welding::Nothing`] in none.
//! [`FileMesh::welded_vertices`] counts the joined vertices. If joined vertices are neighbours in a
//! face, the face loses the repeat, as described next.
//!
//! # Faces that name a vertex twice
//!
//! If a corner repeats its neighbour, as in `f 1 2 2 3 4` or `f 1 2 3 4 1`, only the repeat is
//! removed, with a notice ([`IgnoredKind::RepeatedCorners`]). [`FileMesh::into_polygons`] leaves out
//! faces with fewer than three different corners, and faces that name a vertex twice in other
//! corners. It returns them with their places ([`LeftOut`]). [`FileMesh::facts`] describes the mesh
//! without these faces, and counts them.
//!
//! # Files that lie
//!
//! The reader never panics, and a file cannot make it allocate memory or loop by a number in its
//! header: memory is reserved for a number of records only if the size of the file allows that many,
//! and otherwise grows with the records that were read. Readers of STL, PLY, OFF and OBJ stream: in
//! addition to the mesh they need a buffer and, for STL, the hash table that joins corners. The peak
//! is at most 1.2 times the mesh for binary STL and PLY (1.6 times if the mesh is moved, because its
//! positions are kept in 64 bits), 1.7 times (2.3) for ASCII PLY and OFF, and 2.7 times (2.8) for OBJ
//! and ASCII STL, whose tables grow while they are read. `tests/memory.rs` measures this. glTF
//! refers to its buffers in any order, so they are in memory; a scene that repeats its meshes is
//! limited to 256 vertices and corners for each byte of the file. Only files in the folder of a glTF
//! file or below it are opened, also if links lead elsewhere.
//!
//! # OBJ
//!
//! The reader uses the statements `v` and `f`; `fo` is an old name of `f`. A vertex may have a
//! weight or a colour. A corner may have indices of a texture coordinate and of a normal
//! (`7/1/3`). An index may count backwards. A face may come before its vertices. Lines end in LF,
//! CRLF or CR; `\` at the end of a line continues the line. `#` starts a comment; a comment cannot be continued. The reader also
//! uses the tags `t crease` and `t corner` of OpenSubdiv. Vertices of tags count from 0, but
//! vertices of faces count from 1:
//!
//! ```text
//! t crease 2/1/0 5 9 4.7          the edge between vertices 5 and 9; 2 vertices, 1 sharpness, 0 words
//! t crease 4/3/0 7 2 5 9 1 0.5 4  three edges in a row, each with its own sharpness
//! t corner 2/1/0 5 9 inf          two vertices that stay sharp at all levels
//! ```
//!
//! Other tags are ignored, for example the boundary rule. Such settings are options of the command,
//! not part of a mesh.
//!
//! # Crease files
//!
//! A crease file has one entry per line, `edge a b sharpness` or `corner v sharpness`. Vertices
//! count from 0. Sharpness is the number of levels for which the edge or vertex stays sharp: a
//! number that is 0 or greater, or `inf` for all levels. Sharpness may have a fraction.
//! [`parse_creases`] documents the rules. A fault is returned as a [`CreaseFileError`] with file
//! and line.
//!
//! # Why these readers
//!
//! The readers of STL, PLY, OFF and glTF are our own, because the libraries that exist do not hold
//! up against the files above:
//!
//! - `stl_io` 0.11 treats every file that begins with `solid ` as text, also binary ones. It stops
//!   after the first solid of a text, needs lower case and one line per keyword, and names no line.
//!   It took 6.5 s and 665 MB for 10 million facets; this reader took 2.0 s and 247 MB.
//! - `serde-ply` 0.2 reads each text value byte by byte into a string of its own, and needs a Rust
//!   type for the properties, which are known only from the file. It names no line or byte. It took
//!   1.3 s and 593 MB for 10 million triangles; this reader took 0.7 s and 180 MB.
//! - `ply-rs-bw` 4 keeps each element in a map from names to values: 0.5 s and 482 MB for 800,000
//!   triangles, where this reader took 0.05 s and 14 MB. A type with other storage (its trait
//!   `PropertyAccess`) still gets the corners of each face in a `Vec` of their own.
//! - `gltf` 1.4 slices buffers by the unchecked numbers of views, so a wrong length is a panic, and
//!   subtracts 1 from a count that may be 0. Its positions are only those of 32 bits. Reading the
//!   JSON text with `serde_json` takes one file of structures.
//!
//! (Binary files of a geodesic sphere, one after the other on one machine with two cores that was
//! busy with other work; `examples/reading.rs` measures the readers of this crate.)
//!
//! `tobj` parses the vertices of OBJ. But if it is used alone, it drops vertices without a face, and
//! the numbering of the file is lost. It splits a mesh at every `o`, `g` and `usemtl`, and each part
//! gets its own copy of a shared vertex. It divides the coordinates of a vertex by a fourth value
//! and rejects a fifth value. It misreads lone CR, continued lines and byte order marks. Its errors
//! contain no line number, and it keeps more than 100 bytes for each face. Therefore it gets only
//! the vertices, in blocks of plain statements:
//!
//! ```text
//! bytes ──► lines ──────► normaliser ──► vertices ──► tobj ──► positions ──┐
//!           BOM, CR,          │          16,384 at a time                  ▼
//!           `\`, `#`          └───────────► faces, tags ─────────────► mesh builder
//! ```
//!
//! If `tobj` returns an error, the last statement that was passed caused the error, and the line of
//! this statement is known. A block ends with a polygon through its vertices. The polygon keeps
//! `tobj` from removing vertices and from numbering them in another order.

mod builder;
mod byte_source;
mod crease_file;
mod error;
mod excerpt;
mod face_rules;
mod faults;
mod file_mesh;
mod format;
#[cfg(feature = "gltf")]
mod gltf;
mod lines;
mod load;
mod narrowing;
mod notice;
mod number;
mod obj;
mod off;
mod off_keyword;
mod options;
mod place;
mod ply;
mod read;
mod sharpness;
mod stl;
mod tags;
mod welder;
mod write;

pub use crease_file::{CreaseFileError, parse_creases, read_creases, write_creases};
pub use error::ReadError;
pub use faults::{GltfFault, PlyHeaderFault, TagFault};
pub use file_mesh::{FileMesh, LeftOut, LeftOutReason, ShortFace};
pub use format::Format;
pub use load::{LoadError, load, save};
pub use narrowing::Narrowing;
pub use notice::{IgnoredKind, Notice};
pub use obj::parse_obj;
pub use options::{ReadOptions, Scene, Welding};
pub use place::{Location, Place, PolygonPlaces};
pub use read::{read, read_from, read_with};
pub use tags::{CornerTag, CreaseTag, Tag, UnusedCrease};
pub use write::{Loss, WriteError, WriteOptions, write, write_to, write_with};
