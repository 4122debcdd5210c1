//! The mesh that the main job studies when it is given none.

use mesh_core::PolygonMesh;

use crate::error::ShapeError;
use crate::implicit::Field;

/// Three directions at right angles, all oblique to the lattice: the quaternion (4, 1, 2, 2) / 5.
const AXES: [[f64; 3]; 3] = [
    [9.0 / 25.0, -12.0 / 25.0, 20.0 / 25.0],
    [20.0 / 25.0, 15.0 / 25.0, 0.0],
    [-12.0 / 25.0, 16.0 / 25.0, 15.0 / 25.0],
];

/// The radius of the tube of the ring about each axis.
const RINGS: [f64; 3] = [0.14, 0.10, 0.18];

/// The radius of the ball on each axis, before and behind the centre.
const BALLS: [[f64; 2]; 3] = [[0.36, 0.20], [0.26, 0.42], [0.15, 0.31]];

/// The spacing of the lattice, which makes it 20,000 faces.
const SPACING: f64 = 0.091_83;

/// An irregular closed triangle mesh of genus 7 and 20,000 faces: three rings of different
/// strength through one another, with a ball where each two meet.
///
/// Connected, manifold, oriented outward, every vertex in a place of its own; the same on every
/// machine.
///
/// # Panics
///
/// Never: the parameters are fixed, and tests make it.
pub fn default_study() -> PolygonMesh {
    let mesh = rings_and_balls().and_then(|field| field.polygonised_at(SPACING));
    mesh.expect("fixed parameters within all ranges")
}

fn rings_and_balls() -> Result<Field, ShapeError> {
    let mut parts = Vec::new();
    for ((axis, tube), balls) in AXES.into_iter().zip(RINGS).zip(BALLS) {
        parts.push(Field::torus([0.0; 3], axis, 1.0, tube)?);
        for (sign, radius) in [1.0, -1.0].into_iter().zip(balls) {
            parts.push(Field::sphere(axis.map(|x| sign * x), radius)?);
        }
    }
    let parts = parts.into_iter().map(Ok);
    let blended = parts.reduce(|a, b| a?.smooth_union(b?, 0.0));
    // The blend shows a little off the union.
    blended.unwrap_or(Err(ShapeError::Nothing))?.inflated(0.03)
}
