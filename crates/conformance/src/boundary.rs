//! Checks the boundary edges and the boundary loops of a mesh against the corner lists of its
//! faces.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use sixfold_core::{BoundaryLoop, MeshQuery};

/// Compares `boundary_edges` and `boundary_loops` with the results of a search in lists of corners.
///
/// # Panics
///
/// Panics if an answer differs.
pub(crate) fn check_boundary<M: MeshQuery>(mesh: &M, name: &str) {
    let lists = Lists::new(mesh);
    let has_one_face = |e: &M::Edge| lists.sides[&sorted(mesh.edge_vertices(*e))].len() == 1;
    let edges: Vec<M::Edge> = mesh.edges().filter(has_one_face).collect();
    assert_eq!(mesh.boundary_edges(), edges, "{name}: boundary_edges");
    let edge_by_ends: BTreeMap<_, M::Edge> = edges
        .iter()
        .map(|&e| (sorted(mesh.edge_vertices(e)), e))
        .collect();
    let expected: Vec<_> = lists
        .loops(mesh)
        .into_iter()
        .map(|(vertices, ends)| BoundaryLoop {
            vertices: vertices.into(),
            edges: ends.iter().map(|ends| edge_by_ends[ends]).collect(),
        })
        .collect();
    let got = mesh.boundary_loops();
    assert_eq!(got, expected, "{name}: boundary_loops");
}

/// The vertices and the edges of a chain; an edge is the sorted pair of its ends.
type Chain<V> = (VecDeque<V>, VecDeque<[V; 2]>);

/// The corners of each face, and the faces along each edge.
struct Lists<V> {
    corners: Vec<Vec<V>>,
    /// By the sorted ends of each edge: its faces, each with its direction along the edge.
    sides: BTreeMap<[V; 2], Vec<(usize, [V; 2])>>,
}

impl<V: Copy + Ord> Lists<V> {
    fn new<M: MeshQuery<Vertex = V>>(mesh: &M) -> Self {
        let faces = mesh.faces().map(|f| mesh.face_vertices(f).collect());
        let corners: Vec<Vec<V>> = faces.collect();
        let mut sides: BTreeMap<[V; 2], Vec<(usize, [V; 2])>> = BTreeMap::new();
        for (f, face) in corners.iter().enumerate() {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                sides.entry(sorted([a, b])).or_default().push((f, [a, b]));
            }
        }
        Self { corners, sides }
    }

    fn loops<M: MeshQuery<Vertex = V>>(&self, mesh: &M) -> Vec<Chain<V>> {
        let number: BTreeMap<V, usize> = mesh.vertices().zip(0..).collect();
        let mut starts: Vec<[V; 2]> = Vec::new();
        for sides in self.sides.values() {
            if let [(_, [a, b])] = sides[..] {
                starts.push([b, a]); // the hole is on the left
            }
        }
        starts.sort_by_key(|ends| ends.map(|v| number[&v]));
        let mut visited = BTreeSet::new();
        let mut loops = Vec::new();
        for start in starts {
            if !visited.contains(&sorted(start)) {
                let chain = self.chain(start);
                visited.extend(chain.1.iter().copied());
                loops.push(chain);
            }
        }
        loops
    }

    fn chain(&self, start: [V; 2]) -> Chain<V> {
        let mut vertices = VecDeque::from(start);
        let mut edges = VecDeque::from([sorted(start)]);
        while let Some(edge) = self.next(edges[edges.len() - 1], vertices[vertices.len() - 1]) {
            if edge == edges[0] {
                vertices.pop_back();
                return (vertices, edges);
            }
            vertices.push_back(other_end(edge, vertices[vertices.len() - 1]));
            edges.push_back(edge);
        }
        while let Some(edge) = self.next(edges[0], vertices[0]) {
            vertices.push_front(other_end(edge, vertices[0]));
            edges.push_front(edge);
        }
        (vertices, edges)
    }

    /// Returns the other boundary edge of the fan at `at` that starts at `edge`.
    fn next(&self, mut edge: [V; 2], at: V) -> Option<[V; 2]> {
        let mut crossed = BTreeSet::new();
        loop {
            let mut faces = self.sides[&edge].iter().map(|&(f, _)| f);
            let face = faces.find(|&f| crossed.insert(f))?;
            let corners = &self.corners[face];
            let (i, degree) = (corners.iter().position(|&v| v == at)?, corners.len());
            let [before, after] =
                [i + degree - 1, i + 1].map(|i| sorted([at, corners[i % degree]]));
            let other = if before == edge { after } else { before };
            match self.sides[&other].len() {
                1 => return Some(other),
                2 => edge = other,
                _ => return None,
            }
        }
    }
}

fn other_end<V: PartialEq + Copy>([a, b]: [V; 2], end: V) -> V {
    if a == end { b } else { a }
}

fn sorted<V: Ord + Copy>([a, b]: [V; 2]) -> [V; 2] {
    [a.min(b), a.max(b)]
}
