//! The quadric error of Garland and Heckbert.

use std::ops::AddAssign;

use glam::{DMat3, DVec3};

/// A weighted sum of squared distances to planes: xᵀ A x − 2 b·x + c. The point x is relative to
/// the origin of the quadric.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Quadric {
    /// The matrix A: xx, xy, xz, yy, yz, zz.
    a: [f64; 6],
    b: DVec3,
    c: f64,
}

/// A quadric in f32, with half the bytes. f32 is precise enough, because the vertex is the origin
/// of its quadric. Coordinates relative to the vertex are small.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Packed {
    a: [f32; 6],
    b: [f32; 3],
    c: f32,
}

impl From<Quadric> for Packed {
    #[inline]
    fn from(quadric: Quadric) -> Self {
        Self {
            a: quadric.a.map(|a| a as f32),
            b: quadric.b.to_array().map(|b| b as f32),
            c: quadric.c as f32,
        }
    }
}

impl From<Packed> for Quadric {
    #[inline]
    fn from(packed: Packed) -> Self {
        Self {
            a: packed.a.map(f64::from),
            b: DVec3::from(packed.b.map(f64::from)),
            c: f64::from(packed.c),
        }
    }
}

impl Quadric {
    /// Returns `weight` times the squared distance to a plane through the origin. The unit normal
    /// of the plane is `n`.
    pub(crate) fn plane(n: DVec3, weight: f64) -> Self {
        let a = [
            n.x * n.x,
            n.x * n.y,
            n.x * n.z,
            n.y * n.y,
            n.y * n.z,
            n.z * n.z,
        ];
        Self {
            a: a.map(|a| a * weight),
            ..Self::default()
        }
    }

    /// Returns the same quadric with its origin moved by `d`.
    #[inline]
    pub(crate) fn with_origin(&self, d: DVec3) -> Self {
        let ad = self.times(d);
        Self {
            a: self.a,
            b: self.b - ad,
            c: (self.c - 2.0 * self.b.dot(d) + d.dot(ad)).max(0.0),
        }
    }

    #[inline]
    fn times(&self, x: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        DVec3::new(
            xx * x.x + xy * x.y + xz * x.z,
            xy * x.x + yy * x.y + yz * x.z,
            xz * x.x + yz * x.y + zz * x.z,
        )
    }

    #[inline]
    pub(crate) fn plus(mut self, other: &Self) -> Self {
        self += *other;
        self
    }

    /// Returns the value at `x`, or 0 if rounding makes the value negative.
    #[inline]
    pub(crate) fn value(&self, x: DVec3) -> f64 {
        let ax = self.times(x);
        (x.dot(ax) - 2.0 * self.b.dot(x) + self.c).max(0.0)
    }

    /// Returns the point with the smallest value, or `None` if there are many such points, for
    /// example on a flat surface.
    #[inline]
    pub(crate) fn minimizer(&self) -> Option<DVec3> {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        // The cofactors of the symmetric matrix. The trace of the matrix gives the scale.
        let c0 = yy * zz - yz * yz;
        let c1 = xz * yz - xy * zz;
        let c2 = xy * yz - xz * yy;
        let determinant = xx * c0 + xy * c1 + xz * c2;
        let scale = xx + yy + zz;
        if determinant.abs() <= 1e-6 * scale * scale * scale {
            return None;
        }
        let c4 = xx * zz - xz * xz;
        let c5 = xy * xz - xx * yz;
        let c8 = xx * yy - xy * xy;
        let adjugate = DMat3::from_cols(
            DVec3::new(c0, c1, c2),
            DVec3::new(c1, c4, c5),
            DVec3::new(c2, c5, c8),
        );
        let x = adjugate * self.b / determinant;
        x.is_finite().then_some(x)
    }
}

impl AddAssign for Quadric {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        for (a, b) in self.a.iter_mut().zip(other.a) {
            *a += b;
        }
        self.b += other.b;
        self.c += other.c;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimizer_of_three_planes_is_their_intersection() {
        let corner = DVec3::new(1.0, -2.0, 3.0);
        let mut sum = Quadric::default();
        for (n, weight) in [(DVec3::X, 1.0), (DVec3::Y, 2.0), (DVec3::Z, 0.5)] {
            // All three planes contain the corner. The origin is moved away from the corner.
            sum += Quadric::plane(n, weight).with_origin(-corner);
        }
        let minimizer = sum.minimizer().expect("three planes");
        assert!(minimizer.distance(corner) < 1e-12);
        assert!(sum.value(corner) < 1e-12);
        let off = corner + DVec3::new(1.0, 1.0, 2.0);
        assert!((sum.value(off) - (1.0 + 2.0 + 0.5 * 4.0)).abs() < 1e-12);
        let moved = sum.with_origin(DVec3::ONE);
        assert!((moved.value(off - DVec3::ONE) - sum.value(off)).abs() < 1e-12);
    }

    #[test]
    fn a_plane_and_a_ridge_have_no_unique_minimizer() {
        let flat = Quadric::plane(DVec3::Z, 1.0);
        assert_eq!(flat.minimizer(), None);
        let ridge = flat.plus(&Quadric::plane(DVec3::X, 1.0));
        assert_eq!(ridge.minimizer(), None);
        assert_eq!(Quadric::default().minimizer(), None);
    }

    #[test]
    fn f32_is_precise_enough_near_the_origin() {
        let mut sum = Quadric::default();
        for (i, n) in [DVec3::X, DVec3::Y, DVec3::ONE.normalize()]
            .into_iter()
            .enumerate()
        {
            sum += Quadric::plane(n, 1.0 + i as f64).with_origin(DVec3::new(1e-4, 0.0, -2e-4));
        }
        let packed = Quadric::from(Packed::from(sum));
        let x = DVec3::new(3e-4, 1e-4, -1e-4);
        assert!((packed.value(x) - sum.value(x)).abs() < 1e-6 * sum.value(x));
    }
}
