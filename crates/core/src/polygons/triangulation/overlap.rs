//! Triangles that overlap although none is turned over: the polygon winds twice around some points.

use glam::{DVec2, Vec2Swizzles};

use super::plane::orient2d;
use super::regions::Winding;

/// The most pairs of triangles with overlapping extents along an axis, for each triangle, that are
/// looked at.
const PAIRS: usize = 256;

/// The most sides of the polygon that an estimate looks at, and how far the triangles are from each other
/// that it begins with.
const MOST_SIDES: usize = 20_000_000;
const STEP: usize = 64;

/// Returns the area where triangles overlap, divided by the area of all triangles. A point in `k`
/// triangles counts `k·(k − 1)/2` times. The triangles are those of the polygon `corners`, and none is
/// turned over.
///
/// The result is exact if at most [`PAIRS`] · n pairs of the n triangles have overlapping extents along an
/// axis. Otherwise it is estimated: the polygon winds as often around a point as it is in triangles, and
/// this number is taken at the centre of each triangle, or of some if that takes long.
///
/// O(n log n + k) time for a polygon of `n` corners whose triangles have `k` such pairs, of which at most
/// `n` · [`PAIRS`] are looked at.
pub(super) fn overlapping_part(corners: &[DVec2], triangles: &[[usize; 3]]) -> f64 {
    let of_corners = || triangles.iter().map(|t| t.map(|i| corners[i]));
    let all: f64 = of_corners().map(|t| area(&t)).sum();
    let (along_x, along_y) = (
        sweep_cost(of_corners(), |p| p.x),
        sweep_cost(of_corners(), |p| p.y),
    );
    let (overlap, is_exact) = match along_x <= along_y {
        true => overlap(of_corners().collect()),
        false => overlap(
            of_corners()
                .map(|[a, b, c]| [a.yx(), c.yx(), b.yx()])
                .collect(),
        ),
    };
    let overlap = match is_exact {
        true => overlap,
        false => overlap.max(estimate(corners, of_corners())),
    };
    match all > 0.0 {
        true => overlap / all,
        false => 0.0,
    }
}

/// Returns an estimate of the sum of the areas of the intersections of all pairs of triangles, from as many
/// triangles as [`MOST_SIDES`] allows.
fn estimate(corners: &[DVec2], triangles: impl Iterator<Item = [DVec2; 3]>) -> f64 {
    let n = corners.len();
    let (next, removed): (Vec<u32>, _) = ((1..n as u32).chain([0]).collect(), vec![false; n]);
    let mut winding = Winding::default();
    winding.reset(corners, &next, &removed);
    let (mut sum, mut tried, mut sides) = (0.0, 0, 0);
    // Not neighbours, if not all are tried.
    let triangles: Vec<[DVec2; 3]> = triangles.collect();
    for triangle in (0..STEP).flat_map(|first| triangles.iter().skip(first).step_by(STEP)) {
        let centre = triangle.iter().sum::<DVec2>() / 3.0;
        let (times, looked_at) = winding.around(centre, corners, &next, &removed);
        sum += 0.5 * (times - 1).max(0) as f64 * area(triangle);
        (tried, sides) = (tried + 1, sides + looked_at);
        if sides > MOST_SIDES {
            break;
        }
    }
    sum * triangles.len() as f64 / f64::max(1.0, f64::from(tried))
}

/// Returns whether triangles of the polygon may overlap of which none is turned over.
pub(super) fn may_overlap(corners: &[DVec2]) -> bool {
    // Two triangles lie on either side of their diagonal.
    corners.len() > 4 && !is_convex(corners)
}

/// Returns whether all corners turn left and the polygon winds once.
fn is_convex(corners: &[DVec2]) -> bool {
    let n = corners.len();
    let is_before = |a: DVec2, b: DVec2| (a.x, a.y) < (b.x, b.y);
    let mut ends = 0;
    for i in 0..n {
        let [a, b, c] = [i, (i + 1) % n, (i + 2) % n].map(|i| corners[i]);
        if orient2d(a, b, c) <= 0.0 {
            return false;
        }
        ends += usize::from(is_before(a, b) && is_before(c, b));
    }
    ends == 1
}

/// Returns the mean extent of the triangles along an axis, as a part of the whole extent.
fn sweep_cost(triangles: impl Iterator<Item = [DVec2; 3]>, axis: impl Fn(DVec2) -> f64) -> f64 {
    let (mut sum, mut whole) = (0.0, (f64::INFINITY, f64::NEG_INFINITY));
    for triangle in triangles {
        let (low, high) = extent(&triangle, &axis);
        sum += high - low;
        whole = (whole.0.min(low), whole.1.max(high));
    }
    sum / (whole.1 - whole.0)
}

fn extent(triangle: &[DVec2; 3], axis: impl Fn(DVec2) -> f64) -> (f64, f64) {
    let [a, b, c] = triangle.map(axis);
    (a.min(b).min(c), a.max(b).max(c))
}

