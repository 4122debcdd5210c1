//! The angles at which faces leave their edges.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use sixfold_core::{FaceId, PolygonMesh, RowId, area_vector};

use super::{Sides, TwoWay, faces_of_corners};
use crate::trace::CornerId;

/// Steps per radian in which angles are compared, so that rounding does not decide.
const STEPS: f64 = 1000.0;

/// The order in which pairs of sides are joined: lower first.
pub(super) type Preference = (u32, u32);

/// The directions of faces around crowded edges.
pub(super) struct Angles<'a> {
    polygons: &'a PolygonMesh,
    sides: &'a Sides,
    faces: Vec<FaceId>,
}

impl<'a> Angles<'a> {
    pub(super) fn new(polygons: &'a PolygonMesh, sides: &'a Sides) -> Self {
        Self {
            polygons,
            sides,
            faces: faces_of_corners(polygons.faces()),
        }
    }

    /// Returns for each side of `edge` the angle of its face around the edge, in radians from an
    /// arbitrary direction; first the sides that run up, then those that run down.
    pub(super) fn around(&self, edge: TwoWay) -> [Vec<f64>; 2] {
        let ends = self.sides.ends(edge);
        let [a, b] = ends.map(|v| self.polygons.position(v).as_dvec3());
        // A side that runs up starts at the lower vertex, and `ends` are those of such a side.
        let axis = (b - a).normalize_or_zero();
        let x = axis.any_orthogonal_vector().normalize_or_zero();
        let y = axis.cross(x);
        let [up, down] = self.sides.up_and_down(edge);
        let angles = |sides: &[CornerId], axis: DVec3| {
            let angle = |side: &CornerId| {
                let inward = self.normal(self.faces[side.index()]).cross(axis);
                let angle = inward.dot(y).atan2(inward.dot(x));
                if angle.is_finite() { angle } else { 0.0 }
            };
            sides.iter().map(angle).collect()
        };
        [angles(up, axis), angles(down, -axis)]
    }

    fn normal(&self, f: FaceId) -> DVec3 {
        let corners = self.polygons.faces().face(f).iter();
        area_vector(corners.map(|&v| self.polygons.position(v).as_dvec3())).normalize_or_zero()
    }
}

/// Returns the pairs of the sides around an edge as places in the two lists of angles, each with its
/// preference: how far the two faces are from continuing each other straight, then the angle between
/// them behind the faces, both in steps. Pairs that bound the same solid come before all others.
pub(super) fn preferences(around: &[Vec<f64>; 2]) -> Vec<(Preference, [usize; 2])> {
    let solids = solids(around).unwrap_or_default();
    let [up, down] = around;
    let mut pairs = Vec::with_capacity(up.len() * down.len());
    for (i, &angle) in up.iter().enumerate() {
        for (j, &other) in down.iter().enumerate() {
            let behind = (angle - other).rem_euclid(TAU);
            let preference = match solids.contains(&[i, j]) {
                true => (0, 0),
                false => (steps((behind - PI).abs()), steps(behind)),
            };
            pairs.push((preference, [i, j]));
        }
    }
    pairs
}

fn steps(angle: f64) -> u32 {
    (angle * STEPS).round() as u32
}

