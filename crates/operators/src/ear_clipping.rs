//! One polygon cut into triangles, ear by ear.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3, Vec2Swizzles};

use crate::normals::Newell;

/// Cuts polygons; its tables are reused from one to the next.
///
/// ```text
///    d ─────── c
///     ╲        ┆ ╲        An ear is a convex corner b whose diagonal a–c runs inside: no other
///      e       ┆  b       corner lies in the triangle a b c. Each simple polygon of four corners
///     ╱        ┆ ╱        or more has two (Meisters 1975), and without its ear it is one again.
///    f ─────── a
/// ```
///
/// Only corners that are not convex, as e, need to be looked for in a triangle, and cutting b
/// changes nothing but the ears at a and c.
///
/// Corners are seen along the axis nearest to the Newell normal. For a plane polygon this picture is
/// an affine one, so that ears are ears; and its coordinates are those of the corners, bit by bit,
/// so that corners on a line are on a line. The sign of an area is taken in doubles.
///
/// Of all ears the best shaped is cut first, by its area over the square of its longest side, and
/// one whose diagonal is an edge elsewhere last of all.
#[derive(Default)]
pub(crate) struct EarClipping {
    solid: Vec<DVec3>,
    flat: Vec<DVec2>,
    before: Vec<u32>,
    after: Vec<u32>,
    /// How often the ear at a corner has been looked at; what the heap knows from before is stale.
    looked: Vec<u32>,
    gone: Vec<bool>,
    /// Corners that may lie in the way: neither convex nor gone, when they were last looked at.
    in_the_way: Vec<u32>,
    ears: BinaryHeap<Ear>,
}

/// An ear, the better the greater.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ear {
    /// Its diagonal is no edge elsewhere.
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
    /// Hands `cut` the `n − 2` triangles of the polygon, as numbers of its `n` corners, each
    /// counter-clockwise as the polygon is; `taken` says whether a diagonal is an edge elsewhere.
    ///
    /// A polygon that crosses itself or lies on a line may run out of ears. Then all corners are
    /// looked at again, once for each halving of their number, and failing that the best of the
    /// convex corners is cut, or any: n − 2 triangles come of it always, and O(n²) work at most.
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
            // At the last cut the worse of two triangles counts: all four corners are looked at.
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

    /// Lays the polygon out, all corners in place and none looked at.
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

    /// Finds all ears of the polygon as it is now.
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

    /// Looks whether there is an ear at corner `i` now.
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

    /// The best corner to cut where there is no ear.
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

    /// Twice the area over the square of the longest side: √3/2 at best.
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

    /// Whether another corner lies in the triangle at the convex corner `i`, or on its diagonal.
    fn is_obstructed(&mut self, i: usize) -> bool {
        let triangle = self.triangle(i);
        let mut at = 0;
        while let Some(&q) = self.in_the_way.get(at) {
            let q = q as usize;
            if self.gone[q] || self.is_convex(q) {
                self.in_the_way.swap_remove(at); // it has become convex, and stays so
                continue;
            }
            if !triangle.contains(&q) && self.obstructs(q, triangle) {
                return true;
            }
            at += 1;
        }
        false
    }

    /// Whether corner `q` keeps the triangle from being cut off.
    ///
    /// One at the very place of `a`, `b` or `c`, as where a slit leads to a hole, does so only if
    /// one of its sides runs into the triangle from there.
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

/// Above 0 where a, b, c turn left: twice the area of the triangle.
///
/// Differences of singles that lie within 2²⁹ of each other in size are exact in doubles, and a
/// product rounds only in its last bits.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Leaves out the coordinate along which the polygon is thinnest, so that it runs counter-clockwise.
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
