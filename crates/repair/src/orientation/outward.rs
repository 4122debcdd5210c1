//! The outside of each component.

use std::ops::{ControlFlow, Range};

use glam::{DMat3, DVec3};
use sixfold_core::{FaceId, Incidence, PolygonCutter, PolygonMesh, VertexId, row};
use sixfold_spatial::{
    Bounds, Bvh, FaceTriangle, Item, NamedBox, Ray, SpatialIndex, SurfaceQueries, TurnedBox,
    triangles_touch,
};

use super::{Agreement, UndecidedReason};

/// The least part of the volumes of its faces, without their signs, that the volume of an open
/// component has if it clearly bulges to one side.
const CLEAR_PART: f64 = 0.5;
/// The least volume of such a component, as a part of the area of its faces to the power of 3/2.
const CLEAR_VOLUME: f64 = 1e-3;
/// The least part of a closed component. A smaller volume is only a rounding error.
const ROUNDING: f64 = 1e-9;

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

/// Returns for each component whether all of its faces are to be reversed after those in
/// [`Agreement::reverse`], so that it faces outward. `first` has the first face of each.
pub(super) fn outward(
    polygons: &PolygonMesh,
    incidence: &Incidence<'_>,
    agreement: &Agreement,
    first: &[FaceId],
) -> Vec<Result<bool, UndecidedReason>> {
    let volumes = volumes(polygons, incidence, agreement);
    let kinds = volumes.iter().map(|volume| match volume.is_clear() {
        true if volume.is_closed => Kind::Solid,
        true => Kind::Open,
        false => Kind::Unclear,
    });
    let kinds: Vec<Kind> = kinds.collect();
    let signs: Vec<f64> = volumes.iter().map(|volume| volume.signed).collect();
    let depths = depths(polygons, agreement, first, &kinds, &signs);
    let sides = volumes.iter().zip(depths).map(|(volume, depth)| {
        match (volume.is_closed, volume.is_clear()) {
            (true, false) => Err(UndecidedReason::NoVolume),
            (false, false) => Err(UndecidedReason::Flat),
            (_, true) => depth.map(|depth| (volume.signed < 0.0) == depth.is_multiple_of(2)),
        }
    });
    sides.collect()
}

/// What the volume of a component says.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// It is closed and encloses a volume.
    Solid,
    /// It is open and clearly bulges to one side.
    Open,
    /// It has no side.
    Unclear,
}

/// The volume of a component with a cone from its boundary to the centre of its boundary. A polygon is
/// the cone from its sides to its own centre, so that the volume does not depend on its first corner.
#[derive(Clone, Copy)]
struct Volume {
    is_closed: bool,
    centre: DVec3,
    /// The number of boundary vertices so far.
    ends: usize,
    /// Sum of the signed volumes between the centre and each triangle.
    signed: f64,
    /// Sum of these volumes without their signs.
    size: f64,
    /// How far another cut of the polygons can change the volume: the volumes between the triangles at
    /// the centres of polygons and those at their first corners. Zero if all polygons are planar.
    doubt: f64,
    /// Sum of the areas of these triangles.
    area: f64,
}

impl Volume {
    /// Returns whether the volume decides about the side.
    fn is_clear(&self) -> bool {
        let volume = self.signed.abs() - self.doubt;
        match self.is_closed {
            true => volume > ROUNDING * self.size,
            false => volume > CLEAR_PART * self.size && volume > CLEAR_VOLUME * self.area.powf(1.5),
        }
    }
}

