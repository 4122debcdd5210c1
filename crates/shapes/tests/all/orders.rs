//! An order changes only handles and places in memory.

use sixfold_core::{Facts, Point, PolygonMesh, VertexId};
use sixfold_shapes::{Order, breadth_first, morton, shuffled};

fn meshes() -> Vec<PolygonMesh> {
    let meshes = [
        sixfold_shapes::genus(2),
        sixfold_shapes::mixed_grid(6, 7),
        sixfold_shapes::moebius(9),
        sixfold_shapes::grid_with_holes(9, 9, 5),
        PolygonMesh::new([Point::X, Point::Y, Point::Z, Point::ONE], [[1, 3, 2]])
            .map_err(|_| unreachable!("a triangle and an isolated vertex are valid")),
        Ok(PolygonMesh::default()),
    ];
    meshes.map(|mesh| mesh.expect("small parameters")).into()
}

/// Returns the sorted positions, and the sorted faces. A face starts at its least position.
fn content(mesh: &PolygonMesh) -> (Vec<[u32; 3]>, Vec<Vec<[u32; 3]>>) {
    let position = |v: VertexId| mesh.position(v).to_array().map(f32::to_bits);
    let mut positions: Vec<_> = mesh.vertices().map(position).collect();
    positions.sort_unstable();
    let mut faces: Vec<Vec<_>> = Vec::new();
    for (_, face) in mesh.faces().iter() {
        let mut cycle: Vec<_> = face.iter().map(|&v| position(v)).collect();
        let least = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap_or(0);
        cycle.rotate_left(least);
        faces.push(cycle);
    }
    faces.sort_unstable();
    (positions, faces)
}

#[test]
fn every_order_keeps_the_mesh() {
    for mesh in meshes() {
        for order in Order::ALL {
            assert_eq!(order.name().parse(), Ok(order));
            let ordered = order.apply(&mesh, 3);
            assert_eq!(content(&ordered), content(&mesh), "{order}");
            assert_eq!(
                Facts::from_polygons(&ordered),
                Facts::from_polygons(&mesh),
                "{order}"
            );
        }
        assert_eq!(Order::Given.apply(&mesh, 3), mesh);
    }
}

#[test]
fn new_handles_have_the_same_positions_and_corners() {
    for mesh in meshes() {
        for order in Order::ALL {
            let after = order.apply_with_handles(&mesh, 3);
            assert_eq!(after.mesh, order.apply(&mesh, 3), "{order}");
            for v in mesh.vertices() {
                let new_handle = after.vertices[v.index()];
                assert_eq!(
                    after.mesh.position(new_handle),
                    mesh.position(v),
                    "{order}: {v}"
                );
            }
            for (f, face) in mesh.faces().iter() {
                let mut renamed: Vec<_> = face.iter().map(|v| after.vertices[v.index()]).collect();
                let mut new_handle = after.mesh.faces().face(after.faces[f.index()]).to_vec();
                renamed.sort_unstable();
                new_handle.sort_unstable();
                assert_eq!(new_handle, renamed, "{order}: {f}");
            }
        }
    }
}

#[test]
fn shuffling_depends_only_on_the_seed() {
    let mesh = sixfold_shapes::torus(10, 10).expect("small");
    assert_eq!(shuffled(&mesh, 5), shuffled(&mesh, 5));
    assert_ne!(shuffled(&mesh, 5), shuffled(&mesh, 6));
    assert_ne!(shuffled(&mesh, 5), mesh);
    // In a grid, each face starts at its lower left corner. After shuffling, about a quarter of the
    // faces start there.
    let mesh = sixfold_shapes::grid(10, 10).expect("small");
    let mut starts = [0; 4];
    let shuffled_mesh = shuffled(&mesh, 5);
    for (_, face) in shuffled_mesh.faces().iter() {
        let height = |&i: &usize| {
            let p = shuffled_mesh.position(face[i]);
            p.x + p.y
        };
        let lower_left = (0..4).min_by(|a, b| height(a).total_cmp(&height(b)));
        starts[lower_left.expect("a corner")] += 1;
    }
    assert!(starts.iter().all(|&count| count > 10), "{starts:?}");
}

#[test]
fn morton_and_breadth_first_improve_a_shuffled_order() {
    let mesh = sixfold_shapes::built_in_mesh();
    let sorted = morton(&shuffled(&mesh, 1));
    assert_eq!(sorted.positions(), morton(&mesh).positions());
    // The mean distance between the rows of the two ends of a side.
    let step = |mesh: &PolygonMesh| {
        let sides = mesh
            .faces()
            .iter()
            .flat_map(|(_, f)| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])]);
        let sum: usize = sides.map(|(a, b)| a.index().abs_diff(b.index())).sum();
        sum / mesh.corner_count()
    };
    let random = step(&shuffled(&mesh, 1));
    assert!(
        10 * step(&sorted) < random,
        "morton: {} of {random}",
        step(&sorted)
    );
    let ordered = breadth_first(&shuffled(&mesh, 1));
    assert!(
        10 * step(&ordered) < random,
        "breadth first: {} of {random}",
        step(&ordered)
    );
}

#[test]
fn breadth_first_faces_are_sorted_by_their_lowest_vertex() {
    for mesh in meshes() {
        let ordered = breadth_first(&shuffled(&mesh, 2));
        let firsts = ordered
            .faces()
            .iter()
            .map(|(_, face)| face.iter().min().copied());
        assert!(firsts.is_sorted(), "{ordered:?}");
        // Every vertex, except the first vertex of a component, shares a face with an earlier
        // vertex.
        let components =
            Facts::from_polygons(&mesh).components + Facts::from_polygons(&mesh).isolated_vertices;
        let mut reached = vec![false; ordered.vertex_count()];
        for (_, face) in ordered.faces().iter() {
            let first = face.iter().min().expect("a corner");
            for v in face {
                reached[v.index()] |= v != first;
            }
        }
        let starts = reached.iter().filter(|&&reached| !reached).count();
        assert_eq!(starts, components);
    }
}

#[test]
fn meshes_with_nan_and_infinite_positions_are_ordered_too() {
    let odd = [
        Point::NAN,
        Point::INFINITY,
        Point::NEG_INFINITY,
        Point::MAX,
        Point::MIN,
    ];
    let mesh = PolygonMesh::new(odd, [[0, 1, 2], [2, 3, 4]]).expect("valid faces");
    assert_eq!(morton(&mesh).face_count(), 2);
    let same = PolygonMesh::new([Point::ONE; 3], [[2, 1, 0]]).expect("valid faces");
    assert_eq!(morton(&same), same);
}
