//! Whether patches of holes would lie on the mesh, or on each other.

use std::hash::BuildHasher as _;
use std::ops::ControlFlow;

use glam::DVec3;
use rustc_hash::{FxBuildHasher, FxHashMap};
use sixfold_core::{FaceId, PolygonMesh, VertexId, row};
use sixfold_spatial::{Bvh, FaceTriangle, SpatialError, SpatialIndex, polygon_triangles};

/// A face lies on a patch within this part of the mean length of the hole's edges.
const REACH: f64 = 0.005;
/// The cosine of the largest angle between the planes of a patch and a face that lies on it: 0.02
/// radians. Where planes that meet in an edge differ by more, they leave the reach of each other
/// within a quarter of the length of the edge.
const PARALLEL: f64 = 0.9998;
/// The part of a patch, or of a square on each edge of the hole, that may lie on faces with a
/// corner in the hole.
const MOST_BESIDE: f64 = 0.25;
/// The part of a patch, or of one square on an edge of the hole, that may lie on other faces.
const MOST_ELSEWHERE: f64 = 1e-3;
/// Patches coincide if this part of the larger one lies on the other one.
const COINCIDENT: f64 = 0.9;
/// The number of edges up to which the parts of a patch are as fine as the edges.
const FINE_EDGES: f64 = 64.0;
/// The most that parts are coarser than edges where they are compared with the mesh, of patches with up
/// to 900 edges; for n edges √n / 5. A round patch has O(n) such parts.
const MOST_COARSE: f64 = 6.0;
/// A part of a patch is cut if more items than this lie on it.
const MOST_NEAR: usize = 48;
/// A part is cut further if more items than this lie on it, and of the parts that result, only this number is
/// looked for: there are more at a vertex of very many faces.
const MOST_AT_PART: usize = 256;
/// How many times shorter those parts are.
const CROWDED_PARTS: f64 = 16.0;
/// A part is not cut if the items on it have this many times its area, or more.
const MOST_LAYERS: f64 = 16.0;
/// The most items that a part is compared with.
const MOST_COMPARED: usize = 4096;
/// An item lies on a part if it covers more than this of it. A smaller area is only a rounding error.
const ROUNDING: f64 = 1e-9;
/// In a cube as long as a part, of more parts than this only some are compared, and count for the others.
const MOST_IN_CUBE: usize = 128;

/// The triangles that fill a hole.
pub(super) struct Patch {
    triangles: Vec<Piece>,
    area: f64,
    edges: usize,
    mean_edge: f64,
    /// The distance within which faces lie on the patch.
    reach: f64,
}

/// A triangle of a patch, or a part of it.
#[derive(Clone, Copy)]
struct Piece {
    corners: [DVec3; 3],
    triangle: [VertexId; 3],
}

impl Patch {
    pub(super) fn new(
        polygons: &PolygonMesh,
        hole: &[VertexId],
        triangles: &[[VertexId; 3]],
    ) -> Self {
        let position = |v: VertexId| polygons.position(v).as_dvec3();
        let next = hole.iter().cycle().skip(1);
        let sides = hole.iter().zip(next);
        let length: f64 = sides
            .map(|(&a, &b)| position(a).distance(position(b)))
            .sum();
        let edges = hole.len();
        let mean_edge = length / edges as f64;
        let pieces = triangles.iter().map(|&triangle| Piece {
            corners: triangle.map(position),
            triangle,
        });
        let triangles: Vec<Piece> = pieces.collect();
        let doubled = triangles.iter().map(|piece| normal(piece.corners).length());
        let area = 0.5 * doubled.sum::<f64>();
        // A patch is not wider than this if it is as long as half of its boundary.
        let width = 2.0 * area / length;
        Self {
            triangles,
            area,
            edges,
            mean_edge,
            reach: REACH * mean_edge.min(width),
        }
    }

