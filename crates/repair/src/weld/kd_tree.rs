//! A balanced kd-tree, by the crate `sixfold-spatial`.

use glam::DVec3;
use sixfold_spatial::{PointQueries, SpatialIndex, VertexPoint};

use super::Nearby;

/// The finite points in a kd-tree, each with its number.
pub(super) struct KdTree<'a> {
    points: &'a [DVec3],
    tree: sixfold_spatial::KdTree<VertexPoint<u32>>,
    /// The radius of the search, and a little more.
    radius: f64,
}

impl<'a> KdTree<'a> {
    /// Builds the tree for searches with this radius; O(n log n). `radius` is above zero, and the
    /// coordinates of the points are single precision.
    pub(super) fn new(points: &'a [DVec3], radius: f64) -> Self {
        let numbered = (0..).zip(points).filter(|(_, point)| point.is_finite());
        let items = numbered.map(|(vertex, point)| VertexPoint {
            vertex,
            position: point.as_vec3(),
        });
        let tree = sixfold_spatial::KdTree::build(items.collect());
        Self {
            points,
            tree: tree.expect("the points are finite, and vertices are limited to 32 bits"),
            // The square of the radius must not underflow.
            radius: (radius * 1.001).max(1e-100),
        }
    }
}

impl Nearby for KdTree<'_> {
    fn for_each_candidate(&self, at: u32, mut visit: impl FnMut(u32)) {
        let point = self.points[at as usize];
        let visit = |near: sixfold_spatial::Neighbour<u32>| visit(near.vertex);
        self.tree.for_each_within(point, self.radius, visit);
    }
}
