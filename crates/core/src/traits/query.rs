//! The trait of mesh queries: the nine relations, counts, maps and boundary loops.

use crate::Point;
use crate::handles::handle::{Handle, HandleMap};
use crate::handles::numbering::Numbers;
use crate::polygons::capability::Capabilities;
use crate::traits::boundary::{self, BoundaryLoop};

/// A map that holds a value for each vertex of the mesh type `M`.
pub type VertexMap<M, T> = <<M as MeshQuery>::Vertex as Handle>::Map<T>;
/// A map that holds a value for each edge of the mesh type `M`.
pub type EdgeMap<M, T> = <<M as MeshQuery>::Edge as Handle>::Map<T>;
/// A map that holds a value for each face of the mesh type `M`.
pub type FaceMap<M, T> = <<M as MeshQuery>::Face as Handle>::Map<T>;

/// The nine relations between vertices, edges and faces (Weiler 1985). Each relation is abbreviated
/// by two letters: VF stands for `vertex_faces`, FV for `face_vertices`.
///
/// ```text
///            vertices V        edges E          faces F
/// of a V   vertex_vertices   vertex_edges     vertex_faces
/// of an E  edge_vertices     edge_edges       edge_faces
/// of an F  face_vertices     face_edges       face_faces
/// ```
///
/// # Contract
///
/// - **Elements.** An edge is an unordered pair of vertices that follow each other in some face; no
///   two edges have the same ends. A face has at least three corners, at different vertices.
/// - **Once.** A relation yields each element once, and never the element that is queried. For
///   example, if faces `f` and `g` share several edges, `face_faces(f)` yields `g` once. The
///   relations of an isolated vertex are empty.
/// - **Symmetry.** VF and FV are inverse: `vertex_faces(v)` contains `f` exactly if
///   `face_vertices(f)` contains `v`. VE and EV are inverse, too, and so are EF and FE. VV, EE and
///   FF are symmetric: if element `a` is in the result for element `b`, then `b` is in the result
///   for `a`.
/// - **Order.** `face_vertices` and `face_edges` run counter-clockwise around the face, in the
///   order of the input, from an arbitrary start. Edge `i` of a face joins corners `i` and `i + 1`.
///   All relations except `face_vertices` and `face_edges` are sets: the order of their elements is
///   not guaranteed.
/// - **Iteration.** The iterator of a relation yields the same items by `next` and by `fold`, even
///   if `next` takes the first items and `fold` takes the remaining items.
/// - **No cache.** Each result is computed from the stored tables alone; nothing is stored between
///   calls. If the tables have no links for a query, the query scans all faces.
/// - **Handles.** A handle is valid until an edit removes or renames its element
///   ([`MeshEdit`](crate::MeshEdit)). A query panics if its handle is out of range or belongs to a
///   deleted element; the message names the handle. The use of a handle of another mesh may panic
///   or give a wrong result, but is always memory-safe.
///
/// # Panics
///
/// A query panics if the mesh has no element with the given handle. If the handle is the
/// coordinates of a vertex or the pair of ends of an edge, a query of a missing element does not
/// panic, and the relations of the element are empty. The methods `contains_vertex`,
/// `contains_edge` and `contains_face` return false for a missing element.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a mesh that can be queried",
    label = "this type does not implement `MeshQuery`",
    note = "build one of the six structures, for example by `HalfEdgeMesh::from_polygons(&polygons)`"
)]
pub trait MeshQuery {
    /// The handle of a vertex: a row number, or the coordinates of the vertex.
    type Vertex: Handle;
    /// The handle of an edge: a row number, a corner opposite the edge, or the pair of the ends of
    /// the edge.
    type Edge: Handle;
    /// The handle of a face.
    type Face: Handle;

    /// The meshes that this type can hold; the default is all meshes. An algorithm can omit checks
    /// for cases that the mesh type excludes, such as non-manifold edges.
    const CAPABILITIES: Capabilities = Capabilities::ALL;

    /// Yields every vertex once.
    fn vertices(&self) -> impl Iterator<Item = Self::Vertex>;
    /// Yields every edge once.
    fn edges(&self) -> impl Iterator<Item = Self::Edge>;
    /// Yields every face once, in the order of the input.
    fn faces(&self) -> impl Iterator<Item = Self::Face>;

