//! The options of a scheme.

/// The treatment of the boundary of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
#[non_exhaustive]
pub enum BoundaryRule {
    /// Boundary edges are infinitely sharp, and so are vertices with exactly one face.
    #[default]
    EdgeAndCorner,
    /// Boundary edges are infinitely sharp. The boundary becomes a B-spline curve, which rounds the
    /// corners of the mesh.
    EdgeOnly,
    /// A face is removed from the result if one of its vertices has a boundary edge without
    /// infinite sharpness in the input. A removed face still influences the adjacent faces.
    None,
}

impl BoundaryRule {
    /// All boundary rules.
    pub const ALL: [Self; 3] = [Self::EdgeAndCorner, Self::EdgeOnly, Self::None];

    /// Returns the name of the rule on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::EdgeAndCorner => "edge-and-corner",
            Self::EdgeOnly => "edge-only",
            Self::None => "none",
        }
    }
}

/// The rule that computes the sharpness of the two halves of an edge after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
#[non_exhaustive]
pub enum Creasing {
    /// Each half gets the sharpness of the edge minus 1, but at least 0. An infinite sharpness
    /// stays infinite.
    #[default]
    Uniform,
    /// The half at one end of the edge gets 3/4 of the sharpness of the edge, plus 1/4 of the mean
    /// sharpness of the other semi-sharp edges at this end, minus 1. Sharpness then varies along a
    /// crease like the points of Chaikin's curve. A semi-sharp edge has a finite sharpness above 0.
    /// The rule [`Uniform`](Self::Uniform) applies to edges that are not semi-sharp, and at ends
    /// without another semi-sharp edge.
    Chaikin,
}

impl Creasing {
    /// Both rules for the sharpness of the two halves of an edge.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::Chaikin];

    /// Returns the name of the rule on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Chaikin => "chaikin",
        }
    }
}

/// The weights of Loop's scheme for the neighbours of an extraordinary vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
#[non_exhaustive]
pub enum LoopWeights {
    /// The weights of Loop (1987).
    #[default]
    Loop,
    /// The weights of Warren (1995): 3/(8n) for valence n, but 3/16 for valence 3.
    Warren,
}

impl LoopWeights {
    /// Both sets of weights.
    pub const ALL: [Self; 2] = [Self::Loop, Self::Warren];

    /// Returns the name of the weights on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Loop => "loop",
            Self::Warren => "warren",
        }
    }
}
