//! Queries about vertices.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;
use sixfold_core::for_each_chunk;

use crate::index::SpatialIndex;
use crate::item::VertexPoint;

/// Queries of one thread in a batch.
pub(crate) const CHUNK_QUERIES: usize = 256;

/// A vertex that a query found. Neighbours compare by distance, then by vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour<V> {
    /// The vertex.
    pub vertex: V,
    /// The squared distance to the query.
    pub distance_squared: f64,
}

impl<V> Neighbour<V> {
    /// Returns the distance to the query.
    pub fn distance(&self) -> f64 {
        self.distance_squared.sqrt()
    }
}

impl<V: Ord> Eq for Neighbour<V> {}

impl<V: Ord> PartialOrd for Neighbour<V> {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<V: Ord> Ord for Neighbour<V> {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        let by_distance = self.distance_squared.total_cmp(&other.distance_squared);
        by_distance.then_with(|| self.vertex.cmp(&other.vertex))
    }
}

/// Queries about vertices, for every index of [`VertexPoint`]s.
///
/// Distances are computed in double precision from the stored positions. Of two vertices at the same
/// distance, the lower one comes first. A query with a coordinate that is not finite, or beyond the
/// range of `f32`, finds nothing. No query allocates, except for the neighbours that it returns and
/// for the list of nodes to visit if a tree is unusually deep.
///
/// # Examples
///
/// ```
/// use sixfold_spatial::{KdTree, PointQueries, SpatialIndex, polygon_points};
/// use sixfold_core::VertexId;
///
/// let cube = sixfold_shapes::cube(); // corners at ±1
/// let tree = KdTree::build(polygon_points(&cube)?)?;
/// let nearest = tree.nearest([0.9, 0.8, 0.7]).expect("the cube has vertices");
/// assert_eq!(cube.position(nearest.vertex).to_array(), [1.0, 1.0, 1.0]);
/// let mut found = Vec::new();
/// tree.nearest_k_into([0.0, 0.0, 2.0], 4, &mut found);
/// assert!(found.iter().all(|n| n.distance_squared == 3.0));
/// # Ok::<(), sixfold_spatial::SpatialError>(())
/// ```
pub trait PointQueries<V: Copy + Ord + Send + Sync>: SpatialIndex<VertexPoint<V>> {
    /// Returns the vertex that is nearest to `query`; `None` if there are no vertices.
    #[inline]
    fn nearest(&self, query: impl Into<DVec3>) -> Option<Neighbour<V>> {
        self.nearest_where(query, f64::INFINITY, |_| true)
    }

    /// Returns the nearest vertex within `radius` that `accepts` accepts. `accepts` is called only
    /// with vertices that are nearer than all accepted before.
    #[inline]
    fn nearest_where(
        &self,
        query: impl Into<DVec3>,
        radius: f64,
        mut accepts: impl FnMut(V) -> bool,
    ) -> Option<Neighbour<V>> {
        let query = query.into();
        let items = self.items();
        let mut limit = squared_radius(radius)?;
        let mut best: Option<Neighbour<V>> = None;
        self.visit_near(query, limit, |slot| {
            let found = neighbour(query, &items[slot]);
            let is_better = found.distance_squared <= limit && best.is_none_or(|best| found < best);
            if is_better && accepts(found.vertex) {
                best = Some(found);
                limit = found.distance_squared;
            }
            limit
        });
        best
    }

    /// Calls `visit` with each vertex within `radius` of `query`, at this distance included. The
    /// order depends on the index.
    #[inline]
    fn for_each_within(
        &self,
        query: impl Into<DVec3>,
        radius: f64,
        mut visit: impl FnMut(Neighbour<V>),
    ) {
        let query = query.into();
        let items = self.items();
        let Some(limit) = squared_radius(radius) else {
            return;
        };
        self.visit_near(query, limit, |slot| {
            let found = neighbour(query, &items[slot]);
            if found.distance_squared <= limit {
                visit(found);
            }
            limit
        });
    }

    /// Replaces the content of `found` by the `k` nearest vertices, the nearest first. If there are
    /// fewer vertices, returns all of them. Allocates only if `found` has no room for them.
    fn nearest_k_into(&self, query: impl Into<DVec3>, k: usize, found: &mut Vec<Neighbour<V>>) {
        let query = query.into();
        let items = self.items();
        found.clear();
        if k == 0 {
            return;
        }
        // The farthest of the nearest vertices so far is at the top.
        let mut heap = BinaryHeap::from(std::mem::take(found));
        let mut limit = f64::INFINITY;
        self.visit_near(query, limit, |slot| {
            let new = neighbour(query, &items[slot]);
            if heap.len() < k {
                heap.push(new);
            } else if let Some(mut farthest) = heap.peek_mut()
                && new < *farthest
            {
                *farthest = new;
            }
            if heap.len() == k {
                limit = heap.peek().map_or(limit, |top| top.distance_squared);
            }
            limit
        });
        *found = heap.into_sorted_vec();
    }

    /// Returns the nearest vertex of each query, in order. With the feature `rayon`, the threads of
    /// the current rayon pool share the queries. Neighbouring queries should be near each other in
    /// memory, because they then use the same nodes.
    fn nearest_of_each<Q: Copy + Into<DVec3> + Sync>(
        &self,
        queries: &[Q],
    ) -> Vec<Option<Neighbour<V>>> {
        let mut found = vec![None; queries.len()];
        for_each_chunk(&mut found, CHUNK_QUERIES, |first, found| {
            for (found, query) in found.iter_mut().zip(&queries[first..]) {
                *found = self.nearest(*query);
            }
        });
        found
    }
}

impl<V: Copy + Ord + Send + Sync, T: SpatialIndex<VertexPoint<V>>> PointQueries<V> for T {}

#[inline(always)]
fn neighbour<V: Copy>(query: DVec3, item: &VertexPoint<V>) -> Neighbour<V> {
    Neighbour {
        vertex: item.vertex,
        distance_squared: (item.position.as_dvec3() - query).length_squared(),
    }
}

/// Returns the squared radius, or `None` if the radius is negative or NaN.
#[inline]
pub(crate) fn squared_radius(radius: f64) -> Option<f64> {
    (radius >= 0.0).then_some(radius * radius)
}