    /// Returns the length of parts that are at most `most` times as long as edges. With n edges and no
    /// limit, there are O(n) such parts.
    fn part_length(&self, most: f64) -> f64 {
        1.5 * self.mean_edge * (self.edges as f64 / FINE_EDGES).clamp(1.0, most)
    }

    pub(super) fn area(&self) -> f64 {
        self.area
    }

    /// Returns whether a noticeable part of the patch is covered.
    pub(super) fn is_covered(&self, covered: Covered) -> bool {
        let square = self.mean_edge * self.mean_edge;
        covered.beside > MOST_BESIDE * self.area.min(self.edges as f64 * square)
            || covered.elsewhere > MOST_ELSEWHERE * self.area.min(square)
    }

    /// Calls `visit` with each item that lies on the patch, and the area of the part of the patch on
    /// which it lies; several times if it lies on several parts. If a part is near too many items to find all
    /// that lie on it, the last call for it is without an item, and the rest of the part counts as covered.
    /// Ends if `visit` returns true.
    ///
    /// Parts of the patch on which many items lie are cut down to `part_length`. Where many items lie on many
    /// parts, as around a vertex of many long triangles, the areas are estimates.
    fn find_covers<F: Copy + Send + Sync>(
        &self,
        index: &ByNormal<F>,
        part_length: f64,
        is_chosen: impl Fn(F) -> bool,
        mut visit: impl FnMut(Option<F>, f64) -> bool,
    ) {
        let mut finder = Finder {
            index,
            reach: self.reach,
            is_chosen,
            clipper: Clipper::default(),
            found: Vec::new(),
        };
        let mut crowds = Crowds::default();
        // Each with the number of parts for which it counts.
        let mut parts: Vec<([DVec3; 3], usize)> = Vec::new();
        for piece in &self.triangles {
            parts.push((piece.corners, 1));
            while let Some((part, mut count)) = parts.pop() {
                let size = 0.5 * normal(part).length();
                let mut are_all = finder.find(part, MOST_NEAR);
                if !are_all && finder.found_area() < MOST_LAYERS * size {
                    count = crowds.share(part, count);
                    if count == 0 {
                        continue;
                    }
                    if let Some(halves) = halves(part, part_length) {
                        parts.extend(halves.map(|half| (half, count)));
                        continue;
                    }
                    are_all = finder.find(part, MOST_AT_PART);
                    let shortest = part_length / CROWDED_PARTS;
                    if let Some(halves) = halves(part, shortest).filter(|_| !are_all) {
                        parts.extend(halves.map(|half| (half, count)));
                        continue;
                    }
                }
                let count = count as f64;
                for &(item, area) in &finder.found {
                    if visit(Some(item), count * area) {
                        return;
                    }
                }
                let rest = (size - finder.found_area()).max(0.0);
                if !are_all && visit(None, count * rest) {
                    return;
                }
            }
        }
    }
}

/// How many parts there are in cubes about as long as they are.
#[derive(Default)]
struct Crowds(FxHashMap<(i32, [i64; 3]), usize>);

impl Crowds {
    /// Adds a part that counts for `count` parts. Returns for how many it counts from here on: 0 if it
    /// is not needed. Of n parts in one cube, O(log n) are needed.
    fn share(&mut self, part: [DVec3; 3], count: usize) -> usize {
        let length = longest_side(part).1.sqrt();
        let level = length.log2().ceil();
        let centre = part.into_iter().sum::<DVec3>() / 3.0;
        let cube = (centre / level.exp2()).to_array();
        let cube = cube.map(|coordinate| coordinate.floor() as i64);
        let parts = self.0.entry((level as i32, cube)).or_default();
        *parts += count;
        let period = parts.div_ceil(MOST_IN_CUBE).next_power_of_two();
        if count >= period {
            return count;
        }
        // A hash does not follow the order of the parts.
        let drawn =
            FxBuildHasher.hash_one(part.map(|corner| corner.to_array().map(f64::to_bits))) >> 32;
        match (drawn * (period / count) as u64) >> 32 {
            0 => period,
            _ => 0,
        }
    }
}

