//! The distance between two surfaces.

use glam::DVec3;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use sixfold_core::{MAX_ROWS, PolygonMesh, for_each_chunk};

use crate::error::DistanceError;
use crate::index::SpatialIndex;
use crate::item::{FaceTriangle, polygon_triangles};
use crate::sampling::{AreaSamples, Sampling};
use crate::surface_queries::{SearchHint, SurfaceQueries};
use crate::tree::Bvh;

/// Queries of one block. Each block has its own random numbers, so the result does not depend on the
/// number of threads.
const BLOCK: usize = 4096;

/// The distances from the points of one surface to another surface, in the unit of the coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OneSidedDistance {
    /// The mean over the surface, estimated from the samples.
    pub mean: f64,
    /// The root of the mean square over the surface, estimated from the samples.
    pub root_mean_square: f64,
    /// The largest distance of a sample or a vertex: a lower bound of the one-sided Hausdorff
    /// distance.
    pub largest: f64,
    /// The sample or vertex with the largest distance. In a tie, the first; vertices come first.
    pub farthest: DVec3,
    /// The number of samples; 0 if the surface has no area, and then the means are over vertices.
    pub samples: usize,
    /// The number of vertices that were measured: those of faces.
    pub vertices: usize,
}

/// The distances between two surfaces, in both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshDistance {
    /// From the first mesh to the second.
    pub forward: OneSidedDistance,
    /// From the second mesh to the first.
    pub backward: OneSidedDistance,
}

impl MeshDistance {
    /// Returns the mean of the two mean distances.
    pub fn mean(&self) -> f64 {
        0.5 * (self.forward.mean + self.backward.mean)
    }

    /// Returns the root of the mean of the two mean squares.
    pub fn root_mean_square(&self) -> f64 {
        let squares = [self.forward, self.backward].map(|side| side.root_mean_square.powi(2));
        (0.5 * (squares[0] + squares[1])).sqrt()
    }

    /// Returns the larger of the two largest distances: a lower bound of the Hausdorff distance.
    pub fn largest(&self) -> f64 {
        self.forward.largest.max(self.backward.largest)
    }

    fn scaled(self, factor: f64) -> Self {
        let scaled = |side: OneSidedDistance| OneSidedDistance {
            mean: factor * side.mean,
            root_mean_square: factor * side.root_mean_square,
            largest: factor * side.largest,
            farthest: factor * side.farthest,
            ..side
        };
        Self {
            forward: scaled(self.forward),
            backward: scaled(self.backward),
        }
    }
}

/// Measures the distance between the surfaces of two meshes, in both directions.
///
/// Each surface is sampled evenly by area, and the closest point of the other surface is computed for
/// each sample and each vertex, as in Metro (Cignoni, Rocchini & Scopigno 1998). The closest points
/// are exact; the means are estimates; meshes with the same positions and faces are 0 apart. Polygons are measured as the triangles
/// of [`polygon_triangles`]. With the feature `rayon`, the threads of the current pool share the
/// queries; the result has the same bits on any number of threads.
///
/// O((faces + samples) · log faces) expected.
///
/// # Errors
///
/// [`DistanceError::NoFaces`] if a mesh has no faces; [`DistanceError::Mesh`] if a position is not
/// finite; [`DistanceError::TooManySamples`] beyond `u32::MAX` samples.
///
/// # Examples
///
/// ```
/// use sixfold_spatial::{Sampling, mesh_distance};
///
/// let cube = sixfold_shapes::cube(); // corners at ±1
/// let octahedron = sixfold_shapes::octahedron(); // corners at ±1 on the axes
/// let distance = mesh_distance(&cube, &octahedron, Sampling::default())?;
/// let corner = 2.0 / 3_f64.sqrt(); // from (1, 1, 1) to the plane x + y + z = 1
/// assert!((distance.largest() - corner).abs() < 1e-6);
/// assert!(distance.forward.mean < distance.forward.root_mean_square);
/// # Ok::<(), sixfold_spatial::DistanceError>(())
/// ```
pub fn mesh_distance(
    first: &PolygonMesh,
    second: &PolygonMesh,
    sampling: Sampling,
) -> Result<MeshDistance, DistanceError> {
    let sizes = [first, second].map(largest_coordinate);
    if let Some(factor) = unusual_scale(sizes[0].max(sizes[1])) {
        let [first, second] = [first, second].map(|mesh| scaled(mesh, factor));
        return Ok(distance_of_usual(&first, &second, sampling)?.scaled(1.0 / factor));
    }
    distance_of_usual(first, second, sampling)
}

