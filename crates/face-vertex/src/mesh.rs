//! The structure itself.

use std::ops::Range;

use mesh_core::{FaceId, FaceSpans, Point, Probe, Table, Untraced, VertexId};

/// Vertices and faces that know each other; edges are seen, not stored.
///
/// ```text
///    c ────── b     positions  a  b  c  d …                 by vertex
///    │ f0  /  │     corners    a  b  c │ a  d  b │ …        by corner
///    │   /    │     fans       0,2  2,2  4,1  5,1 …         by vertex: start, length
///    │ /  f1  │                └┐   └───┐
///    a ────── d     pool       f0 f1 │ f0 f1 │ f0 │ f1 │ …  the faces around a, b, c, d …
/// ```
///
/// - I1  Face `f` has the corners of `spans.range(f)`; these ranges follow one another through the
///   whole table. A face names at least three vertices, each of them there and each once.
/// - I2  The fans of two vertices lie apart in the pool.
/// - I3  The fan of `v` names each face with a corner at `v`, once, and no other.
///
/// Words for each vertex of a large closed triangle mesh: 17, being 3 of positions, 6 of corners, 2
/// of fans and 6 of the pool. Mixed degrees add the offsets of the faces. With one offset a vertex
/// it would be 16; but then the lists fill the pool without a gap, and a list that grows by one
/// face moves all that follow. With start and length it moves to the end of the pool alone.
///
/// # Complexity
///
/// The fan of a vertex has as many faces as the vertex has corners, its length; `d` is their degree.
///
/// | query | looks at | time |
/// |---|---|---|
/// | FV, FE | the corners of the face | O(1) an item |
/// | VF | the fan of the vertex | O(1) an item |
/// | EV | the handle itself | O(1), without reading |
/// | VV, VE | the corners of the fan | O(length · d) expected |
/// | EF | the corners of the shorter fan of the two ends | O(length · d) |
/// | EE | the corners of both fans | O(lengths · d) expected |
/// | FF | for each side, as EF | O(sides · length · d) expected |
/// | `vertices`, `faces` | nothing | O(1) an item |
/// | `edges`, `edge_count` | all corners | O(corners + vertices), without hashing |
///
/// Sweeps over VF and FV read tables from end to end: in cache they are bound by the loop around six
/// and three items, beyond it by bytes, 32 a vertex (8 of fans, 24 of pool) and 12 a triangle. The
/// other sweeps jump from the pool to the corners of a face, six independent loads a vertex, and
/// then compare what they found: VV is bound by these comparisons in a well ordered mesh, by the
/// latency of the jumps in a shuffled one.
///
/// Splitting every face ([`Refine`](mesh_core::Refine)) takes O(corners · d + vertices), and as much
/// again to number the edges, for the vertex of a fan is looked for in each face of it.
///
/// # Examples
///
/// ```
/// use face_vertex::FaceVertexMesh;
/// use mesh_core::{FaceId, MeshQuery, Point, PolygonMesh, Representation, VertexId};
///
/// let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
/// let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
/// let mesh = FaceVertexMesh::from_polygons(&polygons)?;
/// assert_eq!(mesh.fan(VertexId::new(0)), [0, 1].map(FaceId::new));
/// assert_eq!(mesh.edges().count(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FaceVertexMesh<P: Probe = Untraced> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) corners: Table<VertexId, P>,
    pub(crate) spans: FaceSpans<P>,
    pub(crate) fans: Table<Fan, P>,
    pub(crate) pool: Table<FaceId, P>,
}

/// Where the faces around one vertex are in the pool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fan {
    /// The row of the first.
    pub start: u32,
    /// How many there are.
    pub len: u32,
}

impl Fan {
    /// The rows of all.
    #[inline]
    pub fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + self.len as usize
    }
}

impl<P: Probe> FaceVertexMesh<P> {
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

    /// Where the faces around each vertex are in the [`pool`](Self::pool).
    pub fn fans(&self) -> &[Fan] {
        self.fans.rows()
    }

    /// The faces around all vertices, as they lie in memory.
    pub fn pool(&self) -> &[FaceId] {
        self.pool.rows()
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

    /// The faces around `v`, in no promised order.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[inline]
    pub fn fan(&self, v: VertexId) -> &[FaceId] {
        self.pool.read_range(self.fans.read(v.index()).range())
    }
}
