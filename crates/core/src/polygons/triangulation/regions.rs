//! Two trees over the corners of a polygon, so that a cut does not look at all corners: the obstacles near
//! a triangle, and how often the polygon winds around a point.
//!
//! ```text
//!   corners   0 … 15   16 … 31   32 … 47   48 … 63        a row: at most 16 corners
//!                 ╲    ╱             ╲    ╱
//!                   ▭                  ▭                  a node: the box of two rows or nodes
//!                     ╲              ╱
//!                            ▭
//! ```

use std::ops::Range;

use glam::DVec2;

use super::plane::orient2d;

/// The most corners of a row.
const ROW: usize = 16;

/// A box in the plane; empty if `low` is above `high`.
#[derive(Clone, Copy, Debug)]
struct Extent {
    low: DVec2,
    high: DVec2,
}

impl Extent {
    const EMPTY: Self = Self {
        low: DVec2::INFINITY,
        high: DVec2::NEG_INFINITY,
    };

    fn of(points: impl IntoIterator<Item = DVec2>) -> Self {
        let points = points.into_iter();
        points.fold(Self::EMPTY, |all, p| Self {
            low: all.low.min(p),
            high: all.high.max(p),
        })
    }

    fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Returns whether a point of the box may lie in the triangle or on its border, which runs
    /// counter-clockwise. Exact for each side of the triangle and of the box.
    fn meets(&self, triangle: &[DVec2; 3]) -> bool {
        let [a, b, c] = *triangle;
        let around = Self::of([a, b, c]);
        if around.low.cmpgt(self.high).any() || self.low.cmpgt(around.high).any() {
            return false;
        }
        [[a, b], [b, c], [c, a]].into_iter().all(|[from, to]| {
            // The corner of the box that lies farthest to the left of the side.
            let x = if from.y > to.y {
                self.high.x
            } else {
                self.low.x
            };
            let y = if to.x > from.x {
                self.high.y
            } else {
                self.low.y
            };
            orient2d(from, to, DVec2::new(x, y)) >= 0.0
        })
    }
}

/// Returns the number of rows of `n` corners: a power of two, so that the rows are the leaves of a
/// binary tree. Node 1 is its root, and node `k` has the children `2 k` and `2 k + 1`.
fn row_count(n: usize) -> usize {
    n.div_ceil(ROW).next_power_of_two()
}

/// What a test says about an obstacle.
pub(super) enum Obstacle {
    /// It does not prevent this cut.
    Clear,
    /// It prevents the cut.
    Prevents,
    /// It never prevents a cut again.
    Gone,
}

/// The corners that may prevent the cut of an ear: a kd-tree (Bentley 1975) from which corners are
/// removed. Its boxes are small also where successive corners are far from each other.
#[derive(Default)]
pub(super) struct Obstacles {
    /// By row; those that are left of a row come first in it.
    corners: Vec<u32>,
    /// By node: its box, and the number of its obstacles.
    nodes: Vec<(Extent, u32)>,
    rows: usize,
    /// The nodes still to visit.
    stack: Vec<usize>,
}

impl Obstacles {
    /// Replaces the obstacles. O(n log n).
    pub(super) fn reset(&mut self, corners: impl Iterator<Item = u32>, points: &[DVec2]) {
        self.corners.clear();
        self.corners.extend(corners);
        self.rows = row_count(self.corners.len());
        self.nodes.clear();
        self.nodes.resize(2 * self.rows, (Extent::EMPTY, 0));
        self.divide(1, 0..self.rows, points);
    }

    /// Orders the corners of a node by the rows below it, and stores its box.
    fn divide(&mut self, node: usize, rows: Range<usize>, points: &[DVec2]) {
        let slots = self.first_slot(rows.start)..self.first_slot(rows.end);
        let corners = &mut self.corners[slots.clone()];
        let extent = Extent::of(corners.iter().map(|&q| points[q as usize]));
        self.nodes[node] = (extent, corners.len() as u32);
        if rows.len() == 1 {
            return;
        }
        let middle = (rows.start + rows.end) / 2;
        let size = extent.high - extent.low;
        let axis = usize::from(size.y > size.x);
        let along = |q: &u32| points[*q as usize][axis];
        let half = self.first_slot(middle) - slots.start;
        self.corners[slots].select_nth_unstable_by(half, |p, q| along(p).total_cmp(&along(q)));
        self.divide(2 * node, rows.start..middle, points);
        self.divide(2 * node + 1, middle..rows.end, points);
    }

    /// Returns where the corners of a row start.
    fn first_slot(&self, row: usize) -> usize {
        row * self.corners.len() / self.rows
    }

