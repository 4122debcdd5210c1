//! Errors of the generators.

use sixfold_core::did_you_mean;

/// The reason why a shape cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message shows the meaning of each field")]
pub enum ShapeError {
    /// A parameter is outside the range that the shape accepts.
    #[error("{parameter} = {value} is out of range: choose a value from {min} to {max}")]
    OutOfRange {
        parameter: &'static str,
        value: f64,
        min: f64,
        max: f64,
    },
    /// Each parameter is in its range, but the shape has too many corners.
    #[error("{shape} with {} has {corners} corners, more than {limit}: choose smaller numbers", format_parameters(.parameters))]
    TooManyCorners {
        shape: &'static str,
        parameters: Vec<(&'static str, usize)>,
        corners: u64,
        limit: u64,
    },
    /// A count is not an integer.
    #[error("{parameter} = {value} is not an integer: choose a whole number from {min} to {max}")]
    NotInteger {
        parameter: &'static str,
        value: f64,
        min: f64,
        max: f64,
    },
    /// The shape has no parameter of this name.
    #[error(
        "{shape} has no parameter {given:?}{}: {}", did_you_mean(.given, .parameters),
        format_allowed(.parameters)
    )]
    UnknownParameter {
        shape: &'static str,
        given: String,
        parameters: Vec<&'static str>,
    },
    /// A parameter is given twice.
    #[error("parameter {parameter} of {shape} is given twice: remove one")]
    RepeatedParameter {
        shape: &'static str,
        parameter: &'static str,
    },
    /// The number of control points is not a multiple of the number of columns.
    #[error("{points} control points do not fill rows of {columns}: add or remove points")]
    RaggedNet { points: usize, columns: usize },
    /// The solid is unbounded: its field is not positive far away from the origin.
    #[error("the solid is unbounded: raise the level of the blobs, or inflate by less")]
    Unbounded,
    /// The solid is empty, or so thin that it contains no point of the lattice of cubes from which
    /// the surface is built.
    #[error("the solid contains no lattice point: make it thicker, or choose more faces")]
    Empty,
    /// The lattice of cubes from which the surface is built is too large for memory, or too fine
    /// for `f32`.
    #[error(
        "a lattice of spacing {spacing:e} is too fine for this solid: choose fewer faces, or move the solid to the origin"
    )]
    TooFine { spacing: f64 },
    /// No lattice of cubes gives a surface with about the requested number of faces.
    #[error("no lattice gives {faces} faces: choose about {nearest}")]
    UnreachableFaceCount { faces: usize, nearest: usize },
}

/// Maximum number of corners of a shape (2³¹ − 1).
pub(crate) const MAX_CORNERS: u64 = (1 << 31) - 1;

/// Maximum number of cells along a side. `f32` represents all integers and halves up to twice this
/// number.
pub(crate) const MAX_SIDE: usize = 1 << 22;

/// Maximum number of steps around a circle. Adjacent points still differ in `f32`.
pub(crate) const MAX_SEGMENTS: usize = 1 << 20;

pub(crate) fn check_count(
    parameter: &'static str,
    value: usize,
    min: usize,
    max: usize,
) -> Result<(), ShapeError> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    let [value, min, max] = [value, min, max].map(|x| x as f64);
    Err(ShapeError::OutOfRange {
        parameter,
        value,
        min,
        max,
    })
}

pub(crate) fn check_value(
    parameter: &'static str,
    value: f64,
    min: f64,
    max: f64,
) -> Result<(), ShapeError> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(ShapeError::OutOfRange {
        parameter,
        value,
        min,
        max,
    })
}

pub(crate) fn check_corners(
    shape: &'static str,
    parameters: &[(&'static str, usize)],
    corners: u64,
) -> Result<usize, ShapeError> {
    match usize::try_from(corners) {
        Ok(count) if corners <= MAX_CORNERS => Ok(count),
        _ => Err(ShapeError::TooManyCorners {
            shape,
            parameters: parameters.to_vec(),
            corners,
            limit: MAX_CORNERS,
        }),
    }
}

/// Formats parameters. Example: `m = 3, n = 4`.
fn format_parameters(parameters: &[(&'static str, usize)]) -> String {
    let pairs: Vec<String> = parameters
        .iter()
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    pairs.join(", ")
}

/// Formats the allowed names. Example: `choose from m, n`.
fn format_allowed(parameters: &[&'static str]) -> String {
    match parameters {
        [] => "it has no parameters".to_owned(),
        names => format!("choose from {}", names.join(", ")),
    }
}
