//! The subdivision schemes and their properties.

use std::fmt;

use sixfold_core::Split;

/// A subdivision scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Scheme {
    /// The scheme of Catmull & Clark (1978).
    CatmullClark,
    /// The scheme of Loop (1987).
    Loop,
    /// The √3 scheme of Kobbelt (2000).
    Sqrt3,
    /// The modified butterfly scheme of Zorin, Schröder & Sweldens (1996).
    Butterfly,
    /// The scheme of Doo & Sabin (1978).
    DooSabin,
    /// Splits every triangle into four at the midpoints of its edges.
    Midpoint,
    /// Splits every polygon into quads at the midpoints of its edges and the mean of its corners.
    Bilinear,
}

/// The elements that a step splits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Primitive {
    /// A step splits every face.
    FaceSplit,
    /// A step makes a face from every vertex and every edge.
    VertexSplit,
}

/// The faces that a scheme accepts or makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum FaceKind {
    /// All faces are triangles.
    Triangles,
    /// All faces have four corners.
    Quads,
    /// Faces can have any number of corners.
    Polygons,
}

impl FaceKind {
    /// Returns the name in text and in files, for example `triangles`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Quads => "quads",
            Self::Polygons => "polygons",
        }
    }
}

impl fmt::Display for FaceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The properties of a scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SchemeProperties {
    /// The kind of elements that a step splits: faces or vertices.
    pub primitive: Primitive,
    /// The faces of the input: triangles or polygons.
    pub takes: FaceKind,
    /// The faces of the output.
    pub makes: FaceKind,
    /// True if the vertices of the input keep their positions.
    pub interpolating: bool,
    /// The smoothness of the limit surface. If the smoothness at extraordinary vertices is
    /// different, the text names both.
    pub continuity: &'static str,
    /// The factor by which a step multiplies the number of faces. In the first steps, the factor
    /// can be different.
    pub growth: &'static str,
    /// The behaviour of the scheme at boundaries.
    pub boundary: &'static str,
    /// True if the scheme has rules for creases.
    pub creases: bool,
    /// The split with which a structure can run the scheme in its own tables; `None` if the scheme
    /// does not split faces.
    pub split: Option<Split>,
    /// True if the scheme can run as one pass over the faces.
    pub scatter: bool,
    /// The publication that describes the scheme.
    pub source: &'static str,
}

impl Scheme {
    /// All schemes.
    pub const ALL: [Self; 7] = [
        Self::CatmullClark,
        Self::Loop,
        Self::Sqrt3,
        Self::Butterfly,
        Self::DooSabin,
        Self::Midpoint,
        Self::Bilinear,
    ];

    /// Returns the name of the scheme on the command line and in files, for example
    /// `catmull-clark`.
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

    /// Returns the scheme with this [`name`](Self::name), or `None` if the name is unknown.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scheme| scheme.name() == name)
    }

    /// Returns the properties of the scheme.
    pub const fn properties(self) -> SchemeProperties {
        const BASE: SchemeProperties = SchemeProperties {
            primitive: Primitive::FaceSplit,
            takes: FaceKind::Triangles,
            makes: FaceKind::Triangles,
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
            Self::CatmullClark => SchemeProperties {
                takes: FaceKind::Polygons,
                makes: FaceKind::Quads,
                continuity: "C2, extraordinary C1",
                boundary: "B-spline curve; corners may stay",
                creases: true,
                split: Some(Split::Quads),
                source: "Catmull & Clark 1978; DeRose et al. 1998",
                ..BASE
            },
            Self::Loop => SchemeProperties {
                continuity: "C2, extraordinary C1",
                boundary: "B-spline curve; corners may stay",
                creases: true,
                source: "Loop 1987; Warren 1995",
                ..BASE
            },
            Self::Sqrt3 => SchemeProperties {
                continuity: "C2, extraordinary C1",
                growth: "3",
                boundary: "B-spline curve, every second step",
                split: Some(Split::Sqrt3 { trisect: false }),
                source: "Kobbelt 2000",
                ..BASE
            },
            Self::Butterfly => SchemeProperties {
                interpolating: true,
                continuity: "C1",
                boundary: "four-point curve",
                scatter: false,
                source: "Zorin, Schroeder & Sweldens 1996",
                ..BASE
            },
            Self::DooSabin => SchemeProperties {
                primitive: Primitive::VertexSplit,
                takes: FaceKind::Polygons,
                makes: FaceKind::Polygons,
                continuity: "C1",
                boundary: "shrinks: its edges make no faces",
                split: None,
                source: "Doo & Sabin 1978",
                ..BASE
            },
            Self::Midpoint => SchemeProperties {
                interpolating: true,
                ..BASE
            },
            Self::Bilinear => SchemeProperties {
                takes: FaceKind::Polygons,
                makes: FaceKind::Quads,
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

#[cfg(feature = "serde")]
impl serde::Serialize for Scheme {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A way to run a scheme. All methods give the same mesh, except for the order of its elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Method {
    /// Computes each new point with queries of its neighbourhood (VV, VF and EF).
    Gather,
    /// Runs one pass over the faces and adds the values of each face to its vertices and edges.
    /// Queries only the vertices and edges of each face (queries FV and FE).
    Scatter,
    /// Computes each new point with queries. The structure splits its own tables, and no new
    /// structure is built.
    Native,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 3] = [Self::Gather, Self::Scatter, Self::Native];

    /// Returns the name of the method on the command line and in files.
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