    /// Returns whether an obstacle prevents the cut of the triangle. Tests the obstacles of rows whose
    /// boxes meet the triangle, until one does.
    pub(super) fn any(
        &mut self,
        triangle: [DVec2; 3],
        mut test: impl FnMut(u32) -> Obstacle,
    ) -> bool {
        self.stack.clear();
        self.stack.push(1);
        while let Some(node) = self.stack.pop() {
            let (extent, count) = self.nodes[node];
            if count == 0 || (node > 1 && !extent.meets(&triangle)) {
                continue;
            }
            if node < self.rows {
                self.stack.extend([2 * node, 2 * node + 1]);
                continue;
            }
            let first = self.first_slot(node - self.rows);
            let mut end = first + count as usize;
            let mut at = first;
            while at < end {
                match test(self.corners[at]) {
                    Obstacle::Clear => at += 1,
                    Obstacle::Prevents => return true,
                    Obstacle::Gone => {
                        end -= 1;
                        self.corners[at] = self.corners[end];
                        self.forget(node);
                    }
                }
            }
        }
        false
    }

    /// Removes one obstacle from the counts of a row and of the nodes above it.
    fn forget(&mut self, mut node: usize) {
        while node > 0 {
            self.nodes[node].1 -= 1;
            node /= 2;
        }
    }
}

/// The sides that start at the remaining corners of a row or node.
#[derive(Clone, Copy)]
struct Chain {
    extent: Extent,
    /// The first and the last position of the chain.
    ends: [DVec2; 2],
}

/// How often the remaining polygon winds around a point.
///
/// A half-line from the point to the right crosses a chain of sides, counted with signs, as often as the
/// segment between the ends of the chain, if the whole chain lies to the right of the point. Successive
/// corners are near each other in most polygons, so the boxes of their rows are small.
#[derive(Default)]
pub(super) struct Winding {
    nodes: Vec<Option<Chain>>,
    rows: usize,
}

impl Winding {
    /// Builds the tree of a polygon. O(n).
    pub(super) fn reset(&mut self, points: &[DVec2], next: &[u32], removed: &[bool]) {
        self.rows = row_count(points.len());
        self.nodes.clear();
        self.nodes.resize(2 * self.rows, None);
        for row in 0..points.len().div_ceil(ROW) {
            self.nodes[self.rows + row] = chain_of_row(row, points, next, removed);
        }
        for node in (1..self.rows).rev() {
            self.nodes[node] = self.joined(node);
        }
    }

    /// Updates the tree after the side that starts at corner `i` was changed or removed.
    /// O([`ROW`] + log n).
    pub(super) fn update(&mut self, i: usize, points: &[DVec2], next: &[u32], removed: &[bool]) {
        let row = i / ROW;
        let mut node = self.rows + row;
        self.nodes[node] = chain_of_row(row, points, next, removed);
        while node > 1 {
            node /= 2;
            self.nodes[node] = self.joined(node);
        }
    }

    fn joined(&self, node: usize) -> Option<Chain> {
        match [2 * node, 2 * node + 1].map(|child| self.nodes[child]) {
            [Some(one), Some(other)] => Some(Chain {
                extent: one.extent.union(other.extent),
                ends: [one.ends[0], other.ends[1]],
            }),
            [one, other] => one.or(other),
        }
    }

    /// Returns how often the polygon winds around `at`, and the number of sides that were looked at.
    pub(super) fn around(
        &self,
        at: DVec2,
        points: &[DVec2],
        next: &[u32],
        removed: &[bool],
    ) -> (isize, usize) {
        let mut visits = 0;
        let times = self.around_in(1, at, &mut |row| {
            visits += ROW;
            let sides = sides_of_row(row, points, next, removed);
            sides.map(|side| crossing(side, at)).sum()
        });
        (times, visits)
    }

    fn around_in(&self, node: usize, at: DVec2, of_row: &mut impl FnMut(usize) -> isize) -> isize {
        let Some(Chain { extent, ends }) = self.nodes[node] else {
            return 0;
        };
        if extent.high.y <= at.y || extent.low.y > at.y || extent.high.x < at.x {
            return 0;
        }
        if extent.low.x > at.x {
            let [starts_below, ends_below] = ends.map(|end| end.y <= at.y);
            return isize::from(starts_below) - isize::from(ends_below);
        }
        match node >= self.rows {
            true => of_row(node - self.rows),
            false => {
                let [one, other] = [2 * node, 2 * node + 1];
                self.around_in(one, at, of_row) + self.around_in(other, at, of_row)
            }
        }
    }
}

