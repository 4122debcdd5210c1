//! The trait of data that is updated after each edit.

use crate::edit::edit_log::{Changes, EditRecord};
use crate::handles::handle::Handle;
use crate::handles::short_vec::ShortVec;
use crate::traits::query::MeshQuery;

/// Data that is updated after each edit of a [`MeshWithData`](crate::MeshWithData).
///
/// [`VertexData`](crate::VertexData), [`EdgeData`](crate::EdgeData), [`FaceData`](crate::FaceData) and
/// [`SideData`](crate::SideData) implement this trait. Tuples, vectors and mutable references of
/// types with this trait also implement this trait. The type `()` stands for no data and costs
/// nothing. Implement this trait for your own types of data, such as a set of selected faces.
pub trait FollowEdits<M: MeshQuery> {
    /// True if the data uses the changes that an edit reports. If `USES_CHANGES` is false, edits
    /// can skip the computation of the changes.
    const USES_CHANGES: bool = true;

    /// Returns true if [`follow`](Self::follow) needs the parents of new elements (the old elements
    /// from which the new elements are made). If the result is false, edits do not record parents.
    fn uses_parents(&self) -> bool {
        false
    }

    /// Updates the data after one edit.
    fn follow(&mut self, edit: &AcceptedEdit<'_, M>);
}

/// A completed edit: the mesh, the changes of handles, and the parents of new elements.
pub struct AcceptedEdit<'a, M: MeshQuery> {
    /// The mesh after the edit.
    pub mesh: &'a M,
    /// The created, removed and renamed elements of this edit.
    pub changes: &'a EditRecord<M>,
    pub(crate) source: Source<M>,
}

impl<M: MeshQuery> AcceptedEdit<'_, M> {
    /// Returns the old vertices from which a new vertex was made: the ends of the split edge, the
    /// corners of the poked face, or the vertex that was split. The list is empty if the edit is
    /// not one of these splits.
    ///
    /// The list is also empty if [`uses_parents`](FollowEdits::uses_parents) returns false.
    pub fn vertex_parents(&self) -> ShortVec<M::Vertex> {
        let parents: &[M::Vertex] = match &self.source {
            Source::Nothing => &[],
            Source::Vertex(v) => std::slice::from_ref(v),
            Source::Edge { ends, .. } => ends,
            Source::Face { corners, .. } => corners,
        };
        let renamed = |&v| self.changes.vertices.current(v);
        parents.iter().map(renamed).collect()
    }

    /// If the new edge `e` is one half of a split edge, returns the current handle of the other
    /// half, which replaces the split edge. Returns `None` if `e` is not one half of a split edge.
    /// Costs as much as `vertex_edges`.
    pub fn edge_parent(&self, e: M::Edge) -> Option<M::Edge> {
        let Source::Edge { ends, .. } = &self.source else {
            return None;
        };
        let middle = *self.changes.vertices.created.first()?;
        let [a, b] = ends.map(|v| self.changes.vertices.current(v));
        let own_ends = self.mesh.edge_vertices(e);
        if !own_ends.contains(&middle) {
            return None;
        }
        let other_end = if own_ends.contains(&a) {
            b
        } else if own_ends.contains(&b) {
            a
        } else {
            return None;
        };
        let half = self.mesh.edge_between(middle, other_end)?;
        (!self.changes.edges.created.contains(&half)).then_some(half)
    }

    /// Returns the face from which the new face `f` was cut; `None` if `f` was not cut from a face.
    /// Costs as much as `face_vertices`.
    pub fn face_parent(&self, f: M::Face) -> Option<M::Face> {
        let parent = match &self.source {
            Source::Nothing | Source::Vertex(_) => None,
            Source::Face { face, .. } => Some(*face),
            // Both halves of a cut triangle have the third corner of the triangle.
            Source::Edge { ends, faces } => {
                let middle = *self.changes.vertices.created.first()?;
                let ends = ends.map(|v| self.changes.vertices.current(v));
                let mut corners = self.mesh.face_vertices(f);
                let apex = corners.find(|v| *v != middle && !ends.contains(v))?;
                let has_apex = |&&g: &&M::Face| {
                    self.mesh
                        .face_vertices(self.current_face(g))
                        .any(|v| v == apex)
                };
                faces.iter().find(has_apex).copied()
            }
        };
        parent.map(|g| self.current_face(g))
    }

    fn current_face(&self, f: M::Face) -> M::Face {
        self.changes.faces.current(f)
    }
}

