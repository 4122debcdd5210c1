//! Maps by vertex, edge or face that are updated after every edit.

use std::fmt;
use std::ops::{Index, IndexMut};
use std::sync::Arc;

use crate::edit::edit_log::{Changes, EditRecord};
use crate::edit::follow_edits::{AcceptedEdit, FollowEdits};
use crate::handles::handle::Handle;
use crate::handles::short_vec::ShortVec;
use crate::traits::query::MeshQuery;

/// A value for each vertex of the mesh type `M`. In a [`MeshWithData`](crate::MeshWithData), every
/// edit updates the values.
pub type VertexData<M, T> = ElementData<M, Vertices, T>;
/// A value for each edge of the mesh type `M`. In a [`MeshWithData`](crate::MeshWithData), every
/// edit updates the values.
pub type EdgeData<M, T> = ElementData<M, Edges, T>;
/// A value for each face of the mesh type `M`. In a [`MeshWithData`](crate::MeshWithData), every
/// edit updates the values.
pub type FaceData<M, T> = ElementData<M, Faces, T>;

/// A map with a value for each element of one kind, together with the initial value of new
/// elements. The forms of this type are [`VertexData`], [`EdgeData`] and [`FaceData`].
///
/// After an edit, the values of removed elements are dropped, and renamed elements have their
/// values under the new handles. A new element gets a fixed value, or a value that a function of
/// the program computes (a rule). `data[handle]` reads and writes the value of an element.
///
/// The arguments of a rule are the map and a [`Created`] element. Parents are the old elements from
/// which an edit makes a new element. The table shows the parents of each new element:
///
/// | element | edit | parents |
/// |---|---|---|
/// | vertex | `split_edge`, `bisect_edge` | the ends of the edge |
/// | vertex | `poke_face` | the corners of the face |
/// | vertex | `split_vertex` | the vertex that was split |
/// | edge | `split_edge`, `bisect_edge` | for the new half of the edge: the other half |
/// | face | `bisect_edge`, `poke_face`, `split_face` | the face that was cut |
/// | any | any other edit | none |
///
/// ```
/// use sixfold_core::{FaceData, MeshQuery, VertexData};
///
/// /// Returns temperatures: a new vertex has the mean of its parents.
/// fn temperatures<M: MeshQuery>(mesh: &M) -> VertexData<M, f32> {
///     VertexData::new(mesh, 20.0).with_rule(|temperature, new| {
///         let sum: f32 = new.parents.iter().map(|&v| temperature[v]).sum();
///         sum / new.parents.len().max(1) as f32
///     })
/// }
///
/// /// Returns materials: a part of a face has its material, and an added face has material 0.
/// fn materials<M: MeshQuery>(mesh: &M) -> FaceData<M, u8> {
///     FaceData::new(mesh, 0).with_rule(|material, new| {
///         new.parents.first().map_or(0, |&f| material[f])
///     })
/// }
/// ```
///
/// Data with a fixed value costs O(changes) for each edit. Data with a rule costs more than data
/// with a fixed value, because each edit that splits an element queries the mesh for the parents.
pub struct ElementData<M: MeshQuery, K: ElementKind<M>, T: Clone> {
    values: Map<M, K, T>,
    initial: Initial<M, K, T>,
}

type Map<M, K, T> = <<K as ElementKind<M>>::Handle as Handle>::Map<T>;

type Rule<M, K, T> =
    dyn Fn(&Map<M, K, T>, Created<'_, M, <K as ElementKind<M>>::Handle>) -> T + Send + Sync;

/// The value of a new element.
enum Initial<M: MeshQuery, K: ElementKind<M>, T: Clone> {
    Value(T),
    Rule(Arc<Rule<M, K, T>>),
}

/// A new element, as an argument of a rule of [`ElementData`].
pub struct Created<'a, M, H> {
    /// The mesh after the edit.
    pub mesh: &'a M,
    /// The handle of the new element. The map has no value for this handle yet.
    pub element: H,
    /// The current handles of the old elements from which the new element was made. Parents are of
    /// the same kind as the new element.
    pub parents: &'a [H],
}

impl<M: MeshQuery, K: ElementKind<M>, T: Clone> ElementData<M, K, T> {
    /// Returns data that holds `value` for all elements of `mesh`, and for new elements.
    pub fn new(mesh: &M, value: T) -> Self {
        Self::from_map(K::map(mesh, value.clone()), value)
    }

    /// Returns data with the values in the map `values`; new elements get the value `initial`.
    pub fn from_map(values: Map<M, K, T>, initial: T) -> Self {
        Self {
            values,
            initial: Initial::Value(initial),
        }
    }

