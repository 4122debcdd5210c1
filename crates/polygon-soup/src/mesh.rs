//! The structure itself.

use mesh_core::{FaceId, FaceSpans, Point, Probe, Table, Untraced};

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
///   three, and these ranges follow one another through the whole table.
/// - I2  No coordinate is −0; construction and [`set_positions`] write 0 for it.
/// - I3  The corners of one face are at different places; [`set_positions`] refuses what would bring
///   two of them together.
///
/// Words for each vertex of a large closed triangle mesh: 18, three points a face. Mixed degrees
/// add the offsets of the faces.
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
#[derive(Clone, Debug)]
pub struct PolygonSoup<P: Probe = Untraced> {
    pub(crate) corners: Table<Point, P>,
    pub(crate) spans: FaceSpans<P>,
}

impl<P: Probe> PolygonSoup<P> {
    /// Where each corner is, face by face, as it lies in memory.
    pub fn corners(&self) -> &[Point] {
        self.corners.rows()
    }

    /// How the corners fall into faces.
    pub fn spans(&self) -> &FaceSpans<P> {
        &self.spans
    }

    /// Where the corners of `f` are, in order.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[inline]
    pub fn face_positions(&self, f: FaceId) -> &[Point] {
        self.corners.read_range(self.spans.range(f))
    }

    /// The face of a corner, and the vertices before, at and after it there.
    pub(crate) fn around(&self, corner: usize) -> (FaceId, [SoupVertex; 3]) {
        let (face, corners) = self.spans.around(corner);
        let vertices = corners.map(|corner| SoupVertex::at(*self.corners.read(corner)));
        (face, vertices)
    }
}
