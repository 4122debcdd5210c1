//! Triangulation: cuts polygons into triangles on the same vertices.

mod conflicts;
mod ears;
mod exhaustive;
mod loops;
mod outside;
mod overlap;
mod plane;
mod regions;

use glam::{DVec2, DVec3};

use self::ears::{EarClipping, Shape};
use crate::handles::pair::Pair;
use crate::handles::row_id::{FaceId, VertexId};
use crate::polygons::error::PolygonError;
use crate::polygons::face_list::FaceList;
use crate::polygons::polygon_mesh::{PolygonMesh, repeated};

/// A mesh whose polygons were cut into triangles.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Triangulated {
    /// The mesh of triangles. A polygon of `n` corners is replaced by `n − 2` triangles, in the order
    /// of the polygons.
    pub polygons: PolygonMesh,
    /// The polygons that cross themselves, ascending. Some of their triangles overlap.
    pub crossing: Vec<FaceId>,
}

impl PolygonMesh {
    /// Returns the mesh in which each polygon of `n` corners is replaced by `n − 2` triangles.
    ///
    /// ```text
    ///    d ─────── c           d ─────── c
    ///     ╲        │            ╲    ╱   │      The triangles do not overlap, and none is turned
    ///      e       │     ⇒       e       │      over, also if the polygon is not convex. A fan from
    ///     ╱        │            ╱    ╲   │      corner a would cover the hollow at e.
    ///    a ─────── b           a ─────── b
    /// ```
    ///
    /// The result has the same vertices. Triangles have the orientation of their polygon, and each
    /// side of the polygon is a side of one of them. A face with three corners is unchanged.
    /// [`PolygonCutter::cut`] says how a polygon is cut.
    ///
    /// Diagonals that are already edges of the mesh are avoided, because these edges would then have
    /// three or more faces. If there is no other diagonal, the polygon is cut there anyway.
    /// Structures that hold only manifolds then reject the mesh with an error that names the edge.
    ///
    /// # Errors
    ///
    /// Returns [`PolygonError::TooMany`] if the triangles have more corners than 32-bit indices can
    /// number.
    ///
    /// # Complexity
    ///
    /// O(corners) expected for faces of bounded degree; [`PolygonCutter::cut`] states the time for
    /// one face.
    ///
    /// # Examples
    ///
    /// ```
    /// use sixfold_core::{Point, PolygonMesh};
    ///
    /// // An arrow head, not convex at v3: the only diagonal inside is v1–v3.
    /// let points = [[0.0, 0.0], [2.0, -1.0], [0.0, 2.0], [0.5, 0.5]].map(|[x, y]| Point::new(x, y, 0.0));
    /// let arrow = PolygonMesh::new(points, [[0, 1, 2, 3]])?;
    /// let cut = arrow.triangulated()?;
    /// assert!(cut.crossing.is_empty());
    /// assert!(cut.polygons.faces().iter().all(|(_, face)| {
    ///     face.iter().any(|v| v.index() == 1) && face.iter().any(|v| v.index() == 3)
    /// }));
    /// # Ok::<(), sixfold_core::PolygonError>(())
    /// ```
    pub fn triangulated(&self) -> Result<Triangulated, PolygonError> {
        let mut triangles = FaceList::with_capacity(self.corner_count());
        let mut crossing = Vec::new();
        let mut diagonals = Vec::new();
        let mut cutter = PolygonCutter::default();
        for (f, face) in self.faces().iter() {
            if cutter.face_crosses(self, face, |_, _| false) {
                crossing.push(f);
            }
            cutter
                .triangles
                .iter()
                .try_for_each(|t| triangles.push(t.map(|i| face[i])))?;
            diagonals.extend(cutter.diagonals(face).map(|diagonal| (diagonal, f)));
        }
        let again = conflicts::faces(self, &diagonals);
        if !again.is_empty() {
            triangles = self.cut_again(&triangles, &again, &diagonals)?;
        }
        let polygons = Self::from_faces(self.positions().to_vec(), triangles)?;
        Ok(Triangulated { polygons, crossing })
    }

