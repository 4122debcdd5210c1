//! Rays, and where they hit boxes and triangles.

use glam::{DVec3, Vec3};

use crate::bounds::Bounds;
use crate::error::SpatialError;
use crate::item::FaceTriangle;

/// Relative width by which the interval of a box is extended at both ends. Each end has at most
/// four rounding errors of single precision (2⁻²⁴ each).
const PADDING: f32 = 4e-7;

/// A half-line from an origin in a direction: the points `origin + t · direction` for `t ≥ 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// The largest coordinate of the direction, without sign. Inside, parameters are in units of
    /// the direction divided by this length.
    longest: f64,
    /// The axis along which the direction is longest, and the two others.
    axes: [usize; 3],
    /// How far the ray moves along the two other axes while it moves 1 along the first.
    shear: [f64; 2],
    /// The direction along the first axis: 1 or −1.
    sign: f64,
    slab: SlabRay,
}

/// A ray in single precision, rounded so that a box that the ray hits is never missed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlabRay {
    /// The origin, subtracted from the side of a box at which the ray enters, by axis.
    enter_origin: [f32; 3],
    /// The origin, subtracted from the side at which the ray leaves.
    leave_origin: [f32; 3],
    inverse: [f32; 3],
    /// By axis: whether the ray enters a box at its high side.
    pub(crate) descends: [bool; 3],
}

impl Ray {
    /// Makes the ray from `origin` in `direction`, which may have any length above 0.
    ///
    /// # Errors
    ///
    /// [`SpatialError::InvalidRay`] if a coordinate is not finite, if the origin is beyond the range
    /// of `f32`, or if the direction is zero.
    pub fn new(
        origin: impl Into<DVec3>,
        direction: impl Into<DVec3>,
    ) -> Result<Self, SpatialError> {
        let (origin, direction) = (origin.into(), direction.into());
        let longest = direction.abs().max_element();
        let scaled = direction / longest;
        if !origin.as_vec3().is_finite() || !scaled.is_finite() || longest == 0.0 {
            return Err(SpatialError::InvalidRay {
                origin: origin.to_array(),
                direction: direction.to_array(),
            });
        }
        let main = if direction.x.abs() == longest {
            0
        } else if direction.y.abs() == longest {
            1
        } else {
            2
        };
        let axes = [main, (main + 1) % 3, (main + 2) % 3];
        Ok(Self {
            origin,
            direction,
            longest,
            axes,
            shear: [axes[1], axes[2]].map(|axis| scaled[axis] / scaled[main]),
            sign: scaled[main],
            slab: SlabRay::new(origin, scaled),
        })
    }

