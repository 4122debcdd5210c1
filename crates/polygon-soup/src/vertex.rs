//! The handle of a vertex that has no row.

use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};

use rustc_hash::FxHashSet;
use sixfold_core::{Handle, HashHandleMap, Point};
use sixfold_scanning::ScannedVertex;

/// The handle of a vertex of a polygon soup: the bits of its coordinates. A coordinate −0 is stored
/// as 0.
///
/// Two corners are at one vertex if and only if the bits of their coordinates are equal. The order
/// of vertices has no geometric meaning.
///
/// # Points that are nearly equal
///
/// Two vertices whose coordinates differ only by rounding errors are different vertices. Handles
/// are keys of maps, so handles need [`Eq`] and [`Hash`]. A comparison with a tolerance is not
/// transitive, so [`Eq`] cannot allow a tolerance. For example, with a tolerance of 1, the points 0
/// and 0.8 are equal and the points 0.8 and 1.6 are equal, but the points 0 and 1.6 are not equal.
///
/// Merge points that are nearly equal before you build the soup. For example, round the positions
/// to a grid: points with the same rounded position are one vertex. Two close points on different
/// sides of a boundary between grid cells stay different.
///
/// ```
/// use sixfold_polygon_soup::prelude::*;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0],
///                [1.0, 1e-7, 0.0], [1.0, 1.0, 0.0], [-1e-7, 1.0, 0.0]];
/// let faces = [[0, 1, 2], [3, 4, 5]];
/// assert_eq!(PolygonSoup::from_polygons(&PolygonMesh::new(corners, faces)?)?.vertex_count(), 6);
///
/// let spacing = 1e-3;
/// let rounded = corners.map(|p| (Point::from(p) / spacing).round() * spacing);
/// let soup = PolygonSoup::from_polygons(&PolygonMesh::new(rounded, faces)?)?;
/// assert_eq!(soup.vertex_count(), 4);
/// assert_eq!(soup.to_polygons().vertex_count(), 4); // with shared vertices, for any structure
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// If two corners of one face have the same rounded position, building returns an error.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct SoupVertex([u32; 3]);

impl SoupVertex {
    /// Returns the vertex at `point`, even if no face has a corner at `point`.
    #[inline]
    pub fn at(point: Point) -> Self {
        // −0 + 0 is 0.
        let [x, y, z] = point.to_array().map(|x| (x + 0.0).to_bits());
        // One NaN bit pattern marks blank corners. If `point` contains this NaN, use another NaN.
        let x = if x == BLANK { f32::NAN.to_bits() } else { x };
        Self([x, y, z])
    }

    /// Returns the position of the vertex.
    #[inline]
    pub fn position(self) -> Point {
        Point::from_array(self.0.map(f32::from_bits))
    }
}

/// The x of a blank corner, a NaN. [`SoupVertex::at`] never returns this NaN.
const BLANK: u32 = u32::MAX;

/// A corner has the same bits as its handle, because I2 excludes −0.
impl ScannedVertex for SoupVertex {
    type Corner = Point;
    type Set = FxHashSet<Self>;
    const BLANK: Self = Self([BLANK; 3]);
    const IS_POSITION: bool = true;

    #[inline]
    fn from_corner(corner: Point) -> Self {
        Self(corner.to_array().map(f32::to_bits))
    }

    #[inline]
    fn corner(self) -> Point {
        self.position()
    }

    /// Always compares all three coordinates: a branch would cost more than the two comparisons.
    #[inline]
    fn is_at(self, corner: &Point) -> bool {
        let [x, y, z] = self.0;
        (corner.x.to_bits() == x) & (corner.y.to_bits() == y) & (corner.z.to_bits() == z)
    }

    fn set(vertices: impl Iterator<Item = Self>) -> FxHashSet<Self> {
        vertices.collect()
    }

    #[inline]
    fn is_in(corner: &Point, set: &FxHashSet<Self>) -> bool {
        set.contains(&Self::from_corner(*corner))
    }
}

impl Ord for SoupVertex {
    /// Compares the three words as one number, without a branch.
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        let number = |[x, y, z]: [u32; 3]| {
            (u128::from(x) << 64) | u128::from(u64::from(y) << 32 | u64::from(z))
        };
        number(self.0).cmp(&number(other.0))
    }
}

impl PartialOrd for SoupVertex {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Hash for SoupVertex {
    /// Hashes whole words. A slice of numbers would be hashed byte by byte, at twice the cost.
    #[inline]
    fn hash<H: Hasher>(&self, state: &mut H) {
        let [x, y, z] = self.0;
        state.write_u64(u64::from(x) | u64::from(y) << 32);
        state.write_u32(z);
    }
}

impl Handle for SoupVertex {
    type Map<T: Clone> = HashHandleMap<Self, T>;
}

impl From<Point> for SoupVertex {
    #[inline]
    fn from(point: Point) -> Self {
        Self::at(point)
    }
}

impl From<SoupVertex> for Point {
    #[inline]
    fn from(vertex: SoupVertex) -> Self {
        vertex.position()
    }
}

impl fmt::Debug for SoupVertex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.position().to_array();
        write!(f, "({x}, {y}, {z})")
    }
}

impl fmt::Display for SoupVertex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_zeros_are_one_vertex() {
        let [plus, minus] = [0.0, -0.0].map(|zero| SoupVertex::at(Point::new(1.0, zero, 2.5)));
        assert_eq!(plus, minus);
        assert_eq!(minus.position().y.to_bits(), 0);
        assert_eq!(minus.to_string(), "(1, 0, 2.5)");
        assert_ne!(plus, SoupVertex::at(Point::new(1.0, 1e-45, 2.5)));
    }

    #[test]
    fn the_order_is_that_of_the_words() {
        let words = [0, 1, 0x8000_0000, BLANK];
        let triples = words.map(|x| words.map(|y| words.map(|z| [x, y, z])));
        let triples = triples.as_flattened().as_flattened();
        for a in triples {
            for b in triples {
                assert_eq!(SoupVertex(*a).cmp(&SoupVertex(*b)), a.cmp(b), "{a:?} {b:?}");
            }
        }
    }
}
