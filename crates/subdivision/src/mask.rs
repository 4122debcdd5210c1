//! What a scheme that splits faces says of new points where nothing is sharp.

use mesh_core::{Point, Split};

/// The weights of a scheme, as functions of sums over a neighbourhood.
///
/// Gather, scatter and native differ in how they come by the sums; the rules stand here alone. A
/// *face value* is whatever the scheme wants to know of a face: its centroid, the sum of its
/// corners.
pub(crate) trait Mask: Copy + Sync {
    /// How faces are split.
    const SPLIT: Split;
    /// Whether old vertices move. Otherwise `vertex` is not asked, and boundaries and creases need no
    /// rules: edges have their midpoints anyway.
    const APPROXIMATES: bool;
    /// Whether `edge` looks at face values.
    const EDGES_SEE_FACES: bool;
    /// Whether `vertex` looks at face values.
    const VERTICES_SEE_FACES: bool;

    /// The face value of a face of `degree` corners with this sum. Where the split has face points
    /// it is the face point.
    fn face(self, corners: Point, degree: usize) -> Point;

    /// The point of an edge `[a, b]` between two faces, whose values have this sum.
    fn edge(self, ends: [Point; 2], faces: Point) -> Point;

    /// Where a vertex inside goes: its place, its valence, and the sums of its neighbours and of the
    /// values of its faces.
    fn vertex(self, at: Point, valence: usize, neighbours: Point, faces: Point) -> Point;
}

/// The midpoint of an edge: of boundaries, creases, and schemes that do not smooth.
pub(crate) fn midpoint([a, b]: [Point; 2]) -> Point {
    (a + b) * 0.5
}