/// Triangles by the direction of their normals, and then by place. So a patch among many triangles is
/// compared only with those that are nearly parallel to it.
struct ByNormal<F> {
    /// By cube of [`ByNormal::CUBE`] around the end of the unit normal.
    cubes: FxHashMap<[i8; 3], Bvh<FaceTriangle<F>>>,
}

impl<F: Copy + Send + Sync> ByNormal<F> {
    const CUBE: f64 = 0.05;
    /// The most that coordinates of unit normals differ if planes are nearly parallel.
    const APART: f64 = 0.0201;

    /// Sorts triangles; O(n log n).
    fn new(items: impl IntoIterator<Item = FaceTriangle<F>>) -> Result<Self, SpatialError> {
        let mut lists: FxHashMap<[i8; 3], Vec<FaceTriangle<F>>> = FxHashMap::default();
        for item in items {
            let up = item.normal().normalize_or_zero();
            // A triangle without area lies on nothing.
            if up != DVec3::ZERO {
                lists
                    .entry(up.to_array().map(Self::cube))
                    .or_default()
                    .push(item);
            }
        }
        let cubes = lists
            .into_iter()
            .map(|(cube, list)| Ok((cube, Bvh::build(list)?)));
        Ok(Self {
            cubes: cubes.collect::<Result<_, _>>()?,
        })
    }

    fn cube(coordinate: f64) -> i8 {
        (coordinate / Self::CUBE).floor() as i8
    }

    /// Calls `visit` with triangles until it breaks, among them those that are nearly parallel to a triangle
    /// and within `reach` of it.
    fn visit(
        &self,
        triangle: [DVec3; 3],
        reach: f64,
        mut visit: impl FnMut(&FaceTriangle<F>) -> ControlFlow<()>,
    ) {
        // Corners of parts are rounded.
        let corners = triangle.map(|corner| corner.as_vec3());
        let rounded = triangle.map(|corner| corner.abs().max_element());
        let rounding = rounded.into_iter().fold(0.0, f64::max) * f64::from(f32::EPSILON);
        let reach = ((reach + rounding) as f32).next_up();
        let shape = FaceTriangle { face: (), corners };
        let up = normal(triangle).normalize_or_zero();
        let mut end = ControlFlow::Continue(());
        for up in [up, -up] {
            let [x, y, z] = up
                .to_array()
                .map(|at| Self::cube(at - Self::APART)..=Self::cube(at + Self::APART));
            let cubes = x.flat_map(|x| y.clone().map(move |y| [x, y]));
            for cube in cubes.flat_map(|[x, y]| z.clone().map(move |z| [x, y, z])) {
                let Some(index) = self.cubes.get(&cube).filter(|_| end.is_continue()) else {
                    continue;
                };
                index.visit_meeting(&shape, reach, |slot| {
                    end = visit(&index.items()[slot]);
                    end
                });
            }
        }
    }
}

/// Finds the items that lie on a part of a patch.
struct Finder<'a, F, C> {
    index: &'a ByNormal<F>,
    reach: f64,
    is_chosen: C,
    clipper: Clipper,
    /// The items found last, and the area of the part on which each lies.
    found: Vec<(F, f64)>,
}

impl<F: Copy + Send + Sync, C: Fn(F) -> bool> Finder<'_, F, C> {
    /// Returns whether all items were found: there are at most `most`, and few others near the part.
    fn find(&mut self, part: [DVec3; 3], most: usize) -> bool {
        let Self {
            index,
            reach,
            is_chosen,
            clipper,
            found,
        } = self;
        let least = ROUNDING * 0.5 * normal(part).length();
        found.clear();
        let (mut compared, mut are_all) = (0, true);
        index.visit(part, *reach, |item| {
            if is_chosen(item.face) {
                compared += 1;
                let area = clipper.covered_area(part, item.corners_f64(), *reach);
                if area > least {
                    found.push((item.face, area));
                }
            }
            are_all = compared <= MOST_COMPARED && found.len() <= most;
            match are_all {
                true => ControlFlow::Continue(()),
                false => ControlFlow::Break(()),
            }
        });
        are_all
    }

    fn found_area(&self) -> f64 {
        self.found.iter().map(|(_, area)| area).sum()
    }
}

