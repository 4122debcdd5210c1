//! The name of a vertex that has no number.

use std::fmt;
use std::hash::{Hash, Hasher};

use mesh_core::{Handle, HashHandleMap, Point, ScannedVertex};
use rustc_hash::FxHashSet;

/// A vertex of a soup: its coordinates, as bits, with −0 as 0.
///
/// Two corners are at one vertex exactly when their coordinates are equal, bit for bit. The order
/// of handles is that of the bits: total, and of no geometric meaning.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SoupVertex([u32; 3]);

impl SoupVertex {
    /// The vertex at `point`, wherever that is.
    #[inline]
    pub fn at(point: Point) -> Self {
        // −0 + 0 is 0; every other number stays as it is.
        let [x, y, z] = point.to_array().map(|x| (x + 0.0).to_bits());
        // Of the many bits that are no number, one stands for deleted corners: who hands them in means
        // no number, and gets others of these.
        let x = if x == BLANK { f32::NAN.to_bits() } else { x };
        Self([x, y, z])
    }

    /// Where it is.
    #[inline]
    pub fn position(self) -> Point {
        Point::from_array(self.0.map(f32::from_bits))
    }
}

/// The x of a blank corner, a quiet NaN: [`SoupVertex::at`] makes no vertex of it.
const BLANK: u32 = u32::MAX;

/// A corner keeps its coordinates as they lie in the name: I2 has made the zeros alike.
impl ScannedVertex for SoupVertex {
    type Corner = Point;
    type Set = FxHashSet<Self>;
    const BLANK: Self = Self([BLANK; 3]);
    const IS_PLACE: bool = true;

    #[inline]
    fn of(corner: Point) -> Self {
        Self(corner.to_array().map(f32::to_bits))
    }

    #[inline]
    fn corner(self) -> Point {
        self.position()
    }

    /// All three coordinates are compared: a branch after the first costs more than the two
    /// comparisons that it saves.
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
        set.contains(&Self::of(*corner))
    }
}

impl Hash for SoupVertex {
    /// Two whole words: a slice of numbers would be hashed byte by byte, at twice the cost.
    #[inline]
    fn hash<H: Hasher>(&self, state: &mut H) {
        let [x, y, z] = self.0;
        state.write_u64(u64::from(x) | u64::from(y) << 32);
        state.write_u32(z);
    }
}

impl Handle for SoupVertex {
    type Map<T: Clone> = HashHandleMap<Self, T>;

    #[inline]
    fn token(self) -> u64 {
        let [x, y, z] = self.0.map(u64::from);
        x ^ y << 16 ^ z << 32
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
}
