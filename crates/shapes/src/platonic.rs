//! The five Platonic solids, oriented outward.
//!
//! | solid | V | E | F | dual |
//! |---|---|---|---|---|
//! | tetrahedron | 4 | 6 | 4 | tetrahedron |
//! | cube | 8 | 12 | 6 | octahedron |
//! | octahedron | 6 | 12 | 8 | cube |
//! | dodecahedron | 20 | 30 | 12 | icosahedron |
//! | icosahedron | 12 | 30 | 20 | dodecahedron |

use sixfold_core::PolygonMesh;

use crate::builder::MeshBuilder;

/// The golden ratio, (1 + √5) / 2.
const PHI: f64 = 1.618_033_988_749_895;

/// Builds a tetrahedron: four triangles. The vertices are every second corner of the cube with the
/// corners (±1, ±1, ±1).
pub fn tetrahedron() -> PolygonMesh {
    solid(
        &[
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ],
        &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    )
}

/// Builds a cube: six squares, with the corners (±1, ±1, ±1).
///
/// ```text
///      7────────6
///     ╱│       ╱│
///    4────────5 │
///    │ │      │ │      z
///    │ 3──────│─2      │ y
///    │╱       │╱       │╱
///    0────────1        └─ x
/// ```
pub fn cube() -> PolygonMesh {
    solid(
        &[
            [-1.0, -1.0, -1.0],
            [1.0, -1.0, -1.0],
            [1.0, 1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
            [1.0, -1.0, 1.0],
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, 1.0],
        ],
        &[
            [0, 3, 2, 1],
            [0, 1, 5, 4],
            [1, 2, 6, 5],
            [2, 3, 7, 6],
            [3, 0, 4, 7],
            [4, 5, 6, 7],
        ],
    )
}

/// Builds an octahedron: eight triangles, with vertices at ±1 on each axis.
pub fn octahedron() -> PolygonMesh {
    solid(
        &[
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ],
        &[
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
    )
}

/// Builds a dodecahedron: twelve pentagons. The vertices are (±1, ±1, ±1), and the cyclic
/// permutations of (0, ±φ, ±1/φ), with φ = (1 + √5)/2.
pub fn dodecahedron() -> PolygonMesh {
    const Q: f64 = PHI - 1.0;
    solid(
        &[
            [1.0, 1.0, 1.0],
            [1.0, 1.0, -1.0],
            [1.0, -1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, 1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
            [-1.0, -1.0, -1.0],
            [0.0, PHI, Q],
            [0.0, PHI, -Q],
            [0.0, -PHI, Q],
            [0.0, -PHI, -Q],
            [Q, 0.0, PHI],
            [-Q, 0.0, PHI],
            [Q, 0.0, -PHI],
            [-Q, 0.0, -PHI],
            [PHI, Q, 0.0],
            [PHI, -Q, 0.0],
            [-PHI, Q, 0.0],
            [-PHI, -Q, 0.0],
        ],
        &[
            [0, 8, 4, 13, 12],
            [1, 14, 15, 5, 9],
            [2, 12, 13, 6, 10],
            [3, 11, 7, 15, 14],
            [0, 12, 2, 17, 16],
            [4, 18, 19, 6, 13],
            [1, 16, 17, 3, 14],
            [5, 15, 7, 19, 18],
            [0, 16, 1, 9, 8],
            [2, 10, 11, 3, 17],
            [4, 8, 9, 5, 18],
            [6, 19, 7, 11, 10],
        ],
    )
}

/// Builds an icosahedron: twenty triangles. The vertices are the cyclic permutations of (0, ±1,
/// ±φ), with φ = (1 + √5)/2.
pub fn icosahedron() -> PolygonMesh {
    solid(&ICOSAHEDRON_VERTICES, &ICOSAHEDRON_FACES)
}

pub(crate) const ICOSAHEDRON_VERTICES: [[f64; 3]; 12] = [
    [0.0, 1.0, PHI],
    [0.0, 1.0, -PHI],
    [0.0, -1.0, PHI],
    [0.0, -1.0, -PHI],
    [PHI, 0.0, 1.0],
    [-PHI, 0.0, 1.0],
    [PHI, 0.0, -1.0],
    [-PHI, 0.0, -1.0],
    [1.0, PHI, 0.0],
    [1.0, -PHI, 0.0],
    [-1.0, PHI, 0.0],
    [-1.0, -PHI, 0.0],
];

pub(crate) const ICOSAHEDRON_FACES: [[u32; 3]; 20] = [
    [0, 2, 4],
    [0, 5, 2],
    [0, 4, 8],
    [0, 10, 5],
    [0, 8, 10],
    [1, 6, 3],
    [1, 3, 7],
    [1, 8, 6],
    [1, 7, 10],
    [1, 10, 8],
    [2, 9, 4],
    [2, 5, 11],
    [2, 11, 9],
    [3, 6, 9],
    [3, 11, 7],
    [3, 9, 11],
    [4, 6, 8],
    [4, 9, 6],
    [5, 10, 7],
    [5, 7, 11],
];

fn solid<const DEGREE: usize>(vertices: &[[f64; 3]], faces: &[[u32; DEGREE]]) -> PolygonMesh {
    let mut builder = MeshBuilder::with_capacity(vertices.len(), DEGREE * faces.len());
    for &position in vertices {
        builder.add_vertex(position);
    }
    for &face in faces {
        builder.add_face(face);
    }
    builder.build()
}
