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
