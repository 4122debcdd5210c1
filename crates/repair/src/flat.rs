//! Removal of faces without area.

use glam::DVec3;
use sixfold_core::{FaceId, PolygonMesh, area_vector};

use crate::error::RepairError;
use crate::outcome::Outcome;
use crate::remove::without;

/// Removes faces whose area is exactly zero; O(corners). The vertices remain.
pub(crate) fn remove(polygons: &PolygonMesh) -> Result<Outcome, RepairError> {
    without(polygons, |_| true, |f| !is_flat(polygons, f))
}

/// Returns whether the area of `f` is exactly zero in double precision. A face with a coordinate
/// that is not finite has no area vector, and is not flat.
pub(crate) fn is_flat(polygons: &PolygonMesh, f: FaceId) -> bool {
    let corners = polygons.faces().face(f).iter();
    area_vector(corners.map(|&v| polygons.position(v).as_dvec3())) == DVec3::ZERO
}
