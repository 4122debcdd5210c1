//! What makes a data structure one of ours.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Point;
use crate::capability::Capabilities;
use crate::error::{BuildError, InvariantError, MoveError};
use crate::memory::MemoryFootprint;
use crate::polygon_mesh::PolygonMesh;
use crate::probe::Probe;
use crate::query::{MeshQuery, VertexMap};
use crate::row_id::{FaceId, VertexId};

/// One of the nine relations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
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
    /// All nine, in the order of the table in [`MeshQuery`].
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

    /// The name of the method: `vertex_vertices`.
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

/// How much of a mesh one query looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum QueryCost {
    /// O(1) for each element it yields.
    Constant,
    /// The faces around the element; independent of the size of the mesh.
    Local,
    /// All faces.
    Scan,
}

/// The sizes of a mesh that decide what a structure weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Vertices, isolated ones included.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Faces.
    pub faces: usize,
    /// Corners of all faces.
    pub corners: usize,
    /// Whether all faces have one degree.
    pub uniform: bool,
}

impl Counts {
    /// Bytes of a table of face offsets, which mixed degrees need.
    pub const fn offset_bytes(&self) -> usize {
        if self.uniform {
            0
        } else {
            4 * (self.faces + 1)
        }
    }
}

/// A mesh data structure: what it is called and can hold, how it is built, what it weighs.
///
/// # Contract
///
/// - `from_polygons` succeeds exactly when `CAPABILITIES.check` does, with the same error, but for a
///   mesh with too many elements for its handles.
/// - `faces()` and `vertices()` keep the order of the input; where a vertex is its coordinates,
///   vertices come in the order in which faces first name them.
/// - `to_polygons(from_polygons(m))` is `m` up to the start of each face. Where a vertex is its
///   coordinates, vertices that share them are one, in the order of `vertices()`.
pub trait Representation: MeshQuery + Clone + Sized + Send + Sync {
    /// What users call it: `half-edge`.
    const NAME: &'static str;

    /// What it can hold.
    const CAPABILITIES: Capabilities;

    /// How much of the mesh each relation looks at, in the order of [`Relation::ALL`].
    const COSTS: [QueryCost; 9];

    /// The same structure with its tables watched.
    type Probed<P: Probe>: MeshQuery<Vertex = Self::Vertex, Edge = Self::Edge, Face = Self::Face>;

    /// Builds the structure.
    ///
    /// # Errors
    ///
    /// What [`Capabilities::check`] finds.
    fn from_polygons(polygons: &PolygonMesh) -> Result<Self, BuildError>;

    /// The mesh as positions and polygons; O(corners) expected.
    fn to_polygons(&self) -> PolygonMesh;

    /// The name that `from_polygons(polygons)` gives to vertex `v` of `polygons`; O(1).
    fn vertex_name(polygons: &PolygonMesh, v: VertexId) -> Self::Vertex;

    /// The name that `from_polygons(polygons)` gives to face `f` of `polygons`; O(1).
    fn face_name(polygons: &PolygonMesh, f: FaceId) -> Self::Face;

    /// Moves every vertex to its place in `positions`; O(vertices), or O(corners) where nothing is shared.
    ///
    /// Where a vertex is its coordinates this renames it, and vertices moved to one place become one.
    ///
    /// # Errors
    ///
    /// [`MoveError`]: a map of another mesh; or two corners of a face would come to one place where
    /// a vertex is its coordinates. Nothing has moved then.
    fn set_positions(&mut self, positions: &VertexMap<Self, Point>) -> Result<(), MoveError>;

    /// The bytes really held, table by table.
    fn memory(&self) -> MemoryFootprint;

    /// The bytes that the layout takes in theory for a mesh of these sizes.
    fn layout_bytes(counts: &Counts) -> usize;

    /// Checks every invariant that the structure's documentation numbers; O(corners) expected.
    ///
    /// # Errors
    ///
    /// The first invariant that fails, by number, and where.
    fn validate(&self) -> Result<(), InvariantError>;

    /// The same mesh with `probe` watching every table.
    fn probed<P: Probe>(self, probe: P) -> Self::Probed<P>;
}
