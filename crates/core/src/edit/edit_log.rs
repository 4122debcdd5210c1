//! Reports of edits: a trait that receives the changes of elements and handles, a record of these
//! changes, and the update of maps.

use std::fmt;

use crate::handles::handle::{Handle, HandleMap};
use crate::traits::query::{EdgeMap, FaceMap, MeshQuery, VertexMap};

/// The new handle of each element that existed before [`compact`](crate::MeshEdit::compact); `None`
/// for the rows of deleted elements.
pub struct OldToNew<M: MeshQuery> {
    /// The new handle of each vertex, by old handle.
    pub vertices: VertexMap<M, Option<M::Vertex>>,
    /// The new handle of each edge, by old handle.
    pub edges: EdgeMap<M, Option<M::Edge>>,
    /// The new handle of each face, by old handle.
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

/// A receiver of the changes that an edit makes to elements and their handles.
///
/// An edit reports each change once. A refused edit reports nothing. The order of the calls within
/// one edit is not specified. A log that stores handles must apply the changes of an edit in three
/// steps: drop all removed handles; rename all renamed handles at once, because elements may
/// exchange handles; add the created handles.
///
/// # Which log to use
///
/// - To keep data by vertex, edge or face correct, put the data into a
///   [`MeshWithData`](crate::MeshWithData). Every edit of a `MeshWithData` updates the data, even
///   in algorithms that have no parameter for a log.
/// - To list the changes of an edit, for instance to undo the edit or to redraw a part of the mesh,
///   pass an [`EditRecord`].
/// - To react to one kind of change, such as the removal of faces, implement this trait.
/// - If you do not need the changes, use the short form of the edit, such as `flip_edge`. The short
///   form passes the log `()`, for which the structures compute no reports.
pub trait EditLog<M: MeshQuery> {
    /// True if the log uses the reports. If `USES_REPORTS` is false, structures can skip the
    /// computation of reports.
    const USES_REPORTS: bool = true;

    /// Reports that `v` was created.
    fn created_vertex(&mut self, _v: M::Vertex) {}
    /// Reports that `v` was removed.
    fn removed_vertex(&mut self, _v: M::Vertex) {}
    /// Reports that the handle of a vertex changed from `old` to `new`.
    fn renamed_vertex(&mut self, _old: M::Vertex, _new: M::Vertex) {}
    /// Reports that `e` was created.
    fn created_edge(&mut self, _e: M::Edge) {}
    /// Reports that `e` was removed.
    fn removed_edge(&mut self, _e: M::Edge) {}
    /// Reports that the handle of an edge changed from `old` to `new`.
    fn renamed_edge(&mut self, _old: M::Edge, _new: M::Edge) {}
    /// Reports that `f` was created.
    fn created_face(&mut self, _f: M::Face) {}
    /// Reports that `f` was removed.
    fn removed_face(&mut self, _f: M::Face) {}
    /// Reports that the handle of a face changed from `old` to `new`.
    fn renamed_face(&mut self, _old: M::Face, _new: M::Face) {}
}

/// Implements the methods of [`EditLog<M>`](EditLog): each passes its report on to fields. A field
/// with `if` gets the reports only under this condition.
#[doc(hidden)]
#[macro_export]
macro_rules! pass_reports_on {
    (@all $fields:tt $($report:ident $handles:tt $parameters:tt)+) => {
        $($crate::pass_reports_on! { @one $fields $report $handles $parameters })+
    };
    (@one [$($field:tt $(if $condition:expr)?),+] $report:ident $handles:tt
        [$($handle:ident: $element:ident),+]) => {
        #[inline]
        fn $report(&mut self, $($handle: M::$element),+) {
            $($(if $condition)? {
                self.$field.$report $handles;
            })+
        }
    };
    ($($fields:tt)+) => {
        $crate::pass_reports_on! { @all [$($fields)+]
            created_vertex(v) [v: Vertex]
            removed_vertex(v) [v: Vertex]
            renamed_vertex(old, new) [old: Vertex, new: Vertex]
            created_edge(e) [e: Edge]
            removed_edge(e) [e: Edge]
            renamed_edge(old, new) [old: Edge, new: Edge]
            created_face(f) [f: Face]
            removed_face(f) [f: Face]
            renamed_face(old, new) [old: Face, new: Face]
        }
    };
}

/// Returns [`EditLog::USES_REPORTS`] of the type of `log`, for code that cannot name this type.
pub const fn uses_reports<M: MeshQuery, L: EditLog<M>>(_log: &L) -> bool {
    L::USES_REPORTS
}

/// A log that ignores all reports.
impl<M: MeshQuery> EditLog<M> for () {
    const USES_REPORTS: bool = false;
}

/// A log that stores all changes since the record was created or last cleared.
///
/// ```
/// # use sixfold_core::{EditRecord, HandleMap, MeshEdit, MeshQuery};
/// # fn example<M: MeshEdit>(mesh: &mut M, e: M::Edge) -> Result<(), sixfold_core::Refusal<M>> {
/// let mut sharpness = mesh.edge_map(0.0_f32);
/// let mut record = EditRecord::new();
/// mesh.flip_edge_logged(e, &mut record)?;
/// record.edges.apply_to(&mut sharpness, &0.0);
/// # Ok(())
/// # }
/// ```
pub struct EditRecord<M: MeshQuery> {
    /// Changes of vertices.
    pub vertices: Changes<M::Vertex>,
    /// Changes of edges.
    pub edges: Changes<M::Edge>,
    /// Changes of faces.
    pub faces: Changes<M::Face>,
}

impl<M: MeshQuery> EditRecord<M> {
    /// Returns an empty record.
    pub fn new() -> Self {
        Self {
            vertices: Changes::default(),
            edges: Changes::default(),
            faces: Changes::default(),
        }
    }

