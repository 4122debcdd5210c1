//! Newell's vector: the area and the normal of a polygon.

use glam::DVec3;

/// Newell's vector of a polygon (Sutherland, Sproull & Schumacker 1974).
///
/// The vector uses corners relative to the first corner, to stay accurate far from the origin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Newell {
    /// The sum so far. Its length is twice the area.
    pub normal: DVec3,
    first: Option<DVec3>,
    spoke: DVec3,
}

impl Newell {
    /// Adds the next corner.
    #[inline(always)]
    pub fn add(&mut self, at: DVec3) {
        let first = *self.first.get_or_insert(at);
        let next = at - first;
        self.normal += self.spoke.cross(next);
        self.spoke = next;
    }
}

/// Returns the area vector of a polygon, by Newell's method: the direction of the vector is the
/// normal, and its length is the area in squared units of the coordinates. O(corners).
pub fn area_vector(corners: impl IntoIterator<Item = DVec3>) -> DVec3 {
    let mut newell = Newell::default();
    corners.into_iter().for_each(|p| newell.add(p));
    newell.normal / 2.0
}
