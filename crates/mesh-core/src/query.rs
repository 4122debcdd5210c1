//! The one query trait.

use crate::Point;
use crate::handle::{Handle, HandleMap};

/// Data by vertex of `M`.
pub type VertexMap<M, T> = <<M as MeshQuery>::Vertex as Handle>::Map<T>;
/// Data by edge of `M`.
pub type EdgeMap<M, T> = <<M as MeshQuery>::Edge as Handle>::Map<T>;
/// Data by face of `M`.
pub type FaceMap<M, T> = <<M as MeshQuery>::Face as Handle>::Map<T>;

/// What touches what: the nine relations between vertices, edges and faces (Weiler 1985).
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
///   two edges have the same ends. A face names at least three vertices, each once.
/// - **Once.** A relation yields each element once, and never the element it was asked about: two
///   faces that share two edges are one neighbour of each other, and so are two faces with the same
///   corners. An isolated vertex has empty relations.
/// - **Symmetry.** `f ∈ VF(v)` exactly when `v ∈ FV(f)`; so too VE/EV, EF/FE, VV, EE and FF.
/// - **Order.** FV and FE run counter-clockwise as the input gave the face, from any start; side `i`
///   joins corners `i` and `i + 1`. The other seven are sets, in no promised order.
/// - **No memory.** Each answer comes from the stored tables alone; nothing is kept between calls.
///   Where that means a scan of all faces, it scans.
/// - **Names.** A handle lives until the next edit. One that is out of range, or of a deleted
///   element, panics and says its name. One of another mesh may panic or mislead, nothing worse.
///
/// # Panics
///
/// Every method that takes a handle panics if the mesh has no such element. Where a vertex *is* its
/// coordinates and an edge *is* its ends, a handle that names nothing has empty relations instead.
pub trait MeshQuery {
    /// How this structure names a vertex: a row, or the very coordinates.
    type Vertex: Handle;
    /// How it names an edge: a row, or the pair of its ends.
    type Edge: Handle;
    /// How it names a face.
    type Face: Handle;

    /// Every vertex once.
    fn vertices(&self) -> impl Iterator<Item = Self::Vertex>;
    /// Every edge once.
    fn edges(&self) -> impl Iterator<Item = Self::Edge>;
    /// Every face once, in the order of the input.
    fn faces(&self) -> impl Iterator<Item = Self::Face>;

    /// How many vertices there are.
    fn vertex_count(&self) -> usize {
        self.vertices().count()
    }
    /// How many edges there are.
    fn edge_count(&self) -> usize {
        self.edges().count()
    }
    /// How many faces there are; O(1).
    fn face_count(&self) -> usize;

    /// Where `v` is.
    fn position(&self, v: Self::Vertex) -> Point;

    /// VV: the other ends of the edges at `v`, its one-ring.
    fn vertex_vertices(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Vertex>;
    /// VE: the edges that end at `v`; their number is the valence.
    fn vertex_edges(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Edge>;
    /// VF: the faces with a corner at `v`.
    fn vertex_faces(&self, v: Self::Vertex) -> impl Iterator<Item = Self::Face>;
    /// EV: the two ends of `e`.
    fn edge_vertices(&self, e: Self::Edge) -> [Self::Vertex; 2];
    /// EE: the edges that share an end with `e`.
    fn edge_edges(&self, e: Self::Edge) -> impl Iterator<Item = Self::Edge>;
    /// EF: the faces along `e`; a boundary edge has one.
    fn edge_faces(&self, e: Self::Edge) -> impl Iterator<Item = Self::Face>;
    /// FV: the corners of `f`. The other eight relations follow from this one.
    fn face_vertices(&self, f: Self::Face) -> impl Iterator<Item = Self::Vertex>;
    /// FE: the sides of `f`.
    fn face_edges(&self, f: Self::Face) -> impl Iterator<Item = Self::Edge>;
    /// FF: the faces that share an edge with `f`.
    fn face_faces(&self, f: Self::Face) -> impl Iterator<Item = Self::Face>;

    /// The edge between `a` and `b`, if there is one; the cost of VE and EV.
    fn edge_between(&self, a: Self::Vertex, b: Self::Vertex) -> Option<Self::Edge> {
        self.vertex_edges(a)
            .find(|&e| self.edge_vertices(e).contains(&b) && a != b)
    }

    /// No vertex handle that is a row is this large or larger; O(1).
    fn vertex_rows(&self) -> usize;
    /// No edge handle that is a row is this large or larger; O(1).
    fn edge_rows(&self) -> usize;
    /// No face handle that is a row is this large or larger; O(1).
    fn face_rows(&self) -> usize;

    /// A map that holds `value` for every vertex.
    fn vertex_map<T: Clone>(&self, value: T) -> VertexMap<Self, T> {
        HandleMap::filled(self.vertex_rows(), value)
    }
    /// A map that holds `value` for every edge.
    fn edge_map<T: Clone>(&self, value: T) -> EdgeMap<Self, T> {
        HandleMap::filled(self.edge_rows(), value)
    }
    /// A map that holds `value` for every face.
    fn face_map<T: Clone>(&self, value: T) -> FaceMap<Self, T> {
        HandleMap::filled(self.face_rows(), value)
    }

    /// The neighbours of a manifold vertex, counter-clockwise; from one boundary edge to the other
    /// where there is a boundary, else from any start.
    ///
    /// `None` where the faces at `v` are not one consistently oriented fan. An isolated vertex has
    /// the empty ring. O(valence log valence) beyond the cost of VF and FV; structures that have
    /// the order for nothing override this.
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
}

/// The corners after and before `v` in a face that has it.
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

/// Chains spokes `[after, before]` into one ring: each runs from its first to its second vertex.
pub(crate) fn ring<V: Ord + Copy>(mut spokes: Vec<[V; 2]>) -> Option<Vec<V>> {
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
            vec![[1, 2], [1, 3]],                 // an edge run twice outwards
            vec![[1, 2], [3, 2]],                 // an edge run twice inwards
        ] {
            assert_eq!(ring(faulty), None);
        }
    }
}