    /// Returns whether there are no changes.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty() && self.edges.is_empty() && self.faces.is_empty()
    }

    /// Removes all changes, but keeps the allocated memory for the next edit.
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

/// The changes of elements of one kind: vertices, edges or faces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Changes<H> {
    /// The handles of new elements.
    pub created: Vec<H>,
    /// The handles of removed elements.
    pub removed: Vec<H>,
    /// The old and the new handle of each renamed element.
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

    /// Returns whether there are no changes.
    pub fn is_empty(&self) -> bool {
        self.created.is_empty() && self.removed.is_empty() && self.renamed.is_empty()
    }

    /// Updates `map` after one edit; O(changes). The values of removed elements are dropped, except
    /// that a [`RowMap`](crate::RowMap) keeps them in unused rows. Renamed elements keep their
    /// values under the new handles. New elements get the value `initial`.
    ///
    /// `self` must hold the changes of a single edit. To apply several edits, keep one record for
    /// each edit and apply the records in order.
    pub fn apply_to<T: Clone>(&self, map: &mut H::Map<T>, initial: &T) {
        self.apply_with(map, |_, _| initial.clone());
    }

    /// Does the same as [`apply_to`](Self::apply_to), but calls `initial` to compute the value of
    /// each new element. The arguments of `initial` are the map and the handle of the new element.
    /// During the call of `initial`, the map holds the values of all old elements under their
    /// current handles. Some new elements may not have a value yet.
    pub fn apply_with<T: Clone>(
        &self,
        map: &mut H::Map<T>,
        mut initial: impl FnMut(&H::Map<T>, H) -> T,
    ) {
        for &old in &self.removed {
            map.remove(old);
        }
        // All at once, because elements may exchange handles.
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
            let value = initial(map, new);
            map.insert(new, value);
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
    use crate::handles::handle::{HashHandleMap, RowMap};
    use crate::handles::pair::Pair;
    use crate::handles::row_id::{FaceId, VertexId};

    #[test]
    fn exchanged_handles_are_updated_in_maps() {
        let f = FaceId::new;
        let changes = Changes {
            created: vec![f(3)],
            removed: vec![f(2)],
            renamed: vec![[f(0), f(1)], [f(1), f(0)]],
        };
        let mut rows: RowMap<FaceId, char> = HandleMap::filled(3, '-');
        (rows[f(0)], rows[f(1)], rows[f(2)]) = ('a', 'b', 'c');
        changes.apply_to(&mut rows, &'n');
        assert_eq!([rows[f(0)], rows[f(1)], rows[f(3)]], ['b', 'a', 'n']);

        let e = |a, b| Pair::new(VertexId::new(a), VertexId::new(b));
        let mut pairs: HashHandleMap<Pair<VertexId>, char> = HandleMap::filled(0, '-');
        pairs[e(0, 1)] = 'x';
        let changes = Changes {
            created: vec![],
            removed: vec![],
            renamed: vec![[e(0, 1), e(2, 3)]],
        };
        changes.apply_to(&mut pairs, &'n');
        assert_eq!([pairs[e(0, 1)], pairs[e(3, 2)]], ['-', 'x']);
    }
}