    /// Sets the rule that computes the values of new elements, instead of a fixed value.
    ///
    /// When the rule is called, its map argument holds the values of all old elements under their
    /// current handles.
    #[must_use]
    pub fn with_rule(
        self,
        rule: impl Fn(&Map<M, K, T>, Created<'_, M, K::Handle>) -> T + Send + Sync + 'static,
    ) -> Self {
        Self {
            values: self.values,
            initial: Initial::Rule(Arc::new(rule)),
        }
    }

    /// Returns the map from handles to values.
    pub fn map(&self) -> &Map<M, K, T> {
        &self.values
    }

    /// Converts to the map from handles to values.
    pub fn into_map(self) -> Map<M, K, T> {
        self.values
    }
}

impl<M: MeshQuery, K: ElementKind<M>, T: Clone> FollowEdits<M> for ElementData<M, K, T> {
    fn uses_parents(&self) -> bool {
        matches!(self.initial, Initial::Rule(_))
    }

    fn follow(&mut self, edit: &AcceptedEdit<'_, M>) {
        let changes = K::changes(edit.changes);
        match &self.initial {
            Initial::Value(value) => changes.apply_to(&mut self.values, value),
            Initial::Rule(rule) => changes.apply_with(&mut self.values, |values, element| {
                let (mesh, parents) = (edit.mesh, &K::parents(edit, element));
                rule(
                    values,
                    Created {
                        mesh,
                        element,
                        parents,
                    },
                )
            }),
        }
    }
}

impl<M: MeshQuery, K: ElementKind<M>, T: Clone> Index<K::Handle> for ElementData<M, K, T> {
    type Output = T;

    #[inline]
    #[track_caller]
    fn index(&self, element: K::Handle) -> &T {
        &self.values[element]
    }
}

impl<M: MeshQuery, K: ElementKind<M>, T: Clone> IndexMut<K::Handle> for ElementData<M, K, T> {
    #[inline]
    #[track_caller]
    fn index_mut(&mut self, element: K::Handle) -> &mut T {
        &mut self.values[element]
    }
}

impl<M: MeshQuery, K: ElementKind<M>, T: Clone> Clone for ElementData<M, K, T> {
    fn clone(&self) -> Self {
        Self {
            values: self.values.clone(),
            initial: match &self.initial {
                Initial::Value(value) => Initial::Value(value.clone()),
                Initial::Rule(rule) => Initial::Rule(Arc::clone(rule)),
            },
        }
    }
}

/// Prints only the value of new elements, because a map cannot list its handles.
impl<M: MeshQuery, K: ElementKind<M>, T: Clone + fmt::Debug> fmt::Debug for ElementData<M, K, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut data = f.debug_struct("ElementData");
        match &self.initial {
            Initial::Value(value) => data.field("initial", value),
            Initial::Rule(_) => data.field("initial", &"a rule"),
        };
        data.finish_non_exhaustive()
    }
}

/// A kind of element: vertices, edges or faces.
pub trait ElementKind<M: MeshQuery> {
    /// The handle of an element.
    type Handle: Handle;

    /// Returns a map that holds `value` for every element of `mesh`.
    fn map<T: Clone>(mesh: &M, value: T) -> Map<M, Self, T>
    where
        Self: Sized;

    /// Returns the changes of elements of this kind.
    fn changes(record: &EditRecord<M>) -> &Changes<Self::Handle>;

    /// Returns the parents of the new `element`: the old elements from which `element` was made.
    fn parents(edit: &AcceptedEdit<'_, M>, element: Self::Handle) -> ShortVec<Self::Handle>;
}

/// Vertices, as the kind of elements of [`VertexData`].
#[derive(Clone, Copy, Debug)]
pub enum Vertices {}
/// Edges, as the kind of elements of [`EdgeData`].
#[derive(Clone, Copy, Debug)]
pub enum Edges {}
/// Faces, as the kind of elements of [`FaceData`].
#[derive(Clone, Copy, Debug)]
pub enum Faces {}

impl<M: MeshQuery> ElementKind<M> for Vertices {
    type Handle = M::Vertex;

    fn map<T: Clone>(mesh: &M, value: T) -> Map<M, Self, T> {
        mesh.vertex_map(value)
    }

    fn changes(record: &EditRecord<M>) -> &Changes<M::Vertex> {
        &record.vertices
    }

    fn parents(edit: &AcceptedEdit<'_, M>, _: M::Vertex) -> ShortVec<M::Vertex> {
        edit.vertex_parents()
    }
}

impl<M: MeshQuery> ElementKind<M> for Edges {
    type Handle = M::Edge;

    fn map<T: Clone>(mesh: &M, value: T) -> Map<M, Self, T> {
        mesh.edge_map(value)
    }

    fn changes(record: &EditRecord<M>) -> &Changes<M::Edge> {
        &record.edges
    }

    fn parents(edit: &AcceptedEdit<'_, M>, e: M::Edge) -> ShortVec<M::Edge> {
        edit.edge_parent(e).into_iter().collect()
    }
}

impl<M: MeshQuery> ElementKind<M> for Faces {
    type Handle = M::Face;

    fn map<T: Clone>(mesh: &M, value: T) -> Map<M, Self, T> {
        mesh.face_map(value)
    }

    fn changes(record: &EditRecord<M>) -> &Changes<M::Face> {
        &record.faces
    }

    fn parents(edit: &AcceptedEdit<'_, M>, f: M::Face) -> ShortVec<M::Face> {
        edit.face_parent(f).into_iter().collect()
    }
}
