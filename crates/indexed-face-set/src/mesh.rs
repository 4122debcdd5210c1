//! The tables, their invariants, and access to them.

use sixfold_core::{
    Compact, Editing, FaceId, FaceSpans, HoleSet, Point, Probe, Table, Untraced, VertexId,
};
use sixfold_scanning::ScannedFaces;

/// A mesh with the position of each vertex and the vertices of each face.
///
/// ```text
///    c ────── b
///    │ f0  /  │     positions  a  b  c  d …             by vertex
///    │   /    │     corners    a  b  c │ a  d  b │ …    by corner
///    │ /  f1  │                └─ f0 ─┘└─ f1 ─┘
///    a ────── d     the link between f0 and f1 is not stored: only a scan finds it
/// ```
///
/// # Invariants
///
/// - I1  Face `f` has the corners `spans.range(f)`, which are at least three. The ranges are
///   consecutive and cover the whole table. After an edit has changed the degree of a face, unused
///   corners can be between the ranges.
/// - I2  The vertices at the corners of a face exist and are distinct.
/// - I3  The hole tables list the rows of deleted vertices and of deleted faces. Exactly two kinds
///   of corners are blank: the corners of deleted faces, and the unused corners between faces. A
///   blank corner has no vertex. A deleted vertex keeps its last position, which is not used.
///
/// # Memory
///
/// A large closed triangle mesh uses 9 words of 4 bytes per vertex: 3 for positions and 6 for
/// corners. If the faces have different degrees, the mesh uses one more word per face. After an
/// edit that changes the degree of a face, the mesh uses two more words per face and one more word
/// per corner than a mesh whose faces have the same degree. After a deletion, the mesh uses up to
/// one more bit per vertex and per face. [`compact`](sixfold_core::MeshEdit::compact) frees the
/// additional memory of edits and deletions.
///
/// # Complexity
///
/// | query | reads | time |
/// |---|---|---|
/// | FV, FE | the corners of the face | O(1) per item |
/// | EV | the handle itself | O(1), reads no table |
/// | VF, VV, VE, EF, EE | all corners, in one scan | O(corners) expected |
/// | FF | all corners, in one scan | O(corners + degree log degree) expected; also O(vertices) if the degree is above 8 |
/// | `vertices`, `faces` | the deleted rows, if there are any | O(1) per item |
/// | `edges`, `edge_count` | all corners | O(corners + vertices), without hashing |
///
/// For each corner at the given vertex, a scan finds the face of the corner in O(1) time, or in
/// O(log faces) time if the faces have different degrees. After an edit that changes a degree, a
/// table stores the face of each corner, so finding the face takes O(1) time.
///
/// # Edits
///
/// | edit | reads | changes |
/// |---|---|---|
/// | `set_position` | the vertex | its position |
/// | `add_vertex` | nothing | a new position |
/// | `add_face` | the given corners | new corners, a new span |
/// | `remove_face`, `split_face`, `poke_face` | the corners of the face | the corners of the face and of new faces |
/// | `split_edge`, `dissolve_edge` | all corners, in one scan | the faces at the edge, which may move to the end of the table |
/// | `bisect_edge` | all corners, in one scan | a corner of each face at the edge, and a new face for each of these faces |
/// | `flip_edge` | all corners, in two scans | one corner of each of the two faces |
/// | `collapse_edge` | all corners, in one scan, rarely more | the corners at the removed vertex |
/// | `split_vertex` | all corners, in one scan | the corners that the new vertex gets, and one or two new faces |
/// | `remove_vertex` | all corners, in one scan | the corners of the faces at the vertex |
/// | `remove_isolated_vertices` | all corners | one bit per removed vertex |
/// | `compact` | everything | everything |
///
/// If a log records the edits, `add_face`, `remove_face`, `remove_vertex` and `split_face` need one
/// more scan, to find the edges that other faces have. The structure holds every polygon mesh. So
/// an edit is refused only if the edit itself is not possible (for example the flip of a boundary
/// edge), if a handle is not valid, or if the tables are full.
#[derive(Debug)]
pub struct IndexedFaceSet<E: Editing = Compact, P: Probe = Untraced> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) faces: ScannedFaces<VertexId, P, E>,
}

sixfold_core::mesh_tables!(IndexedFaceSet {
    tables: positions;
    holes: vertex_holes;
    faces: faces;
});
sixfold_core::polygon_conversions!(IndexedFaceSet);

impl<P: Probe, E: Editing> IndexedFaceSet<E, P> {
    /// Returns the position of each vertex, including deleted vertices.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// Returns the vertex of each corner, face by face, including blank corners.
    pub fn corners(&self) -> &[VertexId] {
        self.faces.corners.rows()
    }

    /// Returns the range of corners of each face, including deleted faces.
    pub fn spans(&self) -> &FaceSpans<P, E> {
        &self.faces.spans
    }

    /// Returns the vertices of `f`, in the order of its corners.
    ///
    /// # Panics
    ///
    /// Panics if there is no face `f`.
    #[inline]
    pub fn face(&self, f: FaceId) -> &[VertexId] {
        self.faces.face(f)
    }

    /// Returns `v` if `v` exists.
    ///
    /// # Panics
    ///
    /// Panics if there is no vertex `v`.
    #[inline]
    pub(crate) fn expect_vertex(&self, v: VertexId) -> VertexId {
        let vertices = self.positions.len();
        assert!(
            v.index() < vertices,
            "no vertex {v}: every vertex has a row below {vertices}"
        );
        self.check_not_deleted(v);
        v
    }

    /// Panics if `v` was deleted.
    #[inline]
    pub(crate) fn check_not_deleted(&self, v: VertexId) {
        if self.vertex_holes.has(v.index()) {
            deleted_vertex(v);
        }
    }
}

#[cold]
#[inline(never)]
fn deleted_vertex(v: VertexId) -> ! {
    panic!("no vertex {v}: it was deleted")
}
