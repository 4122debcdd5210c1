//! The components around a component: a ray that starts in them leaves each of them.

use glam::{DMat3, DVec3};
use sixfold_core::FaceId;
use sixfold_spatial::{Bvh, FaceTriangle, Ray, SpatialIndex, SurfaceQueries};

use super::super::Agreement;

/// The part of all directions in which an open component must hide the outside, so that what it hides
/// counts as inside of it. A solid hides it in all directions.
const ENCLOSED: f64 = 0.9;
/// The number of directions in which the first solid component is looked for: the answer of most of them
/// avoids errors at edges.
const FEW_DIRECTIONS: u32 = 3;
/// The number of directions in which other components are looked for if some are open.
const DIRECTIONS: u32 = 64;
/// The most faces of open components that may hide the outside from a component, in all directions together.
const MOST_HIDING: usize = 2048;

/// The triangles of some components.
#[derive(Clone, Copy)]
pub(super) struct Triangles<'a> {
    pub(super) index: &'a Bvh<FaceTriangle<FaceId>>,
    pub(super) agreement: &'a Agreement,
}

impl Triangles<'_> {
    fn component(&self, triangle: &FaceTriangle<FaceId>) -> usize {
        self.agreement.component(triangle.face)
    }

    /// Returns the number of open components around a component of which `sample` is a triangle, if all
    /// triangles are those of open components; or one that is only partly around it; or `None` if there
    /// are too many. `is_around` returns whether the box of a component contains that of the inner one,
    /// and is larger.
    pub(super) fn open_around(
        &self,
        sample: &FaceTriangle<FaceId>,
        is_around: impl Fn(usize) -> bool,
    ) -> Result<usize, Option<usize>> {
        let mut most = MOST_HIDING;
        let hiding = self.hiding(sample, DIRECTIONS, &mut most).ok_or(None)?;
        // Several open components, such as two halves, can be around it together.
        let sum: f64 = hiding.iter().map(|(_, part)| part).sum();
        let whole = sum.round();
        if (sum - whole).abs() <= 1.0 - ENCLOSED {
            return Ok(whole as usize);
        }
        let partly =
            |&&(component, part): &&(usize, f64)| part > 1.0 - ENCLOSED && is_around(component);
        match hiding.iter().find(partly) {
            Some(&(component, _)) => Err(Some(component)),
            None => Ok(0),
        }
    }

    /// Returns the other components that hide the outside from a triangle, and the part of the directions
    /// in which each does: a ray from the centre of the triangle leaves it. `None` if these are
    /// more than `most` hits.
    fn hiding(
        &self,
        sample: &FaceTriangle<FaceId>,
        directions: u32,
        most: &mut usize,
    ) -> Option<Vec<(usize, f64)>> {
        let inner = self.component(sample);
        let mut votes: Vec<usize> = Vec::new();
        for i in 0..directions {
            let Ok(ray) = Ray::new(centre(sample), direction(i, directions)) else {
                continue;
            };
            votes.extend(self.odd_hits(&ray, inner, most)?);
        }
        votes.sort_unstable();
        let parts = votes.chunk_by(|a, b| a == b);
        let part = |same: &[usize]| same.len() as f64 / f64::from(directions);
        Some(parts.map(|same| (same[0], part(same))).collect())
    }

    /// Returns the components but `own` that a ray hits an odd number of times, ascending; `None` if these
    /// are more than `most` hits. Subtracts the hits from `most`.
    fn odd_hits(&self, ray: &Ray, own: usize, most: &mut usize) -> Option<Vec<usize>> {
        let mut hits: Vec<usize> = Vec::new();
        // A hit that is accepted ends the search behind it.
        let end = self.index.first_hit_where(ray, f64::INFINITY, |triangle| {
            hits.push(self.component(triangle));
            let left = most.checked_sub(1);
            *most = left.unwrap_or(0);
            left.is_none()
        });
        if end.is_some() {
            return None;
        }
        hits.sort_unstable();
        let odd = hits
            .chunk_by(|a, b| a == b)
            .filter(|same| same.len() % 2 == 1);
        let odd = odd.map(|same| same[0]).filter(|&other| other != own);
        Some(odd.collect())
    }
}