/// Returns the volume of each component, after the faces in [`Agreement::reverse`] are reversed.
fn volumes(
    polygons: &PolygonMesh,
    incidence: &Incidence<'_>,
    agreement: &Agreement,
) -> Vec<Volume> {
    let none = Volume {
        is_closed: true,
        centre: DVec3::ZERO,
        ends: 0,
        signed: 0.0,
        size: 0.0,
        doubt: 0.0,
        area: 0.0,
    };
    let mut volumes = vec![none; agreement.conflicts.len()];
    let at = |v: VertexId| polygons.position(v).as_dvec3();
    for edge in incidence.edges().filter(|edge| edge.len() != 2) {
        for side in edge.sides() {
            let volume = &mut volumes[agreement.component(side.face)];
            volume.is_closed = false;
            for v in edge.ends {
                // A running mean, which does not overflow.
                volume.ends += 1;
                volume.centre += (at(v) - volume.centre) / volume.ends as f64;
            }
        }
    }
    let mut seen = vec![false; volumes.len()];
    for (f, face) in polygons.faces().iter() {
        let component = agreement.component(f);
        let volume = &mut volumes[component];
        if volume.is_closed && !std::mem::replace(&mut seen[component], true) {
            volume.centre = at(face[0]);
        }
        let sign = if agreement.reverse[f.index()] {
            -1.0
        } else {
            1.0
        };
        let at = |v| at(v) - volume.centre;
        let first = at(face[0]);
        let centre = match face.len() {
            3 => first,
            n => face.iter().map(|&v| at(v)).sum::<DVec3>() / n as f64,
        };
        for (i, &v) in face.iter().enumerate() {
            let [a, b] = [v, face[(i + 1) % face.len()]].map(at);
            let part = centre.dot(a.cross(b)) / 6.0;
            volume.signed += sign * part;
            volume.size += part.abs();
            volume.doubt += (centre - first).dot((a - first).cross(b - first)).abs() / 6.0;
            volume.area += (a - centre).cross(b - centre).length() / 2.0;
        }
    }
    volumes
}

/// Returns the number of components around each component, or why it is not known. For components that
/// are unclear, the number is 0. The signs of `signs` are those of the volumes.
fn depths(
    polygons: &PolygonMesh,
    agreement: &Agreement,
    first: &[FaceId],
    kinds: &[Kind],
    signs: &[f64],
) -> Vec<Result<usize, UndecidedReason>> {
    let mut depths = vec![Ok(0); first.len()];
    let bounds = bounds(polygons, agreement, kinds);
    let is_near = overlapping(&bounds);
    if !is_near.contains(&true) {
        return depths;
    }
    let Some(index) = index(polygons, agreement, &is_near) else {
        return depths;
    };
    let is_solid = |component: usize| kinds[component] == Kind::Solid;
    for (one, other) in contacts(&index, agreement, is_solid) {
        for (one, other) in [(one, other), (other, one)] {
            if depths[one].is_ok() {
                depths[one] = Err(UndecidedReason::Touches(first[other]));
            }
        }
    }
    // A point of each component: a triangle of it.
    let mut sample = vec![None; first.len()];
    for triangle in index.items() {
        sample[agreement.component(triangle.face)].get_or_insert(triangle);
    }
    let touching: Vec<bool> = depths.iter().map(Result::is_err).collect();
    let any_open = (0..kinds.len()).any(|c| is_near[c] && kinds[c] == Kind::Open);
    let solids_and_open = any_open.then(|| {
        let of_kind = |kind| {
            let is_chosen = is_near.iter().zip(kinds);
            let is_chosen = is_chosen.map(|(&is_near, &own)| is_near && own == kind);
            self::index(polygons, agreement, &is_chosen.collect::<Vec<bool>>())
        };
        (of_kind(Kind::Solid), of_kind(Kind::Open))
    });
    let (solids, open) = match &solids_and_open {
        None => (Some(&index), None),
        Some((solids, open)) => (solids.as_ref(), open.as_ref()),
    };
    let solids = solids.map(|index| Solids {
        depths: depths_by_first_hits(index, agreement, &touching, signs),
        index,
        agreement,
        touching: &touching,
        signs,
        directions: if any_open { DIRECTIONS } else { FEW_DIRECTIONS },
    });
    for (inner, sample) in sample.iter().enumerate() {
        let (Some(sample), Ok(_)) = (sample, &depths[inner]) else {
            continue;
        };
        let is_around = |outer: usize| match (bounds[inner], bounds[outer]) {
            (Some(inner), Some(outer)) => outer.union(inner) == outer && inner != outer,
            _ => false,
        };
        let open = match open {
            Some(open) => open_around(open, sample, agreement, is_around),
            None => Ok(0),
        };
        depths[inner] = match open {
            Ok(open) => solids
                .as_ref()
                .map_or(Ok(0), |solids| solids.around(sample))
                .map(|solids| solids + open)
                .map_err(|outer| UndecidedReason::Touches(first[outer])),
            Err(Some(outer)) => Err(UndecidedReason::PartlyInside(first[outer])),
            Err(None) => Err(UndecidedReason::ManyAround),
        };
    }
    depths
}

