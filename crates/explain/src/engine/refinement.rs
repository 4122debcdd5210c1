//! Subdivision level by level, and the weights of the points.

use std::iter;
use std::ops::Range;

use serde::Serialize;
use sixfold::subdivision::{Extent, Scheme, Step, Subdivision, SubdivisionError, build_level};
use sixfold::{Creases, FaceVertexMesh, Point, PolygonMesh};
use sixfold_core::ElementName;

use super::Error;
use super::source::{check_positions, check_size};

/// Maximum number of levels. Most meshes reach the maximum number of corners before, but a mesh without
/// faces does not grow.
const MOST_LEVELS: u32 = 16;

/// Maximum number of vertices of a mesh whose weights are computed.
const MOST_PARENTS: usize = 20_000;

/// Smaller sums are rounding errors of weights that are 0: weights are at most a few times 1.
const LEAST_WEIGHT: f32 = 1e-7;

/// Maximum difference between a point and the sum of its parents, whose coordinates are at most 2.
const TOLERANCE: f32 = 1e-5;

/// Number of attempts to find the weights.
const SEEDS: u32 = 4;

/// A point of the level before, with its weight in a new point.
#[derive(Debug, Serialize)]
pub(super) struct Parent {
    vertex: String,
    weight: f32,
}

/// Returns the mesh before the first step, and after each of `levels` steps.
pub(super) fn levels(
    scheme: Scheme,
    polygons: &PolygonMesh,
    creases: &Creases,
    levels: u32,
) -> Result<Vec<Step>, Error> {
    if levels > MOST_LEVELS {
        return Err(format!("a request has at most {MOST_LEVELS} levels").into());
    }
    let subdivision = Subdivision::new(scheme);
    let mut extent = Extent::from_polygons(polygons);
    for level in 0..levels {
        extent = subdivision.refined_extent(&extent, level);
        check_size(extent.counts.corners)?;
    }
    let mesh: FaceVertexMesh = build_level(polygons, 0)?;
    let mut steps = vec![Step {
        polygons: polygons.clone(),
        creases: subdivision.control_creases(&mesh, polygons, creases)?,
    }];
    for level in 0..levels {
        let parent = &steps[level as usize];
        let step = refined(&subdivision, &parent.polygons, &parent.creases, level)?;
        check_positions(&step.polygons, "the refined mesh")?;
        steps.push(step);
    }
    Ok(steps)
}

/// Returns the mesh after the step `level`; the first step has level 0.
fn refined(
    subdivision: &Subdivision,
    polygons: &PolygonMesh,
    creases: &Creases,
    level: u32,
) -> Result<Step, SubdivisionError> {
    let mesh: FaceVertexMesh = build_level(polygons, level)?;
    subdivision.gather(&mesh, creases, level)
}

/// Returns the weights of the points of level `level` − 1 in point `point` of level `level`.
///
/// A step is linear: a point is the sum of the weights if the points with these weights are at 1, and all
/// others at 0. So the step itself is run on such positions. O(k log n) steps for k weights of n points:
/// sets of points are halved, and those whose weights are all 0 are left out.
pub(super) fn stencil(
    scheme: Scheme,
    polygons: &PolygonMesh,
    creases: &Creases,
    level: u32,
    point: u32,
) -> Result<Vec<Parent>, Error> {
    let Some(before) = level.checked_sub(1) else {
        return Err("the points of level 0 have no parents: ask for level 1 or higher".into());
    };
    let steps = levels(scheme, polygons, creases, level)?;
    let [.., parent, child] = &steps[..] else {
        unreachable!("one step at least")
    };
    let (parents, points) = (
        parent.polygons.vertex_count(),
        child.polygons.vertex_count(),
    );
    if parents > MOST_PARENTS {
        return Err(format!(
            "the level before has {parents} vertices, and weights are computed for at most {MOST_PARENTS}"
        )
        .into());
    }
    let point = point as usize;
    if point >= points {
        return Err(format!("level {level} has {points} points, from v0, and no v{point}").into());
    }
    let step = |positions| {
        let probed = PolygonMesh::from_faces(positions, parent.polygons.faces().clone())?;
        let child = refined(&Subdivision::new(scheme), &probed, &parent.creases, before)?;
        Ok(child.polygons.positions()[point])
    };
    let weights = weights(parents, step)?;
    let parent = |(vertex, weight)| Parent {
        vertex: ElementName::Vertex(vertex as u32).to_string(),
        weight,
    };
    Ok(weights.into_iter().map(parent).collect())
}

/// Returns the points with a weight, and the weights. `step` returns the new point for given positions of
/// `parents` points.
fn weights(
    parents: usize,
    step: impl Fn(Vec<Point>) -> Result<Point, Error>,
) -> Result<Vec<(usize, f32)>, Error> {
    for seed in 0..SEEDS {
        let weights = weights_with(parents, seed, &step)?;
        // Positive and negative weights of a set can add up to 0. Then other positions show it.
        let other = |vertex| Point::from([1, 2, 3].map(|axis| probe(vertex, SEEDS * axis)));
        let expected = step((0..parents).map(other).collect())?;
        let sum: Point = (weights.iter())
            .map(|&(vertex, weight)| weight * other(vertex))
            .sum();
        if (sum - expected).abs().max_element() < TOLERANCE {
            return Ok(weights);
        }
    }
    Err("the weights of this point were not found".into())
}

fn weights_with(
    parents: usize,
    seed: u32,
    step: &impl Fn(Vec<Point>) -> Result<Point, Error>,
) -> Result<Vec<(usize, f32)>, Error> {
    let mut weights = Vec::new();
    let mut sets: Vec<Range<usize>> = iter::once(0..parents).collect();
    while !sets.is_empty() {
        // One step tests three sets, one for each coordinate.
        let tested = sets.split_off(sets.len().saturating_sub(3));
        let mut positions = vec![Point::ZERO; parents];
        for (coordinate, set) in tested.iter().enumerate() {
            let is_single = set.len() == 1;
            for vertex in set.clone() {
                positions[vertex][coordinate] = if is_single { 1.0 } else { probe(vertex, seed) };
            }
        }
        let sums = step(positions)?;
        for (coordinate, set) in tested.into_iter().enumerate() {
            let (sum, middle) = (sums[coordinate], set.start + set.len() / 2);
            match set.len() {
                0 => {}
                1 if sum.abs() < LEAST_WEIGHT => {}
                1 => weights.push((set.start, sum)),
                _ if sum == 0.0 => {}
                _ => sets.extend([set.start..middle, middle..set.end]),
            }
        }
    }
    weights.sort_by_key(|&(vertex, _)| vertex);
    Ok(weights)
}

/// Returns a number between 1 and 2 without a pattern (the mixing function of Wellons, 2018).
fn probe(vertex: usize, seed: u32) -> f32 {
    let mut mixed = (vertex as u32).wrapping_add(seed.wrapping_mul(0x9e37_79b9));
    mixed = (mixed ^ (mixed >> 16)).wrapping_mul(0x7feb_352d);
    mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x846c_a68b);
    mixed ^= mixed >> 16;
    1.0 + (mixed >> 8) as f32 / (1 << 24) as f32
}