    /// Returns the polygons that cross themselves, ascending: those for which
    /// [`PolygonCutter::cut`] says so, without the triangles. A fan or a Newell vector of such a
    /// polygon has another area than its outline shows.
    ///
    /// O(1) for a triangle or a convex quad; [`PolygonCutter::cut`] states the time for others.
    pub fn crossing_faces(&self) -> Vec<FaceId> {
        let mut cutter = PolygonCutter::default();
        let polygons = self.faces().iter().filter(|(_, face)| face.len() > 3);
        let crossing = polygons.filter(|(_, face)| cutter.face_crosses(self, face, |_, _| false));
        crossing.map(|(f, _)| f).collect()
    }

    /// Returns `triangles` with another cut of the faces `again`, which avoids all sides of faces and
    /// all diagonals.
    fn cut_again(
        &self,
        triangles: &FaceList,
        again: &[FaceId],
        diagonals: &[(Pair<VertexId>, FaceId)],
    ) -> Result<FaceList, PolygonError> {
        let is_kept = |f: &FaceId| again.binary_search(f).is_err();
        let diagonals = diagonals.iter().filter(|(_, f)| is_kept(f));
        let mut edges = conflicts::edges(self, again, diagonals.map(|&(diagonal, _)| diagonal));
        let mut list = FaceList::with_capacity(triangles.corners().len());
        let mut cutter = PolygonCutter::default();
        let mut before = triangles.iter().map(|(_, triangle)| triangle);
        for (f, face) in self.faces().iter() {
            let before = before.by_ref().take(face.len() - 2);
            if is_kept(&f) {
                before
                    .into_iter()
                    .try_for_each(|triangle| list.push(triangle.iter().copied()))?;
                continue;
            }
            before.for_each(drop);
            cutter.face_crosses(self, face, |i, j| edges[Pair::new(face[i], face[j])]);
            cutter
                .triangles
                .iter()
                .try_for_each(|t| list.push(t.map(|i| face[i])))?;
            cutter
                .diagonals(face)
                .for_each(|diagonal| edges[diagonal] = true);
        }
        Ok(list)
    }
}

/// The triangles of one polygon, by [`PolygonCutter::cut`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PolygonTriangles<'a> {
    /// For each triangle three corner numbers, from 0 to `n − 1`, in the orientation of the polygon.
    pub triangles: &'a [[usize; 3]],
    /// Whether the polygon crosses itself. Some of the triangles overlap, and some can be turned over.
    pub is_crossing: bool,
}

/// The faces that [`PolygonCutter::parts`] makes of one face.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FaceParts {
    corners: Vec<usize>,
    degree: usize,
    /// Whether the face was cut and crosses itself, so that its parts overlap.
    pub is_crossing: bool,
}

impl FaceParts {
    /// Returns the parts, each as the numbers of its corners in the face.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[usize]> + Clone {
        self.corners.chunks_exact(self.degree)
    }
}

/// Cuts polygons into triangles, one polygon at a time; keeps its memory for the next one.
///
/// # Examples
///
/// ```
/// use sixfold_core::PolygonCutter;
/// use sixfold_core::glam::DVec3;
///
/// // Two squares that meet in a point.
/// let corners = [[0, 0], [1, 0], [1, 1], [2, 1], [2, 2], [1, 2], [1, 1], [0, 1]];
/// let at = |[x, y]: [i32; 2]| DVec3::new(f64::from(x), f64::from(y), 0.0);
/// let mut cutter = PolygonCutter::default();
/// let cut = cutter.cut(corners.map(at), |_, _| false);
/// assert_eq!((cut.triangles.len(), cut.is_crossing), (6, false));
/// let area = |t: &[usize; 3]| {
///     let [a, b, c] = t.map(|i| at(corners[i]));
///     0.5 * (b - a).cross(c - a).z
/// };
/// assert!(cut.triangles.iter().all(|t| area(t) >= 0.0));
/// assert_eq!(cut.triangles.iter().map(area).sum::<f64>(), 2.0);
/// ```
#[derive(Default)]
pub struct PolygonCutter {
    corners: Vec<DVec3>,
    /// The corners in the plane.
    projected: Vec<DVec2>,
    ears: EarClipping,
    /// The triangles of the last polygon.
    triangles: Vec<[usize; 3]>,
    /// The triangles of an attempt.
    tried: Vec<[usize; 3]>,
}

