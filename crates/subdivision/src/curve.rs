//! Subdivision of curves: refines a polygon towards a cubic or a quadratic B-spline.
//!
//! ```text
//!   add edge midpoints, add struts                  cut corners (Chaikin 1974)
//!
//!            v        a strut runs from a                  v
//!           ╱┊╲       vertex to the middle of             ╱ ╲       each edge yields the points
//!          ╱ v'╲      the new midpoints; the             •───•      at 1/4 and 3/4 of it
//!         m──┊──m     vertex moves half-way             ╱     ╲
//!        ╱   s   ╲    along it:                        •       •
//!       a         b   (a + 6v + b)/8                  a         b
//! ```
//!
//! The limit of "add edge midpoints, add struts" is the uniform cubic B-spline, which is C² (Lane &
//! Riesenfeld 1980). The limit of "cut corners" is the uniform quadratic B-spline, which is C¹
//! (Riesenfeld 1975). Both limits lie in the convex hull of the polygon.

use sixfold_core::{MAX_ROWS, Point};

use crate::error::CurveError;
use crate::mask::midpoint;

/// The rule for the two ends of a polygon. In a grid of points, each row and each column is a
/// polygon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Ends {
    /// The polygon is closed: the last point is joined to the first point.
    Closed,
    /// The two end points keep their positions. The curve is computed as if the polygon had one
    /// more point beyond each end. For the cubic B-spline, the additional point is the neighbour of
    /// the end, reflected at the end. For Chaikin's curve, the additional point equals the end.
    #[default]
    Kept,
    /// The two end points are removed, because an end point has only one neighbour. The limit is
    /// the B-spline of the given points.
    Dropped,
}

/// Refines a polygon with `levels` steps of "add edge midpoints, add struts", and returns the
/// points. The points converge to the uniform cubic B-spline. Takes O(points of the result) time.
///
/// A step on n points returns:
///
/// - 2n points if the polygon is closed
/// - 2n − 1 points if the ends are kept
/// - 2n − 3 points if the ends are dropped
///
/// # Errors
///
/// Returns an error if the result has more than [`MAX_ROWS`] points, or if `points` has too few
/// points. The minimum is 3 points if the polygon is closed, 2 points if the ends are kept, and 4
/// points if the ends are dropped.
///
/// # Examples
///
/// ```
/// use sixfold_core::Point;
/// use sixfold_subdivision::{Ends, cubic_b_spline};
///
/// let roof = [Point::ZERO, Point::new(4.0, 8.0, 0.0), Point::new(8.0, 0.0, 0.0)];
/// let curve = cubic_b_spline(&roof, Ends::Kept, 1)?;
/// assert_eq!(curve[2], Point::new(4.0, 6.0, 0.0));
/// # Ok::<(), sixfold_subdivision::CurveError>(())
/// ```
pub fn cubic_b_spline(points: &[Point], ends: Ends, levels: u32) -> Result<Vec<Point>, CurveError> {
    run_steps(
        points,
        levels,
        cubic_loss(ends),
        min_points(ends),
        |points| cubic_step(points, ends),
    )
}

/// Cuts the corners of a polygon `levels` times, and returns the points. The points converge to the
/// uniform quadratic B-spline (Chaikin 1974). Takes O(points of the result) time.
///
/// A step on n points returns 2n points, or 2n − 2 points if the ends are dropped.
///
/// # Errors
///
/// Returns an error if the result has more than [`MAX_ROWS`] points, or if `points` has too few
/// points. The minimum is 3 points, or 2 points if the ends are kept.
pub fn chaikin(points: &[Point], ends: Ends, levels: u32) -> Result<Vec<Point>, CurveError> {
    let (loss, least) = match ends {
        Ends::Closed => (0, 3),
        Ends::Kept => (0, 2),
        Ends::Dropped => (2, 3),
    };
    run_steps(points, levels, loss, least, |points| {
        chaikin_step(points, ends)
    })
}