/// Returns the pairs of sides whose faces bound the same solid, if solids meet at the edge: around the
/// edge, the space is in turn behind both of two successive faces, and in front of both.
///
/// ```text
///        A │ B             Two boxes with a wall each: A is behind its top and its wall, B
///     ─────╫─────          likewise. Each top continues the other straight, but this is not one
///       A  ║  B            box.
/// ```
///
/// Sheets that cross each other, without faces at one place, are no solids: each continues straight.
fn solids([up, down]: &[Vec<f64>; 2]) -> Option<Vec<[usize; 2]>> {
    let is_straight = |a: f64, b: f64| steps(((a - b).rem_euclid(TAU) - PI).abs()) <= SAME;
    if up.len() != down.len() {
        return None;
    }
    let all = [(up, true), (down, false)]
        .into_iter()
        .flat_map(|(angles, is_up)| {
            let sides = angles.iter().enumerate();
            sides.map(move |(i, &angle)| Side {
                angle: angle.rem_euclid(TAU),
                is_up,
                i,
            })
        });
    let mut sides: Vec<Side> = all.collect();
    sides.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    let n = sides.len();
    let follows = |i: usize| {
        let turn = (sides[(i + 1) % n].angle - sides[i].angle).rem_euclid(TAU);
        steps(turn) <= SAME || steps(TAU - turn) <= SAME
    };
    // Begin after a gap, so that faces at one place are together.
    let first = (0..n).find(|&i| !follows(i))? + 1;
    let has_walls = (0..n).any(|i| follows(i) && sides[i].is_up != sides[(i + 1) % n].is_up);
    let mut free: Vec<f64> = down.clone();
    let all_straight = up.iter().all(|&a| {
        let partner = free.iter().position(|&b| is_straight(a, b));
        partner.map(|j| free.swap_remove(j)).is_some()
    });
    if all_straight && !has_walls {
        return None;
    }
    let mut groups: Vec<Vec<Side>> = Vec::new();
    for i in (first..first + n).map(|i| i % n) {
        match groups.last_mut() {
            Some(group) if i != first % n && follows((i + n - 1) % n) => group.push(sides[i]),
            _ => groups.push(vec![sides[i]]),
        }
    }
    let pairs = [true, false].into_iter().filter_map(|before| {
        let order = alternating(&groups, before)?;
        let pairs = (0..n).map(|i| [order[i], order[(i + 1) % n]]);
        // Counter-clockwise, the space from a side that runs down to one that runs up is behind both.
        Some(pairs.filter(|[from, _]| !from.is_up).collect::<Vec<_>>())
    });
    // Of two faces at one place, the fronts look at each other: a solid has a volume.
    let without_volume = |pairs: &Vec<[Side; 2]>| {
        let turns = pairs
            .iter()
            .map(|[from, to]| (to.angle - from.angle).rem_euclid(TAU));
        turns
            .filter(|&turn| steps(turn) <= SAME || steps(TAU - turn) <= SAME)
            .count()
    };
    let pairs = pairs.min_by_key(without_volume)?;
    Some(pairs.iter().map(|[from, to]| [to.i, from.i]).collect())
}

/// The largest difference of angles that are the same, in steps.
const SAME: u32 = 2;

/// A side at an edge.
#[derive(Clone, Copy)]
struct Side {
    angle: f64,
    is_up: bool,
    /// Its place in its list.
    i: usize,
}

/// Returns the sides in an order in which the directions alternate around the edge, after a side with
/// the direction `before`; `None` if no order does this. The sides of a group have the same angle.
fn alternating(groups: &[Vec<Side>], before: bool) -> Option<Vec<Side>> {
    let mut last = before;
    let mut order = Vec::new();
    for group in groups {
        let mut rest = group.clone();
        while !rest.is_empty() {
            let next = rest.iter().position(|side| side.is_up != last)?;
            last = !last;
            order.push(rest.remove(next));
        }
    }
    (last == before).then_some(order)
}

/// Orders the sides of an edge with many faces by angle, so that the sides at equal places continue
/// each other nearly straight.
pub(super) fn opposite_order(
    [up, down]: [&[CornerId]; 2],
    [up_angles, down_angles]: &[Vec<f64>; 2],
) -> [Vec<CornerId>; 2] {
    let sorted = |sides: &[CornerId], angles: &[f64], turn: f64| {
        let turned = angles.iter().map(|angle| (angle + turn).rem_euclid(TAU));
        let mut order: Vec<(f64, CornerId)> = turned.zip(sides.iter().copied()).collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.row().cmp(&b.1.row())));
        order.into_iter().map(|(_, side)| side).collect()
    };
    [sorted(up, up_angles, 0.0), sorted(down, down_angles, PI)]
}
