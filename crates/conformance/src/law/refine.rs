//! Laws about structures that refine their own tables.

use std::collections::{BTreeMap, BTreeSet};

use sixfold_core::{Counts, FaceId, Point, PolygonMesh, Refine, RefineError, Split, VertexId};

use crate::subject::Subject;

/// Returns all splits of the structure, including both kinds of √3.
fn splits<M: Refine>() -> Vec<Split> {
    let mut splits = Vec::new();
    for &split in M::SPLITS {
        match split {
            Split::Sqrt3 { .. } => {
                splits.extend([false, true].map(|trisect| Split::Sqrt3 { trisect }));
            }
            _ => splits.push(split),
        }
    }
    splits
}

/// The child of every split is valid, and has the expected faces, edges and parents. If a child is
/// impossible, the split returns the matching error. Edges are numbered in the order of `edges()`.
pub fn refine<M: Refine>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, input, .. }) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let mut numbers = M::EdgeNumbers::default();
    mesh.number_edges(&mut numbers);
    check_edge_numbers(&mesh, &numbers);
    // This mesh is reused for all splits, so that a split also overwrites tables that are not
    // empty.
    let mut used = M::empty();
    assert_eq!(used.to_polygons(), PolygonMesh::default());
    for split in splits::<M>() {
        let before = format!("{used:?}", used = FullDebug(&used));
        let result = mesh.split_into(split, &numbers, &mut used);
        let polygon = input.faces().iter().find(|(_, face)| face.len() != 3);
        if let (true, Some((face, corners))) = (split.needs_triangles(), polygon) {
            let degree = corners.len();
            assert_eq!(result, Err(RefineError::NotATriangle { face, degree }));
            assert_eq!(
                before,
                format!("{:?}", FullDebug(&used)),
                "mesh after a refused {split}"
            );
            continue;
        }
        let expected = ExpectedChild::new(&mesh, &input, split);
        if expected.double_edge && !M::CAPABILITIES.non_manifold_edges {
            let Err(RefineError::DoubleEdge { first, second }) = result else {
                panic!("{}: expected DoubleEdge from {split}: {result:?}", M::NAME);
            };
            let [first_corners, second_corners] = [first, second].map(|f| {
                let mut corners = input.faces().face(f).to_vec();
                corners.sort_unstable();
                corners
            });
            assert!(
                first != second && first_corners == second_corners,
                "{first} and {second}"
            );
            assert_eq!(
                before,
                format!("{:?}", FullDebug(&used)),
                "mesh after a refused {split}"
            );
            continue;
        }
        result.unwrap_or_else(|e| panic!("{}: {split} refused: {e}", M::NAME));
        expected.check(&mesh, &numbers, &mut used, split);
        let mut fresh = M::empty();
        let result = mesh.split_into(split, &numbers, &mut fresh);
        result.expect("the same split succeeded before");
        expected.check(&mesh, &numbers, &mut fresh, split);
        assert_eq!(
            format!("{:?}", FullDebug(&fresh)),
            format!("{:?}", FullDebug(&used)),
            "{}: {split} into an empty mesh (left) and into a used one (right)",
            M::NAME
        );
    }
}

/// Refined meshes of many chunks are equal on one thread and on three.
pub fn refine_in_parallel<M: Refine>() {
    let pool = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started")
    };
    let message = "shapes of this size can be built";
    let mut meshes = vec![
        sixfold_shapes::geodesic(24).expect(message),
        sixfold_shapes::triangle_grid(70, 81).expect(message),
    ];
    if M::CAPABILITIES.polygons {
        meshes.push(sixfold_shapes::mixed_grid(60, 77).expect(message));
    }
    for polygons in &meshes {
        let Some(Subject { mesh, input, .. }) = Subject::<M>::from_polygons(polygons) else {
            panic!("{} refuses a manifold", M::NAME);
        };
        let mut numbers = M::EdgeNumbers::default();
        mesh.number_edges(&mut numbers);
        for split in splits::<M>() {
            let refined = |threads| {
                pool(threads).install(|| {
                    let mut numbers = M::EdgeNumbers::default();
                    mesh.number_edges(&mut numbers);
                    check_edge_numbers(&mesh, &numbers);
                    let mut child = M::empty();
                    let result = mesh.split_into(split, &numbers, &mut child);
                    result.ok()?;
                    child.positions_mut().fill(Point::ZERO);
                    Some(child)
                })
            };
            let (Some(mut one), Some(three)) = (refined(1), refined(3)) else {
                assert!(split.needs_triangles(), "{}: {split} refused", M::NAME);
                continue;
            };
            let same =
                format!("{one:?}", one = FullDebug(&one)) == format!("{:?}", FullDebug(&three));
            assert!(
                same,
                "{}: {split} differs on one thread and on three",
                M::NAME
            );
            let expected = ExpectedChild::new(&mesh, &input, split);
            expected.check(&mesh, &numbers, &mut one, split);
        }
    }
}

/// A mesh whose debug output is its polygons, positions and edges.
struct FullDebug<'a, M>(&'a M);

impl<M: Refine> std::fmt::Debug for FullDebug<'_, M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let polygons = self.0.to_polygons();
        let edges: Vec<_> = self.0.edges().collect();
        let ends = edges.iter().map(|&e| self.0.edge_vertices(e));
        let leaving: Vec<Vec<_>> = self
            .0
            .vertices()
            .map(|v| self.0.vertex_edges(v).collect())
            .collect();
        let ends: Vec<_> = ends.collect();
        write!(f, "{polygons:?} {edges:?} {ends:?} {leaving:?}")
    }
}

