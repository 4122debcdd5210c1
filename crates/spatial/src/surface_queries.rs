//! Queries about the surface: closest points and ray hits.

use glam::DVec3;
use sixfold_core::for_each_chunk;

use crate::index::{SpatialIndex, can_search};
use crate::item::{FaceTriangle, Item};
use crate::point_queries::{CHUNK_QUERIES, squared_radius};
use crate::ray::Ray;
use crate::triangle::offset_to_triangle;

/// The closest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<F> {
    /// The face with the point. If several faces have the same distance, the lowest.
    pub face: F,
    /// The point.
    pub point: DVec3,
    /// The squared distance to the query.
    pub distance_squared: f64,
}

impl<F> SurfacePoint<F> {
    /// Returns the distance to the query.
    pub fn distance(&self) -> f64 {
        self.distance_squared.sqrt()
    }
}

/// Where a ray hits a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit<F> {
    /// The face. If several faces are hit at the same parameter, the lowest.
    pub face: F,
    /// The parameter `t` of the ray: the distance in lengths of its direction.
    pub t: f64,
}

/// The place where the last search ended, from which the next one starts.
///
/// A search that starts at a triangle near the result skips most of the index. An algorithm that
/// moves vertices a little and returns them to the surface, again and again, keeps one hint for each
/// vertex. A walk over samples passes one hint from sample to sample. A hint never changes the
/// result. A hint of another index is allowed; it does not help.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchHint {
    slot: Option<u32>,
    visits: u64,
}

impl SearchHint {
    /// Returns how many triangles the searches with this hint have compared with their queries: the
    /// larger part of their time.
    pub fn visits(&self) -> u64 {
        self.visits
    }
}

/// Queries about surfaces, for every index of [`FaceTriangle`]s.
///
/// Everything is computed in double precision from the stored corners. A query with a coordinate
/// that is not finite, or beyond the range of `f32`, finds nothing. No query allocates, except for
/// the list of nodes to visit if a tree is unusually deep.
///
/// # Examples
///
/// ```
/// use sixfold_spatial::{Bvh, Ray, SpatialIndex, SurfaceQueries, polygon_triangles};
///
/// let surface = Bvh::build(polygon_triangles(&sixfold_shapes::cube())?)?; // corners at ±1
/// let closest = surface.closest_point([3.0, 0.25, 0.5]).expect("the cube has faces");
/// assert_eq!((closest.point.to_array(), closest.distance()), ([1.0, 0.25, 0.5], 2.0));
/// let hit = surface.first_hit(&Ray::new([0.1, 0.2, 9.0], [0.0, 0.0, -2.0])?, f64::INFINITY);
/// assert_eq!(hit.expect("it hits the top").t, 4.0);
/// # Ok::<(), sixfold_spatial::SpatialError>(())
/// ```
pub trait SurfaceQueries<F: Copy + Ord + Send + Sync>: SpatialIndex<FaceTriangle<F>> {
    /// Returns the point of the surface that is closest to `query`; `None` if there are no faces.
    #[inline]
    fn closest_point(&self, query: impl Into<DVec3>) -> Option<SurfacePoint<F>> {
        self.closest_point_from(query, &mut SearchHint::default())
    }

    /// Returns what [`closest_point`](Self::closest_point) returns, in less time if `hint` is the
    /// result of a query nearby. Stores the new place in `hint`.
    #[inline]
    fn closest_point_from(
        &self,
        query: impl Into<DVec3>,
        hint: &mut SearchHint,
    ) -> Option<SurfacePoint<F>> {
        self.closest_point_where(query, f64::INFINITY, hint, |_| true)
    }

