//! The kinds of edits.

use std::fmt;

use crate::traits::representation::QueryCost;

/// A kind of edit: one method of [`MeshEdit`](crate::MeshEdit).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "snake_case")
)]
#[expect(
    missing_docs,
    reason = "the names are those of the methods of MeshEdit"
)]
pub enum Edit {
    SetPosition,
    AddVertex,
    AddFace,
    RemoveFace,
    RemoveVertex,
    RemoveIsolatedVertices,
    SplitEdge,
    BisectEdge,
    PokeFace,
    SplitFace,
    DissolveEdge,
    FlipEdge,
    CollapseEdge,
    SplitVertex,
    Compact,
}

impl Edit {
    /// All edits, in the order of [`MeshEdit::EDITS`](crate::MeshEdit::EDITS).
    pub const ALL: [Self; 15] = [
        Self::SetPosition,
        Self::AddVertex,
        Self::AddFace,
        Self::RemoveFace,
        Self::RemoveVertex,
        Self::RemoveIsolatedVertices,
        Self::SplitEdge,
        Self::BisectEdge,
        Self::PokeFace,
        Self::SplitFace,
        Self::DissolveEdge,
        Self::FlipEdge,
        Self::CollapseEdge,
        Self::SplitVertex,
        Self::Compact,
    ];

    /// The costs of the edits in a structure that stores adjacency. `set_position` and `add_vertex`
    /// read O(1) rows. `remove_isolated_vertices` and `compact` read whole tables. All other edits
    /// read the faces around the edited element.
    pub const LOCAL_COSTS: [Option<QueryCost>; Self::ALL.len()] = {
        let mut costs = [Some(QueryCost::Local); Self::ALL.len()];
        costs[Self::SetPosition as usize] = Some(QueryCost::Constant);
        costs[Self::AddVertex as usize] = Some(QueryCost::Constant);
        costs[Self::RemoveIsolatedVertices as usize] = Some(QueryCost::Scan);
        costs[Self::Compact as usize] = Some(QueryCost::Scan);
        costs
    };

    /// The costs of the edits in a structure that scans all faces, if the log ignores reports.
    /// `add_face` reads O(1) rows. `remove_face`, `poke_face` and `split_face` read one face. All
    /// other edits scan all faces. A structure can declare a different cost for an edit.
    pub const SCAN_COSTS: [Option<QueryCost>; Self::ALL.len()] = {
        let mut costs = [Some(QueryCost::Scan); Self::ALL.len()];
        costs[Self::AddFace as usize] = Some(QueryCost::Constant);
        costs[Self::RemoveFace as usize] = Some(QueryCost::Local);
        costs[Self::PokeFace as usize] = Some(QueryCost::Local);
        costs[Self::SplitFace as usize] = Some(QueryCost::Local);
        costs
    };

    /// Returns the name of the method, for example `flip_edge`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SetPosition => "set_position",
            Self::AddVertex => "add_vertex",
            Self::AddFace => "add_face",
            Self::RemoveFace => "remove_face",
            Self::RemoveVertex => "remove_vertex",
            Self::RemoveIsolatedVertices => "remove_isolated_vertices",
            Self::SplitEdge => "split_edge",
            Self::BisectEdge => "bisect_edge",
            Self::PokeFace => "poke_face",
            Self::SplitFace => "split_face",
            Self::DissolveEdge => "dissolve_edge",
            Self::FlipEdge => "flip_edge",
            Self::CollapseEdge => "collapse_edge",
            Self::SplitVertex => "split_vertex",
            Self::Compact => "compact",
        }
    }
}

impl fmt::Display for Edit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_edits_are_in_the_order_of_their_numbers() {
        for (i, edit) in Edit::ALL.into_iter().enumerate() {
            assert_eq!(edit as usize, i, "{edit}");
        }
    }
}
