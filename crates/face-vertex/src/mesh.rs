//! The structure itself.

use std::ops::Range;

use mesh_core::{
    Editable, Editing, FACE_HOLES, FaceId, FaceSpans, Point, Probe, Table, Untraced, VERTEX_HOLES,
    VertexId, Whole,
};

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
/// - I1  Face `f` has the corners of `spans.range(f)`; these ranges lie apart, and until a degree is
///   edited follow one another through the whole table. A face names at least three vertices, each
///   of them there and each once.
/// - I2  The fans of two vertices lie apart in the pool.
/// - I3  The fan of `v` names each face with a corner at `v`, once, and no other.
/// - I4  What is deleted, or nobody's, is blank: the corners of a deleted face and those of no face
///   name vertex `u32::MAX`, which no mesh has; the places of no fan name face `u32::MAX`; the fan of
///   a deleted vertex is [`Fan::GONE`]. The holes are just these vertices and faces.
///
/// Words for each vertex of a large closed triangle mesh: 17, being 3 of positions, 6 of corners, 2
/// of fans and 6 of the pool. Mixed degrees add the offsets of the faces. With one offset a vertex
/// it would be 16; but then the lists fill the pool without a gap, and a list that grows by one
/// face moves all that follow. With start and length it moves to the end of the pool alone. Deleting
/// adds a bit a row of vertices or of faces; faces of edited degrees, two words and one a corner.
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
/// | `vertices`, `faces` | the holes, if there are any | O(1) an item |
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
/// Edits ([`MeshEdit`](mesh_core::MeshEdit)) rewrite corners and repair fans. A fan that shrinks stays
/// where it is and leaves blanks behind it; one that grows takes a blank behind it or, where there is
/// none, moves to the end of the pool, with blanks for as many faces again. So a fan that grows face by
/// face moves O(log length) times, and the pool has at most a few times the places that the input
/// and the edits have filled; [`compact`](mesh_core::MeshEdit::compact) closes it up. Every edit but the
/// last two is local: `n` is the length of a fan, `d` the degree of a face around.
///
/// | edit | time | writes |
/// |---|---|---|
/// | `set_position` | O(1) | the position |
/// | `add_vertex` | O(1) | a position, an empty fan |
/// | `add_face` | O(d) | d new corners, a place in d fans |
/// | `remove_face` | O(d · n) | its corners and d places, blank |
/// | `remove_vertex` | O(n · d · n) | the same for each face of its fan |
/// | `split_edge` | O(n · d) | the corners of its faces, at the end of the table; a new fan |
/// | `bisect_edge` | O(n) | a corner in each face, three new ones a new face; four fans for two faces |
/// | `poke_face` | O(d · n) | a corner, three new ones a new face; d fans, and a new one |
/// | `split_face` | O(d · n) | the corners of both parts, the fans of the one cut off |
/// | `dissolve_edge` | O(n · d) | the corners of both faces, the fans of the one that goes |
/// | `flip_edge` | O(n) | a corner of each face, a place in four fans |
/// | `collapse_edge` | O(n · d) | a corner in each face of the end that goes, the fans of both ends and of the third corners |
/// | `split_vertex` | O(n · d + n log n) | a corner in each face that the new vertex gets, four fans |
/// | `remove_isolated_vertices` | O(vertices) | their fans |
/// | `compact` | O(corners + vertices) | all tables |
///
/// The first edit that leaves faces of different degrees where all had one, or changes the degree of
/// one face, brings a table of spans and one of owners ([`FaceSpans::Scattered`]): O(corners), once
/// until the next `compact`. `split_edge`, `split_face` and `dissolve_edge` always change degrees;
/// `add_face`, `poke_face` and `collapse_edge` do so at polygons alone.
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
#[derive(Debug)]
pub struct AnyFaceVertexMesh<P: Probe, E: Editing> {
    pub(crate) positions: Table<Point, P>,
    pub(crate) corners: Table<VertexId, P>,
    pub(crate) spans: FaceSpans<P, E>,
    pub(crate) fans: Table<Fan, P>,
    pub(crate) pool: Table<FaceId, P>,
    pub(crate) vertex_holes: E::Holes<P>,
    pub(crate) face_holes: E::Holes<P>,
}

