//! The quadric error of Garland and Heckbert.

use std::ops::AddAssign;

use glam::{DMat3, DVec3};

/// A sum of squared distances to planes, each with a weight: xᵀ A x − 2 b·x + c.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Quadric {
    /// A: xx, xy, xz, yy, yz, zz.
    a: [f64; 6],
    b: DVec3,
    c: f64,
}

impl Quadric {
    /// `weight` times the squared distance to the plane through `at` with the unit normal `n`.
    pub(crate) fn plane(n: DVec3, at: DVec3, weight: f64) -> Self {
        let d = n.dot(at);
        Self {
            a: [
                n.x * n.x,
                n.x * n.y,
                n.x * n.z,
                n.y * n.y,
                n.y * n.z,
                n.z * n.z,
            ]
            .map(|a| a * weight),
            b: n * (d * weight),
            c: d * d * weight,
        }
    }

    /// The sum of both.
    #[inline]
    pub(crate) fn plus(mut self, other: &Self) -> Self {
        self += *other;
        self
    }

    /// What it comes to at `x`; rounding may leave a hair below zero, which is zero.
    #[inline]
    pub(crate) fn at(&self, x: DVec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let ax = DVec3::new(
            xx * x.x + xy * x.y + xz * x.z,
            xy * x.x + yy * x.y + yz * x.z,
            xz * x.x + yz * x.y + zz * x.z,
        );
        (x.dot(ax) - 2.0 * self.b.dot(x) + self.c).max(0.0)
    }

    /// Where it is least, if that is one well-determined point: not along a flat or a straight part.
    #[inline]
    pub(crate) fn least(&self) -> Option<DVec3> {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        // Cofactors of a symmetric matrix; the trace tells its scale.
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
    fn three_planes_meet_where_the_sum_is_least() {
        let corner = DVec3::new(1.0, -2.0, 3.0);
        let mut sum = Quadric::default();
        for (n, weight) in [(DVec3::X, 1.0), (DVec3::Y, 2.0), (DVec3::Z, 0.5)] {
            sum += Quadric::plane(n, corner, weight);
        }
        let least = sum.least().expect("three planes");
        assert!(least.distance(corner) < 1e-12);
        assert!(sum.at(corner) < 1e-12);
        let off = corner + DVec3::new(1.0, 1.0, 2.0);
        assert!((sum.at(off) - (1.0 + 2.0 + 0.5 * 4.0)).abs() < 1e-12);
    }

    #[test]
    fn a_plane_and_a_ridge_have_no_single_least_point() {
        let flat = Quadric::plane(DVec3::Z, DVec3::ZERO, 1.0);
        assert_eq!(flat.least(), None);
        assert_eq!(
            flat.plus(&Quadric::plane(DVec3::X, DVec3::ZERO, 1.0))
                .least(),
            None
        );
        assert_eq!(Quadric::default().least(), None);
    }
}
