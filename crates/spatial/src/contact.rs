//! Whether two triangles touch.

use glam::{DVec2, DVec3, Vec3Swizzles};
use robust::{Coord, Coord3D};

use crate::bounds::Bounds;

/// Returns whether two triangles have a common point. Sides and corners belong to a triangle. The
/// result is exact, unless products of three coordinates overflow. A triangle without area touches
/// nothing.
///
/// If the planes of the triangles differ, a side of one triangle meets the other triangle. The signs of
/// volumes decide about this (Guigue & Devillers 2003 use the same signs); they are exact (Shewchuk
/// 1997).
///
/// ```
/// use sixfold_core::glam::DVec3;
/// use sixfold_spatial::triangles_touch;
///
/// let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let above = |height: f64| triangle.map(|p| p + DVec3::new(0.25, 0.25, height));
/// assert!(triangles_touch(triangle, above(0.0)) && !triangles_touch(triangle, above(1e-9)));
/// ```
pub fn triangles_touch(a: [DVec3; 3], b: [DVec3; 3]) -> bool {
    if [a, b].iter().any(has_no_area) {
        return false;
    }
    let meets = |from: [DVec3; 3], to: [DVec3; 3]| {
        (0..3).any(|i| segment_touches([from[i], from[(i + 1) % 3]], to))
    };
    meets(a, b) || meets(b, a)
}

/// Returns whether a triangle may have a point in a box: false only if the plane of the triangle, or a plane
/// along a side of it and along an axis, separates them (Akenine-Möller 2001). Planes across the axes are
/// not tested.
pub(crate) fn meets_box(corners: [DVec3; 3], bounds: &Bounds) -> bool {
    let [low, high] = [bounds.low.as_dvec3(), bounds.high.as_dvec3()];
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let corners = corners.map(|corner| corner - centre);
    let size = corners
        .iter()
        .fold(half, |size, corner| size.max(corner.abs()))
        .max_element();
    let separates = |normal: DVec3| {
        let along = corners.map(|corner| normal.dot(corner));
        let least = along.into_iter().fold(f64::INFINITY, f64::min);
        let most = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // More than the rounding errors.
        let reach = normal.abs().dot(half + 1e-12 * size);
        least > reach || most < -reach
    };
    let [a, b, c] = corners;
    let sides = [b - a, c - b, a - c];
    let along_sides = |side: DVec3| DVec3::AXES.map(|axis| axis.cross(side));
    !separates(sides[0].cross(sides[1])) && !sides.into_iter().flat_map(along_sides).any(separates)
}

fn has_no_area(corners: &[DVec3; 3]) -> bool {
    (0..3).all(|axis| {
        let [a, b, c] = corners.map(|p| along(p, axis));
        orient2d(a, b, c) == 0.0
    })
}

fn segment_touches([p, q]: [DVec3; 2], triangle: [DVec3; 3]) -> bool {
    let [a, b, c] = triangle;
    let [at_p, at_q] = [p, q].map(|end| orient3d(a, b, c, end));
    if at_p == 0.0 && at_q == 0.0 {
        return touches_in_plane([p, q], triangle);
    }
    if (at_p > 0.0 && at_q > 0.0) || (at_p < 0.0 && at_q < 0.0) {
        return false;
    }
    let turns = [[a, b], [b, c], [c, a]].map(|[from, to]| orient3d(p, q, from, to));
    turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0)
}

/// Returns whether a segment in the plane of a triangle touches the triangle.
fn touches_in_plane(segment: [DVec3; 2], triangle: [DVec3; 3]) -> bool {
    let [a, b, c] = triangle;
    let normal = (b - a).cross(c - a).abs();
    let axis = match normal {
        n if n.x >= n.y && n.x >= n.z => 0,
        n if n.y >= n.z => 1,
        _ => 2,
    };
    let [p, q] = segment.map(|end| along(end, axis));
    let [a, b, c] = triangle.map(|corner| along(corner, axis));
    let sides = [[a, b], [b, c], [c, a]];
    let turns = sides.map(|[from, to]| orient2d(from, to, p));
    let is_inside = turns.iter().all(|&turn| turn >= 0.0) || turns.iter().all(|&turn| turn <= 0.0);
    is_inside || sides.iter().any(|&side| segments_touch([p, q], side))
}

