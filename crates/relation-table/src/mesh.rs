//! The tables of several relations, as a mesh that can be queried.

use sixfold_core::{
    EdgeId, EditLog, FaceId, MeshMove, MeshQuery, MoveError, Point, Relation, RowId, VertexId,
    VertexMap,
};

use crate::numbering::Numbering;
use crate::table::{RelationTable, TabulationError};

/// A read-only mesh that consists of positions and of the tables of some relations.
///
/// A program that is generic over [`MeshQuery`] runs on the tables without a change, if it queries only
/// relations that were given to [`new`](Self::new). Vertices may move ([`MeshMove`]); faces and edges cannot
/// change. The handle of an element is its number in the mesh from which the tables were made, see [`Numbering`].
///
/// # Panics
///
/// A query of a relation without a table panics, and the message names the relation. The provided methods of
/// [`MeshQuery`] query relations, too: for example, [`one_ring`](MeshQuery::one_ring) needs
/// [`VertexFaces`](Relation::VertexFaces) and [`FaceVertices`](Relation::FaceVertices).
///
/// # Examples
///
/// ```
/// use sixfold_core::{MeshQuery, Point, Relation, Representation};
/// use sixfold_half_edge::HalfEdgeMesh;
/// use sixfold_relation_table::RelationTables;
///
/// /// Returns the mean of the neighbours of each vertex.
/// fn means<M: MeshQuery>(mesh: &M) -> Vec<Point> {
///     let mean = |v| {
///         let ring = mesh.vertex_vertices(v).map(|w| mesh.position(w));
///         let (sum, count) = ring.fold((Point::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
///         sum / count
///     };
///     mesh.vertices().map(mean).collect()
/// }
///
/// let mesh = HalfEdgeMesh::from_polygons(&sixfold_shapes::icosahedron())?;
/// let tables = RelationTables::new(&mesh, &[Relation::VertexVertices])?;
/// assert_eq!(means(&tables).len(), means(&mesh).len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RelationTables {
    positions: Vec<Point>,
    edges: usize,
    faces: usize,
    vertex_vertices: Option<RelationTable<VertexId, VertexId>>,
    vertex_edges: Option<RelationTable<VertexId, EdgeId>>,
    vertex_faces: Option<RelationTable<VertexId, FaceId>>,
    edge_vertices: Option<RelationTable<EdgeId, VertexId>>,
    edge_edges: Option<RelationTable<EdgeId, EdgeId>>,
    edge_faces: Option<RelationTable<EdgeId, FaceId>>,
    face_vertices: Option<RelationTable<FaceId, VertexId>>,
    face_edges: Option<RelationTable<FaceId, EdgeId>>,
    face_faces: Option<RelationTable<FaceId, FaceId>>,
}

