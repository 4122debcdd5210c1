//! Ear clipping: cuts one polygon into triangles.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};

use super::plane::{orient2d, quality};
use super::regions::{Obstacle, Obstacles, Winding};

/// Maximum number of full tests of all corners, beyond those after the corners have halved.
const FULL_TESTS: usize = 64;

/// The corners and sides that the tests of one polygon may look at: this number, and more for each corner.
/// Then all tests are left out. Where very many long triangles cross each other, no cut is right anyway.
const MOST_VISITS: usize = 50_000_000;
const MOST_VISITS_OF_CORNER: usize = 300;

/// What is known about a polygon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Shape {
    /// The polygon is taken for simple: no two sides share a point, except for successive sides.
    #[default]
    Simple,
    /// The polygon may touch itself, but does not cross itself.
    Touching,
}

/// Cuts polygons into triangles, one polygon at a time.
///
/// ```text
///    d ─────── c
///     ╲        ┆ ╲        An ear is a convex corner b whose diagonal a–c runs inside: no other
///      e       ┆  b       corner lies in the triangle a b c. Each simple polygon with four or more
///     ╱        ┆ ╱        corners has two ears (Meisters 1975), and stays simple if one is cut.
///    f ─────── a
/// ```
///
/// In a simple polygon, only corners that are not convex, such as e, can lie in a triangle, and
/// cutting b changes only the ears at a and c. In a polygon that touches itself:
///
/// - A corner or a side on the border of the triangle prevents the cut only if a side runs into the
///   triangle from there.
/// - The triangle must lie inside, where the polygon winds once around each point. Along a spike, or
///   along a bridge to a hole, the polygon runs twice, and a turn to the left can be outside.
/// - If there is no ear with an area, a corner whose triangle is flat is cut. This does not change
///   where the rest of the polygon winds.
///
/// The ear with the best shape is cut first. The shape is the area of the ear relative to the
/// square of its longest side. Ears whose diagonal is already an edge of the mesh are cut last.
#[derive(Default)]
pub(super) struct EarClipping {
    shape: Shape,
    points: Vec<DVec3>,
    projected: Vec<DVec2>,
    prev: Vec<u32>,
    next: Vec<u32>,
    /// For each corner, its number of tests. Heap entries with an older number are outdated.
    version: Vec<u32>,
    removed: Vec<bool>,
    /// Corners that may lie in an ear.
    obstacles: Obstacles,
    /// How often the remaining polygon winds around a point, if it may touch itself.
    winding: Winding,
    ears: BinaryHeap<Ear>,
    /// The corners and sides that tests may still look at.
    visits_left: usize,
    /// All remaining corners, the best to cut first, once there was no ear. Whether the corner is convex
    /// decides before all else.
    others: BinaryHeap<(bool, Ear)>,
}

/// The kind of an ear; a better one compares greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// The corner lies between its neighbours, on the same line.
    Flat,
    /// The sides run out and back on the same line, or one of them has no length.
    Spike,
    /// The ear has an area, and its diagonal is already an edge of the mesh.
    KnownDiagonal,
    /// The ear has an area, and its diagonal is new.
    NewDiagonal,
}

/// An ear. A better ear compares greater.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ear {
    kind: Kind,
    quality: f64,
    corner: u32,
    version: u32,
}

impl Eq for Ear {}

impl PartialOrd for Ear {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ear {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_quality = self.quality.total_cmp(&other.quality);
        let first = other.corner.cmp(&self.corner);
        self.kind.cmp(&other.kind).then(by_quality).then(first)
    }
}

impl EarClipping {
    /// Starts with a polygon of `corners` corners, which may be cut several times.
    pub(super) fn start(&mut self, corners: usize) {
        self.visits_left =
            MOST_VISITS.saturating_add(corners.saturating_mul(MOST_VISITS_OF_CORNER));
    }

