use proptest::collection;
use proptest::prelude::*;
use proptest::sample;
use sixfold_core::{FaceId, Facts, Partition};

use super::*;
use crate::step::{Step, repair};

/// The largest number of ways to join sides that the brute force tries.
const MAX_WAYS: usize = 5000;

/// Generates a few faces on a few vertices.
fn small_mesh() -> impl Strategy<Value = PolygonMesh> {
    (4..7_u32, 1..8_usize, 3..5_usize).prop_flat_map(|(vertices, faces, most)| {
        let all: Vec<u32> = (0..vertices).collect();
        let face = sample::subsequence(all, 3..=most).prop_shuffle();
        collection::vec(face, 1..=faces).prop_map(move |faces| with_few_ways(vertices, faces))
    })
}

/// Builds the mesh of as many of the faces as the brute force can treat.
fn with_few_ways(vertices: u32, mut faces: Vec<Vec<u32>>) -> PolygonMesh {
    let at = |v: u32| [v as f32, (v * v) as f32, (v % 3) as f32];
    loop {
        let mesh = PolygonMesh::new((0..vertices).map(at), &faces).expect("valid");
        let edges = edges(&mesh);
        let ways = edges.iter().map(|[up, down]| matchings(up, down).len());
        if ways.product::<usize>() <= MAX_WAYS {
            return mesh;
        }
        faces.pop();
    }
}

/// Returns the sides of each edge, as numbers of corners: those that run up, and those that run
/// down.
fn edges(mesh: &PolygonMesh) -> Vec<[Vec<usize>; 2]> {
    let incidence = Incidence::new(mesh.vertex_count(), mesh.faces(), |_| true);
    let lists = incidence.edges().map(|edge| {
        [false, true].map(|downward| {
            let sides = edge.sides().filter(|side| side.downward == downward);
            sides.map(|side| side.corner as usize).collect()
        })
    });
    lists.collect()
}

/// Returns every way to join some of the sides that run up with sides that run down.
fn matchings(up: &[usize], down: &[usize]) -> Vec<Vec<[usize; 2]>> {
    let Some((&side, rest)) = up.split_first() else {
        return vec![Vec::new()];
    };
    let mut found = matchings(rest, down);
    for (i, &other) in down.iter().enumerate() {
        let mut others = down.to_vec();
        others.remove(i);
        for mut pairs in matchings(rest, &others) {
            pairs.push([side, other]);
            found.push(pairs);
        }
    }
    found
}

/// Returns the mesh in which exactly the corners that `pairs` connect share a vertex.
fn joined(mesh: &PolygonMesh, pairs: &[[usize; 2]]) -> PolygonMesh {
    let next = next_corners(mesh.faces());
    let mut classes = Partition::new(next.len());
    for &[side, other] in pairs {
        classes.join(side, next[other].index());
        classes.join(other, next[side].index());
    }
    let positions: Vec<_> = mesh
        .faces()
        .corners()
        .iter()
        .map(|&v| mesh.position(v))
        .collect();
    let faces: Vec<Vec<u32>> = mesh
        .faces()
        .iter()
        .map(|(f, _)| {
            mesh.faces()
                .range(f)
                .map(|c| classes.root(c).0 as u32)
                .collect()
        })
        .collect();
    PolygonMesh::new(positions, &faces).expect("corners of one face stay apart")
}

/// Returns the number of edges with two faces.
fn inner_edges(mesh: &PolygonMesh) -> usize {
    let facts = Facts::from_polygons(mesh);
    facts.edges - facts.boundary_edges
}

/// Returns the largest number of inner edges of all ways to join sides that give an oriented
/// manifold.
fn most_inner_edges(mesh: &PolygonMesh) -> usize {
    let mut ways = vec![Vec::new()];
    for [up, down] in edges(mesh) {
        let choices = matchings(&up, &down);
        let longer = ways.iter().flat_map(|way: &Vec<[usize; 2]>| {
            choices
                .iter()
                .map(move |choice| [&way[..], choice].concat())
        });
        ways = longer.collect();
    }
    let meshes = ways.iter().map(|way| joined(mesh, way));
    let held = meshes.filter(|mesh| Capabilities::ORIENTED_MANIFOLDS.check(mesh).is_ok());
    held.map(|mesh| inner_edges(&mesh))
        .max()
        .expect("no joined sides are a manifold")
}

