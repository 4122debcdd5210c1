//! The vertices, triangles, query points and rays.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use sixfold::glam::DVec3;
use sixfold::spatial::{
    FaceTriangle, Ray, SpatialError, VertexPoint, polygon_points, polygon_triangles,
};
use sixfold::{FaceId, PolygonMesh, VertexId};
use sixfold_results::QueryPoints;

/// Maximum number of query points.
pub const MAX_QUERIES: usize = 10_000;
/// How far a query point near the surface may be from a vertex, as a part of the diagonal of the
/// bounding box.
const NEAR: f64 = 0.01;
/// The radius of a query, as a multiple of the mean distance from a vertex to the next vertex of
/// its face.
const RADIUS: f64 = 2.0;

/// An item of the indices of vertices.
pub type Vertex = VertexPoint<VertexId>;
/// An item of the indices of triangles.
pub type Triangle = FaceTriangle<FaceId>;

/// The input of all indices: what they store, and what they are asked.
pub struct Input {
    /// The vertices of the mesh.
    pub vertices: Vec<Vertex>,
    /// The triangles of the mesh.
    pub triangles: Vec<Triangle>,
    /// The query points.
    pub points: Vec<DVec3>,
    /// A ray from each query point to another query point.
    pub rays: Vec<Ray>,
    /// The radius of [`SpatialTask::VerticesWithin`](sixfold_results::SpatialTask::VerticesWithin).
    pub radius: f64,
}

impl Input {
    /// Makes up to [`MAX_QUERIES`] query points.
    ///
    /// # Errors
    ///
    /// Returns an error if a position of the mesh is not finite.
    pub fn new(
        polygons: &PolygonMesh,
        points: QueryPoints,
        seed: u64,
    ) -> Result<Self, SpatialError> {
        let (vertices, triangles) = (polygon_points(polygons)?, polygon_triangles(polygons)?);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let positions = || vertices.iter().map(|vertex| vertex.position.as_dvec3());
        let low = positions().fold(DVec3::INFINITY, DVec3::min);
        let high = positions().fold(DVec3::NEG_INFINITY, DVec3::max);
        let count = vertices.len().min(MAX_QUERIES);
        let mut in_cube = || DVec3::from_array(std::array::from_fn(|_| random.random::<f64>()));
        let points: Vec<DVec3> = match points {
            QueryPoints::Near => {
                let reach = NEAR * low.distance(high);
                let chosen = (0..count).map(|i| i * vertices.len() / count);
                let near = chosen.map(|vertex| {
                    let offset = 2.0 * in_cube() - 1.0;
                    vertices[vertex].position.as_dvec3() + reach * offset
                });
                near.collect()
            }
            QueryPoints::Box => (0..count).map(|_| low + in_cube() * (high - low)).collect(),
        };
        let targets = points.iter().rev();
        let rays = points.iter().zip(targets);
        let rays = rays.filter_map(|(&from, &to)| Ray::new(from, to - from).ok());
        Ok(Self {
            rays: rays.collect(),
            radius: RADIUS * mean_side(&triangles),
            points,
            vertices,
            triangles,
        })
    }
}

/// Returns the mean length of the first sides of all triangles.
fn mean_side(triangles: &[Triangle]) -> f64 {
    let sides = triangles.iter().map(|triangle| {
        let [a, b, _] = triangle.corners_f64();
        a.distance(b)
    });
    sides.sum::<f64>() / triangles.len().max(1) as f64
}