    /// Returns whether tests were left out, because they looked at too many corners.
    pub(super) fn is_exhausted(&self) -> bool {
        self.visits_left == 0
    }

    /// Appends the `n − 2` triangles of the polygon with the corners `points` to `triangles`. A
    /// triangle has three corner numbers from 0 to `n − 1`, in the orientation of the polygon.
    /// `projected` are the corners in a plane, in which the polygon runs counter-clockwise.
    /// `is_edge` returns whether a diagonal is already an edge of the mesh.
    ///
    /// A polygon that crosses itself, or that touches itself although `shape` is
    /// [`Shape::Simple`], may have no ear. All corners are then tested again, if their number has
    /// halved since the last such test. If there is still no ear, the best convex corner is cut. If
    /// no corner is convex, the best of all corners is cut. The result is always n − 2 triangles.
    ///
    /// A test takes O(log n) time where successive corners are near each other, and O(n) in the worst
    /// case. There are at most 3 n tests, and 64 n more for a polygon that touches itself.
    pub(super) fn clip(
        &mut self,
        points: &[DVec3],
        projected: &[DVec2],
        shape: Shape,
        is_edge: impl Fn(usize, usize) -> bool,
        triangles: &mut Vec<[usize; 3]>,
    ) {
        self.init(points, projected, shape);
        let mut remaining = points.len();
        let mut last_full_test = usize::MAX;
        let mut more_tests = match shape {
            Shape::Simple => 0,
            Shape::Touching => FULL_TESTS,
        };
        while remaining > 3 {
            // The last cut makes two triangles. The worse triangle determines the quality of the
            // cut, so all four corners are tested again.
            if remaining == 4 || last_full_test == usize::MAX {
                self.find_ears(remaining, &is_edge);
                last_full_test = remaining;
            }
            let mut ear = self.best_ear();
            let may_test = 2 * remaining <= last_full_test || more_tests > 0;
            if ear.is_none_or(|ear| ear.kind < Kind::KnownDiagonal)
                && may_test
                && remaining < last_full_test
            {
                more_tests = more_tests.saturating_sub(1);
                self.find_ears(remaining, &is_edge);
                last_full_test = remaining;
                ear = self.best_ear();
            }
            let tip = match ear {
                Some(ear) => ear.corner as usize,
                None => self.fallback_ear(&is_edge),
            };
            let (a, c) = (self.prev[tip], self.next[tip]);
            triangles.push([a as usize, tip, c as usize]);
            self.removed[tip] = true;
            self.next[a as usize] = c;
            self.prev[c as usize] = a;
            if self.shape == Shape::Touching {
                for corner in [a as usize, tip] {
                    self.winding
                        .update(corner, &self.projected, &self.next, &self.removed);
                }
            }
            remaining -= 1;
            self.test_corner(a as usize, remaining, &is_edge);
            self.test_corner(c as usize, remaining, &is_edge);
        }
        if let Some(last) = self.removed.iter().position(|&removed| !removed) {
            triangles.push([last, self.next[last] as usize, self.prev[last] as usize]);
        }
    }