    /// Returns the number of vertices; O(1) if vertex handles are row numbers. By default, counts
    /// [`vertices`](Self::vertices): if handles are coordinates, O(corners) expected.
    fn vertex_count(&self) -> usize {
        self.vertices().count()
    }
    /// Returns the number of edges; O(1) if the structure has a row for each edge. By default, counts
    /// [`edges`](Self::edges): O(corners) expected on the structures that store no edges.
    fn edge_count(&self) -> usize {
        self.edges().count()
    }
    /// Returns the number of faces; O(1).
    fn face_count(&self) -> usize;

    /// Returns the position of `v`; O(1).
    fn position(&self, v: Self::Vertex) -> Point;

    /// VV: yields the vertices that are joined to `v` by an edge (the one-ring of `v`).
    fn vertex_vertices(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Vertex>;
    /// VE: yields the edges that have `v` as an end.
    fn vertex_edges(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Edge>;
    /// VF: yields the faces that have a corner at `v`.
    fn vertex_faces(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Face>;
    /// EV: returns the two ends of `e`.
    fn edge_vertices(&self, e: Self::Edge) -> [Self::Vertex; 2];
    /// EE: yields the edges that share an end with `e`.
    fn edge_edges(&self, e: Self::Edge) -> impl Iterator<Item = Self::Edge>;
    /// EF: yields the faces along `e`. A boundary edge has exactly one face.
    fn edge_faces(&self, e: Self::Edge) -> impl Iterator<Item = Self::Face>;
    /// FV: yields the vertices at the corners of `f`, in order.
    fn face_vertices(&self, f: Self::Face) -> impl Iterator<Item = Self::Vertex>;
    /// FE: yields the edges of `f`, in the order of its corners.
    fn face_edges(&self, f: Self::Face) -> impl Iterator<Item = Self::Edge>;
    /// FF: yields the faces that share an edge with `f`.
    fn face_faces(&self, f: Self::Face) -> impl Iterator<Item = Self::Face>;

    /// Returns the edge between `a` and `b`, or `None` if no edge joins `a` and `b`. Costs as much
    /// as `vertex_edges(a)`, plus `edge_vertices` for each edge at `a`.
    fn edge_between(&self, a: Self::Vertex, b: Self::Vertex) -> Option<Self::Edge> {
        self.vertex_edges(a)
            .find(|&e| self.edge_vertices(e).contains(&b) && a != b)
    }

    /// Returns a face that has corners at `a` and at `b`, or `None` if no face has both corners. If
    /// several faces have both corners, returns any of these faces. The two corners need not be
    /// adjacent in the face. Costs as much as `vertex_faces(a)`, plus `face_vertices` for each face
    /// at `a`.
    fn common_face(&self, a: Self::Vertex, b: Self::Vertex) -> Option<Self::Face> {
        self.vertex_faces(a)
            .find(|&f| self.face_vertices(f).any(|v| v == b))
    }

    /// Returns an edge of both faces, or `None` if they share no edge. If they share several edges, returns
    /// any of them. Costs as much as `face_edges(f)` and, for each edge, `edge_faces`.
    fn common_edge(&self, f: Self::Face, g: Self::Face) -> Option<Self::Edge> {
        self.face_edges(f)
            .find(|&e| f != g && self.edge_faces(e).any(|other| other == g))
    }

    /// Yields the third vertex of each triangle along `e`: two vertices at an inner edge, and one at a
    /// boundary edge. Faces that are not triangles have none. Costs as much as `edge_faces(e)`, plus
    /// `face_vertices` for each face.
    fn opposite_vertices(&self, e: Self::Edge) -> impl Iterator<Item = Self::Vertex> {
        self.edge_faces(e)
            .filter_map(move |f| self.opposite_vertex(f, e))
    }

    /// Returns the vertex of triangle `f` that is not an end of `e`; costs as much as
    /// `edge_vertices(e)` and `face_vertices(f)`. Returns `None` if `f` is not a triangle, or if
    /// `e` is not a side of `f`.
    fn opposite_vertex(&self, f: Self::Face, e: Self::Edge) -> Option<Self::Vertex> {
        let ends = self.edge_vertices(e);
        let mut corners = self.face_vertices(f);
        let three = [corners.next()?, corners.next()?, corners.next()?];
        let is_triangle = corners.next().is_none() && ends.iter().all(|end| three.contains(end));
        is_triangle.then(|| three.into_iter().find(|v| !ends.contains(v)))?
    }

    /// Returns the number of edges at `v`; costs as much as `vertex_edges(v)`.
    fn valence(&self, v: Self::Vertex) -> usize {
        self.vertex_edges(v).count()
    }

    /// Returns the number of corners of `f`; costs as much as `face_vertices(f)`.
    fn degree(&self, f: Self::Face) -> usize {
        self.face_vertices(f).count()
    }

    /// Returns whether `e` has exactly one face; costs as much as `edge_faces(e)`.
    fn is_boundary_edge(&self, e: Self::Edge) -> bool {
        let mut faces = self.edge_faces(e);
        faces.next().is_some() && faces.next().is_none()
    }

    /// Returns whether `v` is an end of a boundary edge; costs as much as `vertex_edges(v)`, plus
    /// `edge_faces` for each edge at `v`.
    fn is_boundary_vertex(&self, v: Self::Vertex) -> bool {
        self.vertex_edges(v).any(|e| self.is_boundary_edge(e))
    }

    /// Returns whether an edge of `f` is a boundary edge; costs as much as `face_edges(f)`, plus `edge_faces`
    /// for each edge.
    fn is_boundary_face(&self, f: Self::Face) -> bool {
        self.face_edges(f).any(|e| self.is_boundary_edge(e))
    }

    /// Returns whether `v` is the handle of a vertex of this mesh. The result is false if an edit
    /// has deleted the vertex or changed its handle.
    ///
    /// The default searches all vertices: O(vertices). The six structures override it: O(1) if
    /// vertex handles are row numbers; costs as much as `vertex_faces` if vertex handles are
    /// coordinates.
    fn contains_vertex(&self, v: Self::Vertex) -> bool {
        self.vertices().any(|vertex| vertex == v)
    }

    /// Returns whether `e` is the handle of an edge of this mesh. The result is false if an edit
    /// has deleted the edge or changed its handle.
    ///
    /// Use this method to check an edge handle that was stored before an edit. If a later edit
    /// created a new edge with the same handle, the result is true.
    ///
    /// The default searches all edges: O(edges). The six structures override it: O(1) if edge
    /// handles are rows or corners; costs as much as `vertex_edges` if edge handles are pairs of
    /// ends.
    fn contains_edge(&self, e: Self::Edge) -> bool {
        self.edges().any(|edge| edge == e)
    }

    /// Returns whether `f` is the handle of a face of this mesh; false for a deleted face.
    ///
    /// The default searches all faces: O(faces). The six structures override it: O(1).
    fn contains_face(&self, f: Self::Face) -> bool {
        self.faces().any(|face| face == f)
    }

    /// Returns a number that is larger than every vertex row; 0 if vertex handles are not rows.
    /// O(1).
    ///
    /// Programs use [`vertex_map`](Self::vertex_map) and [`vertex_numbers`](Self::vertex_numbers).
    /// The number is a method of its own because only the structure knows how its handles are
    /// stored: where handles are rows, a map is a vector of this length, otherwise a hash table.
    fn vertex_rows(&self) -> usize;
    /// Returns a number that is larger than every edge row; 0 if edge handles are not rows. O(1).
    fn edge_rows(&self) -> usize;
    /// Returns a number that is larger than every face row; O(1).
    fn face_rows(&self) -> usize;

    /// Returns a map that holds `value` for every vertex. O([`vertex_rows`](Self::vertex_rows)), which
    /// is O(1) if vertex handles are not rows.
    fn vertex_map<T: Clone>(&self, value: T) -> VertexMap<Self, T> {
        HandleMap::filled(self.vertex_rows(), value)
    }
    /// Returns a map that holds `value` for every edge. O([`edge_rows`](Self::edge_rows)), which is
    /// O(1) if edge handles are not rows.
    fn edge_map<T: Clone>(&self, value: T) -> EdgeMap<Self, T> {
        HandleMap::filled(self.edge_rows(), value)
    }
    /// Returns a map that holds `value` for every face. O([`face_rows`](Self::face_rows)).
    fn face_map<T: Clone>(&self, value: T) -> FaceMap<Self, T> {
        HandleMap::filled(self.face_rows(), value)
    }

    /// Numbers the vertices from 0, in the order of [`vertices`](Self::vertices); O(vertices)
    /// expected.
    fn vertex_numbers(&self) -> Numbers<Self::Vertex> {
        Numbers::new(self.vertex_rows(), self.vertices())
    }
    /// Numbers the edges from 0, in the order of [`edges`](Self::edges); O(edges) expected.
    fn edge_numbers(&self) -> Numbers<Self::Edge> {
        Numbers::new(self.edge_rows(), self.edges())
    }
    /// Numbers the faces from 0, in the order of [`faces`](Self::faces); O(faces) expected.
    fn face_numbers(&self) -> Numbers<Self::Face> {
        Numbers::new(self.face_rows(), self.faces())
    }

    /// Returns the number of faces of each edge; the value 255 stands for 255 or more faces.
    ///
    /// This method queries `face_edges` once for each face, which takes O(corners) time in total.
    /// On a structure that scans all faces for each `edge_faces` query, the `edge_faces` queries of
    /// all edges would take O(edges · corners) time.
    fn edge_face_counts(&self) -> EdgeMap<Self, u8> {
        boundary::edge_face_counts(self)
    }

    /// Returns the edges that have exactly one face, in the order of [`edges`](Self::edges); costs
    /// as much as [`edge_face_counts`](Self::edge_face_counts).
    fn boundary_edges(&self) -> Vec<Self::Edge> {
        let counts = self.edge_face_counts();
        self.edges().filter(|&e| counts[e] == 1).collect()
    }

    /// Returns the boundary loops: chains of boundary edges with the hole on their left.
    ///
    /// ```text
    ///    ┌───┬───┬───┐
    ///    │   │   │   │      the vertices of a loop around a hole, in order,
    ///    ├───d ← c───┤      are the corners of the face that fills the hole:
    ///    │   ↓   ↑   │      a, b, c, d
    ///    ├───a → b───┤
    ///    │   │   │   │      the loop around the outside runs clockwise
    ///    └───┴───┴───┘
    /// ```
    ///
    /// - Every boundary edge is in exactly one loop, and occurs in this loop once.
    /// - At a vertex, a loop arrives at one boundary edge of a fan of faces, and continues at the
    ///   other boundary edge of the fan. If two holes meet at a vertex, one loop runs around both
    ///   holes and visits the vertex twice.
    /// - A chain ends at a vertex if the fan of faces at the vertex reaches an edge with three or
    ///   more faces. A chain without ends is [closed](BoundaryLoop::is_closed).
    /// - Each edge of a loop runs in the direction opposite to its face. Boundary edges are ordered
    ///   by the index of their start vertex in the sequence [`vertices`](Self::vertices), then by
    ///   the index of their end vertex. If the faces of a loop disagree in orientation, the loop
    ///   has the direction of the edge that comes first in the order of boundary edges.
    /// - A closed loop starts with the edge that comes first in the order of boundary edges. The
    ///   loops are sorted by their first edges. Structures that list the vertices in the same order
    ///   therefore return the same loops.
    ///
    /// If `face_vertices` and `face_edges` do not scan all faces, the expected time is O(corners),
    /// plus O(n log n) for the n corners at boundary vertices.
    fn boundary_loops(&self) -> Vec<BoundaryLoop<Self::Vertex, Self::Edge>> {
        boundary::boundary_loops(self)
    }

    /// Returns the one-ring of the manifold vertex `v`: the vertices adjacent to `v`,
    /// counter-clockwise. At a boundary vertex, the ring starts at one boundary edge and ends at
    /// the other boundary edge. At an inner vertex, the start of the ring is arbitrary.
    ///
    /// Returns `None` if the faces at `v` do not form one consistently oriented fan. The ring of an
    /// isolated vertex is empty. The cost is O(valence log valence), plus `vertex_faces(v)` and
    /// `face_vertices` for each face at `v`. Structures that can find the order without sorting
    /// override this method.
    ///
    /// ```text
    ///      c ───── b        faces (v, a, b), (v, b, c):  a, b, c
    ///       \    / │
    ///        \  /  │
    ///         v ── a
    /// ```
    fn one_ring(&self, v: Self::Vertex) -> Option<impl Iterator<Item = Self::Vertex>> {
        let spokes = self
            .vertex_faces(v)
            .map(|f| spoke(self.face_vertices(f), v));
        ring(spokes.collect()).map(Vec::into_iter)
    }

    /// Returns the vertices of [`one_ring`](Self::one_ring), each with the face that follows it
    /// counter-clockwise. At a boundary vertex, the last vertex has no face. Costs as much as `one_ring`,
    /// plus `vertex_faces(v)` and `face_vertices` for each face at `v`.
    fn one_ring_with_faces(
        &self,
        v: Self::Vertex,
    ) -> Option<impl Iterator<Item = (Self::Vertex, Option<Self::Face>)>> {
        let after = |f: Self::Face| (spoke(self.face_vertices(f), v)[0], f);
        let mut faces: Vec<(Self::Vertex, Self::Face)> = self.vertex_faces(v).map(after).collect();
        faces.sort_unstable();
        let ring = self.one_ring(v)?;
        Some(ring.map(move |w| {
            let place = faces.binary_search_by_key(&w, |&(after, _)| after);
            (w, place.ok().map(|place| faces[place].1))
        }))
    }
}

/// Returns the corners after and before `v` in a face.
fn spoke<V: Eq + Copy>(corners: impl Iterator<Item = V>, v: V) -> [V; 2] {
    let (mut first, mut last) = (None, None);
    let (mut after, mut before) = (None, None);
    for corner in corners {
        first.get_or_insert(corner);
        if corner == v {
            before = last;
        }
        if last == Some(v) {
            after = Some(corner);
        }
        last = Some(corner);
    }
    let (after, before) = (after.or(first), before.or(last));
    after
        .zip(before)
        .map(|(a, b)| [a, b])
        .expect("a face has corners")
}

/// Chains spokes into one ring around a vertex; O(n log n). There is one spoke for each face at the
/// vertex: `[after, before]` are the vertices after and before the vertex in the face. An open ring
/// starts and ends on the boundary. Returns `None` if the spokes form more than one chain or cycle.
pub fn ring<V: Ord + Copy>(mut spokes: Vec<[V; 2]>) -> Option<Vec<V>> {
    let Some(&[any, _]) = spokes.first() else {
        return Some(Vec::new());
    };
    spokes.sort_unstable();
    let mut targets: Vec<V> = spokes.iter().map(|&[_, to]| to).collect();
    targets.sort_unstable();
    let repeats = |sorted: &[V]| sorted.windows(2).any(|pair| pair[0] == pair[1]);
    if repeats(&targets) || spokes.windows(2).any(|pair| pair[0][0] == pair[1][0]) {
        return None;
    }
    let mut starts = spokes
        .iter()
        .map(|&[from, _]| from)
        .filter(|from| targets.binary_search(from).is_err());
    let open = starts.next();
    let start = open.unwrap_or(any);
    let mut ring = vec![start];
    let mut at = start;
    while let Ok(next) = spokes.binary_search_by_key(&at, |&[from, _]| from) {
        at = spokes[next][1];
        if at == start {
            break;
        }
        ring.push(at);
    }
    let spokes_used = if open.is_some() {
        ring.len() - 1
    } else {
        ring.len()
    };
    (spokes_used == spokes.len()).then_some(ring)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spokes_wrap_around_the_face() {
        assert_eq!(spoke([7, 1, 2].into_iter(), 7), [1, 2]);
        assert_eq!(spoke([1, 7, 2].into_iter(), 7), [2, 1]);
        assert_eq!(spoke([1, 2, 7].into_iter(), 7), [1, 2]);
        assert_eq!(spoke([5, 1, 7, 2, 6].into_iter(), 7), [2, 1]);
    }

    #[test]
    fn a_ring_is_one_chain_or_one_cycle() {
        assert_eq!(ring::<u8>(vec![]), Some(vec![]));
        assert_eq!(ring(vec![[3, 1], [1, 2]]), Some(vec![3, 1, 2]));
        let closed = ring(vec![[2, 3], [1, 2], [3, 1]]).expect("one cycle");
        assert_eq!(closed.len(), 3);
        for faulty in [
            vec![[1, 2], [3, 4]],                 // two fans
            vec![[1, 2], [2, 1], [3, 4], [4, 3]], // two cycles
            vec![[1, 2], [2, 1], [3, 4]],         // a cycle and a fan
            vec![[1, 2], [1, 3]],                 // an edge used twice outwards
            vec![[1, 2], [3, 2]],                 // an edge used twice inwards
        ] {
            assert_eq!(ring(faulty), None);
        }
    }
}