    /// Returns the squared distance to the surface, in less time if `hint` is the result of a query
    /// nearby; `None` if there are no faces. Unlike [`closest_point_from`](Self::closest_point_from), it
    /// ends at the first face that the query is on.
    #[inline]
    fn distance_squared_from(&self, query: impl Into<DVec3>, hint: &mut SearchHint) -> Option<f64> {
        let query = query.into();
        let items = self.items();
        let mut best: Option<(usize, f64)> = None;
        let visits = &mut hint.visits;
        let mut visit = |slot: usize| {
            *visits += 1;
            let squared = offset_to_triangle(query, &items[slot]).length_squared();
            if best.is_none_or(|(_, least)| squared < least) {
                best = Some((slot, squared));
            }
            match best {
                Some((_, least)) if least > 0.0 => least,
                // Nothing is nearer.
                _ => f64::NEG_INFINITY,
            }
        };
        let mut limit = f64::INFINITY;
        let start = hint.slot.map(|slot| slot as usize);
        if let Some(slot) = start.filter(|&slot| slot < items.len() && can_search(query)) {
            limit = visit(slot);
        }
        self.visit_near(query, limit, visit);
        let (slot, squared) = best?;
        hint.slot = u32::try_from(slot).ok();
        Some(squared)
    }

    /// Returns whether the surface is within `radius` of `query`, at this distance included. Ends at the
    /// first face that is.
    #[inline]
    fn is_within(&self, query: impl Into<DVec3>, radius: f64) -> bool {
        let query = query.into();
        let items = self.items();
        // A little more, because the root of a squared distance is rounded.
        let Some(limit) = squared_radius(radius * (1.0 + 1e-12)) else {
            return false;
        };
        let mut is_within = false;
        self.visit_near(query, limit, |slot| {
            is_within |= offset_to_triangle(query, &items[slot]).length() <= radius;
            if is_within { f64::NEG_INFINITY } else { limit }
        });
        is_within
    }

    /// Returns the closest point of the faces whose normal agrees with `normal`: the cosine of the
    /// angle between them is at least `least_cosine`. So a point does not get to the other side of a
    /// thin wall. Faces without area are left out.
    ///
    /// `normal` needs no particular length. If it is zero, only `least_cosine ≤ 0` accepts faces.
    #[inline]
    fn closest_point_facing(
        &self,
        query: impl Into<DVec3>,
        normal: DVec3,
        least_cosine: f64,
        hint: &mut SearchHint,
    ) -> Option<SurfacePoint<F>> {
        let normal = normal.normalize_or_zero();
        self.closest_point_where(query, f64::INFINITY, hint, |triangle| {
            let other = triangle.normal();
            let length = other.length();
            length > 0.0 && normal.dot(other) >= least_cosine * length
        })
    }

    /// Returns the closest point within `radius` on the triangles that `accepts` accepts. `accepts`
    /// is called only with triangles that are at least as near as all accepted before.
    #[inline]
    fn closest_point_where(
        &self,
        query: impl Into<DVec3>,
        radius: f64,
        hint: &mut SearchHint,
        mut accepts: impl FnMut(&FaceTriangle<F>) -> bool,
    ) -> Option<SurfacePoint<F>> {
        let query = query.into();
        let items = self.items();
        let mut limit = squared_radius(radius)?;
        let mut first_limit = limit;
        let mut best: Option<(usize, F, DVec3)> = None;
        let visits = &mut hint.visits;
        let mut visit = |slot: usize| {
            *visits += 1;
            let triangle = &items[slot];
            let offset = offset_to_triangle(query, triangle);
            let squared = offset.length_squared();
            // In a tie, the lower face wins; within a face, the offset that compares lower.
            let is_better = squared < limit
                || squared == limit
                    && best.is_none_or(|(_, face, at)| {
                        triangle.face < face || triangle.face == face && precedes(offset, at)
                    });
            if is_better && accepts(triangle) {
                best = Some((slot, triangle.face, offset));
                limit = squared;
            }
            limit
        };
        let start = hint.slot.map(|slot| slot as usize);
        if let Some(slot) = start.filter(|&slot| slot < items.len() && can_search(query)) {
            first_limit = visit(slot);
        }
        self.visit_near(query, first_limit, visit);
        let (slot, face, offset) = best?;
        hint.slot = u32::try_from(slot).ok();
        Some(SurfacePoint {
            face,
            point: query + offset,
            distance_squared: offset.length_squared(),
        })
    }