impl PolygonCutter {
    /// Cuts one polygon of `n` corners into `n − 2` triangles.
    ///
    /// - The triangles of a simple polygon do not overlap and are not flat, even if some corners of
    ///   the polygon are collinear.
    /// - The triangles of a polygon that touches itself, but does not cross itself, do not overlap
    ///   either, and none is turned over. Some can be flat: a spike that runs out and back on the
    ///   same line has no area. Corners of such a polygon may have the same position.
    /// - A polygon that crosses itself winds clockwise around some points, or twice around some, and has
    ///   no such triangles. It is cut nevertheless, with as little area turned over or overlapping as
    ///   was found. If this is at most a millionth of the area, the polygon does not count as crossing:
    ///   where it touches itself, rounded coordinates cross.
    /// - The number of corners and sides that tests look at is limited, to 50 million and 300 for each
    ///   corner. If this is not enough, the polygon counts as crossing unless the triangles that were
    ///   found are right.
    ///
    /// A polygon that is not planar is projected along the axis nearest to its Newell normal. If it
    /// crosses itself there, it is projected along the normal itself. Signs of areas are exact.
    ///
    /// `is_edge` returns whether a diagonal between two corner numbers is already an edge of the
    /// mesh. Such a diagonal is used only if there is no other. A polygon with fewer than three
    /// corners has no triangles.
    ///
    /// # Algorithm
    ///
    /// A polygon of 32 or more corners is divided where it touches itself in corners, if the parts lie
    /// beside each other. Ears are clipped (Meisters 1975), the one with the best shape first. If a triangle of the
    /// result is turned over, the polygon is not simple, and its ears are clipped by rules for
    /// polygons that touch themselves. If this fails, too, and the polygon has at most 256 corners,
    /// all triangulations are compared by dynamic programming (Klincsek 1980).
    ///
    /// # Complexity
    ///
    /// O(n log n) time for most polygons of `n` corners: a test of an ear looks only at corners near it. Up
    /// to O(n²) if very many long triangles cross each other, until the limit of the tests, then O(n). O(n³)
    /// for at most 256 corners that ear clipping does not solve, unless sides cross in very many places.
    pub fn cut(
        &mut self,
        corners: impl IntoIterator<Item = DVec3>,
        is_edge: impl Fn(usize, usize) -> bool,
    ) -> PolygonTriangles<'_> {
        let is_crossing = self.crosses(corners, is_edge);
        PolygonTriangles {
            triangles: &self.triangles,
            is_crossing,
        }
    }

    /// Makes faces without repeated vertices of a face with the corners `face`, which may name
    /// vertices repeatedly. `position(i)` is the position of corner `i`.
    ///
    /// ```text
    ///     b ─── c       d ─── e         The face a b c a d e names a twice: it is cut into
    ///       ╲   │       │   ╱           triangles. Of corners that repeat the corner before
    ///         ╲ │       │ ╱             them, such as a a b c, only the first remains, and a
    ///           a       a               part with fewer than three corners is left out.
    /// ```
    ///
    /// A spike that runs out and back on one edge, such as b c b, is removed.
    ///
    /// The parts have the area of the face if corners with the same vertex have the same position
    /// ([`cut`](Self::cut) says for which polygons). The time is that of `cut`, or O(n) if only
    /// neighbours repeat.
    pub fn parts(&mut self, face: &[VertexId], position: impl Fn(usize) -> DVec3) -> FaceParts {
        let corners = without_spikes(face);
        let vertices: Vec<VertexId> = corners.iter().map(|&i| face[i]).collect();
        if corners.len() < 3 || repeated(&vertices).is_none() {
            let degree = corners.len().max(3);
            return FaceParts {
                corners,
                degree,
                is_crossing: false,
            };
        }
        let is_same = |i: usize, j: usize| vertices[i] == vertices[j];
        // By the rules for simple polygons, a polygon that touches itself can get flat triangles that a
        // spike would do without.
        let methods = [TOUCHING, Method::Exhaustive];
        let is_crossing = self.crosses_by(&methods, corners.iter().map(|&i| position(i)), is_same);
        let has_area =
            |&&[a, b, c]: &&[usize; 3]| !is_same(a, b) && !is_same(b, c) && !is_same(c, a);
        let triangles = self.triangles.iter().filter(has_area);
        FaceParts {
            corners: triangles.flatten().map(|&i| corners[i]).collect(),
            degree: 3,
            is_crossing,
        }
    }

    /// Cuts a face of a mesh. Returns whether it crosses itself.
    fn face_crosses(
        &mut self,
        polygons: &PolygonMesh,
        face: &[VertexId],
        is_edge: impl Fn(usize, usize) -> bool,
    ) -> bool {
        self.crosses(
            face.iter().map(|&v| polygons.position(v).as_dvec3()),
            is_edge,
        )
    }

    /// Returns the sides of the triangles that are not sides of the face that was cut.
    fn diagonals(&self, face: &[VertexId]) -> impl Iterator<Item = Pair<VertexId>> {
        let n = face.len();
        // Each diagonal is the side from the last corner of a triangle to its first.
        let ends = self.triangles.iter().map(|&[a, _, c]| [a.min(c), a.max(c)]);
        let inner = ends.filter(move |[a, c]| c - a > 1 && c - a < n - 1);
        inner.map(|[a, c]| Pair::new(face[a], face[c]))
    }

    /// Cuts a polygon like [`cut`](Self::cut). Returns whether it crosses itself.
    fn crosses(
        &mut self,
        corners: impl IntoIterator<Item = DVec3>,
        is_edge: impl Fn(usize, usize) -> bool,
    ) -> bool {
        self.crosses_by(&[SIMPLE, TOUCHING, Method::Exhaustive], corners, is_edge)
    }

    /// Cuts a polygon like [`crosses`](Self::crosses), by the first of `methods` that succeeds.
    fn crosses_by(
        &mut self,
        methods: &[Method],
        corners: impl IntoIterator<Item = DVec3>,
        is_edge: impl Fn(usize, usize) -> bool,
    ) -> bool {
        self.corners.clear();
        self.corners.extend(corners);
        self.triangles.clear();
        if self.corners.len() < 4 {
            let triangle = (self.corners.len() == 3).then_some([0, 1, 2]);
            self.triangles.extend(triangle);
            return false;
        }
        let normal = plane::normal(&self.corners);
        plane::project_along_axis(&self.corners, normal, &mut self.projected);
        if let Some(triangles) = convex_quad(&self.corners, &self.projected, &is_edge) {
            self.triangles.extend(triangles);
            return false;
        }
        let along_axis = std::mem::take(&mut self.projected);
        self.ears.start(self.corners.len());
        let mut least = self.cut_loops(&along_axis, &is_edge);
        if least == 0.0 {
            return false;
        }
        for &method in methods {
            least = self.improve(least, &along_axis, method, &is_edge);
            if least == 0.0 {
                return false;
            }
            // No method makes right triangles of such a polygon.
            if least > MAX_WRONG && plane::is_tangled(&along_axis) {
                break;
            }
        }
        if least > MAX_WRONG
            && let Some(along_normal) = plane::along_normal(&self.corners, normal)
        {
            for method in [SIMPLE, TOUCHING] {
                least = self.improve(least, &along_normal, method, &is_edge);
                if plane::is_tangled(&along_normal) {
                    break;
                }
            }
        }
        least > MAX_WRONG
    }

    /// Cuts the parts of a large polygon that touches itself in corners, one by one. Keeps the triangles,
    /// and returns the wrong part of their area; infinity if nothing was cut.
    fn cut_loops(&mut self, projected: &[DVec2], is_edge: &impl Fn(usize, usize) -> bool) -> f64 {
        let Some(loops) = (projected.len() >= SPLIT_CORNERS)
            .then(|| loops::split(projected))
            .flatten()
        else {
            return f64::INFINITY;
        };
        self.triangles.extend(loops.joints);
        for part in &loops.parts {
            let corners: Vec<DVec3> = part.iter().map(|&i| self.corners[i]).collect();
            let points: Vec<DVec2> = part.iter().map(|&i| projected[i]).collect();
            for shape in [Shape::Simple, Shape::Touching] {
                self.tried.clear();
                let is_edge = |i: usize, j: usize| is_edge(part[i], part[j]);
                self.ears
                    .clip(&corners, &points, shape, is_edge, &mut self.tried);
                if plane::turned_part(&points, &self.tried) == 0.0 {
                    break;
                }
            }
            let cut = self.tried.iter().map(|t| t.map(|i| part[i]));
            self.triangles.extend(cut);
        }
        wrong_part(projected, &self.triangles, |_| false)
    }

    /// Cuts the polygon with the corners `projected`. Keeps the triangles and returns the wrong part of
    /// their area, if this is less than `least`, the part of the triangles so far.
    fn improve(
        &mut self,
        least: f64,
        projected: &[DVec2],
        method: Method,
        is_edge: &impl Fn(usize, usize) -> bool,
    ) -> f64 {
        let Self {
            corners,
            projected: _,
            ears,
            triangles,
            tried,
        } = self;
        if ears.is_exhausted() && least.is_finite() {
            return least;
        }
        tried.clear();
        match method {
            Method::Ears(shape) => ears.clip(corners, projected, shape, is_edge, tried),
            Method::Exhaustive if corners.len() > exhaustive::MAX_CORNERS => return least,
            Method::Exhaustive => exhaustive::triangulate(corners, projected, is_edge, tried),
        }
        let wrong = wrong_part(projected, tried, |projected| {
            is_proved_simple(ears, projected, method)
        });
        if wrong >= least {
            return least;
        }
        std::mem::swap(triangles, tried);
        wrong
    }
}