/// The area of the part of a patch on which faces lie.
#[derive(Clone, Copy, Default)]
pub(super) struct Covered {
    /// By faces with a corner in the hole.
    beside: f64,
    /// By other faces.
    elsewhere: f64,
}

impl Covered {
    fn add(&mut self, is_beside: bool, area: f64) {
        match is_beside {
            true => self.beside += area,
            false => self.elsewhere += area,
        }
    }

    pub(super) fn with(self, other: Self) -> Self {
        Self {
            beside: self.beside + other.beside,
            elsewhere: self.elsewhere + other.elsewhere,
        }
    }

    fn area(self) -> f64 {
        self.beside + self.elsewhere
    }
}

/// The surface before holes are filled.
pub(super) struct Surface<'a> {
    polygons: &'a PolygonMesh,
    index: Option<ByNormal<FaceId>>,
}

impl<'a> Surface<'a> {
    pub(super) fn new(polygons: &'a PolygonMesh) -> Self {
        // Without an index, because a coordinate is not finite, nothing lies on a patch.
        let index = polygon_triangles(polygons).and_then(ByNormal::new).ok();
        Self { polygons, index }
    }

    /// Returns the part of a patch on which faces lie, or less of it if this is too much already.
    /// `is_in_hole` is true for the vertices of the hole.
    pub(super) fn on(&self, patch: &Patch, is_in_hole: impl Fn(VertexId) -> bool) -> Covered {
        let mut covered = Covered::default();
        if let Some(index) = &self.index {
            let most_coarse = MOST_COARSE.max(0.2 * (patch.edges as f64).sqrt());
            let length = patch.part_length(most_coarse);
            patch.find_covers(
                index,
                length,
                |_| true,
                |f, area| {
                    let face = f.map_or(&[][..], |f| self.polygons.faces().face(f));
                    covered.add(face.iter().any(|&v| is_in_hole(v)), area);
                    patch.is_covered(covered)
                },
            );
        }
        covered
    }
}

/// Several patches, by place.
pub(super) struct Patches<'a> {
    patches: Vec<&'a Patch>,
    /// Their triangles, each with the number of its patch.
    index: Option<ByNormal<(u32, [VertexId; 3])>>,
}

impl<'a> Patches<'a> {
    /// Sorts patches; O(n log n).
    pub(super) fn new(patches: Vec<&'a Patch>) -> Self {
        let mut items = Vec::new();
        for (number, patch) in patches.iter().enumerate() {
            patch.add_pieces(row(number), &mut items);
        }
        let index = ByNormal::new(items).ok();
        Self { patches, index }
    }

    /// Returns the patches that lie on a patch, each with its part; `None` if there are too many to tell them
    /// apart. `is_in_hole` is true for the vertices of the hole.
    pub(super) fn on(
        &self,
        number: usize,
        is_in_hole: impl Fn(VertexId) -> bool,
    ) -> Option<Vec<(usize, Covered)>> {
        let patch = self.patches[number];
        let mut covers: FxHashMap<usize, Covered> = FxHashMap::default();
        let mut are_known = true;
        if let Some(index) = &self.index {
            let is_other = |(other, _)| other as usize != number;
            let length = patch.part_length(f64::INFINITY);
            patch.find_covers(index, length, is_other, |item, area| {
                let Some((other, triangle)) = item else {
                    are_known = false;
                    return true;
                };
                let other = covers.entry(other as usize).or_default();
                other.add(triangle.into_iter().any(&is_in_hole), area);
                false
            });
        }
        let mut covers: Vec<_> = covers.into_iter().collect();
        covers.sort_unstable_by_key(|&(other, _)| other);
        are_known.then_some(covers)
    }
}

