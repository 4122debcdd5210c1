//! The lattice that gives a surface the number of faces that was asked for.

use mesh_core::PolygonMesh;

use crate::bounds::Bounds;
use crate::error::{ShapeError, within};
use crate::marching::{Solid, polygonised as marched};

/// The fewest faces to ask for.
pub(crate) const MIN_FACES: usize = 100;

/// The most faces to ask for.
pub(crate) const MAX_FACES: usize = 4_000_000;

/// How many lattices are tried.
const TRIES: u32 = 24;

/// How many cubes are searched for a solid before there is held to be none.
const FRUITLESS: f64 = (1 << 22) as f64;

/// Refuses a number of faces that is not to be asked for.
pub(crate) fn check_faces(faces: usize) -> Result<(), ShapeError> {
    within("faces", faces, MIN_FACES, MAX_FACES)
}

/// The surface of `solid`, which `bounds` hold, as about `faces` triangles.
///
/// The number of faces goes with the square of the fineness, so each lattice tells the spacing of
/// the next. Where a surface follows the lattice the number jumps; so each is shifted anew as well.
pub(crate) fn polygonised(
    solid: &impl Solid,
    bounds: Bounds,
    faces: usize,
) -> Result<PolygonMesh, ShapeError> {
    let tolerance = (faces / 20).max(20);
    let mut spacing = bounds.longest() / 16.0;
    if spacing == 0.0 {
        return Err(ShapeError::Nothing); // A point encloses nothing.
    }
    let mut nearest = 0;
    for attempt in 0..TRIES {
        let lattice = bounds.lattice(spacing, shift(attempt))?;
        let draft = marched(solid, &lattice);
        let count = draft.face_count();
        if count.abs_diff(faces) <= tolerance {
            return Ok(draft.finish());
        }
        if count == 0 && nearest == 0 && lattice.cubes() > FRUITLESS {
            break;
        }
        if count.abs_diff(faces) < faces.abs_diff(nearest) {
            nearest = count;
        }
        spacing *= (count as f64 / faces as f64).sqrt().clamp(0.5, 2.0);
    }
    match nearest {
        0 => Err(ShapeError::Nothing),
        nearest => Err(ShapeError::Missed { faces, nearest }),
    }
}

/// Shifts that fill the cube evenly: multiples of the powers of the inverse plastic ratio of
/// dimension three (Roberts 2018).
fn shift(attempt: u32) -> [f64; 3] {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_3,
    ];
    STEPS.map(|step| (0.5 + step * f64::from(attempt)).fract())
}