    /// Returns the closest point for each query, in order. With the feature `rayon`, the threads of
    /// the current rayon pool share the queries. Each query starts where the one before ended, so
    /// this is fastest if consecutive queries are near each other.
    fn closest_point_of_each<Q: Copy + Into<DVec3> + Sync>(
        &self,
        queries: &[Q],
    ) -> Vec<Option<SurfacePoint<F>>> {
        let mut found = vec![None; queries.len()];
        for_each_chunk(&mut found, CHUNK_QUERIES, |first, found| {
            let mut hint = SearchHint::default();
            for (found, query) in found.iter_mut().zip(&queries[first..]) {
                *found = self.closest_point_from(*query, &mut hint);
            }
        });
        found
    }

    /// Returns the first hit of `ray` up to parameter `limit`, from either side of a face. Sides and
    /// corners belong to a face; a ray in the plane of a face does not hit it.
    #[inline]
    fn first_hit(&self, ray: &Ray, limit: f64) -> Option<RayHit<F>> {
        self.first_hit_where(ray, limit, |_| true)
    }

    /// Returns the first hit of `ray` up to parameter `limit` on the triangles that `accepts` accepts.
    /// `accepts` is called only with triangles that are hit at least as early as all accepted before.
    #[inline]
    fn first_hit_where(
        &self,
        ray: &Ray,
        limit: f64,
        mut accepts: impl FnMut(&FaceTriangle<F>) -> bool,
    ) -> Option<RayHit<F>> {
        let items = self.items();
        let mut limit = scaled_limit(ray, limit)?;
        let mut best: Option<F> = None;
        self.visit_along(ray, limit, |slot| {
            let triangle = &items[slot];
            if let Some(t) = ray.hit(&triangle.bounds(), triangle) {
                let in_tie = || t == limit && best.is_none_or(|best| triangle.face < best);
                if (t < limit || in_tie()) && accepts(triangle) {
                    limit = t;
                    best = Some(triangle.face);
                }
            }
            limit
        });
        let t = ray.given(limit);
        best.map(|face| RayHit { face, t })
    }

    /// Calls `visit` with each hit of `ray` up to parameter `limit`, in an order that depends on the
    /// index. Where the ray passes through a side, both faces are hit; a polygon is hit twice on a
    /// diagonal along which it is cut.
    #[inline]
    fn for_each_hit(&self, ray: &Ray, limit: f64, mut visit: impl FnMut(RayHit<F>)) {
        let items = self.items();
        let Some(limit) = scaled_limit(ray, limit) else {
            return;
        };
        self.visit_along(ray, limit, |slot| {
            let triangle = &items[slot];
            if let Some(t) = ray.hit(&triangle.bounds(), triangle)
                && t <= limit
            {
                let (face, t) = (triangle.face, ray.given(t));
                visit(RayHit { face, t });
            }
            limit
        });
    }

    /// Returns the first hit of each ray, in order. With the feature `rayon`, the threads of the
    /// current rayon pool share the rays.
    fn first_hit_of_each(&self, rays: &[Ray]) -> Vec<Option<RayHit<F>>> {
        let mut found = vec![None; rays.len()];
        for_each_chunk(&mut found, CHUNK_QUERIES, |first, found| {
            for (found, ray) in found.iter_mut().zip(&rays[first..]) {
                *found = self.first_hit(ray, f64::INFINITY);
            }
        });
        found
    }
}

impl<F: Copy + Ord + Send + Sync, T: SpatialIndex<FaceTriangle<F>>> SurfaceQueries<F> for T {}

/// Returns whether `offset` comes before `other`, coordinate by coordinate.
fn precedes(offset: DVec3, other: DVec3) -> bool {
    let coordinates = offset.to_array().into_iter().zip(other.to_array());
    coordinates
        .map(|(a, b)| a.total_cmp(&b))
        .find(|order| order.is_ne())
        .is_some_and(|order| order.is_lt())
}

/// Returns the limit in units of the longest coordinate, or `None` if it is negative or NaN.
#[inline]
fn scaled_limit(ray: &Ray, limit: f64) -> Option<f64> {
    (limit >= 0.0).then(|| ray.scaled(limit))
}