    fn init(&mut self, points: &[DVec3], projected: &[DVec2], shape: Shape) {
        self.shape = shape;
        self.points.clear();
        self.points.extend(points);
        self.projected.clear();
        self.projected.extend(projected);
        let n = self.points.len() as u32;
        self.prev.clear();
        self.prev
            .extend((0..n).map(|i| if i == 0 { n - 1 } else { i - 1 }));
        self.next.clear();
        self.next
            .extend((0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }));
        self.version.clear();
        self.version.resize(n as usize, 0);
        self.removed.clear();
        self.removed.resize(n as usize, false);
        self.ears.clear();
        self.others.clear();
        if shape == Shape::Touching {
            self.winding
                .reset(&self.projected, &self.next, &self.removed);
        }
    }

    fn find_ears(&mut self, remaining: usize, is_edge: &impl Fn(usize, usize) -> bool) {
        self.ears.clear();
        let mut obstacles = std::mem::take(&mut self.obstacles);
        let may_obstruct =
            |&i: &usize| !self.removed[i] && (self.shape == Shape::Touching || !self.is_convex(i));
        let corners = (0..self.projected.len()).filter(may_obstruct);
        obstacles.reset(corners.map(|i| i as u32), &self.projected);
        self.obstacles = obstacles;
        for i in 0..self.projected.len() {
            if !self.removed[i] {
                self.test_corner(i, remaining, is_edge);
            }
        }
    }

    /// Tests corner `i`. Adds the ear of the corner, if there is an ear.
    fn test_corner(&mut self, i: usize, remaining: usize, is_edge: &impl Fn(usize, usize) -> bool) {
        self.version[i] += 1;
        if !self.others.is_empty() {
            self.push_other(i, is_edge);
        }
        let (a, c) = (self.prev[i] as usize, self.next[i] as usize);
        let kind = match self.area(i) {
            area if area > 0.0 => match is_edge(a, c) {
                true => Kind::KnownDiagonal,
                false => Kind::NewDiagonal,
            },
            0.0 if self.shape == Shape::Touching => self.kind_without_area(i),
            _ => return,
        };
        let is_tested = kind >= Kind::KnownDiagonal && !self.is_exhausted();
        if is_tested && (self.is_obstructed(i) || !self.is_inside(i)) {
            return;
        }
        let mut quality = self.quality(i);
        if remaining == 4 {
            quality = quality.min(self.quality(self.next[c] as usize));
        }
        self.ears.push(Ear {
            kind,
            quality,
            corner: i as u32,
            version: self.version[i],
        });
    }

    /// Returns the kind of the ear at a corner on a line with its neighbours.
    fn kind_without_area(&self, i: usize) -> Kind {
        let [a, b, c] = self.triangle(i).map(|j| self.projected[j]);
        match a == b || b == c || (a - b).dot(c - b) > 0.0 {
            true => Kind::Spike,
            false => Kind::Flat,
        }
    }

    fn best_ear(&mut self) -> Option<Ear> {
        while let Some(&ear) = self.ears.peek() {
            if self.is_current(&ear) {
                return Some(ear);
            }
            self.ears.pop();
        }
        None
    }

    fn is_current(&self, ear: &Ear) -> bool {
        let corner = ear.corner as usize;
        !self.removed[corner] && self.version[corner] == ear.version
    }

    /// Returns the best corner to cut if there is no ear.
    fn fallback_ear(&mut self, is_edge: &impl Fn(usize, usize) -> bool) -> usize {
        if self.others.is_empty() {
            for i in 0..self.projected.len() {
                if !self.removed[i] {
                    self.push_other(i, is_edge);
                }
            }
        }
        loop {
            let (_, best) = self.others.pop().expect("more than three corners are left");
            if self.is_current(&best) {
                return best.corner as usize;
            }
        }
    }

    /// Adds corner `i` to those of which the best is cut if there is no ear.
    fn push_other(&mut self, i: usize, is_edge: &impl Fn(usize, usize) -> bool) {
        let [a, _, c] = self.triangle(i);
        let ear = Ear {
            kind: match is_edge(a, c) {
                true => Kind::KnownDiagonal,
                false => Kind::NewDiagonal,
            },
            quality: self.quality(i),
            corner: i as u32,
            version: self.version[i],
        };
        self.others.push((self.is_convex(i), ear));
    }

    fn triangle(&self, i: usize) -> [usize; 3] {
        [self.prev[i] as usize, i, self.next[i] as usize]
    }

    /// Returns twice the signed area of the triangle at corner `i`.
    fn area(&self, i: usize) -> f64 {
        let [a, b, c] = self.triangle(i).map(|j| self.projected[j]);
        orient2d(a, b, c)
    }

    fn is_convex(&self, i: usize) -> bool {
        self.area(i) > 0.0
    }

    fn quality(&self, i: usize) -> f64 {
        quality(self.triangle(i).map(|j| self.points[j]))
    }

    /// Returns whether another corner prevents the cut of the convex corner `i`.
    fn is_obstructed(&mut self, i: usize) -> bool {
        let triangle = self.triangle(i);
        let mut obstacles = std::mem::take(&mut self.obstacles);
        let mut visits = 0;
        let is_obstructed = obstacles.any(triangle.map(|j| self.projected[j]), |q| {
            visits += 1;
            let q = q as usize;
            let is_gone = match self.shape {
                Shape::Simple => self.removed[q] || self.is_convex(q),
                Shape::Touching => self.removed[q],
            };
            if is_gone {
                Obstacle::Gone
            } else if !triangle.contains(&q) && self.obstructs(q, triangle) {
                Obstacle::Prevents
            } else {
                Obstacle::Clear
            }
        });
        self.obstacles = obstacles;
        self.visits_left = self.visits_left.saturating_sub(visits);
        is_obstructed
    }

    /// Returns whether corner `q` prevents the cut of the triangle.
    ///
    /// A corner at the position of `a`, `b` or `c` prevents the cut only if one of its sides runs
    /// into the triangle. Such corners occur along a bridge to a hole. If the polygon may touch
    /// itself, the same holds for corners on the sides of the triangle.
    fn obstructs(&self, q: usize, triangle: [usize; 3]) -> bool {
        let [a, b, c] = triangle.map(|j| self.projected[j]);
        let at = self.projected[q];
        let sides = [[a, b], [b, c], [c, a]];
        let left_of = sides.map(|[from, to]| orient2d(from, to, at));
        if left_of.iter().any(|&area| area < 0.0) {
            return false;
        }
        let ends = [self.prev[q], self.next[q]].map(|to| self.projected[to as usize]);
        let wedge = [[a, b, c], [b, c, a], [c, a, b]];
        if let Some([tip, right, left]) = wedge.into_iter().find(|&[tip, ..]| tip == at) {
            let runs_in =
                |to: DVec2| orient2d(tip, right, to) > 0.0 && orient2d(tip, to, left) > 0.0;
            return ends.into_iter().any(runs_in);
        }
        let on_side = left_of.iter().position(|&area| area == 0.0);
        match on_side.filter(|_| self.shape == Shape::Touching) {
            Some(side) => {
                let [from, to] = sides[side];
                ends.into_iter().any(|end| orient2d(from, to, end) > 0.0)
            }
            None => true,
        }
    }

    /// Returns whether the rest of the polygon winds once around the triangle at corner `i`, which
    /// no side enters.
    fn is_inside(&mut self, i: usize) -> bool {
        if self.shape == Shape::Simple {
            return true;
        }
        let [a, b, c] = self.triangle(i).map(|j| self.projected[j]);
        let at = (a + b + c) / 3.0;
        let (times, visits) = self
            .winding
            .around(at, &self.projected, &self.next, &self.removed);
        self.visits_left = self.visits_left.saturating_sub(visits);
        times == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_is_cut_to_the_end_when_the_limit_of_the_tests_is_reached() {
        let at = |i: u32| DVec2::from_angle(f64::from(i)) * f64::from(1 + i % 3);
        let projected: Vec<DVec2> = (0..100).map(at).collect();
        let points: Vec<DVec3> = projected.iter().map(|p| p.extend(0.0)).collect();
        for (visits, is_exhausted) in [(10, true), (10_000_000, false)] {
            let mut ears = EarClipping::default();
            ears.start(points.len());
            ears.visits_left = visits;
            let mut triangles = Vec::new();
            for shape in [Shape::Simple, Shape::Touching] {
                triangles.clear();
                ears.clip(&points, &projected, shape, |_, _| false, &mut triangles);
                assert_eq!((triangles.len(), ears.is_exhausted()), (98, is_exhausted));
            }
        }
    }
}