/// Returns the corners of `face` without those that repeat the vertex of the corner before them, and
/// without spikes: corners between two with the same vertex.
fn without_spikes(face: &[VertexId]) -> Vec<usize> {
    let mut corners: Vec<usize> = Vec::with_capacity(face.len());
    for corner in 0..face.len() {
        let is_back =
            |at: usize| corners.len() >= at && face[corners[corners.len() - at]] == face[corner];
        if is_back(2) {
            corners.pop();
        } else if !is_back(1) {
            corners.push(corner);
        }
    }
    // The same around the first corner.
    let (mut first, mut last) = (0, corners.len());
    while last - first > 1 {
        let vertex = |i: usize| face[corners[i]];
        if vertex(first) == vertex(last - 1) {
            last -= 1;
        } else if last - first > 2 && vertex(first + 1) == vertex(last - 1) {
            first += 1;
        } else if last - first > 2 && vertex(first) == vertex(last - 2) {
            last -= 1;
        } else {
            break;
        }
    }
    corners.truncate(last);
    corners.drain(..first);
    corners
}

/// Returns the part of the area of the triangles of a polygon that is turned over, or else the part that
/// overlaps, if it is larger than rounding explains. `is_simple` may prove that none overlap.
fn wrong_part(
    projected: &[DVec2],
    triangles: &[[usize; 3]],
    is_simple: impl FnOnce(&[DVec2]) -> bool,
) -> f64 {
    let turned = plane::turned_part(projected, triangles);
    if turned > 0.0 || !overlap::may_overlap(projected) || is_simple(projected) {
        return turned;
    }
    let overlapping = overlap::overlapping_part(projected, triangles);
    if overlapping > MAX_WRONG {
        overlapping
    } else {
        0.0
    }
}

