//! Polygons in a plane: projections, and the exact sign of an area.

use glam::{DVec2, DVec3, Vec2Swizzles};
use robust::Coord;

use crate::polygons::newell::area_vector;

/// Returns twice the signed area of the triangle. The area is above 0 if a, b, c turn left. The sign
/// is exact (Shewchuk 1997).
pub(super) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    robust::orient2d(coord(a), coord(b), coord(c))
}

fn coord(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// Returns the part of the area of the triangles that is turned over, where corners run clockwise: 0
/// if no triangle is turned, and at most 1. Areas that are not numbers do not count.
pub(super) fn turned_part(points: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
    let (mut turned, mut all) = (0.0, 0.0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| points[i]);
        let area = orient2d(a, b, c);
        turned += f64::max(0.0, -area);
        all += f64::max(0.0, area.abs());
    }
    match turned > 0.0 {
        // Areas can underflow to sizes whose quotient is 0.
        true => (turned / all).max(f64::MIN_POSITIVE),
        false => 0.0,
    }
}

/// Returns a vector that is normal to the polygon, to the side from which most of the polygon runs
/// counter-clockwise. If the parts that run either way have the same area, returns the normal of the
/// largest triangle of three successive corners.
pub(super) fn normal(corners: &[DVec3]) -> DVec3 {
    let area = area_vector(corners.iter().copied());
    let successive = || {
        let from = |first: usize| corners.iter().cycle().skip(first);
        let triples = corners.iter().zip(from(1)).zip(from(2));
        triples.map(|((&a, &b), &c)| (b - a).cross(c - a))
    };
    let size: f64 = successive().map(DVec3::length).sum();
    if area.length() > 1e-12 * size {
        return area;
    }
    let longer = |best: DVec3, one: DVec3| match one.length() > best.length() {
        true => one,
        false => best,
    };
    successive().fold(area, longer)
}

/// Projects corners into `projected` along the axis nearest to `normal`. In the projection, the polygon runs
/// counter-clockwise. The projection copies coordinates bit by bit, so that collinear corners stay
/// collinear. For a planar polygon it is affine.
pub(super) fn project_along_axis(corners: &[DVec3], normal: DVec3, projected: &mut Vec<DVec2>) {
    let size = normal.abs();
    let project = |p: DVec3| {
        let (projected, component) = if size.z >= size.x && size.z >= size.y {
            (DVec2::new(p.x, p.y), normal.z)
        } else if size.x >= size.y {
            (DVec2::new(p.y, p.z), normal.x)
        } else {
            (DVec2::new(p.z, p.x), normal.y)
        };
        match component < 0.0 {
            true => projected.yx(),
            false => projected,
        }
    };
    projected.clear();
    projected.extend(corners.iter().map(|&p| project(p)));
}

/// Projects corners onto the plane normal to `normal`. The coordinates are rounded.
pub(super) fn along_normal(corners: &[DVec3], normal: DVec3) -> Option<Vec<DVec2>> {
    let normal = normal.try_normalize()?;
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let project = |&p: &DVec3| DVec2::new(p.dot(u), p.dot(v));
    Some(corners.iter().map(project).collect())
}

/// The fewest corners of a tangled polygon.
const TANGLED_CORNERS: usize = 32;
/// How many other sides each side is compared with.
const COMPARED_SIDES: usize = 64;

/// Returns whether sides of a polygon cross in more places than there are corners, among pairs that are
/// spread evenly over all pairs. O(n).
pub(super) fn is_tangled(points: &[DVec2]) -> bool {
    let n = points.len();
    if n < TANGLED_CORNERS {
        return false;
    }
    let side = |i: usize| [points[i % n], points[(i + 1) % n]];
    let crosses = |[a, b]: [DVec2; 2], [c, d]: [DVec2; 2]| {
        orient2d(a, b, c) * orient2d(a, b, d) < 0.0 && orient2d(c, d, a) * orient2d(c, d, b) < 0.0
    };
    let strides = COMPARED_SIDES.min(n / 2 - 1);
    let pairs = (0..strides).flat_map(|k| {
        let stride = 2 + k * (n / 2 - 1) / strides;
        (0..n).map(move |i| [i, i + stride])
    });
    let crossing = pairs.filter(|&[i, j]| crosses(side(i), side(j)));
    crossing.take(n + 1).count() > n
}

/// Returns twice the area of a triangle divided by the square of its longest side.
pub(super) fn quality([a, b, c]: [DVec3; 3]) -> f64 {
    let sides = [b - a, c - b, a - c];
    let longest = sides
        .map(DVec3::length_squared)
        .into_iter()
        .fold(0.0, f64::max);
    match longest > 0.0 {
        true => sides[0].cross(sides[1]).length() / longest,
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_are_tangled_and_spirals_are_not() {
        let at = |angle: f64, radius: f64| radius * DVec2::from_angle(angle);
        let star = |n: usize, step: usize| -> Vec<DVec2> {
            let turn = std::f64::consts::TAU / n as f64;
            (0..n)
                .map(|i| at((i * step % n) as f64 * turn, 1.0))
                .collect()
        };
        for n in [33, 65, 129, 1001, 10_001] {
            assert!(is_tangled(&star(n, n / 2)), "{n}");
            assert!(!is_tangled(&star(n, 1)), "{n}");
            // Each side crosses two others.
            assert!(!is_tangled(&star(n, 2)), "{n}");
        }
        assert!(!is_tangled(&star(31, 15)));
        let out = (0..500).map(|i| at(0.1 * f64::from(i), 1.0 + 0.1 * f64::from(i)));
        let back = (0..500)
            .rev()
            .map(|i| at(0.1 * f64::from(i), 1.1 + 0.1 * f64::from(i)));
        assert!(!is_tangled(&out.chain(back).collect::<Vec<_>>()));
    }
}