impl Patch {
    /// Appends the triangles as items of an index; many of them in pieces, whose boxes overlap less.
    fn add_pieces(&self, number: u32, items: &mut Vec<FaceTriangle<(u32, [VertexId; 3])>>) {
        let length = match self.edges as f64 <= FINE_EDGES {
            true => f64::INFINITY,
            false => self.part_length(f64::INFINITY),
        };
        for piece in &self.triangles {
            let mut parts = vec![piece.corners];
            while let Some(part) = parts.pop() {
                match halves(part, length) {
                    Some(halves) => parts.extend(halves),
                    None => items.push(FaceTriangle {
                        face: (number, piece.triangle),
                        corners: part.map(|corner| corner.as_vec3()),
                    }),
                }
            }
        }
    }
}

/// Returns whether two patches coincide, one of which covers this part of the other.
pub(super) fn coincide(one: &Patch, other: &Patch, covered: Covered) -> bool {
    covered.area() > COINCIDENT * one.area.max(other.area)
}

/// Returns the first corner of the longest side of a triangle, and the square of its length.
fn longest_side(triangle: [DVec3; 3]) -> (usize, f64) {
    let length = |i: usize| triangle[i].distance_squared(triangle[(i + 1) % 3]);
    let longest = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j)));
    let first = longest.expect("three sides");
    (first, length(first))
}

/// Returns the halves of a triangle, cut across its longest side; `None` if no side is longer than
/// `longest`.
fn halves(triangle: [DVec3; 3], longest: f64) -> Option<[[DVec3; 3]; 2]> {
    let (first, square) = longest_side(triangle);
    let [a, b, c] = [0, 1, 2].map(|i| triangle[(first + i) % 3]);
    let middle = 0.5 * (a + b);
    let is_long = square > longest * longest;
    is_long.then_some([[a, middle, c], [middle, b, c]])
}

/// Returns the normal whose length is twice the area.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Clips triangles; keeps its memory.
#[derive(Default)]
struct Clipper {
    polygon: Vec<DVec3>,
    clipped: Vec<DVec3>,
}