/// A way to cut a polygon.
#[derive(Clone, Copy)]
enum Method {
    /// Ear clipping of a polygon of this shape.
    Ears(Shape),
    /// The best of all triangulations.
    Exhaustive,
}

/// Returns whether the triangles of a large polygon are known not to overlap.
fn is_proved_simple(ears: &mut EarClipping, projected: &[DVec2], method: Method) -> bool {
    match method {
        Method::Ears(_) if projected.len() > MEASURED_CORNERS => [Shape::Simple, Shape::Touching]
            .into_iter()
            .any(|shape| outside::has_cut(ears, projected, shape) && !ears.is_exhausted()),
        _ => false,
    }
}

const SIMPLE: Method = Method::Ears(Shape::Simple);
const TOUCHING: Method = Method::Ears(Shape::Touching);

/// The largest part of the area of the triangles that is turned over, or that overlaps, because of
/// rounded coordinates, where the polygon touches itself.
const MAX_WRONG: f64 = 1e-6;

/// The fewest corners of a polygon that is split where it touches itself.
const SPLIT_CORNERS: usize = 32;

/// The most corners of a polygon whose overlapping triangles are looked for directly.
const MEASURED_CORNERS: usize = 64;

/// Part by which the second diagonal of a quad must be better than the first. Rounding errors then
/// do not decide between the diagonals of equal quads.
const BETTER: f64 = 1e-4;

