//! The tables, their invariants, and access to them.

use std::ops::Range;

use sixfold_core::{Compact, Editing, FaceId, FaceSpans, Point, Probe, Table, Untraced, VertexId};

/// A mesh with the vertices of each face and the faces of each vertex; edges are not stored.
///
/// ```text
///    c ────── b     positions  a  b  c  d …                 by vertex
///    │ f0  /  │     corners    a  b  c │ a  d  b │ …        by corner
///    │   /    │     fans       0,2  2,2  4,1  5,1 …         by vertex: start, length
///    │ /  f1  │                └┐   └───┐
///    a ────── d     pool       f0 f1 │ f0 f1 │ f0 │ f1 │ …  the faces around a, b, c, d …
/// ```
///
/// The fan of a vertex is the list of its faces. All fans are stored in one table, the pool.
///
/// - I1  Face `f` has the corners `spans.range(f)`. The ranges of faces are disjoint. Until an edit
///   changes the degree of a face, the ranges are consecutive and cover the whole table. A face has
///   at least three vertices, which all exist and are distinct.
/// - I2  The fans of two vertices do not overlap in the pool.
/// - I3  The fan of `v` contains exactly the faces with a corner at `v`, each once.
/// - I4  Deleted and unused entries are blank. A corner that belongs to no face or to a deleted
///   face contains vertex `u32::MAX`. An entry of the pool outside all fans contains face
///   `u32::MAX`. The fan of a deleted vertex is [`Fan::DELETED`]. `vertex_holes` and `face_holes`
///   contain exactly the deleted vertices and faces.
///
/// A large closed triangle mesh uses 17 words of 4 bytes per vertex: 3 for positions, 6 for
/// corners, 2 for fans and 6 for the pool. If the faces have different degrees, the mesh uses one
/// more word per face. For each fan, the mesh stores the start and the length, so a fan that grows
/// can move to the end of the pool without moving other fans. The first deletion of a vertex adds
/// up to one bit per vertex, and the first deletion of a face adds up to one bit per face. The
/// first edit that changes the degree of a face adds two words per face and one word per corner.
///
/// # Complexity
///
/// In the table of queries, `length` is the number of faces in a fan, and `d` is the degree of
/// these faces. The name of a query has two letters, for vertex (V), edge (E) or face (F): VE lists
/// the edges of a vertex.
///
/// | query | reads | time |
/// |---|---|---|
/// | FV, FE | the corners of the face | O(1) per item |
/// | VF | the fan of the vertex | O(1) per item |
/// | EV | the handle itself | O(1), reads no table |
/// | VV, VE | the corners of the fan | O(length · d) expected |
/// | EF | the corners of the shorter fan of the two ends | O(length · d) |
/// | EE | the corners of the fans of both ends | O(d · sum of both lengths) expected |
/// | FF | for each side of the face, the corners of the shorter fan of its two ends | O(sides · length · d) expected |
/// | `vertices`, `faces` | the deleted rows, if there are any | O(1) per item |
/// | `edges`, `edge_count` | all corners | O(corners + vertices), without hashing |
///
/// A pass over all vertices with VF, or over all faces with FV, reads the tables from start to end.
/// If the tables fit in the cache, a pass spends most of its time in the loop over the results of
/// each query: six faces around a vertex (VF), or three vertices of a face (FV). If the tables do
/// not fit in the cache, the number of bytes that are read limits the speed. VF reads 32 bytes per
/// vertex (8 of fans, 24 of pool), and FV reads 12 bytes per triangle. The queries VV, VE, EE, EF
/// and FF read the faces of a fan in the pool, then compare the vertices at the corners of these
/// faces. If neighbours are close in memory, the comparisons limit the speed of VV. In a mesh in
/// random order, the latency of the memory limits the speed of VV.
///
/// [`Refine`](sixfold_core::Refine) takes O(corners · d + vertices) time to split every face, and
/// the same time to number the edges; d is the degree of a face.
///
/// Edits ([`MeshEdit`](sixfold_core::MeshEdit)) write corners and change fans. A fan that shrinks
/// does not move, and leaves blank entries of the pool behind its last face. A fan that grows uses
/// a blank entry behind its last face. If there is no blank entry, the fan moves to the end of the
/// pool and gets room for twice as many faces as before, and for at least eight faces. So a fan
/// that grows face by face moves O(log length) times. [`compact`](sixfold_core::MeshEdit::compact)
/// removes the blank entries. `remove_isolated_vertices` and `compact` read the whole mesh. In the
/// table of edits, `n` is the length of a fan, and `d` is the degree of a face at the edited
/// element.
///
/// | edit | time | writes |
/// |---|---|---|
/// | `set_position` | O(1) | the position |
/// | `add_vertex` | O(1) | a position, an empty fan |
/// | `add_face` | O(d) | d new corners, one entry in each of d fans |
/// | `remove_face` | O(d · n) | blanks in the d corners of the face, and in one entry of each of d fans |
/// | `remove_vertex` | O(n² · d) | as for `remove_face`, for each face of the vertex |
/// | `split_edge` | O(n · d) | the corners of the faces at the edge, at the end of the table; a new fan |
/// | `bisect_edge` | O(n) | one corner in each face at the edge, three in each new face; four fans if the edge has two faces |
/// | `poke_face` | O(d · n) | the corners of the face, three in each new face; d fans, and a new fan |
/// | `split_face` | O(d · n) | the corners of both parts, the fans of the new part |
/// | `dissolve_edge` | O(n · d) | the corners of both faces, the fans of the removed face |
/// | `flip_edge` | O(n) | one corner of each of the two faces, one entry in each of four fans |
/// | `collapse_edge` | O(n · d) | one corner in each face of the removed end, the fans of both ends and of the third corners |
/// | `split_vertex` | O(n · d + n log n) | one corner in each face that the new vertex gets, four fans |
/// | `remove_isolated_vertices` | O(vertices) | the fans of the removed vertices |
/// | `compact` | O(corners + vertices) | all tables |
///
/// Some edits change the degree of a face, or add a face of a different degree to a mesh whose
/// faces all have the same degree. `split_edge`, `split_face` and `dissolve_edge` always change
/// degrees. `poke_face`, `collapse_edge` and `split_vertex` change degrees only if the mesh has a
/// face that is not a triangle. `add_face` changes degrees only if the new face is the first face
/// of a different degree. The first edit that changes degrees after a `compact` takes O(corners)
/// time, because this edit builds a table with the range of each face and a table with the face of
/// each corner ([`FaceSpans::Scattered`]).
///
/// # Examples
///
/// ```
/// use sixfold_face_vertex::FaceVertexMesh;
/// use sixfold_core::{FaceId, MeshQuery, Point, PolygonMesh, Representation, VertexId};
///
/// let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
/// let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
/// let mesh = FaceVertexMesh::from_polygons(&polygons)?;
/// assert_eq!(mesh.fan(VertexId::new(0)), [0, 1].map(FaceId::new));
/// assert_eq!(mesh.edges().count(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FaceVertexMesh<E: Editing = Compact, P: Probe = Untraced> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) corners: Table<VertexId, P>,
    pub(crate) spans: FaceSpans<P, E>,
    pub(crate) fans: Table<Fan, P>,
    pub(crate) pool: Table<FaceId, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

