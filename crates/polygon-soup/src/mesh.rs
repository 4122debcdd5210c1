//! The table, its invariants, and access to it.

use sixfold_core::{Compact, Editing, FaceId, FaceSpans, Point, Probe, Untraced};
use sixfold_scanning::ScannedFaces;

use crate::vertex::SoupVertex;

/// Faces that each store the coordinates of their corners.
///
/// ```text
///    c ────── b   b
///     \  f0  /   / \        corners   a  b  c │ a  d  b │ …      by corner
///      \    /   /   \                 └─ f0 ─┘└─ f1 ─┘
///       \  /   / f1  \
///        a    a ───── d     the table has the edge a–b twice, but no link between f0 and f1
/// ```
///
/// - I1  Face `f` has the corners `spans.range(f)`, which are at least three. The ranges are
///   consecutive and cover the whole table. After an edit has changed the degree of a face, unused
///   corners can be between the ranges.
/// - I2  No coordinate is −0; construction, [`set_positions`] and edits write 0 instead.
/// - I3  The corners of one face are at different positions. [`set_positions`] returns an error if
///   two corners of a face would coincide. Every edit that splits an edge, a face or a vertex
///   returns an error if another vertex is at the position of the new vertex.
/// - I4  The hole table lists the rows of deleted faces. Exactly two kinds of corners are blank:
///   the corners of deleted faces, and the unused corners between faces. A blank corner contains a
///   NaN that no [`SoupVertex`] contains.
///
/// A large closed triangle mesh uses 18 words of 4 bytes per vertex: two faces with three corners
/// of three coordinates each. If the faces have different degrees, the mesh uses one more word per
/// face. After an edit that changes the degree of a face, the mesh uses two more words per face and
/// one more word per corner than a mesh whose faces have the same degree. After a deletion, the
/// mesh uses up to one more bit per face. [`compact`](sixfold_core::MeshEdit::compact) frees the
/// additional memory of edits and deletions.
///
/// # Complexity
///
/// | query | reads | time |
/// |---|---|---|
/// | FV, FE | the corners of the face | O(1) per item |
/// | EV, `position` | the handle itself | O(1), reads no table |
/// | VF, VV, VE, EF, EE | all corners, in one scan | O(corners) |
/// | FF | all corners, in one scan | O(corners + degree log degree) |
/// | `vertices`, `edges` | all corners | O(corners) expected, with a hash set |
/// | `vertex_count`, `edge_count` | all corners | O(corners) expected, with a hash set |
///
/// For each corner at the given vertex, a scan finds the face of the corner in O(1) time. If the
/// faces have different degrees, finding the face takes O(log faces) time until the first edit that
/// changes a degree. A scan reads 12 bytes per corner, once and in order. If the table of corners
/// fits in the cache, the three comparisons per corner limit the speed. In larger meshes, the
/// memory bandwidth limits the speed.
///
/// # Edits
///
/// | edit | reads | changes |
/// |---|---|---|
/// | `set_position` | all corners, in one scan | the corners at the vertex, and its handle |
/// | `add_vertex` | | not supported: a vertex is the position of a corner |
/// | `add_face` | the given corners | new corners, a new span |
/// | `remove_face`, `split_face` | the corners of the face | the corners of the face and of the new face |
/// | `poke_face` | all corners, in one scan | the corners of the face, and new faces |
/// | `split_edge`, `dissolve_edge` | all corners, in one scan | the faces at the edge, which may move to the end of the table |
/// | `bisect_edge` | all corners, in one scan | a corner of each face at the edge, and a new face for each of these faces |
/// | `flip_edge` | all corners, in two scans | one corner of each of the two faces |
/// | `collapse_edge` | all corners, in one scan, rarely more | the corners at the removed vertex, and the corners at the kept end if the kept end moves |
/// | `split_vertex` | all corners, in one scan | the corners that the new vertex gets, and one or two new faces |
/// | `remove_vertex` | all corners, in one scan | the corners of the faces at the vertex |
/// | `remove_isolated_vertices` | nothing | nothing: no vertex is isolated |
/// | `compact` | everything | everything |
///
/// If an edit adds or moves a vertex, the scan also checks that no other vertex has the new
/// position. If a log records the edits, `add_face`, `remove_face`, `remove_vertex` and
/// `split_face` need one more scan, to find the vertices and edges that other faces have. An edit
/// is refused if the edit itself is not possible (for example the flip of a boundary edge), if a
/// handle is not valid, if two vertices would coincide, or if the tables are full.
///
/// [`set_positions`]: sixfold_core::MeshMove::set_positions
///
/// # Examples
///
/// ```
/// use sixfold_core::{MeshQuery, Point, PolygonMesh, Representation};
/// use sixfold_polygon_soup::{PolygonSoup, SoupVertex};
///
/// let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
/// let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
/// let soup = PolygonSoup::from_polygons(&polygons)?;
/// assert_eq!(soup.corners().len(), 6);
/// assert_eq!(soup.vertex_faces(SoupVertex::at(Point::ZERO)).count(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct PolygonSoup<E: Editing = Compact, P: Probe = Untraced> {
    pub(crate) faces: ScannedFaces<SoupVertex, P, E>,
}

sixfold_core::mesh_tables!(PolygonSoup {
    faces: faces;
});
sixfold_core::polygon_conversions!(PolygonSoup);

impl<P: Probe, E: Editing> PolygonSoup<E, P> {
    /// Returns the position of each corner, face by face, including blank corners.
    pub fn corners(&self) -> &[Point] {
        self.faces.corners.rows()
    }

    /// Returns the range of corners of each face, including deleted faces.
    pub fn spans(&self) -> &FaceSpans<P, E> {
        &self.faces.spans
    }

    /// Returns the positions of the corners of `f`, in order.
    ///
    /// # Panics
    ///
    /// Panics if there is no face `f`.
    #[inline]
    pub fn face_positions(&self, f: FaceId) -> &[Point] {
        self.faces.face(f)
    }
}