/// Measures the distance of meshes whose coordinates are not so large or small that the index becomes slow.
fn distance_of_usual(
    first: &PolygonMesh,
    second: &PolygonMesh,
    sampling: Sampling,
) -> Result<MeshDistance, DistanceError> {
    let [to_first, to_second] = [surface("first", first)?, surface("second", second)?];
    // The samples of thin triangles are off them by more than rounding.
    let is_same = first.positions() == second.positions() && first.faces() == second.faces();
    let rounding = if is_same {
        f64::INFINITY
    } else {
        SAMPLE_ROUNDING
    };
    Ok(MeshDistance {
        forward: one_sided("first", first, &to_second, sampling, rounding)?,
        backward: one_sided("second", second, &to_first, sampling, rounding)?,
    })
}

/// Returns the largest coordinate without its sign, of those that are finite.
fn largest_coordinate(mesh: &PolygonMesh) -> f32 {
    let largest = mesh.positions().iter().map(|p| p.abs().max_element());
    largest.filter(|x| x.is_finite()).fold(0.0, f32::max)
}

/// Returns a power of two that brings coordinates up to `largest` near 1, if squares of them may leave the
/// range of `f32`, in which the index has its bounds.
fn unusual_scale(largest: f32) -> Option<f64> {
    let is_usual = largest == 0.0 || (1e-12..1e15).contains(&largest);
    (!is_usual).then(|| (-f64::from(largest).log2().floor()).exp2())
}

/// Returns the mesh with all positions multiplied by `factor`, a power of two.
fn scaled(mesh: &PolygonMesh, factor: f64) -> PolygonMesh {
    let positions = mesh.positions().iter();
    let positions = positions.map(|p| (p.as_dvec3() * factor).as_vec3());
    PolygonMesh::from_faces(positions.collect(), mesh.faces().clone())
        .unwrap_or_else(|_| mesh.clone()) // unreachable: the mesh has as many vertices
}

/// Measures the distances from the surface of `from` to the surface in an index, as
/// [`mesh_distance`] does in both directions.
///
/// # Errors
///
/// [`DistanceError::NoFaces`] if `from` (`first`) or the index (`second`) has no faces;
/// [`DistanceError::Mesh`] if a position of `from` is not finite; [`DistanceError::TooManySamples`]
/// beyond `u32::MAX` samples.
pub fn one_sided_distance<F: Copy + Ord + Send + Sync>(
    from: &PolygonMesh,
    to: &impl SurfaceQueries<F>,
    sampling: Sampling,
) -> Result<OneSidedDistance, DistanceError> {
    if to.items().is_empty() {
        return Err(DistanceError::NoFaces { mesh: "second" });
    }
    one_sided("first", from, to, sampling, SAMPLE_ROUNDING)
}

type Surface = Bvh<FaceTriangle<sixfold_core::FaceId>>;

/// Builds the index of a mesh that has faces.
fn surface(mesh: &'static str, polygons: &PolygonMesh) -> Result<Surface, DistanceError> {
    if polygons.face_count() == 0 {
        return Err(DistanceError::NoFaces { mesh });
    }
    polygon_triangles(polygons)
        .and_then(Bvh::build)
        .map_err(|error| DistanceError::Mesh { mesh, error })
}