fn segments_touch([p, q]: [DVec2; 2], [a, b]: [DVec2; 2]) -> bool {
    let separates = |from: DVec2, to: DVec2, one: DVec2, other: DVec2| {
        let [one, other] = [one, other].map(|end| orient2d(from, to, end));
        (one > 0.0 && other > 0.0) || (one < 0.0 && other < 0.0)
    };
    if separates(p, q, a, b) || separates(a, b, p, q) {
        return false;
    }
    // On one line, the segments may lie apart.
    p.min(q).cmple(a.max(b)).all() && a.min(b).cmple(p.max(q)).all()
}

/// Returns the point without the coordinate along an axis.
fn along(p: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => p.yz(),
        1 => p.zx(),
        _ => p.xy(),
    }
}

fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    robust::orient2d(a, b, c)
}

fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-2..3_i8).prop_map(|p| DVec3::from_array(p.map(f64::from)))
    }

    /// Returns the squared distance of two triangles by a search over both, coarse to fine.
    fn distance_squared(a: [DVec3; 3], b: [DVec3; 3]) -> f64 {
        let on = |t: [DVec3; 3], u: f64, v: f64| t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        let mut point = on(a, 1.0 / 3.0, 1.0 / 3.0);
        let mut best = f64::INFINITY;
        // Alternating projections converge for convex sets.
        for _ in 0..4000 {
            let other = crate::closest_point_on_triangle(point, b);
            point = crate::closest_point_on_triangle(other, a);
            best = point.distance_squared(other).min(best);
        }
        best
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            cases: 1000,
            ..ProptestConfig::default()
        })]

        #[test]
        fn triangles_touch_if_their_distance_is_zero(
            a in prop::array::uniform3(point()),
            b in prop::array::uniform3(point()),
        ) {
            prop_assume!(!has_no_area(&a) && !has_no_area(&b));
            let touches = triangles_touch(a, b);
            prop_assert_eq!(touches, triangles_touch(b, a));
            let distance = distance_squared(a, b);
            // On this grid, triangles that do not touch are farther apart. Where they only touch,
            // the projections converge slowly.
            prop_assert_eq!(touches, distance < 1e-4, "{}", distance);
        }
    }

    proptest! {
        #[test]
        fn a_box_with_a_point_of_a_triangle_is_met(
            corners in prop::array::uniform3(point()),
            weights in prop::array::uniform3(0.0..1.0_f64),
            ends in prop::array::uniform2(prop::array::uniform3(0.0..1.0_f32)),
        ) {
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 0.0);
            let parts = corners.iter().zip(weights);
            let inside = parts.map(|(&corner, weight)| corner * (weight / sum)).sum::<DVec3>().as_vec3();
            let [below, above] = ends.map(glam::Vec3::from_array);
            let bounds = Bounds {
                low: (inside - below).map(f32::next_down),
                high: (inside + above).map(f32::next_up),
            };
            prop_assert!(meets_box(corners, &bounds));
        }
    }

    #[test]
    fn a_box_beside_a_needle_is_not_met() {
        let needle = [DVec3::ZERO, DVec3::splat(10.0), DVec3::new(0.0, 0.1, 0.0)];
        let at = |x: f32, y: f32, z: f32| Bounds {
            low: glam::Vec3::new(x, y, z),
            high: glam::Vec3::new(x + 1.0, y + 1.0, z + 1.0),
        };
        assert!(meets_box(needle, &at(4.0, 4.0, 4.0)));
        assert!(!meets_box(needle, &at(6.0, 4.0, 4.0)) && !meets_box(needle, &at(0.0, 8.0, 0.0)));
        let triangle = [DVec3::X, DVec3::Y, DVec3::Z];
        assert!(
            !meets_box(triangle, &at(-0.9, -0.9, -0.9)) && meets_box(triangle, &at(0.0, 0.0, 0.0))
        );
    }

    #[test]
    fn triangles_without_area_touch_nothing() {
        let line = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert!(!triangles_touch(line, triangle) && !triangles_touch(triangle, line));
    }
}
