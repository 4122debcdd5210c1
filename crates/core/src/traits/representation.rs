//! The trait of all mesh data structures.

use crate::handles::row_id::{FaceId, VertexId};
use crate::polygons::error::{BuildError, InvariantError};
use crate::polygons::polygon_mesh::PolygonMesh;
use crate::tables::memory::MemoryFootprint;
use crate::traits::mesh_move::MeshMove;

crate::named! {
    /// One of the nine relations of [`MeshQuery`](crate::MeshQuery).
    #[expect(
        missing_docs,
        reason = "the names are those of the methods of MeshQuery"
    )]
    pub enum Relation: "relation" {
        VertexVertices = "vertex_vertices",
        VertexEdges = "vertex_edges",
        VertexFaces = "vertex_faces",
        EdgeVertices = "edge_vertices",
        EdgeEdges = "edge_edges",
        EdgeFaces = "edge_faces",
        FaceVertices = "face_vertices",
        FaceEdges = "face_edges",
        FaceFaces = "face_faces",
    }
}

/// Matches a [`Relation`], and calls a macro in each arm: `match_relation!(relation, arm!)`.
///
/// The macro gets the name of the query, the method that lists the queried elements, and the kinds of
/// the queried elements and of the results: `arm!(vertex_edges vertices Vertex Edge)`. So the nine
/// relations are in one place, and an arm can define a function of its own for each of them.
#[doc(hidden)]
#[macro_export]
macro_rules! match_relation {
    ($relation:expr, $arm:ident!) => {
        match $relation {
            $crate::Relation::VertexVertices => $arm!(vertex_vertices vertices Vertex Vertex),
            $crate::Relation::VertexEdges => $arm!(vertex_edges vertices Vertex Edge),
            $crate::Relation::VertexFaces => $arm!(vertex_faces vertices Vertex Face),
            $crate::Relation::EdgeVertices => $arm!(edge_vertices edges Edge Vertex),
            $crate::Relation::EdgeEdges => $arm!(edge_edges edges Edge Edge),
            $crate::Relation::EdgeFaces => $arm!(edge_faces edges Edge Face),
            $crate::Relation::FaceVertices => $arm!(face_vertices faces Face Vertex),
            $crate::Relation::FaceEdges => $arm!(face_edges faces Face Edge),
            $crate::Relation::FaceFaces => $arm!(face_faces faces Face Face),
        }
    };
}

crate::named! {
    /// How much of a mesh one query reads.
    pub enum QueryCost: "cost" {
        /// The query reads O(1) rows for each element that it yields.
        Constant = "constant",
        /// The query reads the faces around the element. The cost does not depend on the size of
        /// the mesh.
        Local = "local",
        /// The query reads all faces.
        Scan = "scan",
    }
}

impl QueryCost {
    /// Returns true if none of `costs` is [`Scan`](Self::Scan).
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
/// - `from_polygons` and [`CAPABILITIES`](crate::MeshQuery::CAPABILITIES)`.check` agree: both succeed, or
///   both return the same error. The results may differ only if the mesh has too many elements for
///   the handles of the structure.
/// - `faces()` and `vertices()` keep the order of the input. If vertices are identified by
///   coordinates, `vertices()` has the order in which the faces first name the vertices.
/// - `to_polygons(from_polygons(m))` equals `m`, except that a face may start at another corner. If
///   vertices are identified by coordinates, vertices with equal coordinates become one vertex, and
///   the vertices of the result are in the order of `vertices()`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a structure that can be built from polygons",
    label = "this type does not implement `Representation`",
    note = "the six structures implement it, each in two forms, such as `HalfEdgeMesh` and \
            `EditableHalfEdgeMesh`; a function that builds a mesh asks for `M: Representation`"
)]
pub trait Representation: MeshMove + Clone + Sized + Send + Sync {
    /// The name of the structure for users, for example `half-edge`.
    const NAME: &'static str;

    /// How much of the mesh each relation reads, in the order of [`Relation::ALL`].
    const COSTS: [QueryCost; 9];

    /// Returns how much of the mesh `relation` reads.
    fn cost(relation: Relation) -> QueryCost {
        Self::COSTS[relation as usize]
    }

    /// Returns true if no relation scans all faces.
    ///
    /// The trait bound [`LocalQueries`](crate::LocalQueries) requires at compile time that no
    /// relation scans.
    fn is_local() -> bool {
        QueryCost::are_local(&Self::COSTS)
    }

    /// Returns the path of the type, for example `sixfold_half_edge::HalfEdgeMesh`. The first part
    /// of the path is the name of the crate.
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

    /// Returns the number of bytes that each table allocates on the heap.
    fn memory(&self) -> MemoryFootprint;

    /// Checks all numbered invariants of the structure; O(corners) expected.
    ///
    /// # Errors
    ///
    /// Returns the number of the first invariant that fails, and the element at which it fails.
    fn validate(&self) -> Result<(), InvariantError>;
}
