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