/// Returns the number of open components around a component of which `sample` is a triangle; or one that is
/// only partly around it; or `None` if there are too many. `is_around` returns whether the box of a
/// component contains that of the inner one, and is larger.
fn open_around(
    index: &Bvh<FaceTriangle<FaceId>>,
    sample: &FaceTriangle<FaceId>,
    agreement: &Agreement,
    is_around: impl Fn(usize) -> bool,
) -> Result<usize, Option<usize>> {
    let mut most = MOST_HIDING;
    let hiding = hiding(index, sample, agreement, DIRECTIONS, &mut most).ok_or(None)?;
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

/// The solid components.
struct Solids<'a> {
    index: &'a Bvh<FaceTriangle<FaceId>>,
    agreement: &'a Agreement,
    touching: &'a [bool],
    signs: &'a [f64],
    /// The number of directions that decide if the first hits do not.
    directions: u32,
    /// By component: the number of components around it, or one around it that touches another.
    depths: Vec<Option<Result<usize, usize>>>,
}

impl Solids<'_> {
    /// Returns the number of solid components around a component of which `sample` is a triangle, or one
    /// around it that touches another.
    fn around(&self, sample: &FaceTriangle<FaceId>) -> Result<usize, usize> {
        let own = self.agreement.component(sample.face);
        self.depths[own]
            .or_else(|| majority([0, 1, 2].map(|i| self.along(sample, i))))
            .unwrap_or_else(|| self.by_all_hits(sample))
    }

    fn along(&self, sample: &FaceTriangle<FaceId>, i: u32) -> Option<Result<usize, usize>> {
        let ray = Ray::new(centre(sample), direction(i, FEW_DIRECTIONS)).ok()?;
        let own = self.agreement.component(sample.face);
        depth_at(
            self.index,
            &ray,
            self.agreement,
            own,
            self.touching,
            self.signs,
            |c| self.depths[c],
        )
    }

    fn by_all_hits(&self, sample: &FaceTriangle<FaceId>) -> Result<usize, usize> {
        let mut most = usize::MAX;
        let hiding = hiding(
            self.index,
            sample,
            self.agreement,
            self.directions,
            &mut most,
        );
        let hiding = hiding.unwrap_or_default().into_iter();
        let around: Vec<usize> = hiding
            .filter(|(_, part)| *part > 0.5)
            .map(|(c, _)| c)
            .collect();
        match around.iter().find(|&&outer| self.touching[outer]) {
            Some(&outer) => Err(outer),
            None => Ok(around.len()),
        }
    }
}

/// Returns the box of each solid or open component; `None` for the others, among them those with a coordinate
/// that is not finite.
fn bounds(polygons: &PolygonMesh, agreement: &Agreement, kinds: &[Kind]) -> Vec<Option<Bounds>> {
    let mut bounds: Vec<Option<Bounds>> = vec![None; kinds.len()];
    for (f, face) in polygons.faces().iter() {
        let component = agreement.component(f);
        if kinds[component] != Kind::Unclear {
            let face = Bounds::from_points(face.iter().map(|&v| polygons.position(v)));
            let all = bounds[component].map_or(face, |all| all.union(face));
            bounds[component] = Some(all);
        }
    }
    bounds
}

/// Returns which boxes overlap another one.
fn overlapping(bounds: &[Option<Bounds>]) -> Vec<bool> {
    let mut found = vec![false; bounds.len()];
    let boxes = bounds
        .iter()
        .enumerate()
        .filter_map(|(component, &bounds)| {
            let bounds = bounds?;
            Some(NamedBox {
                name: component,
                bounds,
            })
        });
    let Ok(index) = Bvh::build(boxes.collect()) else {
        return found;
    };
    for one in index.items() {
        if found[one.name] {
            continue;
        }
        index.visit_meeting(one, 0.0, |slot| {
            let other = &index.items()[slot];
            if other.name == one.name || !other.bounds.meets(&one.bounds) {
                return ControlFlow::Continue(());
            }
            found[one.name] = true;
            found[other.name] = true;
            ControlFlow::Break(())
        });
    }
    found
}

