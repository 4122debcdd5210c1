//! Removal of faces without area.
//!
//! ```text
//!      a ──── b ──── c            a ──── b ──── c      The triangle a b c has no area. The face on
//!       ╲ ‾‾‾‾‾‾‾‾ ╱               ╲     │     ╱       its longest edge a c gets the corner b, and
//!         ╲      ╱        ⇒          ╲   │   ╱         becomes two triangles if it is a triangle:
//!            d                           d             the edge is flipped. If two corners have one
//!                                                      position, their vertices are merged.
//! ```
//!
//! So neighbours stay neighbours. A face that was simply left out would leave a hole without area.

mod patch;

use glam::DVec3;
use sixfold_core::{FaceId, PolygonCutter, PolygonMesh, area_vector};

use self::patch::Patch;
use crate::error::RepairError;
use crate::outcome::Outcome;

/// Removes faces whose area is exactly zero. Expected O(n log n) for n corners, if the number of
/// faces at a vertex is bounded.
pub(crate) fn remove(polygons: &PolygonMesh) -> Result<Outcome, RepairError> {
    let faces = polygons.faces().iter().map(|(f, _)| f);
    let flat: Vec<FaceId> = faces.filter(|&f| is_flat(polygons, f)).collect();
    if flat.is_empty() {
        return Ok(Outcome::unchanged());
    }
    let mut patch = Patch::new(polygons, &flat);
    patch.remove_flat(ATTEMPTS * flat.len());
    patch.finish()
}

/// The largest number of attempts to remove faces, by the number of faces without area. Real meshes
/// need one or two; the limit is for meshes in which most vertices lie on one line.
const ATTEMPTS: usize = 64;

/// Returns whether the area of `f` is exactly zero in double precision. A face with a coordinate
/// that is not finite has no area vector, and is not flat.
pub(crate) fn is_flat(polygons: &PolygonMesh, f: FaceId) -> bool {
    let corners = polygons.faces().face(f).iter();
    is_without_area(corners.map(|&v| polygons.position(v).as_dvec3()))
}

/// Returns whether a face has no area: its area vector is zero, and so is each triangle of it. The
/// vector alone is also zero if parts of a polygon that crosses itself cancel out.
fn is_without_area(corners: impl ExactSizeIterator<Item = DVec3> + Clone) -> bool {
    if area_vector(corners.clone()) != DVec3::ZERO {
        return false;
    }
    if corners.len() == 3 {
        return true;
    }
    let corners: Vec<DVec3> = corners.collect();
    let mut cutter = PolygonCutter::default();
    let cut = cutter.cut(corners.iter().copied(), |_, _| false);
    let mut triangles = cut.triangles.iter().map(|t| t.map(|i| corners[i]));
    triangles.all(|triangle| area_vector(triangle) == DVec3::ZERO)
}

#[cfg(test)]
mod tests;