impl Clipper {
    /// Returns the area of the part of a triangle that has the other triangle above or below it
    /// within `reach`; 0 if their planes are not nearly parallel.
    fn covered_area(&mut self, triangle: [DVec3; 3], other: [DVec3; 3], reach: f64) -> f64 {
        let up = normal(triangle).normalize_or_zero();
        let across = normal(other);
        let is_parallel = up.dot(across).abs() > PARALLEL * across.length();
        if !is_parallel {
            return 0.0;
        }
        let [a, b, c] = triangle;
        self.polygon.clear();
        self.polygon.extend(other.map(|corner| corner - a));
        self.clip(up, reach);
        self.clip(-up, reach);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let inward = up.cross(to - from);
            self.clip(inward, -inward.dot(from - a));
        }
        let Some(&first) = self.polygon.first() else {
            return 0.0;
        };
        let sides = self.polygon.windows(2);
        let sum: DVec3 = sides.map(|p| (p[0] - first).cross(p[1] - first)).sum();
        0.5 * up.dot(sum).abs()
    }

    /// Keeps the part of the polygon where `direction · p + offset` is not negative.
    fn clip(&mut self, direction: DVec3, offset: f64) {
        self.clipped.clear();
        let height = |p: DVec3| direction.dot(p) + offset;
        for i in 0..self.polygon.len() {
            let [p, q] = [self.polygon[i], self.polygon[(i + 1) % self.polygon.len()]];
            let [at_p, at_q] = [height(p), height(q)];
            if at_p >= 0.0 {
                self.clipped.push(p);
            }
            if (at_p >= 0.0) != (at_q >= 0.0) {
                self.clipped.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
        std::mem::swap(&mut self.polygon, &mut self.clipped);
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::super::tests::scattered;
    use super::*;

    /// Around a vertex of many triangles, the covered area is an estimate from a few parts of the patch.
    #[test]
    fn the_covered_area_around_a_hub_is_estimated() {
        let count = 1024;
        let rim = (0..count).map(|i| {
            let (sin, cos) = (i as f32 * std::f32::consts::TAU / count as f32).sin_cos();
            [cos, sin, 0.0]
        });
        let faces = (0..count).map(|i| [i, (i + 1) % count, count]);
        let fan = PolygonMesh::new(rim.chain([[0.0; 3]]), faces).expect("valid");
        let hole: Vec<VertexId> = (0..count).map(VertexId::new).collect();
        let triangles: Vec<[VertexId; 3]> = fan
            .faces()
            .iter()
            .map(|(_, face)| [face[0], face[1], face[2]])
            .collect();
        let patch = Patch::new(&fan, &hole, &triangles);
        // All of the fan, half of it, and each second triangle.
        let parts: [(&dyn Fn(usize) -> bool, f64); 3] = [
            (&|_| true, 1.0),
            (&|f| f < count as usize / 2, 0.5),
            (&|f| f % 2 == 0, 0.5),
        ];
        for (is_in, part) in parts {
            let mut items = polygon_triangles(&fan).expect("finite");
            items.retain(|item| is_in(item.face.index()));
            let index = ByNormal::new(items).expect("finite");
            let (mut area, mut visits) = (0.0, 0);
            patch.find_covers(
                &index,
                0.1,
                |_| true,
                |_, covered| {
                    area += covered;
                    visits += 1;
                    false
                },
            );
            let expected = part * patch.area();
            assert!((area / expected - 1.0).abs() < 0.15, "{area} {expected}");
            // All pairs at the centre alone would be ten times as many.
            assert!(visits < 100 * count, "{visits}");
        }
    }

    /// Among triangles in all directions, a patch is compared with few.
    #[test]
    fn a_patch_is_compared_with_few_triangles() {
        let comparisons = |count: u32| {
            let triangles = scattered(count);
            let items = polygon_triangles(&triangles).expect("finite");
            let index = ByNormal::new(items).expect("finite");
            let comparisons = Cell::new(0);
            for (f, face) in triangles.faces().iter() {
                let patch = Patch::new(&triangles, face, &[[face[0], face[1], face[2]]]);
                let compare = |_| {
                    comparisons.set(comparisons.get() + 1);
                    true
                };
                let mut area = 0.0;
                patch.find_covers(&index, f64::INFINITY, compare, |other, covered| {
                    area += if other == Some(f) { covered } else { 0.0 };
                    false
                });
                assert!((area / patch.area() - 1.0).abs() < 1e-6);
            }
            comparisons.get()
        };
        let [few, many] = [1000, 4000].map(comparisons);
        assert!(many < 4_000_000 / 8 && many < 16 * few, "{few} {many}");
    }

    /// Patches at one place are not told apart if there are many, without a search of their parts.
    #[test]
    fn many_patches_at_one_place_cover_each_other() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p.as_vec3());
        let triangle = PolygonMesh::new(points, [[0, 1, 2]]).expect("valid");
        let corners = [0, 1, 2].map(VertexId::new);
        for (count, are_known) in [(40, true), (400, false)] {
            let patch = || Patch::new(&triangle, &corners, &[corners]);
            let patches: Vec<Patch> = (0..count).map(|_| patch()).collect();
            let patches = Patches::new(patches.iter().collect());
            let covers = patches.on(7, |_| true);
            assert_eq!(covers.is_some(), are_known);
            assert_eq!(covers.map_or(39, |covers| covers.len()), 39);
        }
    }
}
