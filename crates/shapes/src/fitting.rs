//! The search for a lattice that gives the requested number of faces.

use sixfold_core::PolygonMesh;

use crate::bounds::Bounds;
use crate::error::{ShapeError, check_count};
use crate::marching::{Solid, polygonised as triangulate};

/// Minimum number of faces that can be requested.
pub(crate) const MIN_FACES: usize = 100;

/// Maximum number of faces that can be requested.
pub(crate) const MAX_FACES: usize = 4_000_000;

/// Maximum number of lattices that are tried.
const MAX_ATTEMPTS: u32 = 24;

/// Number of cubes of a lattice above which a solid without faces counts as empty.
const MAX_EMPTY_CUBES: f64 = (1 << 22) as f64;

pub(crate) fn check_faces(faces: usize) -> Result<(), ShapeError> {
    check_count("faces", faces, MIN_FACES, MAX_FACES)
}

/// Builds the surface of `solid` from about `faces` triangles. The solid is within `bounds`.
///
/// The number of faces is inversely proportional to the square of the spacing, so each lattice
/// gives an estimate for the spacing of the next lattice. If a surface is parallel to the lattice,
/// the number of faces changes in jumps. Therefore each lattice also has a different shift.
pub(crate) fn polygonised(
    solid: &impl Solid,
    bounds: Bounds,
    faces: usize,
) -> Result<PolygonMesh, ShapeError> {
    let tolerance = (faces / 20).max(20);
    let mut spacing = bounds.longest_side() / 16.0;
    if spacing == 0.0 {
        return Err(ShapeError::Empty); // The bounds are a single point.
    }
    let mut nearest = 0;
    for attempt in 0..MAX_ATTEMPTS {
        let lattice = bounds.lattice(spacing, shift(attempt))?;
        let builder = triangulate(solid, &lattice);
        let count = builder.face_count();
        if count.abs_diff(faces) <= tolerance {
            return Ok(builder.build());
        }
        if count == 0 && nearest == 0 && lattice.cubes() > MAX_EMPTY_CUBES {
            break;
        }
        if count.abs_diff(faces) < faces.abs_diff(nearest) {
            nearest = count;
        }
        spacing *= (count as f64 / faces as f64).sqrt().clamp(0.5, 2.0);
    }
    match nearest {
        0 => Err(ShapeError::Empty),
        nearest => Err(ShapeError::UnreachableFaceCount { faces, nearest }),
    }
}

/// Returns a shift. The shifts fill the cube evenly (Roberts 2018).
fn shift(attempt: u32) -> [f64; 3] {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_3,
    ];
    STEPS.map(|step| (0.5 + step * f64::from(attempt)).fract())
}
