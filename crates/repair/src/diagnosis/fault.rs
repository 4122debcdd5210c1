//! The kinds of faults.

use std::fmt;

use sixfold_core::{Capabilities, FaceId, VertexId};

use crate::duplicates::OppositeFaces;
use crate::holes::FillHoles;
use crate::orientation::{Components, Facing};
use crate::step::Step;
use crate::weld::Weld;

/// A kind of fault, its number in a mesh, and its first places.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Fault {
    /// The kind.
    pub kind: FaultKind,
    /// How many elements have this fault.
    pub count: usize,
    /// The first of these elements.
    pub places: Vec<Place>,
}

impl Fault {
    /// Returns the fault of this kind that does not occur.
    pub(super) fn none(kind: FaultKind) -> Self {
        Self {
            kind,
            count: 0,
            places: Vec::new(),
        }
    }
}

/// Prints the number, the kind and the first places:
/// `2 vertices whose faces form several fans: v3, v7`.
impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [one, many] = self.kind.titles();
        let title = if self.count == 1 { one } else { many };
        write!(f, "{} {title}", self.count)?;
        for (i, place) in self.places.iter().enumerate() {
            let before = if i == 0 { ": " } else { ", " };
            write!(f, "{before}{place}")?;
        }
        if self.count > self.places.len() && !self.places.is_empty() {
            f.write_str(", …")?;
        }
        Ok(())
    }
}

/// An element with a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "snake_case")
)]
pub enum Place {
    /// A vertex.
    Vertex(
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))] VertexId,
    ),
    /// An edge, by its ends, the lower first.
    Edge(
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::rows"))]
        [VertexId; 2],
    ),
    /// A face.
    Face(#[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))] FaceId),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vertex(v) => v.fmt(f),
            Self::Edge([a, b]) => write!(f, "{a}–{b}"),
            Self::Face(face) => face.fmt(f),
        }
    }
}

/// A kind of fault.
///
/// The first six are the reasons for which structures refuse meshes. The others are not errors for
/// any structure, and some of them can be intended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum FaultKind {
    /// A face with more than three corners.
    Polygon,
    /// An edge with three or more faces.
    NonManifoldEdge,
    /// An edge with two faces, which run in the same direction.
    RepeatedSide,
    /// A vertex whose faces form several fans.
    NonManifoldVertex,
    /// A vertex without a face.
    IsolatedVertex,
    /// A face with two corners at one position.
    CoincidentCorners,
    /// A vertex at the position of a lower vertex.
    CoincidentVertex,
    /// A vertex with a coordinate that is not finite.
    NotFiniteVertex,
    /// A face with the same vertices in the same cyclic order as an earlier face.
    DuplicateFace,
    /// A face with the same vertices in the opposite cyclic order as another face.
    OppositeFace,
    /// A face whose area is exactly zero in double precision.
    FlatFace,
    /// A polygon that crosses itself, so that triangles of it overlap; as
    /// [`PolygonCutter::cut`](sixfold_core::PolygonCutter::cut) decides.
    CrossingFace,
    /// A face that runs against its neighbours, or into the solid that it bounds: the faces that
    /// [`Step::Orient`] reverses with [`Facing::Outward`].
    TurnedFace,
    /// A component that is not orientable, by an edge at which its faces cannot agree.
    NotOrientable,
    /// A closed component that touches or crosses another one, by its first face. The volume of the mesh
    /// counts what they share twice, or not at all.
    TouchingComponent,
    /// An edge with one face.
    BoundaryEdge,
}

impl FaultKind {
    /// All kinds, in the order of reports.
    pub const ALL: [Self; 16] = [
        Self::Polygon,
        Self::NonManifoldEdge,
        Self::RepeatedSide,
        Self::NonManifoldVertex,
        Self::IsolatedVertex,
        Self::CoincidentCorners,
        Self::CoincidentVertex,
        Self::NotFiniteVertex,
        Self::DuplicateFace,
        Self::OppositeFace,
        Self::FlatFace,
        Self::CrossingFace,
        Self::TurnedFace,
        Self::NotOrientable,
        Self::TouchingComponent,
        Self::BoundaryEdge,
    ];

