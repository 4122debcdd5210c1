//! The outside of each component.

mod around;

use std::ops::{ControlFlow, Range};

use glam::DVec3;
use sixfold_core::{FaceId, Incidence, PolygonCutter, PolygonMesh, VertexId, row};
use sixfold_spatial::{
    Bounds, Bvh, FaceTriangle, Item, NamedBox, SpatialIndex, TurnedBox, triangles_touch,
};

use around::{Solids, Triangles};

use super::{Agreement, UndecidedReason};

/// The least part of the volumes of its faces, without their signs, that the volume of an open
/// component has if it clearly bulges to one side.
const CLEAR_PART: f64 = 0.5;
/// The least volume of such a component, as a part of the area of its faces to the power of 3/2.
const CLEAR_VOLUME: f64 = 1e-3;
/// The least part of a closed component. A smaller volume is only a rounding error.
const ROUNDING: f64 = 1e-9;

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
    let triangles = |index| Triangles { index, agreement };
    let solids = solids.map(|index| Solids::new(triangles(index), &touching, signs, any_open));
    let open = open.map(triangles);
    for (inner, sample) in sample.iter().enumerate() {
        let (Some(sample), Ok(_)) = (sample, &depths[inner]) else {
            continue;
        };
        let is_around = |outer: usize| match (bounds[inner], bounds[outer]) {
            (Some(inner), Some(outer)) => outer.union(inner) == outer && inner != outer,
            _ => false,
        };
        let open = open.as_ref();
        let open = open.map_or(Ok(0), |open| open.open_around(sample, is_around));
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

#[cfg(test)]
mod tests;
