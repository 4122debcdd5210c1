//! The closest point of one triangle.

use glam::DVec3;

use crate::item::FaceTriangle;

/// The squared sine of the angle at the first corner below which a triangle is thin.
const THIN: f64 = 1e-6;

/// The squared sine below which rounding decides about the regions of a triangle.
const NO_AREA: f64 = 1e-24;

/// Returns the point of the triangle `corners` that is closest to `query`.
///
/// ```text
///            ╲  near c  ╱
///             ╲        ╱           Seven regions: the triangle, its three edges and its three
///     near ca  ╲──c───╱  near bc   corners. Six scalar products determine the region of the
///               ╲ ╳  ╱             query; one division then gives the point.
///     ───────────a──b──────────
///      near a  │ near ab │ near b
/// ```
///
/// Method by Ericson (2004), *Real-Time Collision Detection*, section 5.1.5. A triangle whose
/// corners are collinear or equal is treated as the segment or the point that it is. The result is
/// always inside the bounding box of the corners, also after rounding.
///
/// ```
/// use sixfold_spatial::closest_point_on_triangle;
/// use sixfold_core::glam::DVec3;
///
/// let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let closest = closest_point_on_triangle(DVec3::new(1.0, 1.0, 3.0), triangle);
/// assert_eq!(closest, DVec3::new(0.5, 0.5, 0.0));
/// ```
#[inline]
pub fn closest_point_on_triangle(query: DVec3, corners: [DVec3; 3]) -> DVec3 {
    let [a, b, c] = corners;
    let closest = query + closest_offset(corners.map(|corner| corner - query));
    closest.max(a.min(b).min(c)).min(a.max(b).max(c))
}

/// Returns the offset from `query` to the closest point of `triangle`.
///
/// No coordinate of the offset is closer to zero than the box of the triangle is to the query, with
/// the same rounding. So a search may skip a box by its distance, and finds the same triangle as a
/// search without boxes.
#[inline]
pub(crate) fn offset_to_triangle<F>(query: DVec3, triangle: &FaceTriangle<F>) -> DVec3 {
    closest_offset(triangle.corners.map(|corner| corner.as_dvec3() - query))
}

/// Returns the point of the triangle `a b c` that is closest to the origin.
#[inline]
fn closest_offset([a, b, c]: [DVec3; 3]) -> DVec3 {
    let closest = closest_by_region(a, b, c);
    closest.max(a.min(b).min(c)).min(a.max(b).max(c))
}

#[inline]
fn closest_by_region(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (ab_ab, ab_ac, ac_ac) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
    // How far the origin is from each corner, along ab and along ac.
    let (ab_a, ac_a) = (-ab.dot(a), -ac.dot(a));
    if ab_a <= 0.0 && ac_a <= 0.0 {
        return a;
    }
    let (ab_b, ac_b) = (ab_a - ab_ab, ac_a - ab_ac);
    if ab_b >= 0.0 && ac_b <= ab_b {
        return b;
    }
    let (ab_c, ac_c) = (ab_a - ab_ac, ac_a - ac_ac);
    if ac_c >= 0.0 && ab_c <= ac_c {
        return c;
    }
    let area = ab_ab * ac_ac - ab_ac * ab_ac;
    if area <= THIN * ab_ab * ac_ac {
        return closest_of_thin(a, b, c);
    }
    // The areas of the triangles that the projected origin forms with each edge, with a sign.
    let area_c = ab_ab * ac_a - ab_ac * ab_a;
    if area_c <= 0.0 && ab_a >= 0.0 && ab_b <= 0.0 {
        return a + ab * (ab_a / ab_ab);
    }
    let area_b = ac_ac * ab_a - ab_ac * ac_a;
    if area_b <= 0.0 && ac_a >= 0.0 && ac_c <= 0.0 {
        return a + ac * (ac_a / ac_ac);
    }
    let (from_b, from_c) = (ac_b - ab_b, ab_c - ac_c);
    if area <= area_b + area_c && from_b >= 0.0 && from_c >= 0.0 {
        return b + (c - b) * (from_b / (from_b + from_c));
    }
    let scale = 1.0 / area;
    a + ab * (area_b * scale) + ac * (area_c * scale)
}

/// Returns the closest point of a triangle that is thin or has no area.
///
/// The vector products keep twice as many digits of a small area as the scalar products, which are
/// faster.
#[cold]
#[inline(never)]
fn closest_of_thin(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    let area_b = -normal.dot(a.cross(ac));
    let area_c = -normal.dot(ab.cross(a));
    let has_area = area > NO_AREA * ab.length_squared() * ac.length_squared();
    if has_area && area_b > 0.0 && area_c > 0.0 && area_b + area_c < area {
        return a + ab * (area_b / area) + ac * (area_c / area);
    }
    closest_of_sides(a, b, c)
}

/// Returns the closest point of the three sides.
fn closest_of_sides(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let mut closest = a;
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let along = to - from;
        let squared = along.length_squared();
        let share = if squared > 0.0 {
            (-along.dot(from) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let point = from + along * share;
        if point.length_squared() < closest.length_squared() {
            closest = point;
        }
    }
    closest
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = DVec3> {
        // Few different values, so that corners coincide and triangles have no area.
        let coordinate = prop_oneof![(-2..=2).prop_map(f64::from), -2.0..2.0];
        proptest::array::uniform3(coordinate).prop_map(DVec3::from)
    }

    #[test]
    fn each_region_has_its_closest_point() {
        let triangle = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        for (query, closest) in [
            ([-1.0, -1.0, 1.0], [0.0, 0.0, 0.0]),
            ([5.0, -1.0, 1.0], [4.0, 0.0, 0.0]),
            ([-1.0, 5.0, 1.0], [0.0, 4.0, 0.0]),
            ([1.0, -1.0, 1.0], [1.0, 0.0, 0.0]),
            ([-1.0, 1.0, 1.0], [0.0, 1.0, 0.0]),
            ([4.0, 4.0, 1.0], [2.0, 2.0, 0.0]),
            ([1.0, 2.0, -1.0], [1.0, 2.0, 0.0]),
        ] {
            let found = closest_point_on_triangle(query.into(), triangle);
            assert_eq!(found.to_array(), closest, "{query:?}");
        }
    }

    #[test]
    fn triangles_without_area_are_segments_and_points() {
        let (o, x) = (DVec3::ZERO, DVec3::X);
        let query = DVec3::new(0.5, 1.0, 0.0);
        for corners in [[o, o, x], [o, x, o], [x, o, o], [o, x, x], [o, x * 0.25, x]] {
            let found = closest_point_on_triangle(query, corners);
            assert_eq!(found, x * 0.5, "{corners:?}");
        }
        assert_eq!(closest_point_on_triangle(query, [x; 3]), x);
    }

    proptest! {
        #[test]
        fn no_point_of_the_triangle_is_closer(
            query in point(),
            corners in proptest::array::uniform3(point()),
            weights in proptest::array::uniform3(0.0..1.0),
        ) {
            let closest = closest_point_on_triangle(query, corners);
            let distance = closest.distance(query);
            let [a, b, c] = corners;
            let total: f64 = weights.iter().sum();
            let inner = (a * weights[0] + b * weights[1] + c * weights[2]) / total.max(1e-9);
            for other in [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, inner] {
                prop_assert!(total < 1e-3 || distance <= other.distance(query) + 1e-12);
            }
            // The triangle's own closest point to a point on it is that point.
            let again = closest_point_on_triangle(closest, corners);
            prop_assert!(again.distance(closest) < 1e-9, "{closest} {again}");
        }
    }
}