/// Returns the two triangles of a convex quad; `None` for any other polygon. The result is that of
/// ear clipping, except that of two diagonals that are as good, the one from the first corner is
/// used.
fn convex_quad(
    corners: &[DVec3],
    projected: &[DVec2],
    is_edge: impl Fn(usize, usize) -> bool,
) -> Option<[[usize; 3]; 2]> {
    let &[a, b, c, d] = projected else {
        return None;
    };
    let turns = [[d, a, b], [a, b, c], [b, c, d], [c, d, a]];
    if !turns
        .iter()
        .all(|&[a, b, c]| plane::orient2d(a, b, c) > 0.0)
    {
        return None;
    }
    let worst = |triangles: [[usize; 3]; 2]| {
        let [one, other] = triangles.map(|t| plane::quality(t.map(|i| corners[i])));
        one.min(other)
    };
    let [first, second] = [[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [0, 1, 3]]];
    let is_second_better = match [is_edge(0, 2), is_edge(1, 3)] {
        [true, false] => true,
        [false, true] => false,
        _ => worst(second) > (1.0 + BETTER) * worst(first),
    };
    Some(if is_second_better { second } else { first })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two helices, one of them backwards, as one polygon: in a plane, it crosses itself nearly everywhere.
    #[test]
    fn tests_of_a_polygon_that_crosses_itself_everywhere_end() {
        let turn = |i: u32, radius: f64| {
            let angle = 0.1 * f64::from(i);
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.01 * angle)
        };
        let there = (0..8000).map(|i| turn(i, 1.0));
        let back = (0..8000).rev().map(|i| turn(i, 1.1));
        let mut cutter = PolygonCutter::default();
        let cut = cutter.cut(there.chain(back), |_, _| false);
        assert_eq!((cut.triangles.len(), cut.is_crossing), (15_998, true));
        // The next polygon starts anew.
        let square = [[0, 0], [2, 0], [2, 1], [1, 2], [0, 1]];
        let at = |[x, y]: [i32; 2]| DVec3::new(f64::from(x), f64::from(y), 0.0);
        assert!(!cutter.cut(square.map(at), |_, _| false).is_crossing);
    }

    /// Quads around one point, at which the polygon touches itself as often. Every other one has a hole that
    /// touches it in another corner.
    #[test]
    fn a_polygon_that_touches_itself_very_often_is_cut() {
        let (petals, radius) = (40_000, 10.0);
        let at = |petal: usize, part: f64, radius: f64| {
            let angle = (petal as f64 + part) / petals as f64 * std::f64::consts::TAU;
            radius * DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let corners: Vec<DVec3> = (0..petals)
            .flat_map(|petal| {
                let outer = [0.0, 0.3, 0.6].map(|part| at(petal, part, radius));
                let hole = [0.2, 0.4].map(|part| at(petal, part, 5.0));
                let [first, second, third] = outer;
                match petal % 2 == 0 {
                    true => vec![DVec3::ZERO, first, second, third],
                    false => vec![DVec3::ZERO, first, second, hole[0], hole[1], second, third],
                }
            })
            .collect();
        let mut cutter = PolygonCutter::default();
        let cut = cutter.cut(corners.iter().copied(), |_, _| false);
        assert!(!cut.is_crossing);
        assert_eq!(cut.triangles.len(), corners.len() - 2);
        let area = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| corners[i]);
            0.5 * (b - a).cross(c - a).z
        };
        assert!(cut.triangles.iter().all(|t| area(t) >= 0.0));
        let sum: f64 = cut.triangles.iter().map(area).sum();
        let around = |points: &[DVec3]| {
            let next = points.iter().cycle().skip(1);
            let sides = points.iter().zip(next);
            sides.map(|(p, q)| 0.5 * p.cross(*q).z).sum::<f64>()
        };
        let expected = around(&corners);
        assert!((sum - expected).abs() < 1e-9 * expected, "{sum} {expected}");
    }
}
