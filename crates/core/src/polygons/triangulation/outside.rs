//! The outside of a polygon, cut like the inside.

use glam::DVec2;

use super::ears::{EarClipping, Shape};
use super::plane;

/// Returns whether the outside of a polygon was cut into triangles of which none is turned over.
///
/// ```text
///    ┌───────────────┐     The outside is the polygon of a frame, a bridge, and the polygon backwards.
///    │     ┌───┐     │     If no triangle of the inside and none of the outside is turned over, they
///    ├─────┤   └─┐   │     cover the area in the frame once, because the frame winds once around each
///    │     └─────┘   │     of its points. So no two of them overlap.
///    └───────────────┘
/// ```
///
/// A polygon that does not cross itself may have such a cut that was not found.
pub(super) fn has_cut(ears: &mut EarClipping, polygon: &[DVec2], shape: Shape) -> bool {
    let least = |i: usize, j: usize| {
        let [p, q] = [polygon[i], polygon[j]];
        if (q.x, q.y) < (p.x, p.y) { j } else { i }
    };
    let first = (0..polygon.len()).fold(0, least);
    let (low, high) = polygon
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| {
            (low.min(p), high.max(p))
        });
    let width = (high - low).max_element();
    if !(width > 0.0 && width.is_finite()) || polygon.iter().any(|p| !p.is_finite()) {
        return false;
    }
    let (low, high) = (low - width, high + width);
    let start = DVec2::new(low.x, polygon[first].y);
    let [right_low, left_high] = [DVec2::new(high.x, low.y), DVec2::new(low.x, high.y)];
    let frame = [start, low, right_low, high, left_high, start];
    let (before, after) = polygon.split_at(first + 1);
    let backwards = before.iter().rev().chain(after.iter().rev());
    let outside: Vec<DVec2> = frame
        .iter()
        .chain(backwards)
        .chain([&polygon[first]])
        .copied()
        .collect();
    let flat: Vec<_> = outside.iter().map(|p| p.extend(0.0)).collect();
    let mut triangles = Vec::with_capacity(outside.len() - 2);
    ears.clip(&flat, &outside, shape, |_, _| false, &mut triangles);
    plane::turned_part(&outside, &triangles) == 0.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A closed curve of `n` corners, in polar coordinates.
    fn curve(n: u32, turns: f64, radius: impl Fn(f64) -> f64) -> Vec<DVec2> {
        let corner = |i: u32| {
            let part = f64::from(i) / f64::from(n);
            radius(part) * DVec2::from_angle(TAU * turns * part)
        };
        (0..n).map(corner).collect()
    }

    fn has_cut(polygon: &[DVec2]) -> bool {
        let mut ears = EarClipping::default();
        ears.start(polygon.len());
        [Shape::Simple, Shape::Touching]
            .into_iter()
            .any(|shape| super::has_cut(&mut ears, polygon, shape))
    }

    #[test]
    fn the_outside_of_a_polygon_that_does_not_cross_itself_is_cut() {
        let circle = curve(200, 1.0, |_| 1.0);
        let star = curve(200, 1.0, |part| 1.0 + 0.9 * (20.0 * TAU * part).cos());
        // A ring with a slit: the second circle runs backwards.
        let inner = curve(100, -1.0, |_| 0.5);
        let slit = [&circle[..], &[circle[0]], &inner, &[inner[0]]].concat();
        for polygon in [circle, star, slit] {
            assert!(has_cut(&polygon));
        }
    }

    #[test]
    fn the_outside_of_a_polygon_that_winds_twice_is_not_cut() {
        let twice = curve(200, 2.0, |part| 1.0 + part);
        for polygon in [twice, vec![DVec2::ONE; 5]] {
            assert!(!has_cut(&polygon));
        }
    }
}
