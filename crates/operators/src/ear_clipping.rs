//! Ear clipping: cuts one polygon into triangles.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3, Vec2Swizzles};

use crate::normals::Newell;

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
/// Only corners that are not convex, such as e, can lie in a triangle. Cutting b changes only the
/// ears at a and c.
///
/// Corners are projected along the axis nearest to the Newell normal. For a planar polygon, the
/// projection is affine and keeps all ears. The projection copies coordinates bit by bit, so
/// collinear corners stay collinear. The sign of an area is computed in doubles.
///
/// The ear with the best shape is cut first. The shape is the area of the ear relative to the
/// square of its longest side. Ears whose diagonal is already an edge of the mesh are cut last.
#[derive(Default)]
pub(crate) struct EarClipping {
    points: Vec<DVec3>,
    projected: Vec<DVec2>,
    prev: Vec<u32>,
    next: Vec<u32>,
    /// For each corner, its number of tests. Heap entries with an older number are outdated.
    version: Vec<u32>,
    removed: Vec<bool>,
    /// Corners that may lie in an ear.
    reflex: Vec<u32>,
    ears: BinaryHeap<Ear>,
}

/// An ear. A better ear compares greater.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ear {
    /// Whether the diagonal of the ear is not yet an edge of the mesh.
    has_new_diagonal: bool,
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
        self.has_new_diagonal
            .cmp(&other.has_new_diagonal)
            .then(by_quality)
            .then(first)
    }
}

impl EarClipping {
    /// Passes the `n − 2` triangles of the polygon to `cut`. A triangle has three corner numbers
    /// from 0 to `n − 1`, in the orientation of the polygon. `is_edge` returns whether a diagonal
    /// is already an edge of the mesh.
    ///
    /// If a polygon crosses itself or lies on a line, it may have no ear. All corners are then
    /// tested again, if their number has halved since the last such test. If there is still no ear,
    /// the best convex corner is cut. If no corner is convex, the best of all corners is cut. The
    /// result is always n − 2 triangles, in O(n²) time.
    pub(crate) fn clip(
        &mut self,
        corners: impl Iterator<Item = DVec3>,
        is_edge: impl Fn(usize, usize) -> bool,
        mut cut: impl FnMut([usize; 3]),
    ) {
        self.init(corners);
        let mut remaining = self.projected.len();
        let mut last_full_test = usize::MAX;
        while remaining > 3 {
            // The last cut makes two triangles. The worse triangle determines the quality of the
            // cut, so all four corners are tested again.
            if remaining == 4 || last_full_test == usize::MAX {
                self.find_ears(remaining, &is_edge);
                last_full_test = remaining;
            }
            let mut ear = self.best_ear();
            if ear.is_none() && 2 * remaining <= last_full_test {
                self.find_ears(remaining, &is_edge);
                last_full_test = remaining;
                ear = self.best_ear();
            }
            let tip = ear.unwrap_or_else(|| self.fallback_ear(&is_edge));
            let (a, c) = (self.prev[tip], self.next[tip]);
            cut([a as usize, tip, c as usize]);
            self.removed[tip] = true;
            self.next[a as usize] = c;
            self.prev[c as usize] = a;
            remaining -= 1;
            self.test_corner(a as usize, remaining, &is_edge);
            self.test_corner(c as usize, remaining, &is_edge);
        }
        if let Some(last) = self.removed.iter().position(|&removed| !removed) {
            cut([last, self.next[last] as usize, self.prev[last] as usize]);
        }
    }

    fn init(&mut self, corners: impl Iterator<Item = DVec3>) {
        self.points.clear();
        self.points.extend(corners);
        self.projected.clear();
        let project = projection(&self.points);
        self.projected
            .extend(self.points.iter().map(|&p| project(p)));
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
    }

    fn find_ears(&mut self, remaining: usize, is_edge: &impl Fn(usize, usize) -> bool) {
        self.ears.clear();
        self.reflex.clear();
        for i in 0..self.projected.len() {
            if !self.removed[i] && !self.is_convex(i) {
                self.reflex.push(i as u32);
            }
        }
        for i in 0..self.projected.len() {
            if !self.removed[i] {
                self.test_corner(i, remaining, is_edge);
            }
        }
    }

    /// Tests corner `i`. Adds the ear of the corner, if there is an ear.
    fn test_corner(&mut self, i: usize, remaining: usize, is_edge: &impl Fn(usize, usize) -> bool) {
        self.version[i] += 1;
        if !self.is_convex(i) || self.is_obstructed(i) {
            return;
        }
        let (a, c) = (self.prev[i] as usize, self.next[i] as usize);
        let mut quality = self.quality(i);
        if remaining == 4 {
            quality = quality.min(self.quality(self.next[c] as usize));
        }
        self.ears.push(Ear {
            has_new_diagonal: !is_edge(a, c),
            quality,
            corner: i as u32,
            version: self.version[i],
        });
    }

