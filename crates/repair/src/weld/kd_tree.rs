//! A balanced kd-tree, by the crate `kd-tree`.

use glam::DVec3;

use super::Nearby;

/// The finite points in a kd-tree, each with its number.
pub(super) struct KdTree<'a> {
    points: &'a [DVec3],
    tree: kd_tree::KdTree<([f64; 3], u32)>,
    /// The radius of the search, and a little more.
    radius: f64,
}

impl<'a> KdTree<'a> {
    /// Builds the tree for searches with this radius; O(n log n). `radius` is above zero.
    pub(super) fn new(points: &'a [DVec3], radius: f64) -> Self {
        let numbered = points.iter().map(|point| point.to_array()).zip(0..);
        let finite = numbered.filter(|(point, _)| point.iter().all(|x| x.is_finite()));
        Self {
            points,
            tree: kd_tree::KdTree::build_by_ordered_float(finite.collect()),
            // The tree leaves out points at the radius; its square must not underflow.
            radius: (radius * 1.001).max(1e-100),
        }
    }
}

impl Nearby for KdTree<'_> {
    fn for_each_candidate(&self, at: u32, mut visit: impl FnMut(u32)) {
        let point = self.points[at as usize];
        if point.is_finite() {
            for &&(_, other) in &self.tree.within_radius(&point.to_array(), self.radius) {
                visit(other);
            }
        }
    }
}