/// The number of components around one, or one around it that touches another.
type Depth = Result<usize, usize>;

/// The solid components.
pub(super) struct Solids<'a> {
    triangles: Triangles<'a>,
    touching: &'a [bool],
    signs: &'a [f64],
    /// The number of directions that decide if the first hits do not.
    directions: u32,
    /// By component; `None` if it is not clear.
    pub(super) depths: Vec<Option<Depth>>,
}

impl<'a> Solids<'a> {
    /// Returns the components of `triangles`, all of them solid. `touching` says which of them touch another
    /// one, and `signs` has the signs of their volumes. If components are open as well (`any_open`), more
    /// directions are searched.
    pub(super) fn new(
        triangles: Triangles<'a>,
        touching: &'a [bool],
        signs: &'a [f64],
        any_open: bool,
    ) -> Self {
        let mut solids = Self {
            triangles,
            touching,
            signs,
            directions: if any_open { DIRECTIONS } else { FEW_DIRECTIONS },
            depths: Vec::new(),
        };
        let [a, b, c] = [0, 1, 2].map(|i| solids.depths_along(direction(i, FEW_DIRECTIONS)));
        let all = a.into_iter().zip(b).zip(c);
        solids.depths = all.map(|((a, b), c)| majority([a, b, c])).collect();
        solids
    }

    /// Returns the number of solid components around a component of which `sample` is a triangle, or one
    /// around it that touches another.
    pub(super) fn around(&self, sample: &FaceTriangle<FaceId>) -> Depth {
        let own = self.triangles.component(sample);
        let along = |i| {
            let ray = Ray::new(centre(sample), direction(i, FEW_DIRECTIONS)).ok()?;
            self.depth_at(&ray, own, &self.depths)
        };
        self.depths[own]
            .or_else(|| majority([0, 1, 2].map(along)))
            .unwrap_or_else(|| self.by_all_hits(sample))
    }

    /// Returns the number of components around each solid one, by the first hits in one direction.
    ///
    /// ```text
    ///   ┌───────────────┐      From the end of a component in one direction, a ray leaves it. If it leaves the
    ///   │ ┌───┐   ┌───┐ │ →    component that it hits first, this one is around it, and is one of those around
    ///   │ │ c ├ → │ d │ ├ →    it more than are around the other. If it enters it, both have the same around
    ///   │ └───┘   └───┘ │      them. The end of the other component is farther away, so its number is known.
    ///   └───────────────┘
    /// ```
    ///
    /// O(n log n) for components with n triangles. A component that touches another may be partly inside, so
    /// all hits count behind it.
    fn depths_along(&self, along: [f64; 3]) -> Vec<Option<Depth>> {
        let along = DVec3::from_array(along);
        let mut ends: Vec<Option<(f64, DVec3)>> = vec![None; self.touching.len()];
        for triangle in self.triangles.index.items() {
            let end = &mut ends[self.triangles.component(triangle)];
            for corner in triangle.corners_f64() {
                let place = along.dot(corner);
                if end.is_none_or(|(farthest, _)| place > farthest) {
                    *end = Some((place, corner));
                }
            }
        }
        let mut order: Vec<usize> = (0..ends.len()).filter(|&c| ends[c].is_some()).collect();
        order.sort_by(|&a, &b| {
            let [a, b] = [a, b].map(|c| ends[c].map_or(0.0, |(place, _)| place));
            b.total_cmp(&a)
        });
        let mut depths: Vec<Option<Depth>> = vec![None; ends.len()];
        for own in order.into_iter().filter(|&own| !self.touching[own]) {
            if let Some(ray) = ends[own].and_then(|(_, end)| Ray::new(end, along).ok()) {
                depths[own] = self.depth_at(&ray, own, &depths);
            }
        }
        depths
    }