    fn best_ear(&mut self) -> Option<usize> {
        while let Some(ear) = self.ears.pop() {
            let corner = ear.corner as usize;
            if !self.removed[corner] && self.version[corner] == ear.version {
                return Some(corner);
            }
        }
        None
    }

    /// Returns the best corner to cut if there is no ear.
    fn fallback_ear(&self, is_edge: &impl Fn(usize, usize) -> bool) -> usize {
        let corners = (0..self.projected.len()).filter(|&i| !self.removed[i]);
        let ears = corners.map(|i| {
            let diagonal = [self.prev[i], self.next[i]].map(|j| j as usize);
            let ear = Ear {
                has_new_diagonal: !is_edge(diagonal[0], diagonal[1]),
                quality: self.quality(i),
                corner: i as u32,
                version: 0,
            };
            (self.is_convex(i), ear)
        });
        let best = ears.max().expect("more than three corners are left");
        best.1.corner as usize
    }

    fn triangle(&self, i: usize) -> [usize; 3] {
        [self.prev[i] as usize, i, self.next[i] as usize]
    }

    fn is_convex(&self, i: usize) -> bool {
        let [a, b, c] = self.triangle(i).map(|j| self.projected[j]);
        orient2d(a, b, c) > 0.0
    }

    /// Returns twice the area divided by the square of the longest side.
    fn quality(&self, i: usize) -> f64 {
        let [a, b, c] = self.triangle(i).map(|j| self.points[j]);
        let sides = [b - a, c - b, a - c];
        let longest = sides
            .map(DVec3::length_squared)
            .into_iter()
            .fold(0.0, f64::max);
        if longest > 0.0 {
            sides[0].cross(sides[1]).length() / longest
        } else {
            0.0
        }
    }

    /// Returns whether another corner lies in the triangle at the convex corner `i` or on its
    /// diagonal.
    fn is_obstructed(&mut self, i: usize) -> bool {
        let triangle = self.triangle(i);
        let mut at = 0;
        while let Some(&q) = self.reflex.get(at) {
            let q = q as usize;
            if self.removed[q] || self.is_convex(q) {
                self.reflex.swap_remove(at); // it never obstructs again
                continue;
            }
            if !triangle.contains(&q) && self.obstructs(q, triangle) {
                return true;
            }
            at += 1;
        }
        false
    }

    /// Returns whether corner `q` prevents the cut of the triangle.
    ///
    /// A corner at the position of `a`, `b` or `c` prevents the cut only if one of its sides runs
    /// into the triangle. Such corners occur along a bridge to a hole.
    fn obstructs(&self, q: usize, triangle: [usize; 3]) -> bool {
        let [a, b, c] = triangle.map(|j| self.projected[j]);
        let at = self.projected[q];
        if orient2d(a, b, at) < 0.0 || orient2d(b, c, at) < 0.0 || orient2d(c, a, at) < 0.0 {
            return false;
        }
        let wedge = [[a, b, c], [b, c, a], [c, a, b]];
        let Some([tip, right, left]) = wedge.into_iter().find(|&[tip, ..]| tip == at) else {
            return true;
        };
        [self.prev[q], self.next[q]].into_iter().any(|to| {
            let to = self.projected[to as usize];
            orient2d(tip, right, to) > 0.0 && orient2d(tip, to, left) > 0.0
        })
    }
}

/// Returns twice the signed area of the triangle. The area is above 0 if a, b, c turn left.
///
/// The difference of two singles is exact in doubles if their sizes differ by a factor below 2²⁹. A
/// product rounds only in its last bits.
fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns the projection along the axis nearest to the Newell normal. In the projection, the
/// polygon runs counter-clockwise.
fn projection(corners: &[DVec3]) -> impl Fn(DVec3) -> DVec2 + use<> {
    let mut newell = Newell::default();
    corners.iter().for_each(|&p| newell.add(p));
    let normal = newell.normal;
    let size = normal.abs();
    move |p| {
        let (projected, component) = if size.z >= size.x && size.z >= size.y {
            (DVec2::new(p.x, p.y), normal.z)
        } else if size.x >= size.y {
            (DVec2::new(p.y, p.z), normal.x)
        } else {
            (DVec2::new(p.z, p.x), normal.y)
        };
        if component < 0.0 {
            projected.yx()
        } else {
            projected
        }
    }
}