/// Returns an index of the triangles of the chosen components.
fn index(
    polygons: &PolygonMesh,
    agreement: &Agreement,
    is_chosen: &[bool],
) -> Option<Bvh<FaceTriangle<FaceId>>> {
    let mut cutter = PolygonCutter::default();
    let mut triangles = Vec::new();
    for (face, corners) in polygons.faces().iter() {
        if is_chosen[agreement.component(face)] {
            let at = |i: usize| polygons.position(corners[i]);
            let points = (0..corners.len()).map(|i| at(i).as_dvec3());
            let cut = cutter.cut(points, |_, _| false);
            let triangle = |t: &[usize; 3]| FaceTriangle {
                face,
                corners: t.map(at),
            };
            triangles.extend(cut.triangles.iter().map(triangle));
        }
    }
    Bvh::build(triangles).ok()
}

/// Returns pairs of solid components that touch or cross each other. Each component that does is in a
/// pair.
fn contacts(
    index: &Bvh<FaceTriangle<FaceId>>,
    agreement: &Agreement,
    is_solid: impl Fn(usize) -> bool,
) -> Vec<(usize, usize)> {
    let component = |slot: usize| agreement.component(index.items()[slot].face);
    // By slot: the end of the slots that follow it and have the same component.
    let mut ends: Vec<u32> = (1..=row(index.items().len())).collect();
    for slot in (1..ends.len()).rev() {
        if component(slot - 1) == component(slot) {
            ends[slot - 1] = ends[slot];
        }
    }
    let mut slots: Vec<usize> = (0..ends.len()).collect();
    slots.sort_by_key(|&slot| component(slot));
    let components = agreement.conflicts.len();
    let mut boxes: Vec<Option<TurnedBox>> = vec![None; components];
    for own in slots.chunk_by(|&a, &b| component(a) == component(b)) {
        let triangles = own.iter().map(|&slot| &index.items()[slot]);
        boxes[component(own[0])] = Some(TurnedBox::around(triangles));
    }
    // By component: the one with which its box was compared last, and whether the boxes meet.
    let mut compared = vec![(usize::MAX, false); components];
    let mut touching = vec![false; components];
    let mut pairs = Vec::new();
    for same in slots.chunk_by(|&a, &b| component(a) == component(b)) {
        let own = component(same[0]);
        for &slot in same {
            // A component that touches none yet finds those that it touches by its own triangles.
            if touching[own] || !is_solid(own) {
                break;
            }
            let triangle = &index.items()[slot];
            let corners = triangle.corners_f64();
            let has_others = |slots: Range<usize>| {
                component(slots.start) != own || (ends[slots.start] as usize) < slots.end
            };
            index.visit_meeting_where(triangle, 0.0, has_others, |slot| {
                let near = &index.items()[slot];
                let other = component(slot);
                if own == other || !near.bounds().meets(&triangle.bounds()) || !is_solid(other) {
                    return ControlFlow::Continue(());
                }
                if compared[other].0 != own {
                    let both = boxes[own].zip(boxes[other]);
                    compared[other] = (own, both.is_none_or(|(own, other)| own.meets(&other)));
                }
                if compared[other].1 && triangles_touch(corners, near.corners_f64()) {
                    touching[own] = true;
                    touching[other] = true;
                    pairs.push((own, other));
                    return ControlFlow::Break(());
                }
                ControlFlow::Continue(())
            });
        }
    }
    pairs
}

