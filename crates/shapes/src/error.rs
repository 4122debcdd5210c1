//! What a generator refuses, before it allocates anything.

/// Why there is no such shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum ShapeError {
    /// A parameter beyond what the shape allows.
    #[error("{parameter} = {value}: choose from {least} to {greatest}")]
    OutOfRange {
        parameter: &'static str,
        value: f64,
        least: f64,
        greatest: f64,
    },
    /// Each parameter is allowed, but together they ask for too much.
    #[error("{shape} with {} has {corners} corners, beyond {limit}: choose smaller numbers", list(.parameters))]
    TooMany {
        shape: &'static str,
        parameters: Vec<(&'static str, usize)>,
        corners: u64,
        limit: u64,
    },
    /// A count that is no whole number.
    #[error("{parameter} = {value}: choose a whole number from {least} to {greatest}")]
    NotWhole {
        parameter: &'static str,
        value: f64,
        least: f64,
        greatest: f64,
    },
    /// A name that the shape does not know.
    #[error("{shape} has no parameter {given:?}: {}", allowed(.parameters))]
    UnknownParameter {
        shape: &'static str,
        given: String,
        parameters: Vec<&'static str>,
    },
    /// One parameter given twice.
    #[error("{shape} is given {parameter} twice: leave one out")]
    RepeatedParameter {
        shape: &'static str,
        parameter: &'static str,
    },
    /// Control points that fill no grid.
    #[error("{points} control points in rows of {columns}: every row must be full")]
    RaggedNet { points: usize, columns: usize },
    /// A field that is not positive far away.
    #[error("the solid has no bounds: raise the level of the blobs, or inflate by less")]
    Unbounded,
    /// A field without an inside, or none that a lattice finds.
    #[error("no lattice point lies in the solid: make it thicker, or ask for more faces")]
    Nothing,
    /// A lattice that memory, or `f32`, cannot hold.
    #[error(
        "a lattice of spacing {spacing:e} is too fine there: ask for fewer faces, or move the solid to the origin"
    )]
    TooFine { spacing: f64 },
    /// A surface whose number of faces jumps past the one asked for.
    #[error("no lattice gives {faces} faces: ask for about {nearest}")]
    Missed { faces: usize, nearest: usize },
}

/// The most corners that a generator makes: as many as every structure can number (2³¹ − 1).
pub(crate) const MAX_CORNERS: u64 = (1 << 31) - 1;

/// The most cells along a side: `f32` tells all whole and half numbers up to twice this apart.
pub(crate) const MAX_SIDE: usize = 1 << 22;

/// The most steps around a circle: `f32` tells neighbours apart all the way round.
pub(crate) const MAX_AROUND: usize = 1 << 20;

/// Refuses a `value` outside `least..=greatest`.
pub(crate) fn within(
    parameter: &'static str,
    value: usize,
    least: usize,
    greatest: usize,
) -> Result<(), ShapeError> {
    if (least..=greatest).contains(&value) {
        return Ok(());
    }
    let [value, least, greatest] = [value, least, greatest].map(|x| x as f64);
    Err(ShapeError::OutOfRange {
        parameter,
        value,
        least,
        greatest,
    })
}

/// Refuses a `value` outside `least..=greatest`, or NaN.
pub(crate) fn between(
    parameter: &'static str,
    value: f64,
    least: f64,
    greatest: f64,
) -> Result<(), ShapeError> {
    if (least..=greatest).contains(&value) {
        return Ok(());
    }
    Err(ShapeError::OutOfRange {
        parameter,
        value,
        least,
        greatest,
    })
}

/// Refuses more than [`MAX_CORNERS`].
pub(crate) fn corners_within(
    shape: &'static str,
    parameters: &[(&'static str, usize)],
    corners: u64,
) -> Result<usize, ShapeError> {
    match usize::try_from(corners) {
        Ok(count) if corners <= MAX_CORNERS => Ok(count),
        _ => Err(ShapeError::TooMany {
            shape,
            parameters: parameters.to_vec(),
            corners,
            limit: MAX_CORNERS,
        }),
    }
}

/// `m = 3, n = 4`.
fn list(parameters: &[(&'static str, usize)]) -> String {
    let pairs: Vec<String> = parameters
        .iter()
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    pairs.join(", ")
}

/// `choose from m, n`.
fn allowed(parameters: &[&'static str]) -> String {
    match parameters {
        [] => "it takes none".to_owned(),
        names => format!("choose from {}", names.join(", ")),
    }
}
