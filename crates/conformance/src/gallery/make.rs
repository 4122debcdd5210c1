//! Functions that build the meshes of the gallery.

use sixfold_core::{Point, PolygonMesh};

/// Builds two tetrahedra that share vertex 0.
pub(super) fn closed_bow_tie() -> PolygonMesh {
    let first = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let second = first.map(|face| face.map(|v| if v == 0 { 0 } else { v + 3 }));
    mesh(7, &[first, second].concat())
}

/// Builds a quad grid whose left and right columns are joined in opposite directions.
pub(super) fn klein_bottle(m: u32, n: u32) -> PolygonMesh {
    let at = |i: u32, j: u32| match i == m {
        true => (n - j % n) % n,
        false => i * n + j % n,
    };
    let cells = (0..m).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces = cells.map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    mesh(m * n, &faces.collect::<Vec<_>>())
}

/// Builds 4 × 4 quads without two inner quads that share only a corner.
pub(super) fn touching_holes() -> PolygonMesh {
    let cells = (0..4_u32).flat_map(|j| (0..4_u32).map(move |i| (i, j)));
    let kept = cells.filter(|cell| ![(1, 1), (2, 2)].contains(cell));
    let faces =
        kept.map(|(i, j)| [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| i + x + 5 * (j + y)));
    mesh(25, &faces.collect::<Vec<_>>())
}

/// Builds triangles that join a ring of `n` vertices to two apexes: the first vertex and the last
/// vertex.
pub(crate) fn double_cone(n: u32) -> PolygonMesh {
    let sides = (0..n).map(|i| (1 + i, 1 + (i + 1) % n));
    let faces = sides.flat_map(|(a, b)| [[0, a, b], [n + 1, b, a]]);
    mesh(n + 2, &faces.collect::<Vec<_>>())
}

/// Builds a strip of `n` triangles that starts at `x` and runs to the right.
pub(crate) fn strip(n: u32, x: f32) -> PolygonMesh {
    let faces = (0..n).map(|i| match i % 2 {
        0 => [i, i + 1, i + 2],
        _ => [i + 1, i, i + 2],
    });
    let points = (0..n + 2).map(|i| Point::new(x + i as f32, (i % 2) as f32, 0.0));
    let points: Vec<Point> = points.collect();
    PolygonMesh::new(points, faces).expect("three successive vertices are distinct")
}

/// Builds the surface of a layer of cubes. Each dot in `rows` is one cube.
pub(super) fn voxels(rows: &[&str]) -> PolygonMesh {
    let filled = |x: i32, y: i32, z: i32| {
        let row = usize::try_from(y).ok().and_then(|y| rows.get(y));
        let cell = usize::try_from(x).ok().and_then(|x| row?.chars().nth(x));
        z == 0 && cell == Some('.')
    };
    let mut corners: Vec<[i32; 3]> = Vec::new();
    let mut faces = Vec::new();
    for (y, row) in (0..).zip(rows) {
        for x in (0..).take(row.len()).filter(|&x| filled(x, y, 0)) {
            for (axis, step) in [(0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1)] {
                let mut neighbour = [x, y, 0];
                neighbour[axis] += step;
                if filled(neighbour[0], neighbour[1], neighbour[2]) {
                    continue;
                }
                let mut face = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
                    let mut corner = [x, y, 0];
                    corner[axis] += i32::from(step > 0);
                    corner[(axis + 1) % 3] += u;
                    corner[(axis + 2) % 3] += v;
                    let known = corners.iter().position(|&c| c == corner);
                    known.unwrap_or_else(|| {
                        corners.push(corner);
                        corners.len() - 1
                    }) as u32
                });
                if step < 0 {
                    face.reverse();
                }
                faces.push(face);
            }
        }
    }
    let points = corners
        .iter()
        .map(|c| Point::from_array(c.map(|x| x as f32)));
    PolygonMesh::new(points.collect::<Vec<_>>(), faces).expect("a square has four corners")
}

/// Gives each face its own vertices, with unchanged positions.
pub(super) fn separate_faces(polygons: &PolygonMesh) -> PolygonMesh {
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for (_, corners) in polygons.faces().iter() {
        let first = points.len() as u32;
        points.extend(corners.iter().map(|&v| polygons.position(v)));
        faces.push((first..points.len() as u32).collect::<Vec<_>>());
    }
    PolygonMesh::new(points, faces).expect("each corner has its own vertex")
}

/// Builds two triangles that share an edge only if −0 equals 0.
pub(super) fn negative_zero() -> PolygonMesh {
    let points = [
        Point::new(0.0, 0.0, 0.0),
        Point::new(1.0, -0.0, 0.0),
        Point::new(0.0, 1.0, 0.0),
        Point::new(1.0, 0.0, -0.0),
        Point::new(-0.0, 0.0, -0.0),
        Point::new(0.0, -1.0, 0.0),
    ];
    PolygonMesh::new(points, [[0, 1, 2], [3, 4, 5]]).expect("valid")
}

pub(super) fn coincident_corners() -> PolygonMesh {
    with_positions(
        &mesh(5, &[[0, 1, 2], [0, 2, 3], [0, 3, 4]]),
        &[0, 1, 2, 2, 3],
    )
}

pub(super) fn with_positions(polygons: &PolygonMesh, numbers: &[u32]) -> PolygonMesh {
    let points: Vec<Point> = numbers.iter().map(|&n| distinct_position(n)).collect();
    let faces = polygons.faces().clone();
    PolygonMesh::from_faces(points, faces).expect("the number of vertices is unchanged")
}

/// Places the meshes side by side, as components of one mesh.
pub(super) fn disjoint_union(parts: &[PolygonMesh]) -> PolygonMesh {
    let mut points: Vec<Point> = Vec::new();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for (part, shift) in parts.iter().zip(0_u8..) {
        let first = points.len() as u32;
        let offset = Point::X * 16.0 * f32::from(shift);
        points.extend(part.positions().iter().map(|&p| p + offset));
        let corners = part.faces().iter().map(|(_, face)| corner_numbers(face));
        faces.extend(corners.map(|face| face.iter().map(|v| v + first).collect()));
    }
    PolygonMesh::new(points, faces).expect("the parts are meshes")
}

pub(super) fn mesh<F: AsRef<[u32]>>(vertices: u32, faces: &[F]) -> PolygonMesh {
    let points: Vec<Point> = (0..vertices).map(distinct_position).collect();
    PolygonMesh::new(points, faces).expect("a mesh made by hand is valid")
}

/// Returns a different position for each number.
pub(crate) fn distinct_position(number: u32) -> Point {
    let x = number as f32;
    Point::new(x, (number * number % 7) as f32, (number % 3) as f32)
}

pub(super) fn corner_numbers(corners: &[sixfold_core::VertexId]) -> Vec<u32> {
    corners.iter().map(|v| v.index() as u32).collect()
}

pub(super) fn expect_shape(shape: Result<PolygonMesh, sixfold_shapes::ShapeError>) -> PolygonMesh {
    shape.expect("a shape of this size can be built")
}
