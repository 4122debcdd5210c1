//! Numbers for the elements of any mesh, and the nine tables by them.

use std::cell::OnceCell;

use mesh_core::{
    EdgeId, EdgeMap, FaceId, FaceMap, MeshQuery, Point, Relation, VertexId, VertexMap, row,
};

use crate::table::{RelationTable, TabulationError};

/// The elements of a mesh, numbered in the order in which the structure names them.
///
/// Where handles are rows and nothing was removed, the number is the row. Each kind of element is
/// numbered when it is first asked for.
pub struct Numbering<'m, M: MeshQuery> {
    mesh: &'m M,
    vertices: OnceCell<VertexMap<M, VertexId>>,
    edges: OnceCell<EdgeMap<M, EdgeId>>,
    faces: OnceCell<FaceMap<M, FaceId>>,
}

/// A table by name: `fn vertex_faces() -> RelationTable<VertexId, FaceId>`.
macro_rules! tabulate {
    ($(#[$doc:meta])+ $name:ident, $relation:ident, $all:ident, $from:ty => $number:ident, $to:ty) => {
        $(#[$doc])+
        ///
        /// O(rows + items) beyond the cost of asking every element once.
        ///
        /// # Errors
        ///
        /// [`TabulationError`]: more items than offsets of 32 bits can tell apart.
        pub fn $name(&self) -> Result<RelationTable<$from, $to>, TabulationError> {
            let mesh = self.mesh;
            RelationTable::collect(Relation::$relation, mesh.$all(), |element, items| {
                items.extend(mesh.$name(element).into_iter().map(|found| self.$number(found)));
            })
        }
    };
}

impl<'m, M: MeshQuery> Numbering<'m, M> {
    /// Numbers the elements of `mesh`.
    pub fn of(mesh: &'m M) -> Self {
        Self {
            mesh,
            vertices: OnceCell::new(),
            edges: OnceCell::new(),
            faces: OnceCell::new(),
        }
    }

    /// The number of `v`; O(1) but for the first one, which numbers all: O(vertices).
    #[inline]
    pub fn vertex(&self, v: M::Vertex) -> VertexId {
        self.vertices.get_or_init(|| {
            let mut numbers = self.mesh.vertex_map(VertexId::new(0));
            let numbered = self.mesh.vertices().enumerate();
            numbered.for_each(|(number, v)| numbers[v] = VertexId::new(row(number)));
            numbers
        })[v]
    }

    /// The number of `e`; O(1) but for the first one, which numbers all: O(edges).
    #[inline]
    pub fn edge(&self, e: M::Edge) -> EdgeId {
        self.edges.get_or_init(|| {
            let mut numbers = self.mesh.edge_map(EdgeId::new(0));
            let numbered = self.mesh.edges().enumerate();
            numbered.for_each(|(number, e)| numbers[e] = EdgeId::new(row(number)));
            numbers
        })[e]
    }

    /// The number of `f`; O(1) but for the first one, which numbers all: O(faces).
    #[inline]
    pub fn face(&self, f: M::Face) -> FaceId {
        self.faces.get_or_init(|| {
            let mut numbers = self.mesh.face_map(FaceId::new(0));
            let numbered = self.mesh.faces().enumerate();
            numbered.for_each(|(number, f)| numbers[f] = FaceId::new(row(number)));
            numbers
        })[f]
    }

    /// The positions, by number.
    pub fn positions(&self) -> Vec<Point> {
        let vertices = self.mesh.vertices();
        vertices.map(|v| self.mesh.position(v)).collect()
    }

    tabulate! {
        /// VV: the neighbours of every vertex.
        vertex_vertices, VertexVertices, vertices, VertexId => vertex, VertexId
    }
    tabulate! {
        /// VE: the edges at every vertex.
        vertex_edges, VertexEdges, vertices, VertexId => edge, EdgeId
    }
    tabulate! {
        /// VF: the faces at every vertex.
        vertex_faces, VertexFaces, vertices, VertexId => face, FaceId
    }
    tabulate! {
        /// EV: the two ends of every edge.
        edge_vertices, EdgeVertices, edges, EdgeId => vertex, VertexId
    }
    tabulate! {
        /// EE: the edges that share an end with every edge.
        edge_edges, EdgeEdges, edges, EdgeId => edge, EdgeId
    }
    tabulate! {
        /// EF: the faces along every edge.
        edge_faces, EdgeFaces, edges, EdgeId => face, FaceId
    }
    tabulate! {
        /// FV: the corners of every face.
        face_vertices, FaceVertices, faces, FaceId => vertex, VertexId
    }
    tabulate! {
        /// FE: the sides of every face.
        face_edges, FaceEdges, faces, FaceId => edge, EdgeId
    }
    tabulate! {
        /// FF: the faces beside every face.
        face_faces, FaceFaces, faces, FaceId => face, FaceId
    }
}
