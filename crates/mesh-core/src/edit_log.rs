//! What an edit did to names: who is told, the record of it, and maps that follow.

use std::fmt;

use crate::handle::{Handle, HandleMap};
use crate::query::{EdgeMap, FaceMap, MeshQuery, VertexMap};

/// What each element that a mesh had before [`compact`](crate::MeshEdit::compact) is called since; `None` for what
/// was a hole. Maps by handle that cost what the structure's maps cost.
pub struct OldToNew<M: MeshQuery> {
    /// By old vertex.
    pub vertices: VertexMap<M, Option<M::Vertex>>,
    /// By old edge.
    pub edges: EdgeMap<M, Option<M::Edge>>,
    /// By old face.
    pub faces: FaceMap<M, Option<M::Face>>,
}

impl<M: MeshQuery> EditLog<M> for OldToNew<M> {
    fn renamed_vertex(&mut self, old: M::Vertex, new: M::Vertex) {
        self.vertices.insert(old, Some(new));
    }

    fn renamed_edge(&mut self, old: M::Edge, new: M::Edge) {
        self.edges.insert(old, Some(new));
    }

    fn renamed_face(&mut self, old: M::Face, new: M::Face) {
        self.faces.insert(old, Some(new));
    }
}

/// Who is told what an edit does to the elements and their names.
///
/// An edit tells everything, and only what it did: afterwards the names in use are those before,
/// without the removed, with the renamed under their new names, and with the created. Of one edit,
/// all removals come first to mind, then all renamings at once (elements may exchange names), then
/// what is new; in which order they are told is open. A refused edit tells nothing.
pub trait EditLog<M: MeshQuery> {
    /// Whether anybody listens: where nobody does, structures need not find out what to tell.
    const LISTENS: bool = true;

    /// `v` is new.
    fn created_vertex(&mut self, _v: M::Vertex) {}
    /// `v` is no more.
    fn removed_vertex(&mut self, _v: M::Vertex) {}
    /// What was called `old` is called `new`.
    fn renamed_vertex(&mut self, _old: M::Vertex, _new: M::Vertex) {}
    /// `e` is new.
    fn created_edge(&mut self, _e: M::Edge) {}
    /// `e` is no more.
    fn removed_edge(&mut self, _e: M::Edge) {}
    /// What was called `old` is called `new`.
    fn renamed_edge(&mut self, _old: M::Edge, _new: M::Edge) {}
    /// `f` is new.
    fn created_face(&mut self, _f: M::Face) {}
    /// `f` is no more.
    fn removed_face(&mut self, _f: M::Face) {}
    /// What was called `old` is called `new`.
    fn renamed_face(&mut self, _old: M::Face, _new: M::Face) {}
}

/// Nobody listens.
impl<M: MeshQuery> EditLog<M> for () {
    const LISTENS: bool = false;
}

/// What edits did, since the record was last cleared: to be looked at, and for maps to follow.
///
/// ```
/// # use mesh_core::{EditRecord, HandleMap, MeshEdit, MeshQuery};
/// # fn example<M: MeshEdit>(mesh: &mut M, e: M::Edge) -> Result<(), mesh_core::Refusal<M>> {
/// let mut sharpness = mesh.edge_map(0.0_f32);
/// let mut record = EditRecord::new();
/// mesh.flip_edge(e, &mut record)?;
/// record.edges.follow(&mut sharpness, &0.0);
/// # Ok(())
/// # }
/// ```
pub struct EditRecord<M: MeshQuery> {
    /// What happened to vertices.
    pub vertices: Changes<M::Vertex>,
    /// What happened to edges.
    pub edges: Changes<M::Edge>,
    /// What happened to faces.
    pub faces: Changes<M::Face>,
}

impl<M: MeshQuery> EditRecord<M> {
    /// A record of nothing.
    pub fn new() -> Self {
        Self {
            vertices: Changes::default(),
            edges: Changes::default(),
            faces: Changes::default(),
        }
    }

    /// Forgets everything, and keeps the room for more: between one edit and the next.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.edges.clear();
        self.faces.clear();
    }
}

impl<M: MeshQuery> Default for EditRecord<M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<M: MeshQuery> fmt::Debug for EditRecord<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("EditRecord")
            .field("vertices", &self.vertices)
            .field("edges", &self.edges)
            .field("faces", &self.faces)
            .finish()
    }
}

