//! The handle of a vertex that has no row.

use std::fmt;
use std::hash::{Hash, Hasher};

use rustc_hash::FxHashSet;
use sixfold_core::{Handle, HashHandleMap, Point, ScannedVertex};

/// A vertex of a soup: the bits of its coordinates, with −0 as 0.
///
/// Two corners are at one vertex if and only if their coordinates are equal, bit for bit. The order
/// of handles is that of the bits: a total order without geometric meaning.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SoupVertex([u32; 3]);

impl SoupVertex {
    /// Returns the vertex at `point`, whether or not a face has a corner there.
    #[inline]
    pub fn at(point: Point) -> Self {
        // −0 + 0 is 0; every other number stays unchanged.
        let [x, y, z] = point.to_array().map(|x| (x + 0.0).to_bits());
        // One NaN bit pattern marks blank corners. If `point` has it, use another NaN.
        let x = if x == BLANK { f32::NAN.to_bits() } else { x };
        Self([x, y, z])
    }

    /// Returns the position of the vertex.
    #[inline]
    pub fn position(self) -> Point {
        Point::from_array(self.0.map(f32::from_bits))
    }
}

/// The x of a blank corner, a quiet NaN; [`SoupVertex::at`] never returns it.
const BLANK: u32 = u32::MAX;

/// A corner stores the coordinates with the bits of the handle, because I2 excludes −0.
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

    /// Compares all three: a branch after the first costs more than the two comparisons it avoids.
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

impl Hash for SoupVertex {
    /// Writes whole words: a slice of numbers would be hashed byte by byte, at twice the cost.
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
}
