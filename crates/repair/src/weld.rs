//! Welding: vertices within a distance of each other become one vertex.

mod grid;
mod kd_tree;

use glam::DVec3;
use sixfold_core::{Point, PolygonCutter, PolygonMesh, Slot, VertexId, row};

use crate::error::RepairError;
use crate::outcome::{Left, Outcome, StepCounts};
use crate::trace::{Rebuild, VertexTrace, corners_of};
use grid::Grid;
use kd_tree::KdTree;

/// Options of welding.
///
/// The distinct positions are visited in lexicographic order (x, then y, then z). A position that
/// no earlier representative has claimed becomes a representative itself, and claims all positions
/// within the tolerance that are not claimed yet. Each vertex moves to its representative. So no
/// vertex moves by more than the tolerance, two representatives are farther apart than the
/// tolerance, and the result depends neither on the order of the vertices nor on the method.
///
/// Distances are computed in double precision. −0 equals 0. A vertex with a coordinate that is not
/// a number is not merged; infinite coordinates are merged only if all coordinates are equal.
///
/// O(n log n) for n vertices: a sort, and per representative a search whose results are within the
/// tolerance of only a bounded number of representatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weld {
    /// The largest distance between a vertex and its representative.
    pub tolerance: Tolerance,
    /// How vertices within the tolerance are found.
    pub method: WeldMethod,
}

/// The largest distance between a vertex and its representative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tolerance {
    /// Only vertices with equal coordinates are merged.
    #[default]
    Exact,
    /// A distance in units of the coordinates: finite, and at least 0.
    Absolute(f64),
    /// A part of the diagonal of the bounding box of all finite vertices, from 0 to 1.
    Relative(f64),
}

sixfold_core::named! {
    /// How vertices within the tolerance are found; all methods give the same result.
    #[derive(Default)]
    pub enum WeldMethod: "weld method" {
        /// A hashed grid with cells as long as the tolerance: O(1) expected per search.
        #[default]
        Grid = "grid",
        /// A balanced kd-tree (Bentley 1975): O(log n) per search.
        KdTree = "kd-tree",
    }
}

/// A search for points near a point.
trait Nearby {
    /// Calls `visit` with the number of each point whose distance from point `at` is at most the
    /// radius of the search; it may also pass other points.
    fn for_each_candidate(&self, at: u32, visit: impl FnMut(u32));
}

/// Welds vertices.
pub(crate) fn weld(polygons: &PolygonMesh, options: &Weld) -> Result<Outcome, RepairError> {
    merge(polygons, &representatives(polygons, options)?)
}

/// Returns for each vertex the vertex that it is merged with; itself if it remains.
pub(crate) fn representatives(
    polygons: &PolygonMesh,
    options: &Weld,
) -> Result<Vec<VertexId>, RepairError> {
    let tolerance = options.tolerance.distance(polygons.positions())?;
    let mut places = Places::new(polygons.positions());
    if tolerance > 0.0 {
        let Places {
            points, claimed_by, ..
        } = &mut places;
        match options.method {
            WeldMethod::Grid => claim(points, claimed_by, &Grid::new(points, tolerance), tolerance),
            WeldMethod::KdTree => {
                claim(
                    points,
                    claimed_by,
                    &KdTree::new(points, tolerance),
                    tolerance,
                );
            }
        }
    }
    let vertices = polygons.vertices();
    Ok(vertices.map(|v| places.representative(v)).collect())
}

impl Tolerance {
    /// Returns the distance in units of the coordinates.
    fn distance(self, positions: &[Point]) -> Result<f64, RepairError> {
        let (tolerance, scale) = match self {
            Self::Exact => (0.0, 1.0),
            Self::Absolute(tolerance) => (tolerance, 1.0),
            Self::Relative(tolerance) => (tolerance, diagonal(positions)),
        };
        if !(tolerance >= 0.0 && tolerance.is_finite()) {
            return Err(RepairError::BadTolerance { tolerance });
        }
        if matches!(self, Self::Relative(_)) && tolerance > 1.0 {
            return Err(RepairError::RelativeToleranceAboveOne { tolerance });
        }
        Ok(tolerance * scale)
    }
}

/// Returns the diagonal of the bounding box of all finite positions; 0 without finite positions.
pub(crate) fn diagonal(positions: &[Point]) -> f64 {
    let finite = || positions.iter().filter(|p| p.is_finite());
    let low = finite().fold(DVec3::INFINITY, |low, p| low.min(p.as_dvec3()));
    let high = finite().fold(DVec3::NEG_INFINITY, |high, p| high.max(p.as_dvec3()));
    if low.x > high.x {
        return 0.0;
    }
    (high - low).length()
}

/// The distinct positions of vertices, in lexicographic order.
pub(crate) struct Places {
    /// By place: its coordinates.
    points: Vec<DVec3>,
    /// By place: a vertex there that does not depend on the order of the vertices, up to vertices
    /// with the same bits.
    vertices: Vec<VertexId>,
    /// By place: the place that represents it.
    claimed_by: Vec<u32>,
    /// By vertex: its place.
    place: Vec<u32>,
}

impl Places {
    /// Sorts the positions; O(n log n).
    pub(crate) fn new(positions: &[Point]) -> Self {
        let order = sorted(positions);
        let mut places = Self {
            points: Vec::new(),
            vertices: Vec::new(),
            claimed_by: Vec::new(),
            place: vec![0; positions.len()],
        };
        let mut last = None;
        for v in order {
            let position = positions[v as usize];
            // NaN differs from itself, so such a vertex is always a new place.
            if last != Some(position) {
                places.claimed_by.push(row(places.points.len()));
                places.points.push(position.as_dvec3());
                places.vertices.push(VertexId::new(v));
            }
            last = Some(position);
            places.place[v as usize] = row(places.points.len() - 1);
        }
        places
    }

