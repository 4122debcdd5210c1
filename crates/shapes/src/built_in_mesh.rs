//! The mesh that a study uses if no file is given.

use sixfold_core::PolygonMesh;

use crate::error::ShapeError;
use crate::implicit::Field;

/// Three directions at right angles, all oblique to the lattice: the coordinate axes, rotated by
/// the quaternion (4, 1, 2, 2) / 5.
const AXES: [[f64; 3]; 3] = [
    [9.0 / 25.0, -12.0 / 25.0, 20.0 / 25.0],
    [20.0 / 25.0, 15.0 / 25.0, 0.0],
    [-12.0 / 25.0, 16.0 / 25.0, 15.0 / 25.0],
];

/// Tube radius of the torus about each axis.
const RINGS: [f64; 3] = [0.14, 0.10, 0.18];

/// Radii of the two balls on each axis, in positive and negative direction.
const BALLS: [[f64; 2]; 3] = [[0.36, 0.20], [0.26, 0.42], [0.15, 0.31]];

/// Number of faces of the built-in mesh, and the spacing of its lattice.
pub(crate) const FACES: usize = 20_000;
const SPACING: f64 = 0.091_83;

/// Builds an irregular closed triangle mesh of genus 7 with 20,000 faces. The solid is three
/// intersecting tori of different thickness, with a ball at each place where two tori meet.
///
/// The mesh is connected, manifold and oriented outward. No two vertices have the same position.
/// The mesh is the same on every machine.
///
/// # Panics
///
/// Never panics: the parameters are fixed, and a test builds this mesh.
pub fn built_in_mesh() -> PolygonMesh {
    with_faces(FACES).expect("the fixed parameters are within all ranges")
}

/// Builds the surface of the same solid from about `faces` triangles. With [`FACES`], it is the built-in mesh.
pub(crate) fn with_faces(faces: usize) -> Result<PolygonMesh, ShapeError> {
    let field = rings_and_balls()?;
    match faces {
        FACES => field.polygonised_at(SPACING),
        other => field.polygonised(other),
    }
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
    // The blend is visible only on levels other than zero.
    blended.unwrap_or(Err(ShapeError::Empty))?.inflated(0.03)
}