impl<H: Handle> Changes<H> {
    /// Returns the current handle of the element whose handle was `old` before the edit. The
    /// element must still exist.
    fn current(&self, old: H) -> H {
        let mut renamed = self.renamed.iter();
        renamed
            .find(|[from, _]| *from == old)
            .map_or(old, |&[_, to]| to)
    }
}

/// The element that an edit splits, recorded before the edit.
pub(crate) enum Source<M: MeshQuery> {
    /// The edit splits nothing, or the data does not use parents.
    Nothing,
    Vertex(M::Vertex),
    Edge {
        ends: [M::Vertex; 2],
        faces: ShortVec<M::Face>,
    },
    Face {
        face: M::Face,
        corners: ShortVec<M::Vertex>,
    },
}

impl<M: MeshQuery> Source<M> {
    pub(crate) fn nothing(_: &M) -> Self {
        Self::Nothing
    }

    pub(crate) fn vertex(_: &M, v: M::Vertex) -> Self {
        Self::Vertex(v)
    }

    /// Returns the ends and the faces of `e`; nothing if `e` does not exist.
    pub(crate) fn edge(mesh: &M, e: M::Edge) -> Self {
        if !mesh.contains_edge(e) {
            return Self::Nothing;
        }
        Self::Edge {
            ends: mesh.edge_vertices(e),
            faces: mesh.edge_faces(e).collect(),
        }
    }

    /// Returns `f` and its corners; nothing if `f` does not exist.
    pub(crate) fn face(mesh: &M, f: M::Face) -> Self {
        if !mesh.contains_face(f) {
            return Self::Nothing;
        }
        Self::Face {
            face: f,
            corners: mesh.face_vertices(f).collect(),
        }
    }
}

/// The type `()` stands for no data.
impl<M: MeshQuery> FollowEdits<M> for () {
    const USES_CHANGES: bool = false;

    #[inline]
    fn follow(&mut self, _: &AcceptedEdit<'_, M>) {}
}

impl<M: MeshQuery, D: FollowEdits<M>> FollowEdits<M> for &mut D {
    const USES_CHANGES: bool = D::USES_CHANGES;

    fn uses_parents(&self) -> bool {
        (**self).uses_parents()
    }

    fn follow(&mut self, edit: &AcceptedEdit<'_, M>) {
        (**self).follow(edit);
    }
}

impl<M: MeshQuery, D: FollowEdits<M>> FollowEdits<M> for Vec<D> {
    const USES_CHANGES: bool = D::USES_CHANGES;

    fn uses_parents(&self) -> bool {
        self.iter().any(D::uses_parents)
    }

    fn follow(&mut self, edit: &AcceptedEdit<'_, M>) {
        for data in self {
            data.follow(edit);
        }
    }
}

/// Implements [`FollowEdits`] for tuples; longer tuples can be nested.
macro_rules! tuples {
    ($(($($data:ident $index:tt),+))+) => {$(
        impl<M: MeshQuery, $($data: FollowEdits<M>),+> FollowEdits<M> for ($($data,)+) {
            const USES_CHANGES: bool = $($data::USES_CHANGES)||+;

            fn uses_parents(&self) -> bool {
                $(self.$index.uses_parents())||+
            }

            fn follow(&mut self, edit: &AcceptedEdit<'_, M>) {
                $(self.$index.follow(edit);)+
            }
        }
    )+};
}

tuples! {
    (A 0, B 1)
    (A 0, B 1, C 2)
    (A 0, B 1, C 2, D 3)
}
