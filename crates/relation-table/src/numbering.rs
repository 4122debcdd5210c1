//! The numbers of the elements of a mesh, and its nine relation tables.

use std::cell::OnceCell;

use sixfold_core::{EdgeId, FaceId, MeshQuery, Numbers, Point, Relation, VertexId};

use crate::table::{RelationTable, TabulationError};

/// The elements of a mesh, numbered in the order in which the structure lists them.
///
/// If handles are rows and no element was removed, the number of an element is its row. Vertices,
/// edges and faces are numbered separately. Each kind of element (vertex, edge or face) is numbered
/// when a number of this kind is first needed, and the numbers are stored.
pub struct Numbering<'m, M: MeshQuery> {
    mesh: &'m M,
    vertices: OnceCell<Numbers<M::Vertex>>,
    edges: OnceCell<Numbers<M::Edge>>,
    faces: OnceCell<Numbers<M::Face>>,
}

/// Defines the method for one table, such as `vertex_faces`.
macro_rules! tabulate {
    ($(#[$doc:meta])+ $name:ident, $relation:ident, $all:ident, $from:ty => $numbers:ident, $to:ty) => {
        $(#[$doc])+
        ///
        /// Takes O(rows + items) time, plus the time to query every element once.
        ///
        /// # Errors
        ///
        /// Returns [`TabulationError`] if the table would have more items than a 32-bit offset can
        /// address.
        pub fn $name(&self) -> Result<RelationTable<$from, $to>, TabulationError> {
            let mesh = self.mesh;
            let numbers = self.$numbers();
            RelationTable::collect(Relation::$relation, |rows| {
                for element in mesh.$all() {
                    let found = mesh.$name(element).into_iter();
                    rows.items.extend(found.map(|found| <$to>::new(numbers[found])));
                    rows.end_row()?;
                }
                Some(())
            })
        }
    };
}

impl<'m, M: MeshQuery> Numbering<'m, M> {
    /// Returns the numbering of `mesh`. Elements are numbered when their numbers are first needed.
    pub fn new(mesh: &'m M) -> Self {
        Self {
            mesh,
            vertices: OnceCell::new(),
            edges: OnceCell::new(),
            faces: OnceCell::new(),
        }
    }

    /// Returns the numbers of all vertices. The first call lists and numbers all vertices; later
    /// calls take O(1) time.
    #[inline]
    pub fn vertices(&self) -> &Numbers<M::Vertex> {
        self.vertices.get_or_init(|| self.mesh.vertex_numbers())
    }

    /// Returns the numbers of all edges. The first call lists and numbers all edges; later calls
    /// take O(1) time.
    #[inline]
    pub fn edges(&self) -> &Numbers<M::Edge> {
        self.edges.get_or_init(|| self.mesh.edge_numbers())
    }

    /// Returns the numbers of all faces. The first call lists and numbers all faces; later calls
    /// take O(1) time.
    #[inline]
    pub fn faces(&self) -> &Numbers<M::Face> {
        self.faces.get_or_init(|| self.mesh.face_numbers())
    }

    /// Returns the row of `v` in the tables; O(1), except that the first call numbers all vertices.
    #[inline]
    pub fn vertex(&self, v: M::Vertex) -> VertexId {
        VertexId::new(self.vertices()[v])
    }

    /// Returns the row of `e` in the tables; O(1), except that the first call numbers all edges.
    #[inline]
    pub fn edge(&self, e: M::Edge) -> EdgeId {
        EdgeId::new(self.edges()[e])
    }

    /// Returns the row of `f` in the tables; O(1), except that the first call numbers all faces.
    #[inline]
    pub fn face(&self, f: M::Face) -> FaceId {
        FaceId::new(self.faces()[f])
    }

    /// Returns the positions of all vertices, in the order of the vertex numbers.
    pub fn positions(&self) -> Vec<Point> {
        let vertices = self.mesh.vertices();
        vertices.map(|v| self.mesh.position(v)).collect()
    }

    tabulate! {
        /// Builds the VV table: for each vertex, the adjacent vertices.
        vertex_vertices, VertexVertices, vertices, VertexId => vertices, VertexId
    }
    tabulate! {
        /// Builds the VE table: for each vertex, the edges at the vertex.
        vertex_edges, VertexEdges, vertices, VertexId => edges, EdgeId
    }
    tabulate! {
        /// Builds the VF table: for each vertex, the faces at the vertex.
        vertex_faces, VertexFaces, vertices, VertexId => faces, FaceId
    }
    tabulate! {
        /// Builds the EV table: for each edge, the two ends.
        edge_vertices, EdgeVertices, edges, EdgeId => vertices, VertexId
    }
    tabulate! {
        /// Builds the EE table: for each edge, the edges that share an end with the edge.
        edge_edges, EdgeEdges, edges, EdgeId => edges, EdgeId
    }
    tabulate! {
        /// Builds the EF table: for each edge, the faces along the edge.
        edge_faces, EdgeFaces, edges, EdgeId => faces, FaceId
    }
    tabulate! {
        /// Builds the FV table: for each face, the vertices at the corners.
        face_vertices, FaceVertices, faces, FaceId => vertices, VertexId
    }
    tabulate! {
        /// Builds the FE table: for each face, the edges.
        face_edges, FaceEdges, faces, FaceId => edges, EdgeId
    }
    tabulate! {
        /// Builds the FF table: for each face, the adjacent faces.
        face_faces, FaceFaces, faces, FaceId => faces, FaceId
    }
}