fn cut_mesh(mesh: &PolygonMesh) -> PolygonMesh {
    repair(mesh, &[Step::Cut]).expect("small").polygons
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 400, ..ProptestConfig::default() })]

    /// No way to join sides has more joined pairs.
    #[test]
    fn as_many_sides_are_joined_as_possible(mesh in small_mesh()) {
        let cut = cut_mesh(&mesh);
        prop_assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&cut), Ok(()));
        prop_assert_eq!(inner_edges(&cut), most_inner_edges(&mesh));
        prop_assert_eq!(&cut_mesh(&cut), &cut);
    }
}

/// Builds two prisms that touch only along the z axis, `length` storeys high. Each of `rings` lists
/// the corners of a prism in the plane, counter-clockwise from the first of `corners`, the origin.
fn touching_prisms(corners: &[[f32; 2]], rings: [&[u32]; 2], length: u32) -> PolygonMesh {
    let storey = corners.len() as u32;
    let floors = (0..=length).map(|z| corners.iter().map(move |&[x, y]| [x, y, z as f32]));
    let mut faces = Vec::new();
    for ring in rings {
        for z in 0..length {
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                let side = [a, b, b + storey, a + storey];
                faces.push(side.map(|v| v + storey * z).to_vec());
            }
        }
        faces.push(ring.iter().rev().copied().collect());
        faces.push(ring.iter().map(|v| v + storey * length).collect());
    }
    PolygonMesh::new(floors.flatten(), &faces).expect("valid")
}

#[test]
fn solids_that_touch_along_edges_are_separated() {
    let squares = [[0, 0], [1, 0], [1, 1], [0, 1], [-1, 0], [-1, -1], [0, -1]];
    let squares = squares.map(|corner| corner.map(|x: i8| f32::from(x)));
    // Faces of different wedges continue each other more straight than faces of one wedge.
    let wedges = [
        [0.0, 0.0],
        [2.0, -1.0],
        [2.0, 1.0],
        [-2.0, 1.0],
        [-2.0, -1.0],
    ];
    for length in [1, 2, 5] {
        for mesh in [
            touching_prisms(&squares, [&[0, 1, 2, 3], &[0, 4, 5, 6]], length),
            touching_prisms(&wedges, [&[0, 1, 2], &[0, 3, 4]], length),
        ] {
            let facts = Facts::from_polygons(&mesh);
            assert_eq!(facts.non_manifold_edges, length as usize);
            let repaired = repair(&mesh, &[Step::Cut]).expect("small");
            let facts = Facts::from_polygons(&repaired.polygons);
            let found = (facts.components, facts.closed, facts.genus);
            assert_eq!(found, (2, true, Some(0)), "{length}");
            assert_eq!(repaired.steps[0].counts.edges_cut, length as usize);
            assert_eq!(repaired.steps[0].counts.vertices_added, length as usize + 1);
        }
    }
}

#[test]
fn sheets_that_cross_are_two_sheets_again() {
    // Two strips of two quads each, which cross along the z axis in the middle.
    let points = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0],
        [-1.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, 1.0],
        [0.0, -1.0, 0.0],
        [0.0, -1.0, 1.0],
        [0.0, 1.0, 0.0],
        [0.0, 1.0, 1.0],
    ];
    let faces = [[2, 0, 1, 3], [0, 4, 5, 1], [6, 0, 1, 7], [0, 8, 9, 1]];
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let repaired = repair(&mesh, &[Step::Cut]).expect("small");
    let vertices = |f: u32| repaired.polygons.faces().face(FaceId::new(f));
    let shared = |a: u32, b: u32| {
        vertices(a)
            .iter()
            .filter(|v| vertices(b).contains(v))
            .count()
    };
    assert_eq!(
        [shared(0, 1), shared(2, 3), shared(0, 2), shared(1, 2)],
        [2, 2, 0, 0]
    );
}

