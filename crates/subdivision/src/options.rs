//! What a user can choose beside the scheme.

use serde::Serialize;

/// What the rim of an open mesh does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Boundary {
    /// Boundary edges are sharp for ever, and so are vertices with exactly one face.
    #[default]
    EdgeAndCorner,
    /// Boundary edges are sharp for ever: the boundary becomes a B-spline curve, corners rounded.
    EdgeOnly,
    /// Faces that touch a boundary vertex are left out of the result, unless all boundary edges
    /// there are said to be sharp for ever; they still shape their neighbours.
    None,
}

impl Boundary {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::EdgeAndCorner, Self::EdgeOnly, Self::None];

    /// What users call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EdgeAndCorner => "edge-and-corner",
            Self::EdgeOnly => "edge-only",
            Self::None => "none",
        }
    }
}

/// How the sharpness of an edge passes on to its halves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Creasing {
    /// Less by one.
    #[default]
    Uniform,
    /// At each end 3/4 of the edge's own and 1/4 of the mean of the other semi-sharp edges there,
    /// less by one: sharpness varies along a crease as smoothly as Chaikin's curve.
    Chaikin,
}

impl Creasing {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::Chaikin];

    /// What users call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Chaikin => "chaikin",
        }
    }
}

/// Whose weights Loop's scheme gives the neighbours of an extraordinary vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum LoopWeights {
    /// Loop's own, of 1987.
    #[default]
    Loop,
    /// Warren's: 3/(8n), and 3/16 at valence 3.
    Warren,
}

impl LoopWeights {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Loop, Self::Warren];

    /// What users call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::Warren => "warren",
        }
    }
}
