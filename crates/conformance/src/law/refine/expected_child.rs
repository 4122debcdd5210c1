//! The expected result of a split, computed from the faces of the input.

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::{Counts, FaceId, Point, PolygonMesh, Refine, Split, VertexId};

/// The expected result of a split.
pub(super) struct ExpectedChild {
    /// The sorted faces of the child, each with its parent face. The corners start at the lowest
    /// vertex.
    faces: Vec<(Vec<usize>, FaceId)>,
    vertices: usize,
    edges: usize,
    /// Whether the split makes two edges with the same ends.
    pub(super) double_edge: bool,
}

impl ExpectedChild {
    /// Splits the faces of `input`. `mesh` defines the numbers of the edges.
    pub(super) fn new<M: Refine>(mesh: &M, input: &PolygonMesh, split: Split) -> Self {
        let parent = Parent::new(mesh, input);
        let mut faces: Vec<(Vec<usize>, FaceId)> = Vec::new();
        for (f, corners) in input.faces().iter() {
            let children = parent.children(f, corners, split);
            faces.extend(children.into_iter().map(|child| (child, f)));
        }
        let grown = split.refined_counts(&parent.counts(), parent.boundary.len());
        assert_eq!(
            grown.faces,
            faces.len(),
            "faces by the closed form of {split}"
        );
        let mut edges = BTreeSet::new();
        for (face, _) in &mut faces {
            rotate_to_lowest(face);
            edges.extend(sides(face).map(sorted));
        }
        faces.sort();
        assert!(
            edges.len() <= grown.edges,
            "edges by the closed form of {split}"
        );
        Self {
            faces,
            vertices: grown.vertices,
            edges: edges.len(),
            double_edge: edges.len() < grown.edges,
        }
    }

    pub(super) fn check<M: Refine>(
        &self,
        mesh: &M,
        numbers: &M::EdgeNumbers,
        child: &mut M,
        split: Split,
    ) {
        let name = M::NAME;
        child.positions_mut().fill(Point::ZERO);
        assert_eq!(
            child.position_rows().len(),
            self.vertices,
            "{name}: {split}"
        );
        if let Err(fault) = child.validate() {
            panic!("{name}: after {split}: {fault}");
        }
        assert_eq!(
            child.edge_count(),
            self.edges,
            "{name}: edges after {split}"
        );
        let polygons = child.to_polygons();
        let mut faces: Vec<(Vec<usize>, FaceId)> = Vec::new();
        for (f, face) in polygons.faces().iter() {
            let mut corners: Vec<usize> = face.iter().map(|v| v.index()).collect();
            rotate_to_lowest(&mut corners);
            faces.push((corners, mesh.parent(numbers, split, f)));
        }
        faces.sort();
        for (got, expected) in faces.iter().zip(&self.faces) {
            assert_eq!(
                got, expected,
                "{name}: a face after {split}, with its parent"
            );
        }
        assert_eq!(faces.len(), self.faces.len(), "{name}: faces after {split}");
    }
}

/// The mesh that is split, with the numbers of its edges.
struct Parent<'a> {
    input: &'a PolygonMesh,
    /// By the sorted ends of each edge: its number and its faces.
    edges: BTreeMap<[VertexId; 2], (usize, Vec<FaceId>)>,
    /// The numbers of the boundary edges, sorted.
    boundary: Vec<usize>,
}

impl<'a> Parent<'a> {
    fn new<M: Refine>(mesh: &M, input: &'a PolygonMesh) -> Self {
        let mut edges: BTreeMap<[VertexId; 2], (usize, Vec<FaceId>)> = BTreeMap::new();
        for (number, e) in mesh.edges().enumerate() {
            edges.insert(sorted(mesh.edge_vertices(e)), (number, Vec::new()));
        }
        for (f, corners) in input.faces().iter() {
            for side in sides(corners) {
                edges.get_mut(&sorted(side)).expect("an edge").1.push(f);
            }
        }
        let with_one_face = edges.values().filter(|(_, faces)| faces.len() == 1);
        let mut boundary: Vec<usize> = with_one_face.map(|&(number, _)| number).collect();
        boundary.sort_unstable();
        Self {
            input,
            edges,
            boundary,
        }
    }

    fn counts(&self) -> Counts {
        Counts {
            vertices: self.input.vertex_count(),
            edges: self.edges.len(),
            faces: self.input.face_count(),
            corners: self.input.corner_count(),
            uniform: true,
        }
    }

    fn face_point(&self, f: FaceId) -> usize {
        self.input.vertex_count() + f.index()
    }

    fn children(&self, f: FaceId, corners: &[VertexId], split: Split) -> Vec<Vec<usize>> {
        match split {
            Split::Quads => self.quads(f, corners),
            Split::Triangles => self.triangles(corners),
            Split::Sqrt3 { trisect } => sides(corners)
                .flat_map(|side| self.sqrt3_triangles(f, side, trisect))
                .collect(),
        }
    }

    fn quads(&self, f: FaceId, corners: &[VertexId]) -> Vec<Vec<usize>> {
        let middles = self.middles(corners, self.input.vertex_count() + self.input.face_count());
        let quads = (0..corners.len()).map(|i| {
            let before = (i + corners.len() - 1) % corners.len();
            let corner = corners[i].index();
            vec![corner, middles[i], self.face_point(f), middles[before]]
        });
        quads.collect()
    }

    fn triangles(&self, corners: &[VertexId]) -> Vec<Vec<usize>> {
        let middles = self.middles(corners, self.input.vertex_count());
        let at_corners = (0..corners.len()).map(|i| {
            let before = (i + corners.len() - 1) % corners.len();
            vec![corners[i].index(), middles[i], middles[before]]
        });
        at_corners.chain([middles.clone()]).collect()
    }

    /// Returns the edge points of the sides of a face. The edge points are numbered from `first`.
    fn middles(&self, corners: &[VertexId], first: usize) -> Vec<usize> {
        let edges = sides(corners).map(|side| &self.edges[&sorted(side)]);
        edges.map(|(number, _)| first + number).collect()
    }

    /// Returns the triangles at a side of `f`.
    fn sqrt3_triangles(&self, f: FaceId, side: [VertexId; 2], trisect: bool) -> Vec<Vec<usize>> {
        let (number, along) = &self.edges[&sorted(side)];
        let across = along.iter().find(|&&g| g != f);
        let centre = self.face_point(f);
        let [a, b] = side.map(VertexId::index);
        match (across, trisect) {
            (Some(&g), _) => vec![vec![a, self.face_point(g), centre]],
            (None, false) => vec![vec![a, b, centre]],
            (None, true) => {
                let rank = self.boundary.binary_search(number);
                let points = self.input.vertex_count() + self.input.face_count();
                let near = points + 2 * rank.expect("a boundary edge");
                [[a, near], [near, near + 1], [near + 1, b]]
                    .map(|[from, to]| vec![from, to, centre])
                    .to_vec()
            }
        }
    }
}

fn sides<V: Copy>(corners: &[V]) -> impl Iterator<Item = [V; 2]> {
    let after = corners.iter().cycle().skip(1);
    corners.iter().zip(after).map(|(&a, &b)| [a, b])
}

fn sorted<V: Ord>(mut ends: [V; 2]) -> [V; 2] {
    ends.sort_unstable();
    ends
}

fn rotate_to_lowest(face: &mut [usize]) {
    let lowest = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
    face.rotate_left(lowest);
}