/// `rounding` is the distance below which samples count as on the surface, as a part of the largest
/// coordinate.
fn one_sided<F: Copy + Ord + Send + Sync>(
    mesh: &'static str,
    from: &PolygonMesh,
    to: &impl SurfaceQueries<F>,
    sampling: Sampling,
    rounding: f64,
) -> Result<OneSidedDistance, DistanceError> {
    if from.face_count() == 0 {
        return Err(DistanceError::NoFaces { mesh });
    }
    if sampling.samples > MAX_ROWS {
        return Err(DistanceError::TooManySamples {
            samples: sampling.samples,
            limit: MAX_ROWS,
        });
    }
    let triangles = polygon_triangles(from).map_err(|error| DistanceError::Mesh { mesh, error })?;
    let vertices = vertices_of_faces(from);
    let at_vertices = sums(to, vertices.len(), 0.0, |_, range, visit| {
        vertices[range].iter().for_each(|&vertex| visit(vertex));
    });
    let samples = AreaSamples::new(&triangles, sampling);
    let largest = |triangle: &FaceTriangle<_>| {
        let corners = triangle.corners_f64();
        corners
            .map(|corner| corner.abs().max_element())
            .into_iter()
            .fold(0.0, f64::max)
    };
    let rounding = rounding
        * triangles
            .iter()
            .map(largest)
            .fold(f64::MIN_POSITIVE, f64::max);
    let at_samples = sums(to, samples.len(), rounding, |block, range, visit| {
        let mut random = ChaCha8Rng::seed_from_u64(sampling.seed);
        random.set_stream(block as u64);
        samples.for_each(range, &mut random, visit);
    });
    let over = if samples.len() > 0 {
        &at_samples
    } else {
        &at_vertices
    };
    let (largest_squared, farthest) = at_vertices.with(at_samples).farthest;
    Ok(OneSidedDistance {
        mean: over.sum / over.points as f64,
        root_mean_square: (over.sum_of_squares / over.points as f64).sqrt(),
        largest: largest_squared.sqrt(),
        farthest,
        samples: at_samples.points,
        vertices: at_vertices.points,
    })
}

/// The rounding error of a sample and its distance, as a part of the largest coordinate: samples of a surface
/// that are on the other surface are not off it by rounding.
const SAMPLE_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Returns the positions of the vertices that faces name, each once, in the order of the vertices.
fn vertices_of_faces(polygons: &PolygonMesh) -> Vec<DVec3> {
    let positions = polygons.positions().iter().zip(polygons.has_faces());
    positions
        .filter(|&(_, has_face)| has_face)
        .map(|(position, _)| position.as_dvec3())
        .collect()
}

/// Sums over the distances of some points.
#[derive(Clone, Copy)]
struct Sums {
    points: usize,
    sum: f64,
    sum_of_squares: f64,
    /// The largest squared distance, and its point.
    farthest: (f64, DVec3),
}

impl Sums {
    const NONE: Self = Self {
        points: 0,
        sum: 0.0,
        sum_of_squares: 0.0,
        farthest: (f64::NEG_INFINITY, DVec3::ZERO),
    };

    /// Adds the sums over later points.
    fn with(self, later: Self) -> Self {
        Self {
            points: self.points + later.points,
            sum: self.sum + later.sum,
            sum_of_squares: self.sum_of_squares + later.sum_of_squares,
            farthest: if later.farthest.0 > self.farthest.0 {
                later.farthest
            } else {
                self.farthest
            },
        }
    }
}

/// Sums the distances of `points` points to a surface. Distances up to `rounding` are 0. `points_of`
/// passes the points of a range to a function; it also gets the number of the block.
fn sums<F: Copy + Ord + Send + Sync>(
    to: &impl SurfaceQueries<F>,
    points: usize,
    rounding: f64,
    points_of: impl Fn(usize, std::ops::Range<usize>, &mut dyn FnMut(DVec3)) + Sync,
) -> Sums {
    let mut blocks = vec![Sums::NONE; points.div_ceil(BLOCK)];
    for_each_chunk(&mut blocks, 1, |block, sums| {
        let range = block * BLOCK..points.min((block + 1) * BLOCK);
        let mut hint = SearchHint::default();
        points_of(block, range, &mut |point| {
            let Some(squared) = to.distance_squared_from(point, &mut hint) else {
                return; // unreachable: the surface has faces and the point is finite
            };
            let squared = if squared > rounding * rounding {
                squared
            } else {
                0.0
            };
            sums[0] = sums[0].with(Sums {
                points: 1,
                sum: squared.sqrt(),
                sum_of_squares: squared,
                farthest: (squared, point),
            });
        });
    });
    blocks.into_iter().fold(Sums::NONE, Sums::with)
}

#[cfg(test)]
mod tests;