    /// Returns only the numbers of the places.
    pub(crate) fn into_numbers(self) -> PlaceNumbers {
        PlaceNumbers {
            places: self.points.len(),
            place: self.place,
        }
    }

    /// Returns a vertex at the place that represents `v`: `v` itself if it is alone.
    fn representative(&self, v: VertexId) -> VertexId {
        let place = self.place[v.index()];
        self.vertices[self.claimed_by[place as usize] as usize]
    }
}

/// The numbers of the distinct positions of vertices, in lexicographic order.
pub(crate) struct PlaceNumbers {
    places: usize,
    /// By vertex: its place.
    place: Vec<u32>,
}

impl PlaceNumbers {
    /// Returns the number of places.
    pub(crate) fn len(&self) -> usize {
        self.places
    }

    /// Returns the place of `v`, from 0 on in lexicographic order.
    pub(crate) fn place(&self, v: VertexId) -> u32 {
        self.place[v.index()]
    }
}

/// Lets every point that is not claimed claim the later points within `tolerance`; a point that is
/// not claimed by another is claimed by itself.
fn claim(points: &[DVec3], claimed_by: &mut [u32], nearby: &impl Nearby, tolerance: f64) {
    let limit = tolerance * tolerance;
    for at in 0..row(points.len()) {
        if claimed_by[at as usize] != at {
            continue;
        }
        let point = points[at as usize];
        nearby.for_each_candidate(at, |other| {
            let is_free = other > at && claimed_by[other as usize] == other;
            if is_free && point.distance_squared(points[other as usize]) <= limit {
                claimed_by[other as usize] = at;
            }
        });
    }
}

/// Returns the rows of the positions sorted by x, then y, then z, then the signs of their zeros, then
/// the row.
fn sorted(positions: &[Point]) -> Vec<u32> {
    // The keys are together in memory, so that the sort does not jump to the positions.
    let mut keys: Vec<([u32; 3], u8, u32)> = (0..row(positions.len()))
        .zip(positions)
        .map(|(v, position)| {
            let coordinates = position.to_array();
            let is_plus = |x: f32| u8::from(x.to_bits() != (-0.0_f32).to_bits());
            let [x, y, z] = coordinates.map(is_plus);
            (coordinates.map(order_of), 4 * x + 2 * y + z, v)
        })
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(|(.., v)| v).collect()
}

/// Returns a number whose order is the order of `x`. The numbers of −0 and 0 are equal.
fn order_of(x: f32) -> u32 {
    // Adding 0 changes −0 to 0.
    let bits = (x + 0.0).to_bits();
    match bits >> 31 {
        0 => bits | 1 << 31,
        _ => !bits,
    }
}

/// Replaces every vertex by its representative. New vertices are numbered in the order in which
/// their first old vertices are numbered, so that a mesh without merged vertices is unchanged.
fn merge(polygons: &PolygonMesh, representatives: &[VertexId]) -> Result<Outcome, RepairError> {
    let mut number_of = vec![Slot::NONE; representatives.len()];
    let mut numbers = Vec::with_capacity(representatives.len());
    let (mut positions, mut origins) = (Vec::new(), Vec::new());
    let mut largest_shift = 0.0_f64;
    for (old, &representative) in polygons.positions().iter().zip(representatives) {
        let position = polygons.position(representative);
        let number = &mut number_of[representative.index()];
        if number.get().is_none() {
            *number = Slot::some(VertexId::new(row(positions.len())));
            positions.push(position);
            origins.push(Slot::some(representative));
        }
        numbers.push(*number);
        if *old != position {
            largest_shift = largest_shift.max(old.as_dvec3().distance(position.as_dvec3()));
        }
    }
    let mut counts = StepCounts {
        vertices_merged: representatives.len() - positions.len(),
        largest_shift,
        ..StepCounts::default()
    };
    if counts.vertices_merged == 0 {
        return Ok(Outcome::unchanged());
    }
    let mut rebuild = Rebuild::new(polygons);
    let mut cutter = PolygonCutter::default();
    let mut left = Vec::new();
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (f, face) in polygons.faces().iter() {
        let number = |v: VertexId| numbers[v.index()].get().expect("every vertex has one");
        before.clear();
        before.extend(corners_of(polygons, f));
        after.clear();
        after.extend(face.iter().map(|&v| number(v)));
        let parts = cutter.parts(&after, |i| polygons.position(face[i]).as_dvec3());
        if parts.is_crossing {
            left.push(Left::CrossingFace { face: f });
        }
        let parts = parts.iter();
        match parts.len() {
            0 => counts.faces_removed += 1,
            1 => counts.faces_changed += usize::from(parts.clone().any(|p| p.len() < face.len())),
            count => {
                counts.faces_changed += 1;
                counts.faces_added += count - 1;
            }
        }
        for part in parts {
            rebuild.push(Some(f), part.iter().map(|&i| (after[i], Some(before[i].1))))?;
        }
    }
    let vertices = VertexTrace {
        replacements: numbers,
        origins,
    };
    let changed = rebuild.finish(positions, vertices)?;
    Ok(Outcome {
        left,
        ..Outcome::changed(changed, counts)
    })
}

#[cfg(test)]
mod tests;