/// Returns the point of the uniform cubic B-spline of `points` at the parameter `t`. The curve is
/// the limit of [`cubic_b_spline`]. Control point i, counted from 0, has the parameter i. Takes
/// O(1) time.
///
/// Returns `None` if there are too few points, or if `t` is outside the domain. The domain for n
/// points is:
///
/// - ends kept: from 0 to n − 1
/// - ends dropped: from 1 to n − 2
/// - closed: every `t`, because the curve is periodic
pub fn cubic_b_spline_at(points: &[Point], ends: Ends, t: f64) -> Option<Point> {
    let n = points.len();
    if n < min_points(ends) {
        return None;
    }
    let (first, last) = cubic_domain(n, ends);
    let t = match ends {
        Ends::Closed => t.rem_euclid(last),
        _ => t,
    };
    // Also returns `None` if `t` is NaN.
    if !(first <= t && t <= last) {
        return None;
    }
    let piece = t.floor().min(last - 1.0);
    let weights = cubic_basis(t - piece);
    let controls = (0..4).map(|k| control(points, ends, piece as usize + k));
    Some(controls.zip(weights).map(|(p, w)| p * w as f32).sum())
}

/// Returns the first and the last parameter of a curve with enough points.
pub(crate) fn cubic_domain(points: usize, ends: Ends) -> (f64, f64) {
    let n = points as f64;
    match ends {
        Ends::Closed => (0.0, n),
        Ends::Kept => (0.0, n - 1.0),
        Ends::Dropped => (1.0, n - 2.0),
    }
}

/// Returns the weights of four control points at `s` in a piece of the cubic B-spline; `s` is from
/// 0 to 1.
fn cubic_basis(s: f64) -> [f64; 4] {
    let r = 1.0 - s;
    [
        r * r * r / 6.0,
        (s * s * (3.0 * s - 6.0) + 4.0) / 6.0,
        (r * r * (3.0 * r - 6.0) + 4.0) / 6.0,
        s * s * s / 6.0,
    ]
}

/// Returns control point `number` − 1. One more point exists beyond each end.
fn control(points: &[Point], ends: Ends, number: usize) -> Point {
    let n = points.len();
    match ends {
        Ends::Closed => points[(number + n - 1) % n],
        Ends::Kept if number == 0 => points[0] * 2.0 - points[1],
        Ends::Kept if number > n => points[n - 1] * 2.0 - points[n - 2],
        _ => points[number - 1],
    }
}

/// Returns the minimum number of points of a cubic B-spline.
pub(crate) fn min_points(ends: Ends) -> usize {
    match ends {
        Ends::Closed => 3,
        Ends::Kept => 2,
        Ends::Dropped => 4,
    }
}

/// Returns 2n minus the number of points after a step from n points.
fn cubic_loss(ends: Ends) -> usize {
    match ends {
        Ends::Closed => 0,
        Ends::Kept => 1,
        Ends::Dropped => 3,
    }
}

/// Returns the number of points after a cubic step.
pub(crate) fn cubic_count(points: usize, ends: Ends) -> usize {
    (2 * points).saturating_sub(cubic_loss(ends))
}

/// Runs one step of "add midpoints, add struts".
pub(crate) fn cubic_step(points: &[Point], ends: Ends) -> Vec<Point> {
    let n = points.len();
    let mut refined = Vec::with_capacity(cubic_count(n, ends));
    let middle = |i: usize| midpoint([points[i], points[(i + 1) % n]]);
    for (i, &v) in points.iter().enumerate() {
        let (is_first, is_last) = (i == 0, i + 1 == n);
        match ends {
            _ if ends == Ends::Closed || !(is_first || is_last) => {
                let strut = midpoint([middle((i + n - 1) % n), middle(i)]);
                refined.push(midpoint([v, strut]));
            }
            Ends::Kept => refined.push(v),
            _ => {}
        }
        if !is_last || ends == Ends::Closed {
            refined.push(middle(i));
        }
    }
    refined
}

/// Cuts all corners once.
fn chaikin_step(points: &[Point], ends: Ends) -> Vec<Point> {
    let n = points.len();
    let mut refined = Vec::with_capacity(2 * n);
    let edges = if ends == Ends::Closed { n } else { n - 1 };
    if ends == Ends::Kept {
        refined.push(points[0]);
    }
    for i in 0..edges {
        let [a, b] = [points[i], points[(i + 1) % n]];
        refined.extend([a * 0.75 + b * 0.25, a * 0.25 + b * 0.75]);
    }
    if ends == Ends::Kept {
        refined.push(points[n - 1]);
    }
    refined
}

