//! Ear clipping: cuts one polygon into triangles.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3, Vec2Swizzles};

use crate::normals::Newell;

/// Cuts one polygon at a time; its tables are reused for the next one.
///
/// ```text
///    d ─────── c
///     ╲        ┆ ╲        An ear is a convex corner b whose diagonal a–c runs inside: no other
///      e       ┆  b       corner lies in the triangle a b c. Each simple polygon with four or more
///     ╱        ┆ ╱        corners has two ears (Meisters 1975), and stays simple if one is cut.
///    f ─────── a
/// ```
///
/// Only corners that are not convex, such as e, need to be tested against a triangle. Cutting
/// b changes only the ears at a and c.
///
/// Corners are projected along the axis nearest to the Newell normal. For a planar polygon this
/// projection is affine, so ears stay ears. It copies coordinates bit by bit, so collinear corners
/// stay collinear. The sign of an area is computed in doubles.
///
/// The ear with the best shape is cut first: its area divided by the square of its longest side is
/// largest. Ears whose diagonal is already an edge of the mesh are cut last.
#[derive(Default)]
pub(crate) struct EarClipping {
    solid: Vec<DVec3>,
    flat: Vec<DVec2>,
    before: Vec<u32>,
    after: Vec<u32>,
    /// By corner: how often it was tested for an ear. Heap entries with an older count are stale.
    looked: Vec<u32>,
    gone: Vec<bool>,
    /// Corners that may obstruct an ear: neither convex nor cut off at their last test.
    in_the_way: Vec<u32>,
    ears: BinaryHeap<Ear>,
}

/// An ear. A better ear compares greater.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ear {
    /// Whether its diagonal is not yet an edge of the mesh.
    free: bool,
    shape: f64,
    corner: u32,
    looked: u32,
}

impl Eq for Ear {}

impl PartialOrd for Ear {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ear {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_shape = self.shape.total_cmp(&other.shape);
        let first = other.corner.cmp(&self.corner);
        self.free.cmp(&other.free).then(by_shape).then(first)
    }
}

impl EarClipping {
    /// Passes the `n − 2` triangles of the polygon to `cut`, each as three of its corner numbers 0
    /// to `n − 1`, in the orientation of the polygon. `taken` returns whether a diagonal is already
    /// an edge of the mesh.
    ///
    /// A polygon that crosses itself or lies on a line may run out of ears. Then all corners are
    /// tested again, at most once each time their number has halved. If there is still no ear, the
    /// best convex corner is cut, or the best of all corners if no corner is convex. The result is
    /// always n − 2 triangles, in O(n²) time.
    pub(crate) fn clip(
        &mut self,
        corners: impl Iterator<Item = DVec3>,
        taken: impl Fn(usize, usize) -> bool,
        mut cut: impl FnMut([usize; 3]),
    ) {
        self.start(corners);
        let mut left = self.flat.len();
        let mut looked_at_all = usize::MAX;
        while left > 3 {
            // The last cut makes two triangles, and the worse one counts: test all four corners.
            if left == 4 || looked_at_all == usize::MAX {
                self.look_at_all(left, &taken);
                looked_at_all = left;
            }
            let mut ear = self.best_ear();
            if ear.is_none() && 2 * left <= looked_at_all {
                self.look_at_all(left, &taken);
                looked_at_all = left;
                ear = self.best_ear();
            }
            let tip = ear.unwrap_or_else(|| self.makeshift(&taken));
            let (a, c) = (self.before[tip], self.after[tip]);
            cut([a as usize, tip, c as usize]);
            self.gone[tip] = true;
            self.after[a as usize] = c;
            self.before[c as usize] = a;
            left -= 1;
            self.look_at(a as usize, left, &taken);
            self.look_at(c as usize, left, &taken);
        }
        if let Some(last) = self.gone.iter().position(|&gone| !gone) {
            cut([last, self.after[last] as usize, self.before[last] as usize]);
        }
    }

