//! Whether patches of holes would lie on the mesh, or on each other.

use glam::DVec3;
use sixfold_core::{PolygonMesh, VertexId};
use sixfold_spatial::{Bvh, FaceTriangle, SpatialIndex, polygon_triangles};

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
/// The number of edges up to which a patch is cut into pieces that are as long as 1.5 edges.
const FINE_EDGES: f64 = 64.0;

/// The triangles that fill a hole, cut into pieces.
///
/// The pieces have about the same size, so that few triangles are near each of them. A hole with n
/// edges has O(n) pieces.
pub(super) struct Patch {
    pieces: Vec<Piece>,
    area: f64,
    edges: usize,
    mean_edge: f64,
    /// The distance within which faces lie on the patch.
    reach: f64,
}

/// A part of a triangle of a patch.
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
        let longest = 1.5 * mean_edge * f64::max(1.0, edges as f64 / FINE_EDGES);
        let (mut pieces, mut area) = (Vec::new(), 0.0);
        for &triangle in triangles {
            let corners = triangle.map(position);
            area += 0.5 * normal(corners).length();
            cut(corners, longest, &mut |corners| {
                pieces.push(Piece { corners, triangle });
            });
        }
        // A patch is not wider than this if it is as long as half of its boundary.
        let width = 2.0 * area / length;
        Self {
            pieces,
            area,
            edges,
            mean_edge,
            reach: REACH * mean_edge.min(width),
        }
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

    /// Calls `visit` with the number of each item that lies on the patch, and the area of the part of
    /// the patch on which it lies; several times if it lies on several pieces. `corners` returns the
    /// corners of an item.
    fn for_each_cover<F: Copy + Send + Sync>(
        &self,
        index: &Bvh<FaceTriangle<F>>,
        corners: impl Fn(&FaceTriangle<F>) -> [DVec3; 3],
        mut visit: impl FnMut(F, f64),
    ) {
        let mut clipper = Clipper::default();
        for piece in &self.pieces {
            let [a, b, c] = piece.corners;
            let centre = (a + b + c) / 3.0;
            let far = piece.corners.map(|corner| corner.distance(centre));
            let radius = far.into_iter().fold(0.0, f64::max) + self.reach;
            let limit = radius * radius;
            let low = a.min(b).min(c) - self.reach;
            let high = a.max(b).max(c) + self.reach;
            index.visit_near(centre, limit, |slot| {
                let item = &index.items()[slot];
                let other = corners(item);
                let [p, q, r] = other;
                let is_apart =
                    p.max(q).max(r).cmplt(low).any() || p.min(q).min(r).cmpgt(high).any();
                if !is_apart {
                    let area = clipper.covered_area(piece.corners, other, self.reach);
                    if area > 0.0 {
                        visit(item.face, area);
                    }
                }
                limit
            });
        }
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
    index: Option<Bvh<FaceTriangle<sixfold_core::FaceId>>>,
}

impl<'a> Surface<'a> {
    pub(super) fn new(polygons: &'a PolygonMesh) -> Self {
        // Without an index, because a coordinate is not finite, nothing lies on a patch.
        let index = polygon_triangles(polygons).and_then(Bvh::build).ok();
        Self { polygons, index }
    }

    /// Returns the part of a patch on which faces lie. `is_in_hole` is true for the vertices of the
    /// hole.
    pub(super) fn on(&self, patch: &Patch, is_in_hole: impl Fn(VertexId) -> bool) -> Covered {
        let mut covered = Covered::default();
        if let Some(index) = &self.index {
            let corners = |item: &FaceTriangle<_>| item.corners.map(|corner| corner.as_dvec3());
            patch.for_each_cover(index, corners, |f, area| {
                let mut face = self.polygons.faces().face(f).iter();
                covered.add(face.any(|&v| is_in_hole(v)), area);
            });
        }
        covered
    }
}

/// The pieces of several patches.
pub(super) struct Patches<'a> {
    /// The pieces, each with the number of its patch.
    pieces: Vec<(usize, &'a Piece)>,
    index: Option<Bvh<FaceTriangle<u32>>>,
}

impl<'a> Patches<'a> {
    /// Sorts the pieces of patches; O(n log n).
    pub(super) fn new(patches: impl ExactSizeIterator<Item = &'a Patch>) -> Self {
        // One patch lies on no other.
        let patches = Some(patches).filter(|patches| patches.len() > 1);
        let numbered = patches.into_iter().flatten().enumerate();
        let pieces = numbered.flat_map(|(p, patch)| patch.pieces.iter().map(move |at| (p, at)));
        let pieces: Vec<(usize, &Piece)> = pieces.collect();
        let items = (0..).zip(&pieces).map(|(face, (_, piece))| FaceTriangle {
            face,
            corners: piece.corners.map(|corner| corner.as_vec3()),
        });
        let index = Bvh::build(items.collect()).ok();
        Self { pieces, index }
    }

    /// Returns the patches that lie on a patch, in order, each with its part. `is_in_hole` is true for
    /// the vertices of the hole.
    pub(super) fn on(
        &self,
        patch: &Patch,
        number: usize,
        is_in_hole: impl Fn(VertexId) -> bool,
    ) -> Vec<(usize, Covered)> {
        let mut covers = std::collections::BTreeMap::<usize, Covered>::new();
        if let Some(index) = &self.index {
            // The corners in double precision.
            let corners = |item: &FaceTriangle<u32>| self.pieces[item.face as usize].1.corners;
            patch.for_each_cover(index, corners, |piece, area| {
                let (other, piece) = self.pieces[piece as usize];
                if other != number {
                    let is_beside = piece.triangle.into_iter().any(&is_in_hole);
                    covers.entry(other).or_default().add(is_beside, area);
                }
            });
        }
        covers.into_iter().collect()
    }
}

/// Returns whether two patches coincide, one of which covers this part of the other.
pub(super) fn coincide(one: &Patch, other: &Patch, covered: Covered) -> bool {
    covered.area() > COINCIDENT * one.area.max(other.area)
}

/// Calls `visit` with the parts of a triangle whose sides are not longer than `longest`. Triangles
/// without area are left out.
fn cut(triangle: [DVec3; 3], longest: f64, visit: &mut impl FnMut([DVec3; 3])) {
    let mut parts = vec![triangle];
    while let Some(part) = parts.pop() {
        // The first side is the longest one.
        let length = |i: usize| part[i].distance_squared(part[(i + 1) % 3]);
        let first = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j)));
        let first = first.unwrap_or(0);
        let [a, b, c] = [0, 1, 2].map(|i| part[(first + i) % 3]);
        if length(first) > longest * longest {
            let middle = 0.5 * (a + b);
            parts.extend([[a, middle, c], [middle, b, c]]);
        } else if normal(part) != DVec3::ZERO {
            visit(part);
        }
    }
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