fn check_edge_numbers<M: Refine>(mesh: &M, numbers: &M::EdgeNumbers) {
    let edges: Vec<M::Edge> = mesh.edges().collect();
    let chunks = mesh.edge_chunks(numbers);
    assert_eq!(
        chunks.first(),
        Some(&0),
        "{}: start of the first chunk",
        M::NAME
    );
    assert_eq!(
        chunks.last(),
        Some(&edges.len()),
        "{}: end of the chunks",
        M::NAME
    );
    let mut again = Vec::with_capacity(edges.len());
    for (chunk, &start) in chunks.iter().enumerate().take(chunks.len() - 1) {
        assert_eq!(start, again.len(), "{}: start of chunk {chunk}", M::NAME);
        again.extend(mesh.edges_of_chunk(numbers, chunk));
    }
    assert_eq!(again, edges, "{}: the edges of all chunks", M::NAME);
    for (number, &e) in edges.iter().enumerate() {
        assert_eq!(
            mesh.edge_number(numbers, e),
            number,
            "{}: number of {e:?}",
            M::NAME
        );
    }
}

/// The expected result of a split, computed from the faces of the input.
struct ExpectedChild {
    /// Faces of the child, each from its lowest vertex on, with the parent face; sorted.
    faces: Vec<(Vec<usize>, FaceId)>,
    vertices: usize,
    edges: usize,
    /// Whether the split makes two edges with the same ends.
    double_edge: bool,
}

impl ExpectedChild {
    fn new<M: Refine>(mesh: &M, input: &PolygonMesh, split: Split) -> Self {
        let vertices = input.vertex_count();
        let faces = input.face_count();
        let mut edges: BTreeMap<[VertexId; 2], (usize, Vec<FaceId>)> = BTreeMap::new();
        for (number, e) in mesh.edges().enumerate() {
            let mut ends = mesh.edge_vertices(e);
            ends.sort_unstable();
            edges.insert(ends, (number, Vec::new()));
        }
        let pair = |a: VertexId, b: VertexId| [a.min(b), a.max(b)];
        for (f, face) in input.faces().iter() {
            for (i, &a) in face.iter().enumerate() {
                let side = pair(a, face[(i + 1) % face.len()]);
                edges.get_mut(&side).expect("an edge").1.push(f);
            }
        }
        let mut boundary: Vec<usize> = Vec::new();
        let with_one_face = edges.values().filter(|(_, faces)| faces.len() == 1);
        boundary.extend(with_one_face.map(|&(number, _)| number));
        boundary.sort_unstable();
        let face_point = |f: FaceId| vertices + f.index();
        let mut child_faces = Vec::new();
        for (f, face) in input.faces().iter() {
            let degree = face.len();
            let side = |i: usize| &edges[&pair(face[i % degree], face[(i + 1) % degree])];
            let corner = |i: usize| face[i % degree].index();
            let first = match split {
                Split::Quads => vertices + faces,
                _ => vertices,
            };
            let middle = |i: usize| first + side(i).0;
            for i in 0..degree {
                let before = i + degree - 1;
                match split {
                    Split::Quads => {
                        let quad = [corner(i), middle(i), face_point(f), middle(before)];
                        child_faces.push((quad.to_vec(), f));
                    }
                    Split::Triangles => {
                        child_faces.push((vec![corner(i), middle(i), middle(before)], f));
                    }
                    Split::Sqrt3 { trisect } => {
                        let (number, along) = side(i);
                        let other = along.iter().find(|&&g| g != f);
                        let (a, b) = (corner(i), corner(i + 1));
                        match (other, trisect) {
                            (Some(&g), _) => {
                                child_faces.push((vec![a, face_point(g), face_point(f)], f));
                            }
                            (None, false) => child_faces.push((vec![a, b, face_point(f)], f)),
                            (None, true) => {
                                let rank = boundary.binary_search(number).expect("a boundary edge");
                                let near = vertices + faces + 2 * rank;
                                for side in [[a, near], [near, near + 1], [near + 1, b]] {
                                    child_faces.push((vec![side[0], side[1], face_point(f)], f));
                                }
                            }
                        }
                    }
                }
            }
            if split == Split::Triangles {
                child_faces.push(((0..3).map(middle).collect(), f));
            }
        }
        let counts = Counts {
            vertices,
            edges: edges.len(),
            faces,
            corners: input.corner_count(),
            uniform: true,
        };
        let grown = split.refined_counts(&counts, boundary.len());
        assert_eq!(
            grown.faces,
            child_faces.len(),
            "faces by the closed form of {split}"
        );
        let mut ends = BTreeSet::new();
        for (face, _) in &mut child_faces {
            rotate_to_lowest(face);
            let after = face.iter().cycle().skip(1);
            ends.extend(face.iter().zip(after).map(|(&a, &b)| [a.min(b), a.max(b)]));
        }
        child_faces.sort();
        assert!(
            ends.len() <= grown.edges,
            "edges by the closed form of {split}"
        );
        Self {
            faces: child_faces,
            vertices: grown.vertices,
            edges: ends.len(),
            double_edge: ends.len() < grown.edges,
        }
    }

    /// Compares `child` with the expected result.
    fn check<M: Refine>(&self, mesh: &M, numbers: &M::EdgeNumbers, child: &mut M, split: Split) {
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

fn rotate_to_lowest(face: &mut [usize]) {
    let lowest = (0..face.len()).min_by_key(|&i| face[i]).unwrap_or(0);
    face.rotate_left(lowest);
}
