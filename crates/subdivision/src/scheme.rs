//! The subdivision schemes and their properties.

use sixfold_core::Split;

sixfold_core::named! {
    /// A subdivision scheme.
    #[non_exhaustive]
    pub enum Scheme: "subdivision scheme" {
        /// The scheme of Catmull & Clark (1978).
        CatmullClark = "catmull-clark",
        /// The scheme of Loop (1987).
        Loop = "loop",
        /// The √3 scheme of Kobbelt (2000).
        Sqrt3 = "sqrt3",
        /// The modified butterfly scheme of Zorin, Schröder & Sweldens (1996).
        Butterfly = "butterfly",
        /// The scheme of Doo & Sabin (1978).
        DooSabin = "doo-sabin",
        /// Splits every triangle into four at the midpoints of its edges.
        Midpoint = "midpoint",
        /// Splits every polygon into quads at the midpoints of its edges and the mean of its
        /// corners.
        Bilinear = "bilinear",
    }
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

sixfold_core::named! {
    /// The faces that a scheme accepts or makes.
    pub enum FaceKind: "kind of faces" {
        /// All faces are triangles.
        Triangles = "triangles",
        /// All faces have four corners.
        Quads = "quads",
        /// Faces can have any number of corners.
        Polygons = "polygons",
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

sixfold_core::named! {
    /// A way to run a scheme. All methods give the same mesh, except for the order of its elements.
    pub enum Method: "subdivision method" {
        /// Computes each new point with queries of its neighbourhood (VV, VF and EF).
        Gather = "gather",
        /// Runs one pass over the faces and adds the values of each face to its vertices and edges.
        /// Queries only the vertices and edges of each face (queries FV and FE).
        Scatter = "scatter",
        /// Computes each new point with queries. The structure splits its own tables, and no new
        /// structure is built.
        Native = "native",
    }
}
