//! Flat tables of relations, as a mesh that can be queried.

use std::hint::black_box;

use sixfold::{EdgeId, FaceId, MeshQuery, Point, PolygonMesh, Relation, Representation, VertexId};
use sixfold_core::RowId;
use sixfold_relation_table::{Numbering, RelationTable, TabulationError};

use crate::series::{Series, time_making};
use sixfold_results::Time;

/// The name of the tables in rankings.
pub(crate) const TABLES: &str = "relation-tables";
/// The path of their type.
pub(crate) const TABLE_TYPE: &str = "sixfold_relation_table::RelationTable";

/// Flat tables of the relations that a program queries.
pub(crate) struct Tables {
    pub(crate) positions: Vec<Point>,
    edges: usize,
    pub(crate) faces: usize,
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

impl Tables {
    /// Copies `relations` of `mesh` into tables; O(results of the relations).
    pub(crate) fn new<M: MeshQuery>(
        mesh: &M,
        relations: &[Relation],
    ) -> Result<Self, TabulationError> {
        let numbers = Numbering::new(mesh);
        let is_queried = |relation| relations.contains(&relation);
        macro_rules! table {
            ($name:ident, $relation:ident) => {
                match is_queried(Relation::$relation) {
                    true => Some(numbers.$name()?),
                    false => None,
                }
            };
        }
        Ok(Self {
            positions: numbers.positions(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
            vertex_vertices: table!(vertex_vertices, VertexVertices),
            vertex_edges: table!(vertex_edges, VertexEdges),
            vertex_faces: table!(vertex_faces, VertexFaces),
            edge_vertices: table!(edge_vertices, EdgeVertices),
            edge_edges: table!(edge_edges, EdgeEdges),
            edge_faces: table!(edge_faces, EdgeFaces),
            face_vertices: table!(face_vertices, FaceVertices),
            face_edges: table!(face_edges, FaceEdges),
            face_faces: table!(face_faces, FaceFaces),
        })
    }

    pub(crate) fn bytes(&self) -> usize {
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

/// Defines one query. If the relation has no table, the query returns an empty row.
macro_rules! row {
    ($name:ident, $from:ty, $to:ty) => {
        #[inline]
        fn $name(&self, element: $from) -> impl Iterator<Item = $to> {
            let row = self
                .$name
                .as_ref()
                .map_or(&[][..], |table| table.row(element));
            row.iter().copied()
        }
    };
}

fn numbered<H: RowId>(count: usize) -> impl Iterator<Item = H> {
    (0..count as u32).map(H::from_row)
}

impl MeshQuery for Tables {
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
    row!(vertex_vertices, VertexId, VertexId);
    row!(vertex_edges, VertexId, EdgeId);
    row!(vertex_faces, VertexId, FaceId);
    #[inline]
    fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let table = self.edge_vertices.as_ref();
        let row = table.and_then(|table| table.row(e).first_chunk());
        *row.expect("a queried relation has a table, and an edge has two ends")
    }
    row!(edge_edges, EdgeId, EdgeId);
    row!(edge_faces, EdgeId, FaceId);
    row!(face_vertices, FaceId, VertexId);
    row!(face_edges, FaceId, EdgeId);
    row!(face_faces, FaceId, FaceId);
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

/// Builds the structure and the tables, and returns the time. The tables are dropped outside the
/// timing.
pub(crate) fn time_building<M: Representation>(
    polygons: &PolygonMesh,
    relations: &[Relation],
    bytes: usize,
    series: &Series<'_>,
) -> Time {
    let build = || {
        let mesh = M::from_polygons(black_box(polygons)).ok();
        mesh.map(|mesh| Tables::new(&mesh, relations))
    };
    time_making(series, bytes, build).0
}
