//! The structure itself.

use mesh_core::{
    Editable, Editing, FaceId, FaceSpans, Point, Probe, ScannedFaces, Untraced, Whole,
};

use crate::vertex::SoupVertex;

/// Faces that each keep the coordinates of their corners.
///
/// ```text
///    c ────── b   b
///     \  f0  /   / \        corners   a  b  c │ a  d  b │ …      by corner
///      \    /   /   \                 └─ f0 ─┘└─ f1 ─┘
///       \  /   / f1  \
///        a    a ───── d     the edge a–b is in the table twice, and nothing says so
/// ```
///
/// - I1  Each corner belongs to one face: face `f` has the corners of `spans.range(f)`, at least
///   three, and these ranges follow one another through the whole table, until a face gets another
///   degree, which may leave corners between them.
/// - I2  No coordinate is −0; construction, [`set_positions`] and edits write 0 for it.
/// - I3  The corners of one face are at different places; [`set_positions`] refuses what would bring
///   two of them together, and every edit a place that is taken.
/// - I4  Holes are rows of faces. Blank are the corners of deleted faces and those between faces, and
///   no others. A blank corner is a NaN that no [`SoupVertex`] is made of, so no sweep finds it.
///
/// Words for each vertex of a large closed triangle mesh: 18, three points a face. Mixed degrees
/// add the offsets of the faces. Edits that change a degree bring two words a face and one a corner
/// instead, deletions a bit a face, all until [`compact`](mesh_core::MeshEdit::compact).
///
/// # Complexity
///
/// | query | looks at | time |
/// |---|---|---|
/// | FV, FE | the corners of the face | O(1) an item |
/// | EV, `position` | the handle itself | O(1), without reading |
/// | VF, VV, VE, EF, EE | all corners, in one sweep | O(corners) |
/// | FF | all corners, in one sweep | O(corners + degree log degree) |
/// | `vertices`, `edges` | all corners | O(corners) expected, with a hash set |
/// | `vertex_count`, `edge_count` | as above: nothing stores them | O(corners) expected |
///
/// A hit of a sweep costs O(1), or O(log faces) with mixed degrees, where the face of a corner has
/// to be looked for. A sweep reads 12 bytes a corner, once and in order. It is bound by the three
/// comparisons a corner while the table fits the cache, and by the bandwidth of the memory beyond.
///
/// # Edits
///
/// | edit | looks at | changes |
/// |---|---|---|
/// | `set_position` | all corners, in one sweep | those at the vertex, and its name |
/// | `add_vertex` | | not offered: a vertex is the place of a corner |
/// | `add_face` | its corners | new corners, a new span |
/// | `remove_face`, `split_face` | the corners of the face | they, and those of the new face |
/// | `poke_face` | all corners, in one sweep | the corners of the face, and new faces |
/// | `split_edge`, `dissolve_edge` | all corners, in one sweep | the faces along the edge, which may move to the end of the table |
/// | `bisect_edge` | all corners, in one sweep | a corner of each face, and a new face for each |
/// | `flip_edge` | all corners, in two sweeps | one corner of each face |
/// | `collapse_edge` | all corners, in one sweep, seldom two | the corners at the vertex that goes; at both ends, if they move |
/// | `split_vertex` | all corners, in one sweep | the corners that the new vertex gets, and two new faces |
/// | `remove_vertex` | all corners, in one sweep | the corners of its faces |
/// | `remove_isolated_vertices` | nothing | nothing: there are none |
/// | `compact` | everything | everything |
///
/// The sweep for an edge sees as well that no vertex is where a new one is to be. To tell a listener
/// which vertices and sides of a face others have too, `add_face`, `remove_face`, `remove_vertex` and
/// `split_face` sweep once more. An edit is legal where its own rule holds, and no two vertices would be
/// one.
///
/// [`set_positions`]: mesh_core::Representation::set_positions
///
/// # Examples
///
/// ```
/// use mesh_core::{MeshQuery, Point, PolygonMesh, Representation};
/// use polygon_soup::{PolygonSoup, SoupVertex};
///
/// let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
/// let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
/// let soup = PolygonSoup::from_polygons(&polygons)?;
/// assert_eq!(soup.corners().len(), 6);
/// assert_eq!(soup.vertex_faces(SoupVertex::at(Point::ZERO)).count(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct AnyPolygonSoup<P: Probe, E: Editing> {
    pub(crate) faces: ScannedFaces<SoupVertex, P, E>,
}

mesh_core::clone_by_field!(AnyPolygonSoup<P: Probe, E: Editing> { faces });

/// A polygon soup of which nothing can be deleted: [`AnyPolygonSoup`] whose rows are all elements.
pub type PolygonSoup<P = Untraced> = AnyPolygonSoup<P, Whole>;

/// A polygon soup that can be edited ([`MeshEdit`](mesh_core::MeshEdit)): [`AnyPolygonSoup`] with holes.
pub type EditablePolygonSoup<P = Untraced> = AnyPolygonSoup<P, Editable>;

impl<P: Probe> From<PolygonSoup<P>> for EditablePolygonSoup<P> {
    fn from(mesh: PolygonSoup<P>) -> Self {
        Self {
            faces: mesh.faces.into(),
        }
    }
}

impl<P: Probe, E: Editing> AnyPolygonSoup<P, E> {
    /// Where each corner is, face by face, as it lies in memory, blank ones included.
    pub fn corners(&self) -> &[Point] {
        self.faces.corners.rows()
    }

    /// How the corners fall into faces, deleted ones included.
    pub fn spans(&self) -> &FaceSpans<P, E> {
        &self.faces.spans
    }

    /// Where the corners of `f` are, in order.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn face_positions(&self, f: FaceId) -> &[Point] {
        self.faces.face(f)
    }
}
