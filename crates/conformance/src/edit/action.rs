//! Edits of elements that are identified by their numbers in the model.

use sixfold_core::{Edit, Point};

/// An edit, and the elements to which it applies. Vertices and faces are given by their numbers in
/// the [`Model`](super::Model), and edges by the numbers of their two ends.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    missing_docs,
    reason = "the names are those of the methods and arguments of MeshEdit"
)]
pub enum Action {
    SetPosition {
        v: usize,
        to: Point,
    },
    AddVertex {
        at: Point,
    },
    AddFace {
        corners: Vec<usize>,
    },
    RemoveFace {
        f: usize,
    },
    RemoveVertex {
        v: usize,
    },
    RemoveIsolatedVertices,
    SplitEdge {
        ends: [usize; 2],
        at: Point,
    },
    BisectEdge {
        ends: [usize; 2],
        at: Point,
    },
    PokeFace {
        f: usize,
        at: Point,
    },
    SplitFace {
        f: usize,
        ends: [usize; 2],
    },
    DissolveEdge {
        ends: [usize; 2],
    },
    FlipEdge {
        ends: [usize; 2],
    },
    /// Collapses an edge. The first of its two ends is kept.
    CollapseEdge {
        ends: [usize; 2],
        to: Point,
    },
    SplitVertex {
        v: usize,
        left: Option<usize>,
        right: Option<usize>,
        at: Point,
    },
    Compact,
}

impl Action {
    /// Returns the kind of the edit.
    pub fn edit(&self) -> Edit {
        match self {
            Self::SetPosition { .. } => Edit::SetPosition,
            Self::AddVertex { .. } => Edit::AddVertex,
            Self::AddFace { .. } => Edit::AddFace,
            Self::RemoveFace { .. } => Edit::RemoveFace,
            Self::RemoveVertex { .. } => Edit::RemoveVertex,
            Self::RemoveIsolatedVertices => Edit::RemoveIsolatedVertices,
            Self::SplitEdge { .. } => Edit::SplitEdge,
            Self::BisectEdge { .. } => Edit::BisectEdge,
            Self::PokeFace { .. } => Edit::PokeFace,
            Self::SplitFace { .. } => Edit::SplitFace,
            Self::DissolveEdge { .. } => Edit::DissolveEdge,
            Self::FlipEdge { .. } => Edit::FlipEdge,
            Self::CollapseEdge { .. } => Edit::CollapseEdge,
            Self::SplitVertex { .. } => Edit::SplitVertex,
            Self::Compact => Edit::Compact,
        }
    }

    /// Returns the ends of the edge that the edit takes.
    pub(crate) fn ends(&self) -> Option<[usize; 2]> {
        match self {
            Self::SplitEdge { ends, .. }
            | Self::BisectEdge { ends, .. }
            | Self::DissolveEdge { ends }
            | Self::FlipEdge { ends }
            | Self::CollapseEdge { ends, .. } => Some(*ends),
            _ => None,
        }
    }

    /// Returns the face that the edit takes.
    pub(crate) fn face(&self) -> Option<usize> {
        match self {
            Self::RemoveFace { f } | Self::PokeFace { f, .. } | Self::SplitFace { f, .. } => {
                Some(*f)
            }
            _ => None,
        }
    }

    pub(crate) fn position(&self) -> Option<Point> {
        match self {
            Self::SetPosition { to: at, .. }
            | Self::CollapseEdge { to: at, .. }
            | Self::AddVertex { at }
            | Self::SplitEdge { at, .. }
            | Self::BisectEdge { at, .. }
            | Self::PokeFace { at, .. }
            | Self::SplitVertex { at, .. } => Some(*at),
            _ => None,
        }
    }
}
