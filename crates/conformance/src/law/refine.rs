//! Laws about structures that refine their own tables.

mod expected_child;

use sixfold_core::{Point, PolygonMesh, Refine, RefineError, Split};

use self::expected_child::ExpectedChild;
use super::limits::check_split_limits;
use crate::subject::Subject;

/// Returns all splits of the structure, including both values of `trisect`.
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

/// The refined mesh of every split is valid, and has the expected faces, edges and parent faces. An
/// impossible split, or one with too many elements, returns the error that describes the reason.
/// Edges are numbered in the order of `edges()`.
pub fn refine<M: Refine>(polygons: &PolygonMesh) {
    let Some(Subject { mesh, input, .. }) = Subject::<M>::from_polygons(polygons) else {
        return;
    };
    let mut numbers = M::EdgeNumbers::default();
    mesh.number_edges(&mut numbers);
    check_edge_numbers(&mesh, &numbers);
    // All splits overwrite this mesh, so its tables are not always empty.
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
        check_split_limits(&mesh, &numbers, split, &used);
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

/// The result of refining a large mesh is the same on one thread and on three threads.
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
