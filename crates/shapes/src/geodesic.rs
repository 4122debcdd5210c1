//! The geodesic sphere: a subdivided icosahedron, projected to the unit sphere.

use sixfold_core::PolygonMesh;

use crate::builder::MeshBuilder;
use crate::error::{ShapeError, check_count};
use crate::platonic::{ICOSAHEDRON_FACES, ICOSAHEDRON_VERTICES};

/// Maximum frequency: 60 f² corners must not exceed 2³¹ − 1.
pub(crate) const MAX_FREQUENCY: usize = 5_982;

/// Builds an icosahedron with each edge cut into `frequency` parts, projected to the unit sphere.
///
/// With f = `frequency`, the mesh has 10f² + 2 vertices, 30f² edges and 20f² faces. Twelve vertices
/// have valence 5, and all other vertices have valence 6. In Buckminster Fuller's classification,
/// the mesh is a geodesic sphere of class I.
///
/// ```text
///          c
///         ╱ ╲           f = 3: a vertex is a corner, or the k-th point of an edge,
///        ╱───╲          or an inner point of one face
///       ╱ ╲ ╱ ╲
///      ╱───●───╲
///     ╱ ╲ ╱ ╲ ╱ ╲
///    a───────────b
/// ```
///
/// # Errors
///
/// Fails if `frequency` is outside 1 to 5982.
pub fn geodesic(frequency: usize) -> Result<PolygonMesh, ShapeError> {
    check_count("frequency", frequency, 1, MAX_FREQUENCY)?;
    let f = frequency;
    let mut builder = MeshBuilder::with_capacity(10 * f * f + 2, 60 * f * f);
    for corner in 0..12 {
        builder.add_vertex(on_sphere([(corner, 1), (corner, 0), (corner, 0)]));
    }
    let edges = edges();
    for &[a, b] in &edges {
        for k in 1..f {
            builder.add_vertex(on_sphere([(a, f - k), (b, k), (b, 0)]));
        }
    }
    for face in ICOSAHEDRON_FACES {
        let mut numbers = FaceLattice::new(f, face, &edges);
        // Row j is j steps from the side ab towards c.
        for j in 1..f {
            for i in 1..f - j {
                let [a, b, c] = face;
                let inner = builder.add_vertex(on_sphere([(a, f - i - j), (b, i), (c, j)]));
                numbers.set(i, j, inner);
            }
        }
        for j in 0..f {
            for i in 0..f - j {
                builder.add_face([numbers.at(i, j), numbers.at(i + 1, j), numbers.at(i, j + 1)]);
                if i + j + 1 < f {
                    let right = numbers.at(i + 1, j + 1);
                    builder.add_face([numbers.at(i + 1, j), right, numbers.at(i, j + 1)]);
                }
            }
        }
    }
    Ok(builder.build())
}

/// Vertex numbers of the lattice points of one divided face, row by row.
struct FaceLattice {
    frequency: usize,
    numbers: Vec<u32>,
}

impl FaceLattice {
    /// Fills in the points on the sides of the face. The inner points are set later.
    fn new(frequency: usize, [a, b, c]: [u32; 3], edges: &[[u32; 2]]) -> Self {
        let f = frequency;
        let numbers = vec![0; (f + 1) * (f + 2) / 2];
        let mut lattice = Self { frequency, numbers };
        for k in 0..f {
            lattice.set(k, 0, on_edge(f, a, b, k, edges));
            lattice.set(f - k, k, on_edge(f, b, c, k, edges));
            lattice.set(0, f - k, on_edge(f, c, a, k, edges));
        }
        lattice
    }

    fn index(&self, i: usize, j: usize) -> usize {
        // Row r has f + 1 − r points.
        j * (self.frequency + 1) - j * j.saturating_sub(1) / 2 + i
    }

    fn at(&self, i: usize, j: usize) -> u32 {
        self.numbers[self.index(i, j)]
    }

    fn set(&mut self, i: usize, j: usize, number: u32) {
        let index = self.index(i, j);
        self.numbers[index] = number;
    }
}

/// Returns the vertex `k` steps from `from` towards `to`.
fn on_edge(frequency: usize, from: u32, to: u32, k: usize, edges: &[[u32; 2]]) -> u32 {
    if k == 0 {
        return from;
    }
    let ends = [from.min(to), from.max(to)];
    let edge = edges
        .binary_search(&ends)
        .expect("an edge of the icosahedron");
    let step = if from < to { k } else { frequency - k };
    (12 + edge * (frequency - 1) + step - 1) as u32
}

/// Returns the thirty edges of the icosahedron, sorted. Each edge has its lower end first.
fn edges() -> Vec<[u32; 2]> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let sides = ICOSAHEDRON_FACES.iter().flat_map(sides);
    // Each edge occurs as a side once in each direction.
    let mut edges: Vec<[u32; 2]> = sides.filter(|[a, b]| a < b).collect();
    edges.sort_unstable();
    edges
}

/// Returns the weighted mean of three corners, projected to the unit sphere.
fn on_sphere(weights: [(u32, usize); 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (corner, weight) in weights {
        let corner = ICOSAHEDRON_VERTICES[corner as usize];
        for axis in 0..3 {
            sum[axis] += weight as f64 * corner[axis];
        }
    }
    let [x, y, z] = sum;
    let length = (x * x + y * y + z * z).sqrt();
    sum.map(|x| x / length)
}