    /// Returns whether a structure with these capabilities refuses a mesh with this fault.
    pub fn is_refused_by(self, capabilities: &Capabilities) -> bool {
        match self {
            Self::Polygon => !capabilities.polygons,
            // Two of three faces always run in the same direction.
            Self::NonManifoldEdge => {
                !capabilities.non_manifold_edges || !capabilities.inconsistent_orientation
            }
            Self::RepeatedSide => !capabilities.inconsistent_orientation,
            Self::NonManifoldVertex => !capabilities.non_manifold_vertices,
            Self::IsolatedVertex => !capabilities.isolated_vertices,
            Self::CoincidentCorners => !capabilities.coincident_vertices,
            _ => false,
        }
    }

    /// Returns the steps that repair the fault, in order; none if the coordinates must be corrected.
    pub fn repairs(self) -> Vec<Step> {
        let orient = Step::Orient {
            facing: Facing::Outward,
            which: Components::All,
        };
        match self {
            Self::Polygon => vec![Step::Triangulate],
            Self::RepeatedSide => vec![orient, Step::Cut],
            Self::NonManifoldEdge | Self::NonManifoldVertex | Self::NotOrientable => {
                vec![Step::Cut]
            }
            Self::IsolatedVertex => vec![Step::RemoveIsolatedVertices],
            Self::CoincidentCorners | Self::CoincidentVertex => vec![Step::Weld(Weld::default())],
            Self::NotFiniteVertex | Self::CrossingFace | Self::TouchingComponent => Vec::new(),
            Self::DuplicateFace => vec![Step::RemoveDuplicateFaces(OppositeFaces::Keep)],
            Self::OppositeFace => vec![Step::RemoveDuplicateFaces(OppositeFaces::Remove)],
            Self::FlatFace => vec![Step::RemoveFlatFaces],
            Self::TurnedFace => vec![orient],
            Self::BoundaryEdge => vec![Step::FillHoles(FillHoles::default())],
        }
    }

    /// Returns the names of one element with this fault, and of several.
    pub fn titles(self) -> [&'static str; 2] {
        match self {
            Self::Polygon => [
                "face with more than three corners",
                "faces with more than three corners",
            ],
            Self::NonManifoldEdge => [
                "edge with three or more faces",
                "edges with three or more faces",
            ],
            Self::RepeatedSide => [
                "edge along which two faces run in the same direction",
                "edges along which two faces run in the same direction",
            ],
            Self::NonManifoldVertex => [
                "vertex whose faces form several fans",
                "vertices whose faces form several fans",
            ],
            Self::IsolatedVertex => ["vertex without a face", "vertices without a face"],
            Self::CoincidentCorners => [
                "face with two corners at one position",
                "faces with two corners at one position",
            ],
            Self::CoincidentVertex => [
                "vertex at the position of another vertex",
                "vertices at the position of another vertex",
            ],
            Self::NotFiniteVertex => [
                "vertex with a coordinate that is not finite",
                "vertices with a coordinate that is not finite",
            ],
            Self::DuplicateFace => ["face that repeats another", "faces that repeat another"],
            Self::OppositeFace => [
                "face with an opposite face on the same vertices",
                "faces with an opposite face on the same vertices",
            ],
            Self::FlatFace => ["face without area", "faces without area"],
            Self::CrossingFace => [
                "face that crosses itself, so that its triangles overlap",
                "faces that cross themselves, so that their triangles overlap",
            ],
            Self::TurnedFace => [
                "face turned against its neighbours or into its solid",
                "faces turned against their neighbours or into their solid",
            ],
            Self::NotOrientable => [
                "component that is not orientable",
                "components that are not orientable",
            ],
            Self::TouchingComponent => [
                "closed part that touches or crosses another, so that its outside is not known",
                "closed parts that touch or cross others, so that their outsides are not known",
            ],
            Self::BoundaryEdge => ["boundary edge", "boundary edges"],
        }
    }
}