/// Returns the sum of the areas of the intersections of all pairs of triangles, by a sweep along x, and
/// whether all pairs were looked at.
fn overlap(mut triangles: Vec<[DVec2; 3]>) -> (f64, bool) {
    triangles.sort_by(|a, b| extent(a, |p| p.x).0.total_cmp(&extent(b, |p| p.x).0));
    let mut sum = 0.0;
    let mut pairs = PAIRS * triangles.len();
    let mut active: Vec<([DVec2; 3], f64, (f64, f64))> = Vec::new();
    for triangle in triangles {
        let ((left, right), (low, high)) = (extent(&triangle, |p| p.x), extent(&triangle, |p| p.y));
        active.retain(|&(_, end, _)| end > left);
        let Some(rest) = pairs.checked_sub(active.len()) else {
            return (sum, false);
        };
        pairs = rest;
        for (other, _, y) in &active {
            if y.0 < high && low < y.1 && !is_apart(&triangle, other) && !is_apart(other, &triangle)
            {
                sum += area(&intersection(&triangle, other));
            }
        }
        active.push((triangle, right, (low, high)));
    }
    (sum, true)
}

/// Returns whether a side of `triangle` separates it from `other`.
fn is_apart(triangle: &[DVec2; 3], other: &[DVec2; 3]) -> bool {
    let [a, b, c] = *triangle;
    let is_outside = |[from, to]: [DVec2; 2]| other.iter().all(|&p| orient2d(from, to, p) <= 0.0);
    [[a, b], [b, c], [c, a]].into_iter().any(is_outside)
}

/// Returns the polygon in which two triangles intersect (Sutherland & Hodgman 1974).
fn intersection(triangle: &[DVec2; 3], other: &[DVec2; 3]) -> Vec<DVec2> {
    let [a, b, c] = *other;
    let mut polygon = triangle.to_vec();
    for [from, to] in [[a, b], [b, c], [c, a]] {
        let height = |p: DVec2| orient2d(from, to, p);
        let mut inside = Vec::with_capacity(polygon.len() + 1);
        let next = polygon.iter().cycle().skip(1);
        for (&p, &q) in polygon.iter().zip(next) {
            let (at_p, at_q) = (height(p), height(q));
            if at_p >= 0.0 {
                inside.push(p);
            }
            if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                inside.push(p.lerp(q, at_p / (at_p - at_q)));
            }
        }
        polygon = inside;
    }
    polygon
}

/// Returns the area of a convex polygon whose corners run counter-clockwise.
fn area(polygon: &[DVec2]) -> f64 {
    let Some((&first, rest)) = polygon.split_first() else {
        return 0.0;
    };
    let fan = rest.windows(2);
    0.5 * fan
        .map(|pair| (pair[0] - first).perp_dot(pair[1] - first))
        .sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a polygon that runs around its first corner as often as there are radii, and its triangles at
    /// this corner. It starts in the direction `start`.
    fn coil(corners: usize, radii: &[f64], start: f64) -> (Vec<DVec2>, Vec<[usize; 3]>) {
        let (mut points, mut triangles) = (vec![DVec2::ZERO], Vec::new());
        for &radius in radii {
            for i in 0..=corners {
                let angle = start + i as f64 * std::f64::consts::TAU / corners as f64;
                if i > 0 {
                    triangles.push([0, points.len() - 1, points.len()]);
                }
                points.push(radius * DVec2::from_angle(angle));
            }
        }
        (points, triangles)
    }

    #[test]
    fn the_overlap_of_few_triangles_is_exact() {
        for corners in [3, 4, 5, 20] {
            for radii in [&[2.0][..], &[2.0, 1.0], &[1.0, 1.5, 0.5, 1.5]] {
                for quarter in 0..4 {
                    let start = 0.1 + f64::from(quarter) * std::f64::consts::FRAC_PI_2;
                    let (points, triangles) = coil(corners, radii, start);
                    // Of two turns, the smaller one overlaps.
                    let square = |i: usize| radii[i] * radii[i];
                    let pairs = (0..radii.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
                    let both: f64 = pairs.map(|(i, j)| square(i).min(square(j))).sum();
                    let expected = both / (0..radii.len()).map(square).sum::<f64>();
                    let found = overlapping_part(&points, &triangles);
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "{corners} {radii:?} {found}"
                    );
                }
            }
        }
    }

    /// With many corners, not all pairs of triangles are looked at.
    #[test]
    fn the_overlap_of_many_triangles_is_found_or_estimated() {
        for (corners, is_exact) in [(20, true), (3000, false)] {
            for turns in 1..=4 {
                let (points, triangles) = coil(corners, &vec![1.0; turns], 0.0);
                let of_corners = triangles.iter().map(|t| t.map(|i| points[i]));
                assert_eq!(overlap(of_corners.collect()).1, is_exact);
                // Each point is in as many triangles as there are turns.
                let expected = (turns - 1) as f64 / 2.0;
                let found = overlapping_part(&points, &triangles);
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
        }
    }

    #[test]
    fn triangles_of_convex_polygons_do_not_overlap() {
        for n in [5_u8, 7, 20] {
            for (step, expected) in [(1, false), (2, n % 2 == 1)] {
                let corners = (0..n).map(|i| {
                    let angle = f64::from(i * step) * std::f64::consts::TAU / f64::from(n);
                    DVec2::from_angle(angle)
                });
                let mut corners: Vec<DVec2> = corners.collect();
                if n % step == 0 {
                    corners.truncate(usize::from(n / step));
                }
                for _ in 0..n {
                    corners.rotate_left(1);
                    assert_eq!(may_overlap(&corners), expected, "{n} {step}");
                }
            }
        }
        // A quad, and a polygon with a corner that turns right.
        let quad = [[0.0, 0.0], [2.0, 1.0], [0.0, 4.0], [0.5, 1.0]].map(DVec2::from_array);
        assert!(!may_overlap(&quad));
        assert!(may_overlap(&[&quad[..], &[DVec2::new(0.2, 0.5)]].concat()));
    }
}