#[test]
fn a_thousand_faces_on_one_edge_are_paired_by_angle() {
    let n = 1000_u32;
    let at = |i: u32| {
        let angle = 0.1234 + f64::from(i) * std::f64::consts::TAU / f64::from(2 * n);
        [angle.cos() as f32, angle.sin() as f32, 0.0]
    };
    let points = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        .into_iter()
        .chain((0..2 * n).map(at));
    let faces = (0..2 * n).map(|i| if i < n { [0, 1, i + 2] } else { [1, 0, i + 2] });
    let mesh = PolygonMesh::new(points, faces).expect("valid");
    let cut = cut_mesh(&mesh);
    assert_eq!(Capabilities::ORIENTED_MANIFOLDS.check(&cut), Ok(()));
    assert_eq!(inner_edges(&cut), n as usize);
    // Each face is joined with the one on the other side of the axis.
    for i in 0..n {
        let [a, b] = [i, i + n].map(|f| cut.faces().face(FaceId::new(f)));
        assert_eq!(a.iter().filter(|v| b.contains(v)).count(), 2, "{i}");
    }
}

#[test]
fn vertices_without_a_fault_keep_their_numbers() {
    let mesh = sixfold_shapes::grid(2, 2).expect("small");
    let mut faces: Vec<Vec<u32>> = mesh
        .faces()
        .iter()
        .map(|(_, face)| face.iter().map(|v| v.index() as u32).collect())
        .collect();
    faces.push(vec![0, 9, 10]);
    let positions = mesh.positions().iter().map(|p| p.to_array());
    let positions = positions.chain([[9.0; 3], [9.0, 8.0, 7.0]]);
    let bow_tie = PolygonMesh::new(positions, &faces).expect("valid");
    let repaired = repair(&bow_tie, &[Step::Cut]).expect("small");
    assert_eq!(repaired.polygons.vertex_count(), 12);
    let v = VertexId::new(0);
    assert_eq!(repaired.vertices.new_elements(v), [v, VertexId::new(11)]);
    assert_eq!(repaired.vertices.old_elements(VertexId::new(11)), [v]);
    assert_eq!(
        repaired.polygons.faces().face(FaceId::new(4)),
        [11, 9, 10].map(VertexId::new)
    );
}

/// Returns boxes that fill a grid of cells, each with six faces; the boxes share vertices.
fn blocks(size: [u32; 3]) -> PolygonMesh {
    let [nx, ny, nz] = size.map(|n| n + 1);
    let number = |[x, y, z]: [u32; 3]| x + nx * (y + ny * z);
    let points = (0..nx * ny * nz).map(|i| [i % nx, i / nx % ny, i / (nx * ny)].map(|x| x as f32));
    let cells = (0..size.iter().product::<u32>())
        .map(|i| [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])]);
    let cube = sixfold_shapes::cube();
    let faces: Vec<Vec<u32>> = cells
        .flat_map(|cell| {
            let corner = |v: VertexId| {
                let at = cube.position(v).to_array().map(|x| u32::from(x > 0.0));
                number([0, 1, 2].map(|axis| cell[axis] + at[axis]))
            };
            let faces = cube.faces().iter();
            faces
                .map(|(_, face)| face.iter().map(|&v| corner(v)).collect())
                .collect::<Vec<_>>()
        })
        .collect();
    PolygonMesh::new(points, faces).expect("valid")
}

#[test]
fn solids_that_share_walls_are_separated() {
    for size in [[2, 1, 1], [3, 1, 1], [2, 2, 1], [2, 2, 2], [3, 2, 2]] {
        let boxes = size.iter().product::<u32>() as usize;
        let cut = cut_mesh(&blocks(size));
        let facts = Facts::from_polygons(&cut);
        assert_eq!(facts.components, boxes, "{size:?}");
        assert_eq!((facts.boundary_edges, facts.non_manifold_edges), (0, 0));
        assert_eq!(
            [cut.vertex_count(), cut.face_count()],
            [8 * boxes, 6 * boxes]
        );
    }
}