/// Returns the number of components around each solid one, or one around it that touches another; `None`
/// if this is not clear. All components are solid.
///
/// ```text
///   ┌───────────────┐      From the end of a component in one direction, a ray leaves it. If it leaves the
///   │ ┌───┐   ┌───┐ │ →    component that it hits first, this one is around it, and is one of those around
///   │ │ c ├ → │ d │ ├ →    it more than are around the other. If it enters it, both have the same around
///   │ └───┘   └───┘ │      them. The end of the other component is farther away, so its number is known.
///   └───────────────┘
/// ```
///
/// Most of a few directions decide. O(n log n) for components with n triangles. A component that touches
/// another may be partly inside, so all hits count behind it.
fn depths_by_first_hits(
    index: &Bvh<FaceTriangle<FaceId>>,
    agreement: &Agreement,
    touching: &[bool],
    signs: &[f64],
) -> Vec<Option<Result<usize, usize>>> {
    let component = |triangle: &FaceTriangle<FaceId>| agreement.component(triangle.face);
    let in_direction = |i: u32| {
        let along = DVec3::from_array(direction(i, FEW_DIRECTIONS));
        let mut ends: Vec<Option<(f64, DVec3)>> = vec![None; touching.len()];
        for triangle in index.items() {
            let end = &mut ends[component(triangle)];
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
        let mut depths: Vec<Option<Result<usize, usize>>> = vec![None; ends.len()];
        for own in order.into_iter().filter(|&own| !touching[own]) {
            let ray = ends[own].and_then(|(_, end)| Ray::new(end, along).ok());
            let Some(ray) = ray else {
                continue;
            };
            depths[own] = depth_at(index, &ray, agreement, own, touching, signs, |c| depths[c]);
        }
        depths
    };
    let [a, b, c] = [0, 1, 2].map(in_direction);
    let all = a.into_iter().zip(b).zip(c);
    all.map(|((a, b), c)| majority([a, b, c])).collect()
}

/// Returns the number of components around the start of a ray, or one around it that touches another;
/// `None` if this is not clear. All components in the index are solid; `own` does not count. `depth` returns
/// the number of components around one of them.
fn depth_at(
    index: &Bvh<FaceTriangle<FaceId>>,
    ray: &Ray,
    agreement: &Agreement,
    own: usize,
    touching: &[bool],
    signs: &[f64],
    depth: impl Fn(usize) -> Option<Result<usize, usize>>,
) -> Option<Result<usize, usize>> {
    let component = |triangle: &FaceTriangle<FaceId>| agreement.component(triangle.face);
    let mut first = None;
    index.first_hit_where(ray, f64::INFINITY, |triangle| {
        let is_other = component(triangle) != own;
        if is_other {
            first = Some(*triangle);
        }
        is_other
    });
    let Some(hit) = first else {
        return Some(Ok(0));
    };
    let other = component(&hit);
    if touching[other] {
        let mut most = usize::MAX;
        let around = odd_hits(index, ray, agreement, own, &mut most)?;
        let outer = around.iter().find(|&&outer| touching[outer]);
        return Some(outer.map_or(Ok(around.len()), |&outer| Err(outer)));
    }
    let sign = match agreement.reverse[hit.face.index()] {
        true => -signs[other],
        false => signs[other],
    };
    let leaves = sign * hit.normal().dot(ray.direction());
    let depth = depth(other).filter(|_| leaves != 0.0)?;
    Some(depth.map(|depth| depth + usize::from(leaves > 0.0)))
}

/// Returns the value that at least two of three have.
fn majority<T: PartialEq>([a, b, c]: [Option<T>; 3]) -> Option<T> {
    match a == b || a == c {
        true => a,
        false => b.filter(|b| c.as_ref() == Some(b)),
    }
}

/// Returns the other components that a ray hits an odd number of times, ascending; `None` if these are more
/// than `most` hits. Subtracts the hits from `most`.
fn odd_hits(
    index: &Bvh<FaceTriangle<FaceId>>,
    ray: &Ray,
    agreement: &Agreement,
    own: usize,
    most: &mut usize,
) -> Option<Vec<usize>> {
    let mut hits: Vec<usize> = Vec::new();
    // A hit that is accepted ends the search behind it.
    let end = index.first_hit_where(ray, f64::INFINITY, |triangle| {
        hits.push(agreement.component(triangle.face));
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

/// Returns the other components that hide the outside from a triangle, and the part of the directions
/// in which each does: a ray from the centre of the triangle leaves it. `None` if these are
/// more than `most` hits.
fn hiding(
    index: &Bvh<FaceTriangle<FaceId>>,
    sample: &FaceTriangle<FaceId>,
    agreement: &Agreement,
    directions: u32,
    most: &mut usize,
) -> Option<Vec<(usize, f64)>> {
    let inner = agreement.component(sample.face);
    let mut votes: Vec<usize> = Vec::new();
    for i in 0..directions {
        let Ok(ray) = Ray::new(centre(sample), direction(i, directions)) else {
            continue;
        };
        votes.extend(odd_hits(index, &ray, agreement, inner, most)?);
    }
    votes.sort_unstable();
    let parts = votes.chunk_by(|a, b| a == b);
    let part = |same: &[usize]| same.len() as f64 / f64::from(directions);
    Some(parts.map(|same| (same[0], part(same))).collect())
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
mod tests;
