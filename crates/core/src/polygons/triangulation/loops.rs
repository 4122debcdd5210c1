//! Parts of a polygon between two corners at one position.

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

/// A polygon that was split into parts at positions where it touches itself.
pub(super) struct Loops {
    /// The corner numbers of the parts, each with three or more corners. No two parts have a corner in
    /// common.
    pub(super) parts: Vec<Vec<usize>>,
    /// The triangles without area that join the parts: with those of the parts, they are the triangles of
    /// the polygon.
    pub(super) joints: Vec<[usize; 3]>,
}

/// Splits off each part of a polygon that starts and ends at one position and runs counter-clockwise, or
/// runs out and back on one side. Nothing is split off at a position where a part runs clockwise, as a hole
/// does. Returns `None` if nothing is split off at all. O(n) expected for `n` corners.
///
/// ```text
///    b ─── c       d ─── e      The polygon i b c j d e, in which i and j are at one position, has the
///      ╲   │       │   ╱        parts i b c and j d e, and the joints c j i and e i j.
///        ╲ │       │ ╱
///          i       j
/// ```
pub(super) fn split(points: &[DVec2]) -> Option<Loops> {
    let mut with_holes = FxHashSet::default();
    for _ in 0..MOST_WALKS {
        let known = with_holes.len();
        let loops = walk(points, &mut with_holes);
        if with_holes.len() == known {
            return loops;
        }
    }
    None
}

/// How often a polygon is walked around, until no further hole is found.
const MOST_WALKS: usize = 4;

/// A position, without −0.
type Key = [u64; 2];

/// Splits off parts, except at the positions `with_holes`. Adds the other positions where a part runs
/// clockwise.
fn walk(points: &[DVec2], with_holes: &mut FxHashSet<Key>) -> Option<Loops> {
    let key = |c: usize| (points[c] + DVec2::ZERO).to_array().map(f64::to_bits);
    let area_before =
        |from: usize, to: usize| (points[from] - points[0]).perp_dot(points[to] - points[0]);
    let end = points.len() - 1;
    let (mut parts, mut joints) = (Vec::new(), Vec::new());
    // The corners of the rest so far, each with the doubled area up to it.
    let mut rest: Vec<(usize, f64)> = Vec::with_capacity(points.len());
    let mut last_at: FxHashMap<Key, usize> = FxHashMap::default();
    for c in 0..points.len() {
        let known = last_at.get(&key(c)).copied();
        let is_here = |d: &usize| rest.get(*d).is_some_and(|&(i, _)| points[i] == points[c]);
        if let Some(d) = known.filter(is_here) {
            let ((first, before), &(last, area)) = (rest[d], rest.last()?);
            let area = area - before + area_before(last, first);
            let corners = rest.len() - d;
            if area < 0.0 {
                with_holes.insert(key(c));
            }
            let is_part = (corners > 2 && area > 0.0) || (corners == 2 && area == 0.0);
            if is_part && !(d == 0 && c == end) && !with_holes.contains(&key(c)) {
                joints.push([last, c, first]);
                // The corner before the first one is the end of the polygon.
                joints.push([d.checked_sub(1).map_or(end, |d| rest[d].0), first, c]);
                let part: Vec<usize> = rest.drain(d..).map(|(corner, _)| corner).collect();
                if corners > 2 {
                    parts.push(part);
                }
                rest.push((c, before));
                continue;
            }
        }
        last_at.insert(key(c), rest.len());
        let area = rest
            .last()
            .map_or(0.0, |&(last, area)| area + area_before(last, c));
        rest.push((c, area));
    }
    let &(last, area) = rest.last()?;
    if area + area_before(last, rest[0].0) < 0.0 {
        // The rest is a hole in a part that was split off from it.
        with_holes.extend(joints.iter().map(|&[_, c, _]| key(c)));
    }
    if rest.len() > 2 {
        parts.push(rest.into_iter().map(|(corner, _)| corner).collect());
    }
    (!joints.is_empty()).then_some(Loops { parts, joints })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn polygon(corners: &[[i32; 2]]) -> Vec<DVec2> {
        let at = |&[x, y]: &[i32; 2]| DVec2::new(f64::from(x), f64::from(y));
        corners.iter().map(at).collect()
    }

    #[test]
    fn petals_are_split_off_and_holes_are_not() {
        // Two petals at the corner (0, 0), of which the second one has a spike at its side.
        let petals = [
            [0, 0],
            [2, 0],
            [2, 1],
            [0, 0],
            [-2, 0],
            [-3, 0],
            [-2, 0],
            [-2, -1],
        ];
        let Loops { parts, joints } = split(&polygon(&petals)).expect("it touches itself");
        let mut sizes: Vec<usize> = parts.iter().map(Vec::len).collect();
        sizes.sort_unstable();
        assert_eq!(sizes, [3, 3]);
        let triangles = parts.iter().map(|part| part.len() - 2).sum::<usize>() + joints.len();
        assert_eq!(triangles, petals.len() - 2);
        // The sides of the parts and of the joints inside cancel: those of the polygon remain.
        let mut sides = BTreeMap::new();
        let joints = joints.into_iter().map(Vec::from);
        for part in parts.into_iter().chain(joints) {
            for (&from, &to) in part.iter().zip(part.iter().cycle().skip(1)) {
                *sides.entry((from, to)).or_insert(0) += 1;
                *sides.entry((to, from)).or_insert(0) -= 1;
            }
        }
        sides.retain(|_, count| *count > 0);
        let n = petals.len();
        let expected = (0..n).map(|i| ((i, (i + 1) % n), 1));
        assert_eq!(sides, expected.collect());
        // A square with a square hole that touches it in a corner.
        let hole = [
            [0, 0],
            [9, 0],
            [9, 9],
            [0, 9],
            [0, 0],
            [2, 4],
            [4, 4],
            [4, 2],
        ];
        for first in 0..hole.len() {
            let mut turned = hole;
            turned.rotate_left(first);
            let parts = split(&polygon(&turned)).map(|loops| loops.parts);
            assert_eq!(parts, None, "{first}");
        }
        assert!(split(&polygon(&hole[..4])).is_none());
    }
}
