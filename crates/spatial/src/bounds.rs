//! Axis-aligned boxes.

use glam::{DMat3, DVec3, Vec3};

/// More than the rounding errors of a rotation, relative to the coordinates.
const ROTATION_ERROR: f64 = 1e-14;

/// An axis-aligned box from `low` to `high`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lowest coordinate along each axis.
    pub low: Vec3,
    /// The highest coordinate along each axis.
    pub high: Vec3,
}

impl Bounds {
    /// The box without points: its union with another box is the other box.
    pub const EMPTY: Self = Self {
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
    };

    /// Returns the smallest box around `points`.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| Self {
            low: bounds.low.min(point),
            high: bounds.high.max(point),
        })
    }

    /// Returns a box around `points` along other axes, which are the rows of `axes`: the smallest, and a
    /// little more than its rounding errors.
    pub fn from_points_along(axes: &DMat3, points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| {
            let point = point.as_dvec3();
            let error = ROTATION_ERROR * point.abs().max_element();
            let along = *axes * point;
            bounds.union(Self {
                low: (along - error).as_vec3().map(f32::next_down),
                high: (along + error).as_vec3().map(f32::next_up),
            })
        })
    }

    /// Returns the smallest box around `self` and `other`.
    #[inline]
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Returns a box that reaches at least `by` farther at each side.
    #[inline]
    #[must_use]
    pub fn widened(&self, by: f32) -> Self {
        if by == 0.0 {
            return *self;
        }
        Self {
            low: (self.low - by).map(f32::next_down),
            high: (self.high + by).map(f32::next_up),
        }
    }

    /// Returns whether two boxes have a common point.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// Returns the middle of the box, rounded to single precision.
    #[inline]
    pub fn centre(&self) -> Vec3 {
        // Halves first: the sum of two large coordinates could be infinite.
        self.low * 0.5 + self.high * 0.5
    }

    /// Returns the lengths of the box along the axes; negative if the box is empty.
    #[inline]
    pub fn extent(&self) -> DVec3 {
        self.high.as_dvec3() - self.low.as_dvec3()
    }

    /// Returns half of the surface area, and 0 if the box is empty.
    #[inline]
    pub fn half_area(&self) -> f64 {
        let extent = self.extent().max(DVec3::ZERO);
        extent.x * extent.y + extent.y * extent.z + extent.z * extent.x
    }

    /// Returns the longest axis (0, 1 or 2) and the length along it. In a tie, returns the lower
    /// axis.
    #[inline]
    pub fn longest_axis(&self) -> (usize, f64) {
        let extent = self.extent();
        let mut axis = 0;
        for other in 1..3 {
            if extent[other] > extent[axis] {
                axis = other;
            }
        }
        (axis, extent[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_of_a_flat_set_has_no_length_across_it() {
        let points = [[1.0, 5.0, 2.0], [4.0, 5.0, 2.0], [2.0, 5.0, 9.0]].map(Vec3::from);
        let bounds = Bounds::from_points(points);
        assert_eq!(bounds.extent(), DVec3::new(3.0, 0.0, 7.0));
        assert_eq!(
            (bounds.longest_axis(), bounds.half_area()),
            ((2, 7.0), 21.0)
        );
        assert_eq!(bounds.union(Bounds::EMPTY), bounds);
        assert_eq!(Bounds::EMPTY.half_area(), 0.0);
    }

    #[test]
    fn the_centre_of_the_largest_box_is_finite() {
        let largest = Bounds::from_points([Vec3::splat(f32::MAX), Vec3::splat(f32::MAX)]);
        assert_eq!(largest.centre(), Vec3::splat(f32::MAX));
    }
}