/// What happened to elements of one kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Changes<H> {
    /// Those that are new.
    pub created: Vec<H>,
    /// Those that are no more.
    pub removed: Vec<H>,
    /// Old names and new ones.
    pub renamed: Vec<[H; 2]>,
}

impl<H> Default for Changes<H> {
    fn default() -> Self {
        Self {
            created: Vec::new(),
            removed: Vec::new(),
            renamed: Vec::new(),
        }
    }
}

impl<H: Handle> Changes<H> {
    fn clear(&mut self) {
        self.created.clear();
        self.removed.clear();
        self.renamed.clear();
    }

    /// Whether nothing happened.
    pub fn is_empty(&self) -> bool {
        self.created.is_empty() && self.removed.is_empty() && self.renamed.is_empty()
    }

    /// Brings `map` up to date after one edit: what was removed is forgotten (by row, its data stays
    /// until the row is another's), what was renamed keeps its data under the new name, and what is new reads `fresh`. O(changes).
    ///
    /// The record must be that of one edit; those of several in a row are followed one by one.
    pub fn follow<T: Clone>(&self, map: &mut H::Map<T>, fresh: &T) {
        for &old in &self.removed {
            map.remove(old);
        }
        // All at once: one element's new name may be another's old one.
        match *self.renamed.as_slice() {
            [] => {}
            [[old, new]] => map.rename(old, new),
            ref renamed => {
                let values: Vec<T> = renamed.iter().map(|&[old, _]| map[old].clone()).collect();
                for &[old, _] in renamed {
                    map.remove(old);
                }
                for (&[_, new], value) in renamed.iter().zip(values) {
                    map.insert(new, value);
                }
            }
        }
        for &new in &self.created {
            map.insert(new, fresh.clone());
        }
    }
}

impl<M: MeshQuery> EditLog<M> for EditRecord<M> {
    fn created_vertex(&mut self, v: M::Vertex) {
        self.vertices.created.push(v);
    }

    fn removed_vertex(&mut self, v: M::Vertex) {
        self.vertices.removed.push(v);
    }

    fn renamed_vertex(&mut self, old: M::Vertex, new: M::Vertex) {
        self.vertices.renamed.push([old, new]);
    }

    fn created_edge(&mut self, e: M::Edge) {
        self.edges.created.push(e);
    }

    fn removed_edge(&mut self, e: M::Edge) {
        self.edges.removed.push(e);
    }

    fn renamed_edge(&mut self, old: M::Edge, new: M::Edge) {
        self.edges.renamed.push([old, new]);
    }

    fn created_face(&mut self, f: M::Face) {
        self.faces.created.push(f);
    }

    fn removed_face(&mut self, f: M::Face) {
        self.faces.removed.push(f);
    }

    fn renamed_face(&mut self, old: M::Face, new: M::Face) {
        self.faces.renamed.push([old, new]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::handle::{HashHandleMap, Pair, RowMap};
    use crate::row_id::{FaceId, VertexId};

    #[test]
    fn maps_follow_names_that_are_exchanged() {
        let f = FaceId::new;
        let changes = Changes {
            created: vec![f(3)],
            removed: vec![f(2)],
            renamed: vec![[f(0), f(1)], [f(1), f(0)]],
        };
        let mut rows: RowMap<FaceId, char> = HandleMap::filled(3, '-');
        (rows[f(0)], rows[f(1)], rows[f(2)]) = ('a', 'b', 'c');
        changes.follow(&mut rows, &'n');
        assert_eq!([rows[f(0)], rows[f(1)], rows[f(3)]], ['b', 'a', 'n']);

        let e = |a, b| Pair::new(VertexId::new(a), VertexId::new(b));
        let mut pairs: HashHandleMap<Pair<VertexId>, char> = HandleMap::filled(0, '-');
        pairs[e(0, 1)] = 'x';
        let changes = Changes {
            created: vec![],
            removed: vec![],
            renamed: vec![[e(0, 1), e(2, 3)]],
        };
        changes.follow(&mut pairs, &'n');
        assert_eq!([pairs[e(0, 1)], pairs[e(3, 2)]], ['-', 'x']);
    }
}
