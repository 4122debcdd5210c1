//! The table of edits, and their kinds.

use crate::traits::representation::QueryCost;

/// Calls a macro with the table of all edits: the value of [`Edit`], the name, the logged method, its
/// arguments with their kinds (the methods of [`EditArguments`](crate::EditArguments)) and types, and
/// the kind of the result.
#[doc(hidden)]
#[macro_export]
macro_rules! for_each_edit {
    ($callback:ident! { $($before:tt)* }) => {
        $callback! {
            $($before)*
            SetPosition "set_position" set_position_logged(v: vertex V, to: position Point) -> vertex;
            AddVertex "add_vertex" add_vertex_logged(at: position Point) -> vertex;
            AddFace "add_face" add_face_logged(corners: vertices Vec<V>) -> face;
            RemoveFace "remove_face" remove_face_logged(f: face F) -> nothing;
            RemoveFaces "remove_faces" remove_faces_logged(faces: faces Vec<F>) -> nothing;
            RemoveVertex "remove_vertex" remove_vertex_logged(v: vertex V) -> nothing;
            RemoveIsolatedVertices "remove_isolated_vertices" remove_isolated_vertices_logged() -> count;
            SplitEdge "split_edge" split_edge_logged(e: edge E, at: new_position P) -> vertex;
            BisectEdge "bisect_edge" bisect_edge_logged(e: edge E, at: new_position P) -> vertex;
            PokeFace "poke_face" poke_face_logged(f: face F, at: new_position P) -> vertex;
            SplitFace "split_face" split_face_logged(f: face F, ends: corners [V; 2]) -> edge;
            DissolveEdge "dissolve_edge" dissolve_edge_logged(e: edge E) -> face;
            FlipEdge "flip_edge" flip_edge_logged(e: edge E) -> edge;
            CollapseEdge "collapse_edge" collapse_edge_logged(e: edge E, keep: vertex V, to: new_position P) -> vertex;
            SplitVertex "split_vertex" split_vertex_logged(v: vertex V, left: vertex_if_any Option<V>, right: vertex_if_any Option<V>, at: new_position P) -> vertex;
            Compact "compact" compact_logged() -> unit;
        }
    };
}

macro_rules! edit_kinds {
    ($($edit:ident $name:literal $method:ident($($a:ident: $kind:ident $type:ty),*) -> $result:ident;)+) => {
        crate::named! {
            /// A kind of edit: one method of [`MeshEdit`](crate::MeshEdit).
            #[expect(
                missing_docs,
                reason = "the names are those of the methods of MeshEdit"
            )]
            pub enum Edit: "edit" {
                $($edit = $name,)+
            }
        }
    };
}

crate::for_each_edit!(edit_kinds! {});

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
    /// `add_face` reads O(1) rows. `remove_face`, `poke_face` and `split_face` read one face, and
    /// `remove_faces` each of its faces. All other edits scan all faces. A structure can declare a
    /// different cost for an edit.
    pub const SCAN_COSTS: [Option<QueryCost>; Self::ALL.len()] = {
        let mut costs = [Some(QueryCost::Scan); Self::ALL.len()];
        costs[Self::AddFace as usize] = Some(QueryCost::Constant);
        costs[Self::RemoveFace as usize] = Some(QueryCost::Local);
        costs[Self::RemoveFaces as usize] = Some(QueryCost::Local);
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
