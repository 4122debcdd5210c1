//! The boundary loops of a mesh: chains of boundary edges.

use crate::traits::query::{EdgeMap, MeshQuery};

/// A chain of boundary edges. The chain is closed, unless a non-manifold edge interrupts the chain.
///
/// [`MeshQuery::boundary_loops`] defines the order of the edges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundaryLoop<V, E> {
    /// The vertices, in order. A closed chain has as many vertices as edges; an open chain has one
    /// more vertex than edges.
    pub vertices: Vec<V>,
    /// The edges, in order: edge `i` joins vertices `i` and `i + 1`. The last edge of a closed
    /// chain joins the last vertex and the first vertex.
    pub edges: Vec<E>,
}

impl<V, E> BoundaryLoop<V, E> {
    /// Returns true if the chain is closed: the last edge joins the last vertex and the first
    /// vertex.
    pub fn is_closed(&self) -> bool {
        self.vertices.len() == self.edges.len()
    }
}

/// Implements [`MeshQuery::edge_face_counts`].
pub(crate) fn edge_face_counts<M: MeshQuery + ?Sized>(mesh: &M) -> EdgeMap<M, u8> {
    let mut counts = mesh.edge_map(0_u8);
    mesh.faces().for_each(|f| {
        mesh.face_edges(f).for_each(|e| {
            let count = &mut counts[e];
            *count = count.saturating_add(1);
        });
    });
    counts
}

/// Implements [`MeshQuery::boundary_loops`].
pub(crate) fn boundary_loops<M: MeshQuery + ?Sized>(
    mesh: &M,
) -> Vec<BoundaryLoop<M::Vertex, M::Edge>> {
    let counts = mesh.edge_face_counts();
    let sides = boundary_sides(mesh, &counts);
    let turns = boundary_turns(mesh, &sides);
    let boundary = BoundaryEdges {
        mesh,
        counts,
        turns,
    };
    let mut visited = mesh.edge_map(false);
    let mut loops = Vec::new();
    for side in sides {
        if !visited[side.edge] {
            let found = boundary.chain(side);
            for &e in &found.edges {
                visited[e] = true;
            }
            loops.push(found);
        }
    }
    loops
}

/// A boundary edge, in the direction opposite to its face, so that the hole is on its left.
#[derive(Clone, Copy)]
struct Side<V, E> {
    ends: [V; 2],
    edge: E,
}

/// Returns the boundary edges, sorted by the number of the start, then by the number of the end.
fn boundary_sides<M: MeshQuery + ?Sized>(
    mesh: &M,
    counts: &EdgeMap<M, u8>,
) -> Vec<Side<M::Vertex, M::Edge>> {
    let mut sides = Vec::new();
    let mut corners = Vec::new();
    for f in mesh.faces() {
        corners.clear();
        corners.extend(mesh.face_vertices(f));
        for (i, edge) in mesh.face_edges(f).enumerate() {
            if counts[edge] == 1 {
                let ends = [corners[(i + 1) % corners.len()], corners[i]];
                sides.push(Side { ends, edge });
            }
        }
    }
    if !sides.is_empty() {
        let numbers = mesh.vertex_numbers();
        sides.sort_by_cached_key(|side| side.ends.map(|v| numbers[v]));
    }
    sides
}

/// A step around the vertex `at`: `face` leads from its side `edge` to its side `other`.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Turn<V, E, F> {
    at: V,
    edge: E,
    face: F,
    other: E,
}

type Turns<M> = Vec<Turn<<M as MeshQuery>::Vertex, <M as MeshQuery>::Edge, <M as MeshQuery>::Face>>;

/// Returns both turns of every face around every boundary vertex, sorted.
fn boundary_turns<M: MeshQuery + ?Sized>(mesh: &M, sides: &[Side<M::Vertex, M::Edge>]) -> Turns<M> {
    let mut turns = Vec::new();
    if sides.is_empty() {
        return turns;
    }
    let mut is_boundary = mesh.vertex_map(false);
    for v in sides.iter().flat_map(|side| side.ends) {
        is_boundary[v] = true;
    }
    let mut edges = Vec::new();
    for face in mesh.faces() {
        edges.clear();
        edges.extend(mesh.face_edges(face));
        for (i, at) in mesh.face_vertices(face).enumerate() {
            if is_boundary[at] {
                let before = edges[(i + edges.len() - 1) % edges.len()];
                for (edge, other) in [(before, edges[i]), (edges[i], before)] {
                    turns.push(Turn {
                        at,
                        edge,
                        face,
                        other,
                    });
                }
            }
        }
    }
    turns.sort_unstable();
    turns
}

struct BoundaryEdges<'m, M: MeshQuery + ?Sized> {
    mesh: &'m M,
    counts: EdgeMap<M, u8>,
    turns: Turns<M>,
}

impl<M: MeshQuery + ?Sized> BoundaryEdges<'_, M> {
    /// Returns the whole chain through `side`, in the direction of `side`.
    fn chain(&self, side: Side<M::Vertex, M::Edge>) -> BoundaryLoop<M::Vertex, M::Edge> {
        let [from, to] = side.ends;
        let after = self.walk(side.edge, [from, to]);
        if after.is_closed() {
            return after;
        }
        let mut whole = self.walk(side.edge, [to, from]);
        whole.vertices.reverse();
        whole.edges.reverse();
        // Both walks contain `side`.
        whole.vertices.extend(&after.vertices[2..]);
        whole.edges.extend(&after.edges[1..]);
        whole
    }

    /// Walks along `first` and the edges after it, until the chain closes or ends.
    fn walk(&self, first: M::Edge, [from, to]: [M::Vertex; 2]) -> BoundaryLoop<M::Vertex, M::Edge> {
        let mut chain = BoundaryLoop {
            vertices: vec![from],
            edges: vec![first],
        };
        let (mut edge, mut at) = (first, to);
        loop {
            let next = self.next(edge, at);
            if next == Some(first) {
                return chain;
            }
            chain.vertices.push(at);
            let Some(next) = next else {
                return chain;
            };
            chain.edges.push(next);
            let [a, b] = self.mesh.edge_vertices(next);
            (edge, at) = (next, if a == at { b } else { a });
        }
    }

    /// Returns the other boundary edge of the fan at `at` that begins with the boundary edge
    /// `edge`; `None` if the fan ends at a non-manifold edge.
    fn next(&self, mut edge: M::Edge, at: M::Vertex) -> Option<M::Edge> {
        let mut last = None;
        loop {
            let first = self
                .turns
                .partition_point(|turn| (turn.at, turn.edge) < (at, edge));
            // At this vertex, a boundary edge has one turn, and an edge with two faces has two
            // turns.
            let mut turns = self.turns[first..].iter();
            let turn = turns.find(|turn| Some(turn.face) != last)?;
            match self.counts[turn.other] {
                1 => return Some(turn.other),
                2 => (edge, last) = (turn.other, Some(turn.face)),
                _ => return None,
            }
        }
    }
}
