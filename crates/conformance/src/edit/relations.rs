//! Compares the nine relations of an edited mesh with relations that are computed from the corners
//! of its faces.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use sixfold_core::{IteratorExt, MeshQuery};

/// Compares every relation of every element with an answer computed from FV only.
///
/// # Panics
///
/// Panics if an answer differs, if an item occurs twice, or if a count differs from the list.
pub(crate) fn check_relations<M: MeshQuery>(mesh: &M, name: &str) {
    let vertices: Vec<M::Vertex> = mesh.vertices().collect();
    let edges: Vec<M::Edge> = mesh.edges().collect();
    let faces: Vec<M::Face> = mesh.faces().collect();
    let counts = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
    assert_eq!(
        counts,
        [vertices.len(), edges.len(), faces.len()],
        "{name}: counts (left) and lengths of the lists (right)"
    );
    let expected = Expected::new(mesh, &edges, &faces, name);
    for v in vertices {
        expected.check_vertex(mesh, v);
    }
    for &ends in expected.edges.keys() {
        expected.check_edge(mesh, ends);
    }
    for &f in expected.corners.keys() {
        expected.check_face(mesh, f);
    }
}

/// The relations between the elements of a mesh, computed from the corners of its faces. The key of
/// an edge is the sorted pair of its ends.
struct Expected<'a, M: MeshQuery> {
    name: &'a str,
    corners: BTreeMap<M::Face, Vec<M::Vertex>>,
    edges: BTreeMap<[M::Vertex; 2], M::Edge>,
    faces_along: BTreeMap<[M::Vertex; 2], Vec<M::Face>>,
    faces_at: BTreeMap<M::Vertex, BTreeSet<M::Face>>,
}

impl<'a, M: MeshQuery> Expected<'a, M> {
    /// Panics if `edges` does not list every edge of the faces exactly once.
    fn new(mesh: &M, edges: &[M::Edge], faces: &[M::Face], name: &'a str) -> Self {
        let corners_of = |&f: &M::Face| (f, mesh.face_vertices(f).collect());
        let corners: BTreeMap<_, Vec<_>> = faces.iter().map(corners_of).collect();
        let ends_of = |&e: &M::Edge| (sorted(mesh.edge_vertices(e)), e);
        let edge_by_ends: BTreeMap<_, _> = edges.iter().map(ends_of).collect();
        assert_eq!(
            edge_by_ends.len(),
            edges.len(),
            "{name}: two edges have the same ends"
        );
        let mut faces_along: BTreeMap<_, Vec<M::Face>> = BTreeMap::new();
        let mut faces_at: BTreeMap<_, BTreeSet<M::Face>> = BTreeMap::new();
        for (&f, face) in &corners {
            for (ends, &v) in sides(face).zip(face) {
                faces_along.entry(ends).or_default().push(f);
                faces_at.entry(v).or_default().insert(f);
            }
        }
        assert!(
            edge_by_ends.keys().eq(faces_along.keys()),
            "{name}: edges are {:?}, expected {:?}",
            edge_by_ends.keys(),
            faces_along.keys()
        );
        Self {
            name,
            corners,
            edges: edge_by_ends,
            faces_along,
            faces_at,
        }
    }

    fn check_vertex(&self, mesh: &M, v: M::Vertex) {
        let ends = self.edges.keys().filter(|ends| ends.contains(&v));
        let others = ends.map(|&[a, b]| if a == v { b } else { a });
        let edges = self
            .edges
            .iter()
            .filter(|(ends, _)| ends.contains(&v))
            .map(|(_, &e)| e);
        let faces = self.faces_at.get(&v).into_iter().flatten().copied();
        let name = self.name;
        assert_same_items(name, "VV", v, mesh.vertex_vertices(v), others.collect());
        assert_same_items(name, "VE", v, mesh.vertex_edges(v), edges.collect());
        assert_same_items(name, "VF", v, mesh.vertex_faces(v), faces.collect());
    }

    fn check_edge(&self, mesh: &M, [a, b]: [M::Vertex; 2]) {
        let e = self.edges[&[a, b]];
        let faces = self.faces_along[&[a, b]].clone();
        let adjacent = self
            .edges
            .iter()
            .filter(|(ends, _)| **ends != [a, b] && (ends.contains(&a) || ends.contains(&b)))
            .map(|(_, &other)| other);
        let name = self.name;
        assert_same_items(name, "EF", e, mesh.edge_faces(e), faces);
        assert_same_items(name, "EE", e, mesh.edge_edges(e), adjacent.collect());
        assert_eq!(mesh.edge_between(a, b), Some(e), "{name}: edge_between");
    }

    fn check_face(&self, mesh: &M, f: M::Face) {
        let edges = sides(&self.corners[&f]).map(|ends| self.edges[&ends]);
        let adjacent = sides(&self.corners[&f])
            .flat_map(|ends| self.faces_along[&ends].clone())
            .filter(|&g| g != f)
            .distinct();
        let name = self.name;
        assert_same_items(name, "FE", f, mesh.face_edges(f), edges.collect());
        assert_same_items(name, "FF", f, mesh.face_faces(f), adjacent.collect());
    }
}

fn sides<V: Copy + Ord>(face: &[V]) -> impl Iterator<Item = [V; 2]> {
    let after = face.iter().cycle().skip(1);
    face.iter().zip(after).map(|(&a, &b)| sorted([a, b]))
}

fn sorted<V: Ord>(mut ends: [V; 2]) -> [V; 2] {
    ends.sort_unstable();
    ends
}

fn assert_same_items<A: Debug, H: Ord + Debug>(
    name: &str,
    relation: &str,
    of: A,
    got: impl Iterator<Item = H>,
    mut expected: Vec<H>,
) {
    let mut got: Vec<H> = got.collect();
    got.sort_unstable();
    expected.sort_unstable();
    assert_eq!(got, expected, "{name}: {relation} of {of:?}");
}
