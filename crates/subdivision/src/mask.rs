//! The weights of a scheme for points that are not at sharp edges or vertices.

use sixfold_core::{Point, Split};

/// The weights of a scheme, as functions of sums over a neighbourhood.
///
/// Gather, scatter and native compute the sums in different ways, but use the same rules. A *face
/// value* is what the scheme needs to know about a face, for example the centroid.
pub(crate) trait Mask: Copy + Sync {
    /// Whether old vertices move. If this is false, all edge points are midpoints, and `vertex` is
    /// not called.
    const APPROXIMATES: bool;
    /// Whether `edge` uses face values.
    const EDGES_USE_FACES: bool;
    /// Whether `vertex` uses face values.
    const VERTICES_USE_FACES: bool;

    /// Returns the split of the faces.
    fn split(self) -> Split;

    /// Returns the face value of a face with `degree` corners. `corners` is the sum of the corners.
    /// If the split has face points, the face value is the face point.
    fn face(self, corners: Point, degree: usize) -> Point;

    /// Returns the point of an edge between two faces. `faces` is the sum of the two face values.
    fn edge(self, ends: [Point; 2], faces: Point) -> Point;

    /// Returns the new position of an inner vertex at position `at`. `neighbours` is the sum of the
    /// adjacent vertices, and `faces` is the sum of the face values.
    fn vertex(self, at: Point, valence: usize, neighbours: Point, faces: Point) -> Point;
}

pub(crate) fn midpoint([a, b]: [Point; 2]) -> Point {
    (a + b) * 0.5
}