impl RelationTables {
    /// Copies the positions and `relations` of `mesh`. Takes O(results of the relations) time, plus the time to
    /// query every element once for each relation.
    ///
    /// # Errors
    ///
    /// Returns [`TabulationError`] if a table would have more items than a 32-bit offset can address.
    pub fn new<M: MeshQuery>(mesh: &M, relations: &[Relation]) -> Result<Self, TabulationError> {
        let numbers = Numbering::new(mesh);
        let mut tables = Self {
            positions: numbers.positions(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
            vertex_vertices: None,
            vertex_edges: None,
            vertex_faces: None,
            edge_vertices: None,
            edge_edges: None,
            edge_faces: None,
            face_vertices: None,
            face_edges: None,
            face_faces: None,
        };
        for relation in relations {
            match relation {
                Relation::VertexVertices => {
                    tables.vertex_vertices = Some(numbers.vertex_vertices()?)
                }
                Relation::VertexEdges => tables.vertex_edges = Some(numbers.vertex_edges()?),
                Relation::VertexFaces => tables.vertex_faces = Some(numbers.vertex_faces()?),
                Relation::EdgeVertices => tables.edge_vertices = Some(numbers.edge_vertices()?),
                Relation::EdgeEdges => tables.edge_edges = Some(numbers.edge_edges()?),
                Relation::EdgeFaces => tables.edge_faces = Some(numbers.edge_faces()?),
                Relation::FaceVertices => tables.face_vertices = Some(numbers.face_vertices()?),
                Relation::FaceEdges => tables.face_edges = Some(numbers.face_edges()?),
                Relation::FaceFaces => tables.face_faces = Some(numbers.face_faces()?),
            }
        }
        Ok(tables)
    }

    /// Returns the positions of all vertices, in order.
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Moves `v` to `to`; O(1).
    ///
    /// # Panics
    ///
    /// Panics if the mesh has no vertex `v`.
    #[inline]
    pub fn set_position(&mut self, v: VertexId, to: Point) {
        self.positions[v.index()] = to;
    }

    /// Returns the number of bytes of the positions and tables.
    pub fn bytes(&self) -> usize {
        fn bytes<A: RowId, B: RowId>(table: &Option<RelationTable<A, B>>) -> usize {
            table.as_ref().map_or(0, RelationTable::bytes)
        }
        size_of_val(&self.positions[..])
            + bytes(&self.vertex_vertices)
            + bytes(&self.vertex_edges)
            + bytes(&self.vertex_faces)
            + bytes(&self.edge_vertices)
            + bytes(&self.edge_edges)
            + bytes(&self.edge_faces)
            + bytes(&self.face_vertices)
            + bytes(&self.face_edges)
            + bytes(&self.face_faces)
    }
}

/// Ends a query of a relation that has no table.
#[cold]
#[inline(never)]
#[track_caller]
fn no_table(relation: Relation) -> ! {
    panic!(
        "there is no table of {relation}: add `Relation::{relation:?}` to the relations of \
         `RelationTables::new`"
    )
}

/// Defines the query of one relation.
macro_rules! query {
    ($name:ident, $relation:ident, $from:ty => $to:ty) => {
        #[inline]
        fn $name(&self, element: $from) -> impl Iterator<Item = $to> {
            let Some(table) = &self.$name else {
                no_table(Relation::$relation)
            };
            table.row(element).iter().copied()
        }
    };
}

fn numbered<H: RowId>(count: usize) -> impl Iterator<Item = H> {
    (0..count).map(|row| H::from_row(sixfold_core::row(row)))
}

impl MeshQuery for RelationTables {
    type Vertex = VertexId;
    type Edge = EdgeId;
    type Face = FaceId;

    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        numbered(self.positions.len())
    }
    fn edges(&self) -> impl Iterator<Item = EdgeId> {
        numbered(self.edges)
    }
    fn faces(&self) -> impl Iterator<Item = FaceId> {
        numbered(self.faces)
    }
    fn vertex_count(&self) -> usize {
        self.positions.len()
    }
    fn edge_count(&self) -> usize {
        self.edges
    }
    fn face_count(&self) -> usize {
        self.faces
    }
    #[inline]
    fn position(&self, v: VertexId) -> Point {
        self.positions[v.index()]
    }

    query!(vertex_vertices, VertexVertices, VertexId => VertexId);
    query!(vertex_edges, VertexEdges, VertexId => EdgeId);
    query!(vertex_faces, VertexFaces, VertexId => FaceId);
    #[inline]
    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let Some(table) = &self.edge_vertices else {
            no_table(Relation::EdgeVertices)
        };
        *table.row(e).first_chunk().expect("an edge has two ends")
    }
    query!(edge_edges, EdgeEdges, EdgeId => EdgeId);
    query!(edge_faces, EdgeFaces, EdgeId => FaceId);
    query!(face_vertices, FaceVertices, FaceId => VertexId);
    query!(face_edges, FaceEdges, FaceId => EdgeId);
    query!(face_faces, FaceFaces, FaceId => FaceId);

    fn contains_vertex(&self, v: VertexId) -> bool {
        v.index() < self.positions.len()
    }
    fn contains_edge(&self, e: EdgeId) -> bool {
        e.index() < self.edges
    }
    fn contains_face(&self, f: FaceId) -> bool {
        f.index() < self.faces
    }
    fn vertex_rows(&self) -> usize {
        self.positions.len()
    }
    fn edge_rows(&self) -> usize {
        self.edges
    }
    fn face_rows(&self) -> usize {
        self.faces
    }
}

impl MeshMove for RelationTables {
    fn set_positions_logged(
        &mut self,
        positions: &VertexMap<Self, Point>,
        _log: &mut impl EditLog<Self>,
    ) -> Result<(), MoveError> {
        let (given, vertices) = (positions.values().len(), self.positions.len());
        if given != vertices {
            return Err(MoveError::OtherMesh { given, vertices });
        }
        self.positions.copy_from_slice(positions.values());
        Ok(())
    }
}
