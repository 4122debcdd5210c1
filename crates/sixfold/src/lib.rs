//! Six mesh data structures behind one query trait, and the algorithms that run on all of them.
//!
//! Every structure has the same queries ([`MeshQuery`]), and an editable form with the same edits
//! ([`MeshEdit`]). Meshes are built from a [`PolygonMesh`]: positions, and faces as lists of vertex
//! numbers. Algorithms take any structure as a type parameter. A position is a [`Point`], the type `Vec3` of the crate
//! [`glam`]; `sixfold::glam` has its other types, such as `sixfold::glam::DVec3`.
//!
//! | task | start at |
//! |---|---|
//! | [load a mesh](#load-a-mesh), save it | [`io::load`], [`io::save`], [`io::read`], [`PolygonMesh::new`], [`shapes`] |
//! | [walk around a vertex](#walk-around-a-vertex) | [`MeshQuery::vertex_vertices`], [`MeshQuery::one_ring`] |
//! | [flip an edge](#flip-an-edge) | [`MeshEdit::flip_edge`] |
//! | [subdivide](#subdivide) | [`subdivision::subdivide_native`], [`subdivision::Scheme`] |
//! | [choose a structure](#choose-a-structure) | the table below, [`MeshQuery::CAPABILITIES`] |
//! | smooth, triangulate, compute normals | [`operators`] |
//! | simplify, remesh, make Delaunay | [`remeshing`] |
//! | find faults and repair them, so that a structure holds the mesh | [`repair::diagnose`], [`repair::repair_for`] |
//! | find nearest vertices, closest points, ray hits; compare two meshes | [`spatial`] |
//! | store values at vertices, edges, faces and sides | [`values`] |
//! | number elements from 0, for matrices | [`MeshQuery::vertex_numbers`] |
//! | find the boundary | [`MeshQuery::boundary_loops`] |
//! | [accept only structures with local queries](#require-local-queries) | [`LocalQueries`] |
//! | [walk from side to side](#walk-in-order) | [`OrientedWalk`] |
//! | read the topology of a mesh | [`Facts`] |
//! | find what a call of CGAL, OpenMesh, libigl, pmp, geometry-central or trimesh is called here | [`coming_from`] |
//! | remove many faces | [`MeshEdit::retain_faces`] |
//! | query flat tables of a few relations | [`RelationTables`] |
//!
//! # Load a mesh
//!
//! ```no_run
//! use sixfold::{HalfEdgeMesh, io};
//!
//! let mesh: HalfEdgeMesh = io::load("bunny.ply")?;
//! io::save("bunny.obj", &mesh)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The long form tells what was ignored and left out, takes options, and keeps the mesh if the structure
//! cannot hold it:
//!
//! ```no_run
//! use sixfold::{HalfEdgeMesh, io};
//!
//! let file = io::read("bunny.ply")?;
//! for notice in &file.notices {
//!     eprintln!("{notice}");
//! }
//! let (polygons, left_out) = file.into_polygons();
//! println!("{polygons}; {} faces left out", left_out.len());
//! let mesh = HalfEdgeMesh::try_from(&polygons)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A mesh can also be built from arrays. If a structure cannot hold a mesh, the error names the
//! faulty elements:
//!
//! ```
//! use sixfold::prelude::*;
//!
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
//! let polygons = PolygonMesh::new(corners, [[0, 1, 2], [0, 1, 3]])?;
//! let error = HalfEdgeMesh::from_polygons(&polygons).unwrap_err();
//! assert!(error.to_string().contains("f0 and f1"));
//! let mesh = IndexedFaceSet::from_polygons(&polygons)?; // holds every mesh
//! assert_eq!(PolygonMesh::from(&mesh), polygons);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Walk around a vertex
//!
//! ```
//! use sixfold::prelude::*;
//!
//! /// Returns the mean of the vertices adjacent to `v`, on any structure; `None` if `v` is isolated.
//! fn mean_of_neighbours<M: MeshQuery>(mesh: &M, v: M::Vertex) -> Option<Point> {
//!     let neighbours = mesh.vertex_vertices(v).map(|w| mesh.position(w));
//!     let (sum, count) = neighbours.fold((Point::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
//!     (count > 0.0).then(|| sum / count)
//! }
//!
//! let mesh = HalfEdgeMesh::from_polygons(&sixfold::shapes::octahedron())?;
//! let v = VertexId::new(0);
//! assert_eq!(mean_of_neighbours(&mesh, v), Some(Point::ZERO));
//! let ring = mesh.one_ring(v).expect("a manifold vertex"); // the same vertices, in order
//! assert_eq!(ring.count(), 4);
//! # Ok::<(), BuildError>(())
//! ```
//!
//! # Flip an edge
//!
//! Edits need an editable mesh. A refused edit does not change the mesh, and its error names the
//! reason:
//!
//! ```
//! use sixfold::prelude::*;
//!
//! let mut mesh = EditableHalfEdgeMesh::from_polygons(&sixfold::shapes::icosahedron())?;
//! let edge = mesh.edges().next().expect("a mesh with edges");
//! let before = mesh.edge_vertices(edge);
//! let edge = mesh.flip_edge(edge)?;
//! assert!(mesh.edge_between(before[0], before[1]).is_none());
//! assert_eq!(mesh.edge_faces(edge).count(), 2);
//! let mesh: HalfEdgeMesh = mesh.into_compact(); // faster queries, no edits
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Keep data through edits
//!
//! [`MeshWithData`] updates data of vertices, edges or faces after each edit. For programs that update
//! their data themselves, each edit has a second form that writes its changes to a log (for example
//! [`bisect_edge_logged`](MeshEdit::bisect_edge_logged)):
//!
//! ```
//! use sixfold::prelude::*;
//! use sixfold::shapes;
//!
//! let mesh = EditableHalfEdgeMesh::from_polygons(&shapes::icosahedron())?;
//! let materials = FaceData::new(&mesh, 7_u32).with_rule(|materials, new| {
//!     new.parents.first().map_or(0, |&f| materials[f]) // new faces: that of a face that was cut
//! });
//! let mut mesh = MeshWithData::new(mesh, materials);
//!
//! let edge = mesh.edges().next().expect("thirty of them");
//! let middle = mesh.bisect_edge(edge, Point::ZERO)?;
//! assert_eq!(mesh.face_count(), 22);
//! assert!(mesh.faces().all(|f| mesh.data()[f] == 7));
//!
//! let spoke = mesh.vertex_edges(middle).next().expect("four of them");
//! let [a, b] = mesh.edge_vertices(spoke);
//! let keep = if a == middle { b } else { a };
//! mesh.collapse_edge(spoke, keep, mesh.position(keep))?;
//! assert!(!mesh.contains_edge(spoke));
//!
//! let (mesh, _materials) = mesh.into_parts();
//! let mesh: HalfEdgeMesh = mesh.into_compact(); // its queries need no check for deleted rows
//! assert_eq!(mesh.face_count(), 20);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Subdivide
//!
//! ```
//! use sixfold::subdivision::{Scheme, Subdivision, subdivide_native};
//! use sixfold::{Creases, HalfEdgeMesh, shapes};
//!
//! let scheme = Subdivision::new(Scheme::CatmullClark);
//! let smooth = Creases::default();
//! let fine = subdivide_native::<HalfEdgeMesh>(&scheme, &shapes::cube(), &smooth, 3)?;
//! assert_eq!(fine.polygons.face_count(), 6 * 64);
//! # Ok::<(), sixfold::subdivision::SubdivisionError>(())
//! ```
//!
//! Each call of `refine_into` makes one level in the structure's own tables, and reuses the memory of
//! the arguments `numbers` and `fine`:
//!
//! ```
//! use sixfold::subdivision::{Scheme, Subdivision};
//! use sixfold::{Creases, HalfEdgeMesh, MeshQuery, Refine, Representation, shapes};
//!
//! let polygons = shapes::cube();
//! let rim = Creases::new(&polygons, [([0, 1], 2.5), ([1, 2], f32::INFINITY)], [])?;
//! let scheme = Subdivision::new(Scheme::CatmullClark);
//!
//! let cage = HalfEdgeMesh::from_polygons(&polygons)?;
//! let creases = scheme.control_creases(&cage, &polygons, &rim)?;
//! let (mut numbers, mut fine) = (Default::default(), HalfEdgeMesh::empty());
//! let left = scheme.refine_into(&cage, &creases, 0, &mut numbers, &mut fine)?;
//! assert_eq!(fine.face_count(), 24);
//! assert_eq!(left.edges().len(), 4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Choose a structure
//!
//! | structure | holds | bytes per vertex | choose it to |
//! |---|---|---|---|
//! | [`HalfEdgeMesh`] | oriented manifolds | 96 | walk around vertices and edges; edit polygons; subdivide |
//! | [`CornerTable`] | oriented manifolds of triangles | 64 | edit triangles, or walk over them, with little memory |
//! | [`FaceVertexMesh`] | any polygons | 68 | collect the faces at vertices: normals, matrix assembly |
//! | [`WingedEdgeMesh`] | oriented manifolds | 120 | work on edges themselves |
//! | [`IndexedFaceSet`] | any polygons | 36 | store, convert, visit all faces |
//! | [`PolygonSoup`] | any polygons, vertices by coordinates | 72 | transfer faces, as STL does |
//!
//! Polygon soups and indexed face sets scan all faces to find neighbours. The column *bytes per
//! vertex* applies to large closed triangle meshes. If you do not know which structure to choose,
//! use [`CornerTable`] for manifolds of triangles, [`HalfEdgeMesh`] for manifolds of polygons and
//! [`FaceVertexMesh`] for other meshes. The command `sixfold pick` measures a workload on your mesh.
//! [`structures!`] lists all structures, and [`visit`] selects one structure at run time.
//!
//! If a program queries a few relations many times and does not change the connectivity, make flat
//! tables of these relations from any structure. [`RelationTables`] have the same queries:
//!
//! ```
//! use sixfold::prelude::*;
//!
//! fn mean_valence<M: MeshQuery>(mesh: &M) -> f64 {
//!     let neighbours: usize = mesh.vertices().map(|v| mesh.vertex_vertices(v).count()).sum();
//!     neighbours as f64 / mesh.vertex_count() as f64
//! }
//!
//! let mesh = FaceVertexMesh::from_polygons(&sixfold::shapes::icosahedron())?;
//! let tables = RelationTables::new(&mesh, &[Relation::VertexVertices])?;
//! assert_eq!(mean_valence(&tables), mean_valence(&mesh));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Require local queries
//!
//! Polygon soups and indexed face sets scan all faces for most queries. The trait bound
//! [`LocalQueries`] excludes these two structures:
//!
//! ```
//! use sixfold::prelude::*;
//!
//! fn largest_valence<M: LocalQueries>(mesh: &M) -> usize {
//!     mesh.vertices().map(|v| mesh.valence(v)).max().unwrap_or(0)
//! }
//!
//! let mesh = HalfEdgeMesh::from_polygons(&sixfold::shapes::cube())?;
//! assert_eq!(largest_valence(&mesh), 3);
//! assert!(HalfEdgeMesh::is_local() && !PolygonSoup::is_local());
//! # Ok::<(), BuildError>(())
//! ```
//!
//! ```compile_fail,E0277
//! # use sixfold::prelude::*;
//! # fn largest_valence<M: LocalQueries>(mesh: &M) -> usize {
//! #     mesh.vertices().map(|v| mesh.valence(v)).max().unwrap_or(0)
//! # }
//! let mesh = PolygonSoup::from_polygons(&sixfold::shapes::cube())?;
//! largest_valence(&mesh); // queries of a polygon soup may scan all faces of the mesh
//! # Ok::<(), BuildError>(())
//! ```
//!
//! # Walk in order
//!
//! Most queries yield elements in no particular order. [`OrientedWalk`] steps from side to side; a
//! side is a pair of an edge and one of its faces. A walk can follow a face, turn around a vertex,
//! or run straight across quads as in the example below. All structures except polygon soups and
//! indexed face sets implement [`OrientedWalk`].
//!
//! ```
//! use sixfold::prelude::*;
//!
//! /// Returns the strip of quads that begins at the face of `start` and leaves each quad by the side
//! /// opposite the one by which it entered, up to the boundary or back to `start`.
//! fn quad_strip<M: OrientedWalk>(mesh: &M, start: M::Side) -> Vec<M::Face> {
//!     let mut faces = Vec::new();
//!     let mut at = Some(start);
//!     while let Some(side) = at {
//!         faces.push(mesh.side_face(side));
//!         let opposite = mesh.next_side(mesh.next_side(side));
//!         at = mesh.twin_side(opposite).filter(|&next| next != start);
//!     }
//!     faces
//! }
//!
//! let ring = HalfEdgeMesh::from_polygons(&sixfold::shapes::cube())?;
//! let strip = quad_strip(&ring, ring.sides().next().expect("a cube has sides"));
//! assert_eq!(strip.len(), 4);
//! # Ok::<(), BuildError>(())
//! ```
//!
//! # Features
//!
//! - `rayon` (default): subdivision steps in a structure's own tables use all threads. Spatial
//!   indices are built on all threads, and all threads share batches of spatial queries. Facts and
//!   diagnoses use several threads.
//! - `gltf` (default): [`io`] reads and writes glTF.
//! - `serde`: [`Facts`], [`Capabilities`], [`MemoryFootprint`], diagnoses, reports of repairs,
//!   subdivision schemes and mesh orders can be serialised.
//! - `mint`: [`PolygonMesh::new`] takes points and vectors of the crate `mint`, and a [`Point`]
//!   converts to such points and vectors.

