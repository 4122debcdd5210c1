//! Handles of elements in lists, and queries at them.

use std::ops::Range;

use sixfold::{MeshQuery, Relation};

use crate::operation::ElementKind;
use crate::sink::Sink;

/// Handles of elements in one structure: those that a sample, a mix or a trace visits, in order.
pub struct HandleLists<M: MeshQuery> {
    /// The vertices.
    pub vertices: Vec<M::Vertex>,
    /// The edges.
    pub edges: Vec<M::Edge>,
    /// The faces.
    pub faces: Vec<M::Face>,
}

impl<M: MeshQuery> Default for HandleLists<M> {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
        }
    }
}

impl<M: MeshQuery> HandleLists<M> {
    /// Lists all elements of `mesh`, in the order of the structure.
    pub fn of_mesh(mesh: &M) -> Self {
        Self {
            vertices: mesh.vertices().collect(),
            edges: mesh.edges().collect(),
            faces: mesh.faces().collect(),
        }
    }

    /// Converts the handles to handles of another mesh for the same elements.
    pub fn map_handles<N: MeshQuery>(
        self,
        vertex: impl FnMut(M::Vertex) -> N::Vertex,
        edge: impl FnMut(M::Edge) -> N::Edge,
        face: impl FnMut(M::Face) -> N::Face,
    ) -> HandleLists<N> {
        HandleLists {
            vertices: self.vertices.into_iter().map(vertex).collect(),
            edges: self.edges.into_iter().map(edge).collect(),
            faces: self.faces.into_iter().map(face).collect(),
        }
    }

    /// Returns the number of handles of a kind.
    pub fn len(&self, kind: ElementKind) -> usize {
        match kind {
            ElementKind::Vertex => self.vertices.len(),
            ElementKind::Edge => self.edges.len(),
            ElementKind::Face => self.faces.len(),
        }
    }

    /// **Timed**: passes the sink through the queries of `relation` at the elements `range` of their list.
    ///
    /// Each loop is a function of its own, as in `operation::relation::query`.
    #[inline]
    pub fn query(&self, mesh: &M, relation: Relation, range: Range<usize>, sink: Sink) -> Sink {
        macro_rules! query_list {
            ($query:ident $list:ident $from:ident $to:ident) => {{
                #[inline(never)]
                fn $query<M: MeshQuery>(mesh: &M, elements: &[M::$from], sink: Sink) -> Sink {
                    let elements = elements.iter();
                    elements.fold(sink, |sink, &element| sink.with(mesh.$query(element)))
                }
                $query(mesh, &self.$list[range], sink)
            }};
        }
        sixfold_core::match_relation!(relation, query_list!)
    }

    /// **Timed**: as [`query`](Self::query), but takes only the first `taken` results of each query.
    #[inline]
    pub fn query_first(
        &self,
        mesh: &M,
        relation: Relation,
        range: Range<usize>,
        taken: usize,
        sink: Sink,
    ) -> Sink {
        macro_rules! query_list {
            ($query:ident $list:ident $from:ident $to:ident) => {{
                #[inline(never)]
                fn $query<M: MeshQuery>(
                    mesh: &M,
                    elements: &[M::$from],
                    taken: usize,
                    sink: Sink,
                ) -> Sink {
                    let elements = elements.iter();
                    elements.fold(sink, |sink, &element| {
                        sink.with(mesh.$query(element).into_iter().take(taken))
                    })
                }
                $query(mesh, &self.$list[range], taken, sink)
            }};
        }
        sixfold_core::match_relation!(relation, query_list!)
    }
}
