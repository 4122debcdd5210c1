//! The structure itself.

use mesh_core::{
    Editable, Editing, FaceId, FaceSpans, HoleSet, Point, Probe, ScannedFaces, Table, Untraced,
    VERTEX_HOLES, VertexId, Whole,
};

/// Vertices with positions, and faces as lists of vertices.
///
/// ```text
///    c ────── b
///    │ f0  /  │     positions  a  b  c  d …             by vertex
///    │   /    │     corners    a  b  c │ a  d  b │ …    by corner
///    │ /  f1  │                └─ f0 ─┘└─ f1 ─┘
///    a ────── d     that f0 and f1 share the edge a–b, only a scan finds out
/// ```
///
/// # Invariants
///
/// - I1  Face `f` has the corners of `spans.range(f)`, at least three; these ranges follow one
///   another through the whole table, until a face gets another degree, which may leave corners
///   between them.
/// - I2  The corners of a face name vertices that are there, each once.
/// - I3  Holes are rows of vertices and of faces. Blank, which names no vertex, are the corners of
///   deleted faces and those between faces, and no others; so no scan finds them. A deleted vertex
///   keeps its last place, which nobody reads.
///
/// # Memory
///
/// Words for each vertex of a large closed triangle mesh: 9, being 3 of positions and 6 of corners.
/// Mixed degrees add the offsets of the faces. Edits that change a degree bring two words a face and
/// one a corner instead, deletions a bit a row, all until [`compact`](mesh_core::MeshEdit::compact).
///
/// # Complexity
///
/// | query | looks at | time |
/// |---|---|---|
/// | FV, FE | the corners of the face | O(1) an item |
/// | EV | the handle itself | O(1), without reading |
/// | VF, VV, VE, EF, EE | all corners, in one scan | O(corners) expected |
/// | FF | all corners, in one scan | O(corners + degree log degree) expected; beyond degree 8 O(vertices) more |
/// | `vertices`, `faces` | nothing | O(1) an item |
/// | `edges`, `edge_count` | all corners | O(corners + vertices), without hashing |
///
/// A hit of a scan costs O(1), or O(log faces) with mixed degrees, where the face of a corner has to
/// be looked for until edits have brought a table for that.
///
/// # Edits
///
/// | edit | looks at | changes |
/// |---|---|---|
/// | `set_position` | the vertex | its place |
/// | `add_vertex` | nothing | a new place |
/// | `add_face` | its corners | new corners, a new span |
/// | `remove_face`, `split_face`, `poke_face` | the corners of the face | they, and those of new faces |
/// | `split_edge`, `dissolve_edge` | all corners, in one scan | the faces along the edge, which may move to the end of the table |
/// | `bisect_edge` | all corners, in one scan | a corner of each face, and a new face for each |
/// | `flip_edge` | all corners, in two scans | one corner of each face |
/// | `collapse_edge` | all corners, in one scan, seldom two | the corners at the vertex that goes |
/// | `split_vertex` | all corners, in one scan | the corners that the new vertex gets, and two new faces |
/// | `remove_vertex` | all corners, in one scan | the corners of its faces |
/// | `remove_isolated_vertices` | all corners | bits |
/// | `compact` | everything | everything |
///
/// To tell a listener which sides of a face others have too, `add_face`, `remove_face`,
/// `remove_vertex` and `split_face` scan once more. Nothing but a handle that names nothing, or the
/// rule of the edit itself, makes one illegal: any polygon mesh is held.
#[derive(Debug)]
pub struct AnyIndexedFaceSet<P: Probe, E: Editing> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) faces: ScannedFaces<VertexId, P, E>,
}

mesh_core::clone_by_field!(AnyIndexedFaceSet<P: Probe, E: Editing> { positions, vertex_holes, faces });

/// An indexed face set of which nothing can be deleted: [`AnyIndexedFaceSet`] whose rows are all elements.
pub type IndexedFaceSet<P = Untraced> = AnyIndexedFaceSet<P, Whole>;

/// An indexed face set that can be edited ([`MeshEdit`](mesh_core::MeshEdit)): [`AnyIndexedFaceSet`] with holes.
pub type EditableIndexedFaceSet<P = Untraced> = AnyIndexedFaceSet<P, Editable>;

impl<P: Probe> From<IndexedFaceSet<P>> for EditableIndexedFaceSet<P> {
    fn from(mesh: IndexedFaceSet<P>) -> Self {
        let probe = mesh.positions.probe();
        Self {
            positions: mesh.positions,
            faces: mesh.faces.into(),
            vertex_holes: Editable::no_holes(VERTEX_HOLES, probe),
        }
    }
}

impl<P: Probe, E: Editing> AnyIndexedFaceSet<P, E> {
    /// Where each vertex is, as it lies in memory, deleted ones included.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// The vertex of each corner, face by face, as it lies in memory, blank ones included.
    pub fn corners(&self) -> &[VertexId] {
        self.faces.corners.rows()
    }

    /// How the corners fall into faces, deleted ones included.
    pub fn spans(&self) -> &FaceSpans<P, E> {
        &self.faces.spans
    }

    /// The vertices of `f`, in order.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn face(&self, f: FaceId) -> &[VertexId] {
        self.faces.face(f)
    }

    /// Whether `v` is there.
    #[inline]
    pub(crate) fn has(&self, v: VertexId) -> bool {
        v.index() < self.positions.len() && !self.vertex_holes.has(v.index())
    }

    /// `v`, if it is there: a scan for a vertex that is not would find nothing, and say nothing.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[inline]
    pub(crate) fn existing(&self, v: VertexId) -> VertexId {
        let vertices = self.positions.len();
        assert!(v.index() < vertices, "no vertex {v}: there are {vertices}");
        self.check_deleted(v);
        v
    }

    /// # Panics
    ///
    /// If `v` was deleted.
    #[inline]
    pub(crate) fn check_deleted(&self, v: VertexId) {
        if self.vertex_holes.has(v.index()) {
            deleted(v);
        }
    }
}

#[cold]
#[inline(never)]
fn deleted(v: VertexId) -> ! {
    panic!("no vertex {v}: it was deleted")
}
