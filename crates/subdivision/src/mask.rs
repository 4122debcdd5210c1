//! The rules of a scheme that splits faces, for new points at which nothing is sharp.

use sixfold_core::{Point, Split};

/// The weights of a scheme, as functions of sums over a neighbourhood.
///
/// Gather, scatter and native compute the sums in different ways, but the rules are only here. A
/// *face value* is the value that the scheme needs of a face, for example its centroid or the sum
/// of its corners.
pub(crate) trait Mask: Copy + Sync {
    /// The way faces are split.
    const SPLIT: Split;
    /// Whether old vertices move. If they do not, `vertex` is not called. Boundaries and creases
    /// then need no rules, because all edge points are midpoints.
    const APPROXIMATES: bool;
    /// Whether `edge` uses face values.
    const EDGES_USE_FACES: bool;
    /// Whether `vertex` uses face values.
    const VERTICES_USE_FACES: bool;

    /// Returns the face value of a face with `degree` corners, whose sum is `corners`. If the split
    /// has face points, this value is the face point.
    fn face(self, corners: Point, degree: usize) -> Point;

    /// Returns the point of an edge `[a, b]` between two faces, whose values have the sum `faces`.
    fn edge(self, ends: [Point; 2], faces: Point) -> Point;

    /// Returns the new position of an inner vertex from its position, its valence, and the sums of
    /// its neighbours and of the values of its faces.
    fn vertex(self, at: Point, valence: usize, neighbours: Point, faces: Point) -> Point;
}

/// Returns the midpoint of an edge, for boundaries, creases and schemes that do not smooth.
pub(crate) fn midpoint([a, b]: [Point; 2]) -> Point {
    (a + b) * 0.5
}