sixfold_core::mesh_tables!(FaceVertexMesh {
    tables: positions, corners, fans, pool;
    faces: spans;
    holes: vertex_holes, face_holes;
});
sixfold_core::polygon_conversions!(FaceVertexMesh);

/// The vertex in a blank corner.
pub(crate) const BLANK_CORNER: VertexId = VertexId::new(u32::MAX);

/// The face in a blank place of the pool.
pub(crate) const BLANK_PLACE: FaceId = FaceId::new(u32::MAX);

/// A fan: the range of the pool that contains the faces around one vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fan {
    /// The row of the first face in the pool.
    pub start: u32,
    /// The number of faces around the vertex.
    pub len: u32,
}

impl Fan {
    /// The fan of a deleted vertex. The range of this fan is beyond the end of every pool, so a
    /// read of this range fails the bounds check.
    pub const DELETED: Self = Self {
        start: u32::MAX,
        len: u32::MAX,
    };

    /// Returns the rows of the pool that contain the faces of this fan.
    #[inline]
    pub fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + self.len as usize
    }
}

impl<P: Probe, E: Editing> FaceVertexMesh<E, P> {
    /// Returns the position of each vertex, including deleted vertices.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// Returns the vertex of each corner, face by face. A corner that belongs to no face contains
    /// vertex `u32::MAX`.
    pub fn corners(&self) -> &[VertexId] {
        self.corners.rows()
    }

    /// Returns the range of corners of each face, including deleted faces.
    pub fn spans(&self) -> &FaceSpans<P, E> {
        &self.spans
    }

    /// Returns the fan of each vertex, which is a range of the [`pool`](Self::pool). A deleted
    /// vertex has the fan [`Fan::DELETED`].
    pub fn fans(&self) -> &[Fan] {
        self.fans.rows()
    }

    /// Returns the pool: the table with the faces around each vertex. Unused rows contain face
    /// `u32::MAX`.
    pub fn pool(&self) -> &[FaceId] {
        self.pool.rows()
    }

    /// Returns the vertices of `f`, in the order of its corners.
    ///
    /// # Panics
    ///
    /// Panics if there is no face `f`.
    #[inline(always)]
    pub fn face(&self, f: FaceId) -> &[VertexId] {
        let face = self.known_face(f);
        if E::CAN_DELETE && face.first() == Some(&BLANK_CORNER) {
            deleted_face(f);
        }
        face
    }

    /// Returns the vertices of a face that exists.
    #[inline(always)]
    pub(crate) fn known_face(&self, f: FaceId) -> &[VertexId] {
        self.corners.read_range(self.spans.range(f))
    }

    /// Returns the faces around `v`, in unspecified order.
    ///
    /// # Panics
    ///
    /// Panics if there is no vertex `v`.
    #[inline]
    pub fn fan(&self, v: VertexId) -> &[FaceId] {
        self.places(v, *self.fans.read(v.index()))
    }

    /// Returns the faces in `fan`, the fan of `v`.
    #[inline]
    pub(crate) fn places(&self, v: VertexId, fan: Fan) -> &[FaceId] {
        let range = fan.range();
        if E::CAN_DELETE && range.end > self.pool.len() {
            deleted_vertex(v);
        }
        self.pool.read_range(range)
    }
}

#[cold]
#[inline(never)]
pub(crate) fn deleted_vertex(v: VertexId) -> ! {
    panic!("no vertex {v}: it was deleted")
}

#[cold]
#[inline(never)]
pub(crate) fn deleted_face(f: FaceId) -> ! {
    panic!("no face {f}: it was deleted")
}