    /// Fills the tables: all corners are in place, no corner is tested yet.
    fn start(&mut self, corners: impl Iterator<Item = DVec3>) {
        self.solid.clear();
        self.solid.extend(corners);
        self.flat.clear();
        let view = view_along(&self.solid);
        self.flat.extend(self.solid.iter().map(|&p| view(p)));
        let n = self.solid.len() as u32;
        self.before.clear();
        self.before
            .extend((0..n).map(|i| if i == 0 { n - 1 } else { i - 1 }));
        self.after.clear();
        self.after
            .extend((0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }));
        self.looked.clear();
        self.looked.resize(n as usize, 0);
        self.gone.clear();
        self.gone.resize(n as usize, false);
        self.ears.clear();
    }

    /// Finds all ears of the current polygon.
    fn look_at_all(&mut self, left: usize, taken: &impl Fn(usize, usize) -> bool) {
        self.ears.clear();
        self.in_the_way.clear();
        for i in 0..self.flat.len() {
            if !self.gone[i] && !self.is_convex(i) {
                self.in_the_way.push(i as u32);
            }
        }
        for i in 0..self.flat.len() {
            if !self.gone[i] {
                self.look_at(i, left, taken);
            }
        }
    }

    /// Tests corner `i` and adds its ear, if it has one now.
    fn look_at(&mut self, i: usize, left: usize, taken: &impl Fn(usize, usize) -> bool) {
        self.looked[i] += 1;
        if !self.is_convex(i) || self.is_obstructed(i) {
            return;
        }
        let (a, c) = (self.before[i] as usize, self.after[i] as usize);
        let mut shape = self.shape(i);
        if left == 4 {
            shape = shape.min(self.shape(self.after[c] as usize));
        }
        self.ears.push(Ear {
            free: !taken(a, c),
            shape,
            corner: i as u32,
            looked: self.looked[i],
        });
    }

    fn best_ear(&mut self) -> Option<usize> {
        while let Some(ear) = self.ears.pop() {
            let corner = ear.corner as usize;
            if !self.gone[corner] && self.looked[corner] == ear.looked {
                return Some(corner);
            }
        }
        None
    }

    /// Returns the best corner to cut if there is no ear.
    fn makeshift(&self, taken: &impl Fn(usize, usize) -> bool) -> usize {
        let here = (0..self.flat.len()).filter(|&i| !self.gone[i]);
        let ears = here.map(|i| {
            let diagonal = [self.before[i], self.after[i]].map(|j| j as usize);
            let ear = Ear {
                free: !taken(diagonal[0], diagonal[1]),
                shape: self.shape(i),
                corner: i as u32,
                looked: 0,
            };
            (self.is_convex(i), ear)
        });
        let best = ears.max().expect("more than three corners are left");
        best.1.corner as usize
    }

    fn triangle(&self, i: usize) -> [usize; 3] {
        [self.before[i] as usize, i, self.after[i] as usize]
    }

    fn is_convex(&self, i: usize) -> bool {
        let [a, b, c] = self.triangle(i).map(|j| self.flat[j]);
        turn(a, b, c) > 0.0
    }

    /// Returns twice the area divided by the square of the longest side: at most √3/2.
    fn shape(&self, i: usize) -> f64 {
        let [a, b, c] = self.triangle(i).map(|j| self.solid[j]);
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

    /// Returns whether another corner lies in the triangle at the convex corner `i`, or on its
    /// diagonal.
    fn is_obstructed(&mut self, i: usize) -> bool {
        let triangle = self.triangle(i);
        let mut at = 0;
        while let Some(&q) = self.in_the_way.get(at) {
            let q = q as usize;
            if self.gone[q] || self.is_convex(q) {
                self.in_the_way.swap_remove(at); // it never obstructs again
                continue;
            }
            if !triangle.contains(&q) && self.obstructs(q, triangle) {
                return true;
            }
            at += 1;
        }
        false
    }

    /// Returns whether corner `q` prevents the triangle from being cut off.
    ///
    /// A corner at exactly the position of `a`, `b` or `c` obstructs only if one of its sides runs
    /// into the triangle from there. Such corners occur along a slit to a hole.
    fn obstructs(&self, q: usize, triangle: [usize; 3]) -> bool {
        let [a, b, c] = triangle.map(|j| self.flat[j]);
        let at = self.flat[q];
        if turn(a, b, at) < 0.0 || turn(b, c, at) < 0.0 || turn(c, a, at) < 0.0 {
            return false;
        }
        let wedge = [[a, b, c], [b, c, a], [c, a, b]];
        let Some([tip, right, left]) = wedge.into_iter().find(|&[tip, ..]| tip == at) else {
            return true;
        };
        [self.before[q], self.after[q]].into_iter().any(|to| {
            let to = self.flat[to as usize];
            turn(tip, right, to) > 0.0 && turn(tip, to, left) > 0.0
        })
    }
}

/// Returns twice the signed area of the triangle: above 0 if a, b, c turn left.
///
/// The difference of two singles is exact in doubles if their sizes differ by a factor below 2²⁹. A
/// product rounds only in its last bits.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns the projection along the axis nearest to the Newell normal, in which the polygon runs
/// counter-clockwise.
fn view_along(corners: &[DVec3]) -> impl Fn(DVec3) -> DVec2 + use<> {
    let mut newell = Newell::default();
    corners.iter().for_each(|&p| newell.corner(p));
    let normal = newell.normal;
    let size = normal.abs();
    move |p| {
        let (seen, component) = if size.z >= size.x && size.z >= size.y {
            (DVec2::new(p.x, p.y), normal.z)
        } else if size.x >= size.y {
            (DVec2::new(p.y, p.z), normal.x)
        } else {
            (DVec2::new(p.z, p.x), normal.y)
        };
        if component < 0.0 { seen.yx() } else { seen }
    }
}
