//! Subdivision level by level, and the weights of the points.

use std::iter;
use std::ops::Range;

use serde::Serialize;
use sixfold::subdivision::{Extent, Scheme, Step, Subdivision, SubdivisionError, build_level};
use sixfold::{Creases, FaceVertexMesh, Point, PolygonMesh};

use super::Error;
use super::source::check_size;
use crate::element::ElementName;

/// Maximum number of levels. A mesh with one triangle has more corners than allowed before.
const MOST_LEVELS: u32 = 16;

/// Maximum number of vertices of a mesh whose weights are computed.
const MOST_PARENTS: usize = 20_000;

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
        steps.push(refined(
            &subdivision,
            &parent.polygons,
            &parent.creases,
            level,
        )?);
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
    point: usize,
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
    if point >= points {
        return Err(format!("level {level} has {points} points, from v0, and no v{point}").into());
    }
    let subdivision = Subdivision::new(scheme);
    let mut weights = Vec::new();
    let mut sets: Vec<Range<usize>> = iter::once(0..parents).collect();
    while !sets.is_empty() {
        // One step tests three sets, one for each coordinate.
        let tested = sets.split_off(sets.len().saturating_sub(3));
        let mut positions = vec![Point::ZERO; parents];
        for (coordinate, set) in tested.iter().enumerate() {
            let is_single = set.len() == 1;
            for vertex in set.clone() {
                positions[vertex][coordinate] = if is_single { 1.0 } else { probe(vertex) };
            }
        }
        let faces = parent.polygons.faces().clone();
        let probed = PolygonMesh::from_faces(positions, faces)?;
        let child = refined(&subdivision, &probed, &parent.creases, before)?;
        let sums = child.polygons.positions()[point];
        for (coordinate, set) in tested.into_iter().enumerate() {
            let middle = set.start + set.len() / 2;
            match sums[coordinate] {
                0.0 => {}
                weight if set.len() == 1 => weights.push((set.start, weight)),
                _ => sets.extend([set.start..middle, middle..set.end]),
            }
        }
    }
    weights.sort_by_key(|&(vertex, _)| vertex);
    let parent = |(vertex, weight)| Parent {
        vertex: ElementName::Vertex(vertex as u32).to_string(),
        weight,
    };
    Ok(weights.into_iter().map(parent).collect())
}

/// Returns a number between 1 and 2, so that positive and negative weights of a set do not add up to 0.
fn probe(vertex: usize) -> f32 {
    let golden = (vertex as u32).wrapping_mul(2_654_435_769);
    1.0 + (golden >> 8) as f32 / (1 << 24) as f32
}
