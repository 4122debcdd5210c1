//! The structure itself.

use mesh_core::{FaceId, FaceSpans, Point, Probe, Table, Untraced, VertexId};

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
///   another through the whole table.
/// - I2  The corners of a face name vertices that are there, each once.
///
/// # Memory
///
/// Words for each vertex of a large closed triangle mesh: 9, being 3 of positions and 6 of corners.
/// Mixed degrees add the offsets of the faces.
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
/// be looked for.
#[derive(Clone, Debug)]
pub struct IndexedFaceSet<P: Probe = Untraced> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) corners: Table<VertexId, P>,
    pub(crate) spans: FaceSpans<P>,
}

impl<P: Probe> IndexedFaceSet<P> {
    /// Where each vertex is, as it lies in memory.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// The vertex of each corner, face by face, as it lies in memory.
    pub fn corners(&self) -> &[VertexId] {
        self.corners.rows()
    }

    /// How the corners fall into faces.
    pub fn spans(&self) -> &FaceSpans<P> {
        &self.spans
    }

    /// The vertices of `f`, in order.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn face(&self, f: FaceId) -> &[VertexId] {
        self.corners.read_range(self.spans.range(f))
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
        v
    }

    /// The face of a corner, and the vertices before, at and after it there.
    pub(crate) fn around(&self, corner: usize) -> (FaceId, [VertexId; 3]) {
        let (face, corners) = self.spans.around(corner);
        (face, corners.map(|corner| *self.corners.read(corner)))
    }
}