// The exports are a list instead of `*`, because `sixfold_core` also has items that only authors
// of structures and measurements need.

// Traits for queries, walks, edits and refinement; capabilities and costs of a structure.
#[doc(inline)]
pub use sixfold_core::{
    Capabilities, Compact, Edit, Editable, LocalQueries, MeshEdit, MeshMove, MeshQuery,
    OrientedWalk, QueryCost, Refine, Relation, Representation, Split,
};
// Meshes as lists of faces; their topology, creases, sizes and memory.
/// The crate that defines [`Point`] and other vectors and matrices.
#[doc(no_inline)]
pub use sixfold_core::glam;
#[doc(inline)]
pub use sixfold_core::{
    BoundaryLoop, Counts, Creases, Distribution, EdgeUse, FaceList, FaceParts, FaceSpans, Facts,
    MemoryFootprint, Point, PolygonCutter, PolygonMesh, PolygonTriangles, SHARPNESS_INFINITE,
    TableBytes, Triangulated, area_vector,
};
// Handles of elements, data stored by handle, and types to update both after edits.
#[doc(inline)]
pub use sixfold_core::{
    AcceptedEdit, Changes, Created, EdgeData, EdgeId, EdgeMap, EditLog, EditRecord, ElementData,
    FaceData, FaceId, FaceMap, FollowEdits, Handle, HandleMap, HashHandleMap, MeshWithData,
    Numbers, OldToNew, Pair, RowMap, SideData, SideMap, VertexData, VertexId, VertexMap,
};
// Errors.
#[doc(inline)]
pub use sixfold_core::{
    BuildError, CreaseError, EditError, InvariantError, MoveError, PolygonError, RefineError,
    Refusal, UnknownName, did_you_mean,
};

