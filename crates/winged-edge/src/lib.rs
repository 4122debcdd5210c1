//! Winged-edge mesh: one record for every edge, with two ends, two faces and four wings.
//!
//! Choose it where edges are what is asked for, or where an edge must be one thing with one
//! record; not for input with three faces on an edge, which it refuses. It is the oldest structure
//! with constant-time neighbourhoods. Start at [`AnyWingedEdgeMesh`], whose numbered invariants explain
//! the rest. After Baumgart (1972, 1975).
//!
//! | holds | |
//! |---|---|
//! | polygons of any degree, boundaries, isolated vertices | yes |
//! | edges with three faces, vertices with two fans, faces that disagree about the side | no: refused by name |
//!
//! | query | cost | reads |
//! |---|---|---|
//! | VV, VE, VF | O(valence) | `spokes`, then one edge a neighbour |
//! | EV, EF | O(1) | one edge |
//! | EE | O(valence) of both ends | its edge, then one edge a neighbour |
//! | FV, FE, FF | O(degree) | `sides`, then one edge a side |
//! | refining (quads, triangles) | O(edges + vertices) | each edge and its four wings, in closed form |
//!
//! Vertices, edges and faces are rows, so that counting and listing them reads nothing.
//!
//! | edit | cost | which records change |
//! |---|---|---|
//! | `set_position`, `add_vertex` | O(1) | one vertex |
//! | `add_face` | O(degree), and the valence of corners that get an edge | its sides, and at each corner the boundary edges |
//! | `remove_face` | O(degree) | its sides, and at each corner the boundary edges |
//! | `remove_vertex` | O(corners of its faces) | its faces and edges, their outline, the boundary edges there |
//! | `split_edge` | O(1) | the edge, a new one, the two wings at its end |
//! | `bisect_edge` | O(1) | these, and all sides of its triangles |
//! | `poke_face` | O(degree) | its sides, and as many new edges |
//! | `split_face` | O(degree + valence) | the sides of the smaller part, a new edge, two wings |
//! | `dissolve_edge` | O(degrees) | the edge, its four wings, the sides of the smaller face |
//! | `flip_edge` | O(smaller valence) of the third corners | the edge and its four wings |
//! | `collapse_edge` | O(valences) of its ends; O(1) at an end of three triangles | the edges at the end that goes, the sides of its triangles |
//! | `split_vertex` | O(valence) | the edges that move, those to the sides, three new ones |
//! | `remove_isolated_vertices`, `compact` | O(rows) | all |
//!
//! Both wings of both sides are stored, so an edge is linked and unlinked without a search. What costs
//! a walk is to ask whether an edit is legal, and to give the edges at a vertex another end.
//!
//! # The side test
//!
//! An edge lies in the walks around both of its ends and both of its faces, so every step has to
//! ask which side of the edge it is on: does the edge start at this vertex, is this face on its
//! left? A walk keeps its vertex or face at hand, so that one comparison with the record it has
//! just read tells. Which way the answer falls is for the numbering to say; taken as a branch it is
//! guessed wrong every second time on a mesh in random order. Here it selects between two values
//! that are loaded already, without a branch.
//!
//! What it costs, as ratios to the half-edge mesh of this workspace, which need not ask, on 82,000
//! triangles in order and shuffled: counting incident faces and corners 1.6 and 1.5, smoothing over
//! VV 1.5 and 1.3, vertex normals 1.4 and 1.2, all nine relations 1.3 and 1.2, breadth-first search
//! over FF 1.1 and 1.0. It shows least where memory or a queue is what a walk waits for, since a step
//! reads one record in one cache line.
//!
//! # What the sweeps are bound by
//!
//! In cache VV, VE, VF, FV, FE and FF are bound by latency: a step cannot begin before the step
//! before it has loaded its record, compared and selected, about 8 cycles against the 6 of a
//! half-edge, and a walk of six leaves room for two or three vertices at once. Beyond the cache each
//! step waits for one line, in an order that the numbering of the edges decides. EV and EF read the
//! records in order, 32 bytes each, of which they use 8: bound by bandwidth. Building is bound by the
//! counting sort that pairs the sides, half of its time, and by one record written a side.
//!
//! # Examples
//!
//! ```
//! use mesh_core::{MeshQuery, Point, PolygonMesh, Representation, VertexId};
//! use winged_edge::WingedEdgeMesh;
//!
//! let square = [Point::ZERO, Point::X, Point::new(1.0, 1.0, 0.0), Point::Y];
//! let polygons = PolygonMesh::new(square, [[0, 1, 2], [0, 2, 3]])?;
//! let mesh = WingedEdgeMesh::from_polygons(&polygons)?;
//!
//! let v = VertexId::new(0);
//! assert_eq!(mesh.vertex_vertices(v).count(), 3);
//! let diagonal = mesh.edges().find(|&e| mesh.edge_faces(e).count() == 2).expect("one");
//! assert_eq!(mesh.other_end(mesh.left_next(diagonal), mesh.end(diagonal)), VertexId::new(3));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod circulate;
mod construct;
mod edge;
mod edit;
mod mesh;
mod query;
mod refine;
mod validate;
mod wings;

pub use edge::Edge;
pub use mesh::{AnyWingedEdgeMesh, EditableWingedEdgeMesh, WingedEdgeMesh};
