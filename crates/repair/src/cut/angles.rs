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

/// Returns the preference of a pair: how far the two faces are from continuing each other straight,
/// then the angle between them behind the faces, both in steps.
pub(super) fn preference(up: f64, down: f64) -> Preference {
    let behind = (up - down).rem_euclid(TAU);
    let steps = |angle: f64| (angle * STEPS).round() as u32;
    (steps((behind - PI).abs()), steps(behind))
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
