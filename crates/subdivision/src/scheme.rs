//! The schemes, and what kind each is.

use std::fmt;

use serde::{Serialize, Serializer};

use mesh_core::Split;

/// A subdivision scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Scheme {
    /// Catmull & Clark (1978).
    CatmullClark,
    /// Loop (1987).
    Loop,
    /// Kobbelt (2000).
    Sqrt3,
    /// Zorin, Schröder & Sweldens (1996).
    Butterfly,
    /// Doo & Sabin (1978).
    DooSabin,
    /// Every triangle into four at the midpoints of its edges.
    Midpoint,
    /// Every polygon into quads at the midpoints of its edges and its own.
    Bilinear,
}

/// What a step does to the faces of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Primitive {
    /// New vertices divide the faces.
    FaceSplit,
    /// Every vertex becomes a face, and so does every edge.
    VertexSplit,
}

/// What kind a scheme is: a row of the classification.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Kind {
    /// What is split.
    pub primitive: Primitive,
    /// What it takes: `triangles` or `polygons`.
    pub takes: &'static str,
    /// What it makes: `triangles`, `quads`, or `polygons`.
    pub makes: &'static str,
    /// Whether old vertices stay where they are.
    pub interpolating: bool,
    /// The smoothness of the limit surface: where the mesh is regular, and at extraordinary vertices.
    pub continuity: &'static str,
    /// How many faces a step makes of one, in the long run.
    pub growth: &'static str,
    /// What it does at boundaries.
    pub boundary: &'static str,
    /// Whether it has rules for creases.
    pub creases: bool,
    /// How it splits faces in a structure's own tables, if it does.
    pub split: Option<Split>,
    /// Whether it can be run as a pass over faces.
    pub scatter: bool,
    /// Where it comes from.
    pub source: &'static str,
}

impl Scheme {
    /// All of them, in the order in which tables show them.
    pub const ALL: [Self; 7] = [
        Self::CatmullClark,
        Self::Loop,
        Self::Sqrt3,
        Self::Butterfly,
        Self::DooSabin,
        Self::Midpoint,
        Self::Bilinear,
    ];

    /// What users call it: `catmull-clark`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::CatmullClark => "catmull-clark",
            Self::Loop => "loop",
            Self::Sqrt3 => "sqrt3",
            Self::Butterfly => "butterfly",
            Self::DooSabin => "doo-sabin",
            Self::Midpoint => "midpoint",
            Self::Bilinear => "bilinear",
        }
    }

    /// The scheme that users call `name`.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scheme| scheme.name() == name)
    }

    /// What kind it is.
    pub const fn kind(self) -> Kind {
        const BASE: Kind = Kind {
            primitive: Primitive::FaceSplit,
            takes: "triangles",
            makes: "triangles",
            interpolating: false,
            continuity: "C0",
            growth: "4",
            boundary: "midpoints",
            creases: false,
            split: Some(Split::Triangles),
            scatter: true,
            source: "linear",
        };
        match self {
            Self::CatmullClark => Kind {
                takes: "polygons",
                makes: "quads",
                continuity: "C2, extraordinary C1",
                boundary: "B-spline curve; corners may stay",
                creases: true,
                split: Some(Split::Quads),
                source: "Catmull & Clark 1978; DeRose et al. 1998",
                ..BASE
            },
            Self::Loop => Kind {
                continuity: "C2, extraordinary C1",
                boundary: "B-spline curve; corners may stay",
                creases: true,
                source: "Loop 1987; Warren 1995",
                ..BASE
            },
            Self::Sqrt3 => Kind {
                continuity: "C2, extraordinary C1",
                growth: "3",
                boundary: "B-spline curve, every second step",
                split: Some(Split::Sqrt3 { trisect: false }),
                source: "Kobbelt 2000",
                ..BASE
            },
            Self::Butterfly => Kind {
                interpolating: true,
                continuity: "C1",
                boundary: "four-point curve",
                scatter: false,
                source: "Zorin, Schroeder & Sweldens 1996",
                ..BASE
            },
            Self::DooSabin => Kind {
                primitive: Primitive::VertexSplit,
                takes: "polygons",
                makes: "polygons",
                continuity: "C1",
                boundary: "shrinks: its edges make no faces",
                split: None,
                source: "Doo & Sabin 1978",
                ..BASE
            },
            Self::Midpoint => Kind {
                interpolating: true,
                ..BASE
            },
            Self::Bilinear => Kind {
                takes: "polygons",
                makes: "quads",
                interpolating: true,
                split: Some(Split::Quads),
                source: "bilinear",
                ..BASE
            },
        }
    }
}

impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Scheme {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A way to run a scheme; all give the same mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// For every new point, the neighbourhood is asked for: VV, VF, EF of each element.
    Gather,
    /// One pass over the faces adds what each has to give to data kept by handle: FV and FE alone.
    Scatter,
    /// Points by queries, but the structure splits its own tables: nothing is rebuilt.
    Native,
}

impl Method {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Gather, Self::Scatter, Self::Native];

    /// What users call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gather => "gather",
            Self::Scatter => "scatter",
            Self::Native => "native",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