// The six structures.
#[doc(inline)]
pub use sixfold_corner_table::{self as corner_table, CornerTable, EditableCornerTable};
#[doc(inline)]
pub use sixfold_face_vertex::{self as face_vertex, EditableFaceVertexMesh, FaceVertexMesh};
#[doc(inline)]
pub use sixfold_half_edge::{self as half_edge, EditableHalfEdgeMesh, HalfEdgeMesh};
#[doc(inline)]
pub use sixfold_indexed_face_set::{
    self as indexed_face_set, EditableIndexedFaceSet, IndexedFaceSet,
};
#[doc(inline)]
pub use sixfold_polygon_soup::{self as polygon_soup, EditablePolygonSoup, PolygonSoup};
#[doc(inline)]
pub use sixfold_winged_edge::{self as winged_edge, EditableWingedEdgeMesh, WingedEdgeMesh};

// Flat tables of relations, made from a structure.
#[doc(inline)]
pub use sixfold_relation_table::{
    self as relation_table, Numbering, RelationTable, RelationTables, TabulationError,
};

// Algorithms and files.
#[doc(inline)]
pub use sixfold_io as io;
#[doc(inline)]
pub use sixfold_operators as operators;
#[doc(inline)]
pub use sixfold_remeshing as remeshing;
#[doc(inline)]
pub use sixfold_repair as repair;
#[doc(inline)]
pub use sixfold_shapes as shapes;
#[doc(inline)]
pub use sixfold_spatial as spatial;
#[doc(inline)]
pub use sixfold_subdivision as subdivision;

#[cfg(feature = "algorithms")]
pub mod algorithms;
#[doc = include_str!("coming_from.md")]
pub mod coming_from {}
#[doc = include_str!("values.md")]
pub mod values {}
mod structure_list;
mod support;

pub use structure_list::{StructureInfo, Visitor, structure_infos, visit};
pub use support::{Support, support};

/// The usual imports of a program: the six structures, and the traits for queries, edits and
/// refinement.
///
/// ```
/// use sixfold::prelude::*;
///
/// let mesh = HalfEdgeMesh::from_polygons(&sixfold::shapes::cube())?;
/// assert_eq!(mesh.edge_count(), 12);
/// # Ok::<(), BuildError>(())
/// ```
pub mod prelude {
    pub use crate::{
        CornerTable, EditableCornerTable, EditableFaceVertexMesh, EditableHalfEdgeMesh,
        EditableIndexedFaceSet, EditablePolygonSoup, EditableWingedEdgeMesh, FaceVertexMesh,
        HalfEdgeMesh, IndexedFaceSet, PolygonSoup, Relation, RelationTables, WingedEdgeMesh,
    };
    pub use sixfold_core::prelude::*;
}
