//! The trait of all mesh data structures.

use std::fmt;

use crate::Point;
use crate::error::{BuildError, InvariantError, MoveError};
use crate::memory::MemoryFootprint;
use crate::polygon_mesh::PolygonMesh;
use crate::query::{MeshQuery, VertexMap};
use crate::row_id::{FaceId, VertexId};

/// One of the nine relations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize, serde::Serialize),
    serde(rename_all = "snake_case")
)]
#[expect(
    missing_docs,
    reason = "the names are those of the methods of MeshQuery"
)]
pub enum Relation {
    VertexVertices,
    VertexEdges,
    VertexFaces,
    EdgeVertices,
    EdgeEdges,
    EdgeFaces,
    FaceVertices,
    FaceEdges,
    FaceFaces,
}

impl Relation {
    /// All nine relations, in the order of the table in [`MeshQuery`].
    pub const ALL: [Self; 9] = [
        Self::VertexVertices,
        Self::VertexEdges,
        Self::VertexFaces,
        Self::EdgeVertices,
        Self::EdgeEdges,
        Self::EdgeFaces,
        Self::FaceVertices,
        Self::FaceEdges,
        Self::FaceFaces,
    ];

    /// Returns the name of the method: `vertex_vertices`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::VertexVertices => "vertex_vertices",
            Self::VertexEdges => "vertex_edges",
            Self::VertexFaces => "vertex_faces",
            Self::EdgeVertices => "edge_vertices",
            Self::EdgeEdges => "edge_edges",
            Self::EdgeFaces => "edge_faces",
            Self::FaceVertices => "face_vertices",
            Self::FaceEdges => "face_edges",
            Self::FaceFaces => "face_faces",
        }
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How much of a mesh one query reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize, serde::Serialize),
    serde(rename_all = "snake_case")
)]
pub enum QueryCost {
    /// O(1) for each element that it yields.
    Constant,
    /// The faces around the element; independent of the size of the mesh.
    Local,
    /// All faces.
    Scan,
}

impl QueryCost {
    /// Returns whether none of `costs` is a scan.
    pub const fn are_local(costs: &[Self; 9]) -> bool {
        let mut i = 0;
        while i < costs.len() {
            if matches!(costs[i], Self::Scan) {
                return false;
            }
            i += 1;
        }
        true
    }
}

/// A mesh data structure: its name, its construction, and its memory.
///
/// # Contract
///
/// - `from_polygons` succeeds exactly if [`CAPABILITIES`](MeshQuery::CAPABILITIES)`.check` does, and
///   returns the same error, except for a mesh with too many elements for its handles.
/// - `faces()` and `vertices()` keep the order of the input; if a vertex is its coordinates,
///   vertices come in the order in which faces first name them.
/// - `to_polygons(from_polygons(m))` is `m` up to the start of each face. If a vertex is its
///   coordinates, vertices with equal coordinates become one, in the order of `vertices()`.
pub trait Representation: MeshQuery + Clone + Sized + Send + Sync {
    /// The name for users: `half-edge`.
    const NAME: &'static str;

    /// How much of the mesh each relation reads, in the order of [`Relation::ALL`].
    const COSTS: [QueryCost; 9];

    /// Returns how much of the mesh `relation` reads.
    fn cost(relation: Relation) -> QueryCost {
        Self::COSTS[relation as usize]
    }

    /// Returns whether no relation scans all faces.
    ///
    /// The bound [`LocalQueries`](crate::LocalQueries) requires this at compile time.
    fn is_local() -> bool {
        QueryCost::are_local(&Self::COSTS)
    }

    /// Returns the path of the type for users: `sixfold_half_edge::HalfEdgeMesh`. The crate is the
    /// first part.
    fn type_path() -> &'static str {
        std::any::type_name::<Self>()
    }

    /// Builds the structure.
    ///
    /// # Errors
    ///
    /// Returns the fault that [`Capabilities::check`](crate::Capabilities::check) finds.
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError>;

    /// Returns the mesh as positions and polygons; O(corners) expected.
    fn to_polygons(&self) -> PolygonMesh;

    /// Returns the handle that vertex `v` of `polygons` has in `from_polygons(polygons)`; O(1).
    fn vertex_handle(polygons: &PolygonMesh, v: VertexId) -> Self::Vertex;

    /// Returns the handle that face `f` of `polygons` has in `from_polygons(polygons)`; O(1).
    fn face_handle(polygons: &PolygonMesh, f: FaceId) -> Self::Face;

    /// Moves every vertex to its position in `positions`; O(vertices), or O(corners) if corners do
    /// not share vertices.
    ///
    /// If a vertex is its coordinates, this changes its handle, and vertices that move to one
    /// position become one.
    ///
    /// # Errors
    ///
    /// [`MoveError`] if the map belongs to another mesh, or if a vertex is its coordinates and two
    /// corners of a face would be at one position. No vertex has moved then.
    fn set_positions(&mut self, positions: &VertexMap<Self, Point>) -> Result<(), MoveError>;

    /// Returns the bytes held on the heap, table by table.
    fn memory(&self) -> MemoryFootprint;

    /// Checks every invariant that the structure's documentation numbers; O(corners) expected.
    ///
    /// # Errors
    ///
    /// Returns the number of the first invariant that fails, and where.
    fn validate(&self) -> Result<(), InvariantError>;
}