/// Runs `levels` steps. Each step makes 2n − `loss` points from n points.
fn run_steps(
    points: &[Point],
    levels: u32,
    loss: usize,
    least: usize,
    step: impl Fn(&[Point]) -> Vec<Point>,
) -> Result<Vec<Point>, CurveError> {
    let given = points.len();
    if given < least {
        return Err(CurveError::TooFewPoints { given, least });
    }
    // The result has loss + (n − loss)·2^levels points.
    let growth = 1_usize.checked_shl(levels);
    let last = growth.and_then(|growth| (given - loss).checked_mul(growth));
    if last.is_none_or(|last| last > MAX_ROWS - loss) {
        let limit = MAX_ROWS;
        return Err(CurveError::TooManyPoints {
            given,
            levels,
            limit,
        });
    }
    let mut refined = points.to_vec();
    for _ in 0..levels {
        refined = step(&refined);
    }
    Ok(refined)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ALL: [Ends; 3] = [Ends::Closed, Ends::Kept, Ends::Dropped];

    type Scheme = fn(&[Point], Ends, u32) -> Result<Vec<Point>, CurveError>;

    const SCHEMES: [Scheme; 2] = [cubic_b_spline, chaikin];

    fn x(places: &[f32]) -> Vec<Point> {
        places.iter().map(|&x| Point::new(x, 0.0, 0.0)).collect()
    }

    fn polygon() -> impl Strategy<Value = Vec<Point>> {
        let point = [-8.0_f32..8.0, -8.0_f32..8.0, -8.0_f32..8.0];
        prop::collection::vec(point.prop_map(Point::from), 4..9)
    }

    /// Returns the point of the quadratic B-spline at `t`. Corner i of the polygon has the
    /// parameter i.
    fn quadratic(points: &[Point], t: f64) -> Point {
        let i = (t + 0.5).floor();
        let s = (t + 0.5 - i) as f32;
        let n = points.len() as isize;
        let at = |k: isize| points[(i as isize + k).rem_euclid(n) as usize];
        let r = 1.0 - s;
        at(-1) * (r * r / 2.0) + at(0) * (0.5 + s * r) + at(1) * (s * s / 2.0)
    }

    #[test]
    fn a_step_matches_the_weights() {
        let points = x(&[0.0, 8.0, 0.0, 16.0]);
        let step = |ends| cubic_b_spline(&points, ends, 1).expect("four points");
        assert_eq!(step(Ends::Kept), x(&[0.0, 4.0, 6.0, 4.0, 3.0, 8.0, 16.0]));
        assert_eq!(step(Ends::Dropped), x(&[4.0, 6.0, 4.0, 3.0, 8.0]));
        let closed = x(&[3.0, 4.0, 6.0, 4.0, 3.0, 8.0, 12.0, 8.0]);
        assert_eq!(step(Ends::Closed), closed);
        let cut = |ends| chaikin(&points, ends, 1).expect("four points");
        assert_eq!(cut(Ends::Dropped), x(&[2.0, 6.0, 6.0, 2.0, 4.0, 12.0]));
        let kept = x(&[0.0, 2.0, 6.0, 6.0, 2.0, 4.0, 12.0, 16.0]);
        assert_eq!(cut(Ends::Kept), kept);
        let closed = x(&[2.0, 6.0, 6.0, 2.0, 4.0, 12.0, 12.0, 4.0]);
        assert_eq!(cut(Ends::Closed), closed);
    }

    #[test]
    fn each_invalid_input_returns_its_error() {
        for ends in ALL {
            let few = min_points(ends) - 1;
            let error = cubic_b_spline(&vec![Point::ZERO; few], ends, 1).unwrap_err();
            let expected = CurveError::TooFewPoints {
                given: few,
                least: few + 1,
            };
            assert_eq!(error, expected);
            assert_eq!(cubic_b_spline_at(&vec![Point::ZERO; few], ends, 1.0), None);
        }
        for levels in [31, 63, 64, u32::MAX] {
            for scheme in SCHEMES {
                let error = scheme(&[Point::ZERO; 5], Ends::Dropped, levels);
                assert!(matches!(error, Err(CurveError::TooManyPoints { .. })));
            }
        }
        let points = [Point::ZERO; 5];
        assert_eq!(cubic_b_spline_at(&points, Ends::Dropped, 0.5), None);
        assert_eq!(cubic_b_spline_at(&points, Ends::Kept, 4.5), None);
        for t in [f64::NAN, f64::INFINITY] {
            assert!(ALL.map(|ends| cubic_b_spline_at(&points, ends, t)) == [None; 3]);
        }
    }

    proptest! {
        #[test]
        fn points_approach_the_b_spline(points in polygon()) {
            for ends in ALL {
                let levels = 7;
                let refined = cubic_b_spline(&points, ends, levels).expect("enough points");
                let step = f64::from(1 << levels).recip();
                let (first, last) = cubic_domain(points.len(), ends);
                // With dropped ends, the first point comes one step before the first parameter.
                let start = if ends == Ends::Dropped { first - step } else { first };
                prop_assert_eq!(refined.len(), ((last - start) / step).round() as usize
                    + match ends { Ends::Closed => 0, Ends::Kept => 1, Ends::Dropped => 2 });
                for (i, &point) in refined.iter().enumerate() {
                    let t = (start + i as f64 * step).clamp(first, last);
                    let limit = cubic_b_spline_at(&points, ends, t).expect("within");
                    let near = if ends == Ends::Dropped && (i == 0 || i + 1 == refined.len()) { 0.2 } else { 2e-3 };
                    prop_assert!(point.distance(limit) < near, "{:?} {}: {} {}", ends, i, point, limit);
                }
            }
        }

        #[test]
        fn cut_corners_approach_the_quadratic_b_spline(points in polygon()) {
            let levels = 7;
            let cut = chaikin(&points, Ends::Closed, levels).expect("enough points");
            let step = f64::from(1 << levels).recip();
            for (i, &point) in cut.iter().enumerate() {
                let t = 0.5 + (i as f64 - 0.5) * step;
                let near = quadratic(&points, t);
                prop_assert!(point.distance(near) < 5e-3, "{}: {} {}", i, point, near);
            }
        }

        #[test]
        fn kept_ends_are_dropped_ones_of_a_longer_polygon(points in polygon()) {
            let n = points.len();
            let with = |a: Point, b: Point| -> Vec<Point> {
                [&[a][..], &points, &[b]].concat()
            };
            let mirrored = with(points[0] * 2.0 - points[1], points[n - 1] * 2.0 - points[n - 2]);
            let doubled = with(points[0], points[n - 1]);
            for (scheme, longer) in SCHEMES.into_iter().zip([mirrored, doubled]) {
                let kept = scheme(&points, Ends::Kept, 3).expect("enough points");
                let dropped = scheme(&longer, Ends::Dropped, 3).expect("enough points");
                for (a, b) in kept.iter().zip(&dropped[1..]) {
                    prop_assert!(a.distance(*b) < 1e-4);
                }
                prop_assert_eq!(kept.len() + 2, dropped.len());
            }
        }

        #[test]
        fn affine_maps_commute_with_steps(points in polygon(), shift in -9.0_f32..9.0) {
            let map = |p: Point| Point::new(p.x - 2.0 * p.y + shift, 0.5 * p.z, p.y + p.x - shift);
            let mapped: Vec<Point> = points.iter().copied().map(map).collect();
            for scheme in SCHEMES {
                for ends in ALL {
                    let after = scheme(&points, ends, 3).expect("enough points");
                    let before = scheme(&mapped, ends, 3).expect("enough points");
                    prop_assert_eq!(after.len(), before.len());
                    for (a, b) in after.into_iter().map(map).zip(before) {
                        prop_assert!(a.distance(b) < 1e-4);
                    }
                    let still = scheme(&vec![Point::ONE; points.len()], ends, 2);
                    prop_assert!(still.expect("enough points").iter().all(|&p| p == Point::ONE));
                }
            }
        }
    }
}