    /// Returns the number of components but `own` around the start of a ray; `None` if this is not clear.
    /// `depths` has the number of components around the others.
    fn depth_at(&self, ray: &Ray, own: usize, depths: &[Option<Depth>]) -> Option<Depth> {
        let Triangles { index, agreement } = self.triangles;
        let mut first = None;
        index.first_hit_where(ray, f64::INFINITY, |triangle| {
            let is_other = self.triangles.component(triangle) != own;
            if is_other {
                first = Some(*triangle);
            }
            is_other
        });
        let Some(hit) = first else {
            return Some(Ok(0));
        };
        let other = self.triangles.component(&hit);
        if self.touching[other] {
            let mut most = usize::MAX;
            let around = self.triangles.odd_hits(ray, own, &mut most)?;
            return Some(self.depth_of(&around));
        }
        let sign = match agreement.reverse[hit.face.index()] {
            true => -self.signs[other],
            false => self.signs[other],
        };
        let leaves = sign * hit.normal().dot(ray.direction());
        let depth = depths[other].filter(|_| leaves != 0.0)?;
        Some(depth.map(|depth| depth + usize::from(leaves > 0.0)))
    }

    fn by_all_hits(&self, sample: &FaceTriangle<FaceId>) -> Depth {
        let mut most = usize::MAX;
        let hiding = self.triangles.hiding(sample, self.directions, &mut most);
        let hiding = hiding.unwrap_or_default().into_iter();
        let around = hiding.filter(|(_, part)| *part > 0.5).map(|(c, _)| c);
        self.depth_of(&around.collect::<Vec<usize>>())
    }

    /// Returns the number of components of `around`, or one of them that touches another.
    fn depth_of(&self, around: &[usize]) -> Depth {
        let outer = around.iter().find(|&&outer| self.touching[outer]);
        outer.map_or(Ok(around.len()), |&outer| Err(outer))
    }
}

/// Returns the value that at least two of three have.
fn majority<T: PartialEq>([a, b, c]: [Option<T>; 3]) -> Option<T> {
    match a == b || a == c {
        true => a,
        false => b.filter(|b| c.as_ref() == Some(b)),
    }
}

fn centre(triangle: &FaceTriangle<FaceId>) -> DVec3 {
    triangle.corners_f64().iter().sum::<DVec3>() / 3.0
}

/// Returns direction `i` of `n` that are spread evenly: a spiral of golden angles (Vogel 1979), turned
/// so that no face of a usual mesh is parallel to one.
fn direction(i: u32, n: u32) -> [f64; 3] {
    const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
    let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
    let (sin, cos) = (GOLDEN_ANGLE * f64::from(i) + 0.412_913_7).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    let [x, y] = [radius * cos, radius * sin];
    // A turn around an axis in general position.
    let turn = DMat3::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.9);
    (turn * DVec3::new(x, y, z)).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_of_three_decide() {
        let values = [None, Some(1), Some(2), Some(3)];
        for (a, b, c) in values.iter().flat_map(|&a| {
            let pairs = values.iter().flat_map(|&b| values.map(|c| (b, c)));
            pairs.map(move |(b, c)| (a, b, c))
        }) {
            let has_two =
                |value: &i32| [a, b, c].iter().filter(|&&one| one == Some(*value)).count() > 1;
            assert_eq!(
                majority([a, b, c]),
                (1..4).find(has_two),
                "{a:?} {b:?} {c:?}"
            );
        }
    }

    #[test]
    fn directions_are_spread_evenly() {
        for (n, tolerance) in [(FEW_DIRECTIONS, 0.5), (DIRECTIONS, 0.02)] {
            let directions: Vec<DVec3> = (0..n).map(|i| direction(i, n).into()).collect();
            assert!(directions.iter().all(|d| (d.length() - 1.0).abs() < 1e-12));
            let mean = |of: &dyn Fn(DVec3) -> DVec3| {
                directions.iter().map(|&d| of(d)).sum::<DVec3>() / f64::from(n)
            };
            assert!(mean(&|d| d).length() < tolerance);
            assert!((mean(&|d| d * d) - DVec3::splat(1.0 / 3.0)).length() < tolerance);
            let apart = |i: usize| {
                directions[..i]
                    .iter()
                    .all(|d| d.distance(directions[i]) > 0.3)
            };
            assert!((0..directions.len()).all(apart));
        }
    }
}
