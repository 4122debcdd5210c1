//! The kinds of edits.

use crate::traits::representation::QueryCost;

crate::named! {
    /// A kind of edit: one method of [`MeshEdit`](crate::MeshEdit).
    #[expect(
        missing_docs,
        reason = "the names are those of the methods of MeshEdit"
    )]
    pub enum Edit: "edit" {
        SetPosition = "set_position",
        AddVertex = "add_vertex",
        AddFace = "add_face",
        RemoveFace = "remove_face",
        RemoveVertex = "remove_vertex",
        RemoveIsolatedVertices = "remove_isolated_vertices",
        SplitEdge = "split_edge",
        BisectEdge = "bisect_edge",
        PokeFace = "poke_face",
        SplitFace = "split_face",
        DissolveEdge = "dissolve_edge",
        FlipEdge = "flip_edge",
        CollapseEdge = "collapse_edge",
        SplitVertex = "split_vertex",
        Compact = "compact",
    }
}

impl Edit {
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