/// Returns 1 if a side runs upward to the right of `at`, −1 if it runs downward there, and else 0.
fn crossing([from, to]: [DVec2; 2], at: DVec2) -> isize {
    match [from.y <= at.y, to.y <= at.y] {
        [true, false] if orient2d(from, to, at) > 0.0 => 1,
        [false, true] if orient2d(from, to, at) < 0.0 => -1,
        _ => 0,
    }
}

/// Returns the sides that start at the remaining corners of a row.
fn sides_of_row<'a>(
    row: usize,
    points: &'a [DVec2],
    next: &'a [u32],
    removed: &'a [bool],
) -> impl Iterator<Item = [DVec2; 2]> + 'a {
    let corners = row * ROW..points.len().min((row + 1) * ROW);
    let remaining = corners.filter(|&i| !removed[i]);
    remaining.map(|i| [points[i], points[next[i] as usize]])
}

fn chain_of_row(row: usize, points: &[DVec2], next: &[u32], removed: &[bool]) -> Option<Chain> {
    let sides = || sides_of_row(row, points, next, removed);
    let [first, _] = sides().next()?;
    let [_, last] = sides().last()?;
    Some(Chain {
        extent: Extent::of(sides().flatten()),
        ends: [first, last],
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Points with few different coordinates, more than a row of them.
    fn points() -> impl Strategy<Value = Vec<DVec2>> {
        let coordinate = prop_oneof![(0..9_i8).prop_map(f64::from), -1.0..9.0];
        let point = prop::array::uniform2(coordinate).prop_map(DVec2::from_array);
        prop::collection::vec(point, 3..200)
    }

    /// Returns for each corner the next one that is not removed.
    fn next_of(removed: &[bool]) -> Vec<u32> {
        let n = removed.len();
        let next = |i: usize| (1..=n).map(|step| (i + step) % n).find(|&j| !removed[j]);
        (0..n).map(|i| next(i).unwrap_or(i) as u32).collect()
    }

    proptest! {
        #[test]
        fn obstacles_in_a_triangle_are_found_until_they_are_gone(
            points in points(),
            triangles in prop::collection::vec(prop::array::uniform3(any::<usize>()), 1..20),
        ) {
            let n = points.len();
            let mut obstacles = Obstacles::default();
            obstacles.reset(0..n as u32, &points);
            let mut is_gone = vec![false; n];
            for numbers in triangles {
                let [a, b, c] = numbers.map(|i| points[i % n]);
                let triangle = if orient2d(a, b, c) < 0.0 { [a, c, b] } else { [a, b, c] };
                let [a, b, c] = triangle;
                let is_in = |p: DVec2| {
                    [[a, b], [b, c], [c, a]].iter().all(|&[p0, p1]| orient2d(p0, p1, p) >= 0.0)
                };
                let expected = (0..n).any(|i| !is_gone[i] && is_in(points[i]));
                let found = obstacles.any(triangle, |q| match is_in(points[q as usize]) {
                    _ if is_gone[q as usize] => Obstacle::Gone,
                    true => Obstacle::Prevents,
                    false => Obstacle::Clear,
                });
                prop_assert_eq!(found, expected);
                for i in numbers {
                    is_gone[i % n] = true;
                }
            }
        }

        #[test]
        fn the_winding_number_is_that_of_all_remaining_sides(
            points in points(),
            removals in prop::collection::vec(any::<usize>(), 0..60),
            queries in prop::collection::vec(prop::array::uniform2(-1.0..9.0), 1..8),
        ) {
            let n = points.len();
            let mut removed = vec![false; n];
            let mut next = next_of(&removed);
            let mut winding = Winding::default();
            winding.reset(&points, &next, &removed);
            for removal in removals {
                let tip = removal % n;
                if removed[tip] || removed.iter().filter(|&&removed| !removed).count() <= 3 {
                    continue;
                }
                let before = (1..n).map(|step| (tip + n - step) % n).find(|&i| !removed[i]);
                removed[tip] = true;
                next = next_of(&removed);
                for changed in [tip, before.expect("others are left")] {
                    winding.update(changed, &points, &next, &removed);
                }
            }
            for query in queries {
                let at = DVec2::from_array(query);
                let remaining = (0..n).filter(|&i| !removed[i]);
                let sides = remaining.map(|i| [points[i], points[next[i] as usize]]);
                let expected: isize = sides.map(|side| crossing(side, at)).sum();
                prop_assert_eq!(winding.around(at, &points, &next, &removed).0, expected);
            }
        }
    }
}
