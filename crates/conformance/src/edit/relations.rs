//! Compares the nine relations of an edited mesh, which may have holes, with its faces.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use sixfold_core::{IteratorExt, MeshQuery};

/// Queries every relation of every element, and compares the answer with one computed from FV only.
///
/// # Panics
///
/// Panics if an answer differs, if an item occurs twice, or if a count differs from the list.
pub(crate) fn check_relations<M: MeshQuery>(mesh: &M, name: &str) {
    let faces: Vec<M::Face> = mesh.faces().collect();
    let vertices: Vec<M::Vertex> = mesh.vertices().collect();
    let edges: Vec<M::Edge> = mesh.edges().collect();
    let counts = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
    assert_eq!(
        counts,
        [vertices.len(), edges.len(), faces.len()],
        "{name}: counts (left) and lengths of the lists (right)"
    );

    let corners: BTreeMap<M::Face, Vec<M::Vertex>> = faces
        .iter()
        .map(|&f| (f, mesh.face_vertices(f).collect()))
        .collect();
    let edge_by_ends: BTreeMap<[M::Vertex; 2], M::Edge> = edges
        .iter()
        .map(|&e| {
            let [a, b] = mesh.edge_vertices(e);
            ([a.min(b), a.max(b)], e)
        })
        .collect();
    assert_eq!(
        edge_by_ends.len(),
        edges.len(),
        "{name}: two edges have the same ends"
    );

    let mut sides: BTreeMap<[M::Vertex; 2], Vec<M::Face>> = BTreeMap::new();
    let mut faces_at: BTreeMap<M::Vertex, BTreeSet<M::Face>> = BTreeMap::new();
    for (&f, face) in &corners {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            sides.entry([a.min(b), a.max(b)]).or_default().push(f);
            faces_at.entry(a).or_default().insert(f);
        }
    }
    let all: Vec<_> = sides.keys().copied().collect();
    let listed: Vec<_> = edge_by_ends.keys().copied().collect();
    assert_eq!(listed, all, "{name}: edges");

    for &v in &vertices {
        let ends = sides.keys().filter(|ends| ends.contains(&v));
        let others = ends
            .clone()
            .map(|&[a, b]| if a == v { b } else { a })
            .collect();
        assert_same_items(name, "VV", v, mesh.vertex_vertices(v), others);
        assert_same_items(
            name,
            "VE",
            v,
            mesh.vertex_edges(v),
            ends.map(|e| edge_by_ends[e]).collect(),
        );
        let faces = faces_at.get(&v).cloned().unwrap_or_default();
        assert_same_items(
            name,
            "VF",
            v,
            mesh.vertex_faces(v),
            faces.into_iter().collect(),
        );
    }
    for (ends, &e) in &edge_by_ends {
        assert_same_items(name, "EF", e, mesh.edge_faces(e), sides[ends].clone());
        let neighbours = |other: &&[M::Vertex; 2]| {
            *other != ends && (other.contains(&ends[0]) || other.contains(&ends[1]))
        };
        let neighbours = sides
            .keys()
            .filter(neighbours)
            .map(|e| edge_by_ends[e])
            .collect();
        assert_same_items(name, "EE", e, mesh.edge_edges(e), neighbours);
        assert_eq!(
            mesh.edge_between(ends[0], ends[1]),
            Some(e),
            "{name}: edge_between"
        );
    }
    for (&f, face) in &corners {
        let ends = (0..face.len()).map(|i| {
            let (a, b) = (face[i], face[(i + 1) % face.len()]);
            [a.min(b), a.max(b)]
        });
        let ends: Vec<_> = ends.collect();
        assert_same_items(
            name,
            "FE",
            f,
            mesh.face_edges(f),
            ends.iter().map(|e| edge_by_ends[e]).collect(),
        );
        let adjacent = ends.iter().flat_map(|e| sides[e].clone());
        let adjacent = adjacent.filter(|&g| g != f).distinct().collect();
        assert_same_items(name, "FF", f, mesh.face_faces(f), adjacent);
    }
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
