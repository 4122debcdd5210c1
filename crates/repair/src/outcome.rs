//! What a step of a repair did.

use std::fmt;

use sixfold_core::{FaceId, PolygonMesh, VertexId};

use crate::orientation::UndecidedReason;
use crate::trace::Trace;

/// The numbers of elements that a step changed.
///
/// The vertices after the step are those before it, minus `vertices_merged` and
/// `vertices_removed`, plus `vertices_added`; the faces likewise. A face that becomes several
/// faces counts once in `faces_changed`, and each of its further parts in `faces_added`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct StepCounts {
    /// Vertices that became one with a vertex that remains.
    pub vertices_merged: usize,
    /// Copies of vertices, one for each further fan.
    pub vertices_added: usize,
    /// Vertices that were removed.
    pub vertices_removed: usize,
    /// Edges that became two or more edges with the same positions.
    pub edges_cut: usize,
    /// Faces that were added.
    pub faces_added: usize,
    /// Faces that were removed.
    pub faces_removed: usize,
    /// Faces that lost or gained corners, or became several faces.
    pub faces_changed: usize,
    /// Faces that were reversed.
    pub faces_reversed: usize,
    /// Holes that were filled.
    pub holes_filled: usize,
    /// The largest distance between a vertex and its position after the step, in units of the
    /// coordinates.
    pub largest_shift: f64,
}

impl StepCounts {
    /// Returns whether a count is not zero.
    pub fn is_change(&self) -> bool {
        *self != Self::default()
    }
}

/// A place that a step left as it was.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(tag = "kind", rename_all = "snake_case")
)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what each field is")]
pub enum Left {
    /// A component whose faces cannot agree; `face` is its first face.
    NotOrientable {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        face: FaceId,
        faces: usize,
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::rows"))]
        ends: [VertexId; 2],
    },
    /// A component of which the outside is not known; `face` is its first face. Its faces agree, and
    /// most of them are as before.
    Undecided {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        face: FaceId,
        faces: usize,
        reason: UndecidedReason,
    },
    /// A hole that has more edges than allowed; `vertex` is its lowest vertex.
    LargeHole {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        vertex: VertexId,
        edges: usize,
    },
    /// A hole for which every triangulation has a diagonal that is an edge already, or for which
    /// ear clipping found such a triangulation only; `vertex` is its lowest vertex.
    BlockedHole {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        vertex: VertexId,
        edges: usize,
    },
    /// A hole whose triangles would lie on faces of the mesh or on those of another hole; `vertex` is
    /// its lowest vertex.
    CoveringHole {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        vertex: VertexId,
        edges: usize,
    },
    /// A face without area whose removal would add a boundary edge or a non-manifold edge.
    FlatFace {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        face: FaceId,
    },
    /// A polygon that crosses itself and was cut into triangles, which overlap.
    CrossingFace {
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serialize::row"))]
        face: FaceId,
    },
}

impl Left {
    /// Returns the face, or the first face of the component; `None` for a hole. It is a face of the mesh
    /// before the step.
    pub fn face(&self) -> Option<FaceId> {
        match *self {
            Self::NotOrientable { face, .. }
            | Self::Undecided { face, .. }
            | Self::FlatFace { face }
            | Self::CrossingFace { face } => Some(face),
            Self::LargeHole { .. } | Self::BlockedHole { .. } | Self::CoveringHole { .. } => None,
        }
    }
}

impl fmt::Display for Left {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotOrientable { face, faces, ends } => write!(
                f,
                "the component of face {face} ({faces} faces) is not orientable; its faces cannot agree at edge {}–{}",
                ends[0], ends[1]
            ),
            Self::Undecided {
                face,
                faces,
                reason,
            } => {
                let faces = match faces {
                    1 => "1 face".to_owned(),
                    _ => format!("{faces} faces"),
                };
                write!(
                    f,
                    "the component of face {face} ({faces}) {reason}, so its outside is not known"
                )
            }
            Self::LargeHole { vertex, edges } => write!(
                f,
                "the hole at vertex {vertex} has {edges} edges, more than the limit"
            ),
            Self::BlockedHole { vertex, edges } => write!(
                f,
                "the hole at vertex {vertex} ({edges} edges) has no triangulation without a diagonal that is already an edge"
            ),
            Self::CoveringHole { vertex, edges } => write!(
                f,
                "the hole at vertex {vertex} ({edges} edges) is not filled, because its triangles would lie on the mesh or on those of another hole"
            ),
            Self::FlatFace { face } => write!(
                f,
                "face {face} has no area, but remains: without it, an edge would have one face, or more than two"
            ),
            Self::CrossingFace { face } => {
                write!(f, "face {face} crosses itself, so its triangles overlap")
            }
        }
    }
}

/// The result of one step.
pub(crate) struct Outcome {
    /// The changed mesh; `None` if it is unchanged.
    pub(crate) changed: Option<(PolygonMesh, Trace)>,
    pub(crate) counts: StepCounts,
    pub(crate) left: Vec<Left>,
}

impl Outcome {
    /// Returns the outcome of a step that changes nothing.
    pub(crate) fn unchanged() -> Self {
        Self {
            changed: None,
            counts: StepCounts::default(),
            left: Vec::new(),
        }
    }

    pub(crate) fn changed(changed: (PolygonMesh, Trace), counts: StepCounts) -> Self {
        Self {
            changed: Some(changed),
            counts,
            left: Vec::new(),
        }
    }
}