mesh_core::clone_by_field!(AnyFaceVertexMesh<P: Probe, E: Editing> { positions, corners, spans, fans, pool, vertex_holes, face_holes });

/// A face-vertex mesh of which nothing can be deleted: [`AnyFaceVertexMesh`] whose rows are all elements.
pub type FaceVertexMesh<P = Untraced> = AnyFaceVertexMesh<P, Whole>;

/// A face-vertex mesh that can be edited ([`MeshEdit`](mesh_core::MeshEdit)): [`AnyFaceVertexMesh`] with holes.
pub type EditableFaceVertexMesh<P = Untraced> = AnyFaceVertexMesh<P, Editable>;

impl<P: Probe> From<FaceVertexMesh<P>> for EditableFaceVertexMesh<P> {
    fn from(mesh: FaceVertexMesh<P>) -> Self {
        let probe = mesh.positions.probe();
        Self {
            positions: mesh.positions,
            corners: mesh.corners,
            spans: mesh.spans.into(),
            fans: mesh.fans,
            pool: mesh.pool,
            vertex_holes: Editable::no_holes(VERTEX_HOLES, probe.clone()),
            face_holes: Editable::no_holes(FACE_HOLES, probe),
        }
    }
}

/// What a blank corner names: no vertex has so high a row.
pub(crate) const BLANK_CORNER: VertexId = VertexId::new(u32::MAX);

/// What a blank place of the pool names: no face has so high a row.
pub(crate) const BLANK_PLACE: FaceId = FaceId::new(u32::MAX);

/// Where the faces around one vertex are in the pool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fan {
    /// The row of the first.
    pub start: u32,
    /// How many there are.
    pub len: u32,
}

impl Fan {
    /// The fan of a deleted vertex: it reaches beyond every pool, and so is found out by the bounds
    /// check that every reader makes.
    pub const GONE: Self = Self {
        start: u32::MAX,
        len: u32::MAX,
    };

    /// The rows of all.
    #[inline]
    pub fn range(self) -> Range<usize> {
        let start = self.start as usize;
        start..start + self.len as usize
    }
}

impl<P: Probe, E: Editing> AnyFaceVertexMesh<P, E> {
    /// Where each vertex is, as it lies in memory.
    pub fn positions(&self) -> &[Point] {
        self.positions.rows()
    }

    /// The vertex of each corner, face by face, as it lies in memory; blank where a face was.
    pub fn corners(&self) -> &[VertexId] {
        self.corners.rows()
    }

    /// How the corners fall into faces.
    pub fn spans(&self) -> &FaceSpans<P, E> {
        &self.spans
    }

    /// Where the faces around each vertex are in the [`pool`](Self::pool); of deleted vertices, too.
    pub fn fans(&self) -> &[Fan] {
        self.fans.rows()
    }

    /// The faces around all vertices, as they lie in memory; blank where no fan is.
    pub fn pool(&self) -> &[FaceId] {
        self.pool.rows()
    }

    /// The vertices of `f`, in order.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline(always)]
    pub fn face(&self, f: FaceId) -> &[VertexId] {
        let face = self.known_face(f);
        if E::DELETES && face.first() == Some(&BLANK_CORNER) {
            deleted_face(f);
        }
        face
    }

    /// The vertices of a face that some fan names, and that is there therefore.
    #[inline(always)]
    pub(crate) fn known_face(&self, f: FaceId) -> &[VertexId] {
        self.corners.read_range(self.spans.range(f))
    }

    /// The faces around `v`, in no promised order.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[inline]
    pub fn fan(&self, v: VertexId) -> &[FaceId] {
        self.places(v, *self.fans.read(v.index()))
    }

    /// What the pool has in the fan of `v`.
    #[inline]
    pub(crate) fn places(&self, v: VertexId, fan: Fan) -> &[FaceId] {
        let range = fan.range();
        if E::DELETES && range.end > self.pool.len() {
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
fn deleted_face(f: FaceId) -> ! {
    panic!("no face {f}: it was deleted")
}