    /// Returns the origin.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Returns the direction, with the length that it was given.
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Returns the point at parameter `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Returns the parameter of the ray for one in units of its longest coordinate.
    #[inline]
    pub(crate) fn given(&self, scaled: f64) -> f64 {
        scaled / self.longest
    }

    /// Returns the parameter in units of the longest coordinate of the direction.
    #[inline]
    pub(crate) fn scaled(&self, given: f64) -> f64 {
        given * self.longest
    }

    /// Returns the direction, scaled so that its longest coordinate is 1 or −1.
    #[inline]
    pub(crate) fn scaled_direction(&self) -> DVec3 {
        self.direction / self.longest
    }

    /// Returns the axis along which the ray is longest.
    #[inline]
    pub(crate) fn main_axis(&self) -> usize {
        self.axes[0]
    }

    #[inline]
    pub(crate) fn slab(&self) -> &SlabRay {
        &self.slab
    }

    /// Returns the scaled parameter at which the ray hits `triangle`, from either side. Its sides
    /// and corners belong to it.
    ///
    /// Two triangles with a common side compute the same sign for it, so a ray does not slip through
    /// between them (Woop, Benthin & Wald 2013; the method of Möller & Trumbore 1997 does not have
    /// this property). The parameter is within the interval of the triangle's own box, so a search
    /// by boxes finds the same hits as a search without. A ray in the plane of a triangle does not
    /// hit it.
    #[inline]
    pub(crate) fn hit<F>(&self, bounds: &Bounds, triangle: &FaceTriangle<F>) -> Option<f64> {
        let (near, far) = self.slab.interval(bounds)?;
        let [main, u, v] = self.axes;
        let [shear_u, shear_v] = self.shear;
        let [a, b, c] = triangle.corners.map(|corner| {
            let offset = corner.as_dvec3() - self.origin;
            let depth = offset[main];
            (
                offset[u] - shear_u * depth,
                offset[v] - shear_v * depth,
                depth,
            )
        });
        let side_a = c.0 * b.1 - c.1 * b.0;
        let side_b = a.0 * c.1 - a.1 * c.0;
        let side_c = b.0 * a.1 - b.1 * a.0;
        let sum = side_a + side_b + side_c;
        let inside = (side_a >= 0.0 && side_b >= 0.0 && side_c >= 0.0)
            || (side_a <= 0.0 && side_b <= 0.0 && side_c <= 0.0);
        if !inside || sum == 0.0 {
            return None;
        }
        let parameter = (side_a * a.2 + side_b * b.2 + side_c * c.2) / sum * self.sign;
        (parameter >= 0.0).then(|| parameter.clamp(f64::from(near), f64::from(far)))
    }
}

impl SlabRay {
    fn new(origin: DVec3, scaled: DVec3) -> Self {
        let (below, above) = rounded_outwards(origin);
        let inverse: [f32; 3] = std::array::from_fn(|axis| {
            let direction = scaled[axis] as f32;
            // Without the sign of a zero, an axis along which the ray does not move ascends.
            if direction == 0.0 {
                f32::INFINITY
            } else {
                1.0 / direction
            }
        });
        let descends = inverse.map(|inverse| inverse < 0.0);
        let [below, above] = [below.to_array(), above.to_array()];
        let choose = |first: [f32; 3], second: [f32; 3]| {
            std::array::from_fn(|axis| {
                if descends[axis] {
                    second[axis]
                } else {
                    first[axis]
                }
            })
        };
        Self {
            enter_origin: choose(above, below),
            leave_origin: choose(below, above),
            inverse,
            descends,
        }
    }

    /// Returns the parameter at which the ray enters the slab between two planes across `axis`.
    /// Returns NaN, which stands for no restriction, if the ray moves inside the plane.
    #[inline(always)]
    pub(crate) fn enter(&self, axis: usize, plane: f32) -> f32 {
        (plane - self.enter_origin[axis]) * self.inverse[axis]
    }

    /// Returns the parameter at which the ray leaves the slab, or NaN as [`enter`](Self::enter).
    #[inline(always)]
    pub(crate) fn leave(&self, axis: usize, plane: f32) -> f32 {
        (plane - self.leave_origin[axis]) * self.inverse[axis]
    }

    /// Returns the scaled parameters between which the ray is inside `bounds`. The interval
    /// includes the exact one, and the interval of every box inside `bounds`.
    #[inline(always)]
    pub(crate) fn interval(&self, bounds: &Bounds) -> Option<(f32, f32)> {
        let (mut near, mut far) = (0.0, f32::INFINITY);
        for axis in 0..3 {
            let (low, high) = (bounds.low[axis], bounds.high[axis]);
            let (first, last) = if self.descends[axis] {
                (high, low)
            } else {
                (low, high)
            };
            near = larger(near, self.enter(axis, first));
            far = smaller(far, self.leave(axis, last));
        }
        let (near, far) = padded(near, far);
        // An infinite start: the ray moves along the slab, outside.
        (near <= far && near < f32::INFINITY).then_some((near, far))
    }
}

/// Extends an interval of non-negative parameters at both ends by more than its rounding errors.
#[inline(always)]
pub(crate) fn padded(near: f32, far: f32) -> (f32, f32) {
    (near * (1.0 - PADDING), far * (1.0 + PADDING))
}

/// Returns the larger value, and `value` if `other` is NaN.
#[inline(always)]
pub(crate) fn larger(value: f32, other: f32) -> f32 {
    if other > value { other } else { value }
}

/// Returns the smaller value, and `value` if `other` is NaN.
#[inline(always)]
pub(crate) fn smaller(value: f32, other: f32) -> f32 {
    if other < value { other } else { value }
}

/// Returns the nearest points in single precision that are not above and not below `point`.
#[inline]
pub(crate) fn rounded_outwards(point: DVec3) -> (Vec3, Vec3) {
    let rounded = point.as_vec3();
    let mut below = rounded;
    let mut above = rounded;
    for axis in 0..3 {
        if f64::from(rounded[axis]) > point[axis] {
            below[axis] = rounded[axis].next_down();
        } else if f64::from(rounded[axis]) < point[axis] {
            above[axis] = rounded[axis].next_up();
        }
    }
    (below, above)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::item::Item;

    fn hit(origin: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        let corners = [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0];
        let triangle = FaceTriangle { face: 0, corners };
        let ray = Ray::new(origin, direction).expect("a ray");
        let t = ray.hit(&triangle.bounds(), &triangle)?;
        Some(ray.given(t))
    }

    #[test]
    fn a_ray_hits_from_both_sides_and_on_sides_and_corners() {
        assert_eq!(hit([0.5, 0.5, 3.0], [0.0, 0.0, -1.0]), Some(3.0));
        assert_eq!(hit([0.5, 0.5, -3.0], [0.0, 0.0, 6.0]), Some(0.5));
        assert_eq!(hit([1.0, 0.0, 1.0], [0.0, 0.0, -1.0]), Some(1.0));
        assert_eq!(hit([1.0, 1.0, 1.0], [0.0, 0.0, -1.0]), Some(1.0));
        assert_eq!(hit([0.0, 2.0, 1.0], [0.0, 0.0, -1.0]), Some(1.0));
        assert_eq!(hit([3.0, 3.5, 3.0], [-1.0, -1.0, -1.0]), Some(3.0));
        assert_eq!(hit([0.5, 0.5, 0.0], [0.0, 0.0, 1.0]), Some(0.0));
    }

    #[test]
    fn a_ray_misses_beside_behind_and_in_the_plane() {
        assert_eq!(hit([1.1, 1.1, 3.0], [0.0, 0.0, -1.0]), None);
        assert_eq!(hit([-1e-9, 1.0, 3.0], [0.0, 0.0, -1.0]), None);
        assert_eq!(hit([0.5, 0.5, 3.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(hit([-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]), None);
    }

    #[test]
    fn a_ray_needs_a_finite_origin_and_a_direction() {
        assert!(Ray::new([0.0; 3], [0.0; 3]).is_err());
        assert!(Ray::new([0.0; 3], [f64::NAN, 1.0, 0.0]).is_err());
        assert!(Ray::new([0.0; 3], [f64::INFINITY, 1.0, 0.0]).is_err());
        assert!(Ray::new([f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0]).is_err());
        assert!(Ray::new([1e300, 0.0, 0.0], [1.0, 0.0, 0.0]).is_err());
        assert!(Ray::new([0.0; 3], [1e-200, 1e-300, 0.0]).is_ok());
    }

    #[test]
    fn the_interval_of_a_box_includes_that_of_each_inner_box() {
        let ray = Ray::new([-1.0, 0.1, 0.3], [0.9, 0.05, -0.01]).expect("a ray");
        let outer = Bounds {
            low: Vec3::ZERO,
            high: Vec3::ONE,
        };
        let inner = Bounds {
            low: Vec3::splat(0.1),
            high: Vec3::splat(0.4),
        };
        let (near, far) = ray.slab().interval(&outer).expect("it hits");
        let (first, last) = ray.slab().interval(&inner).expect("it hits");
        assert!(near < first && first < last && last < far);
        // A ray inside the side of a flat box.
        let flat = Bounds {
            low: Vec3::ZERO,
            high: Vec3::new(1.0, 1.0, 0.0),
        };
        let along = Ray::new([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]).expect("a ray");
        assert!(along.slab().interval(&flat).is_some());
    }
}
